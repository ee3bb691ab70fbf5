//! Probe of a model before an analysis: repeatability, order of points, errors, noise, speed.
//!
//! Evaluations: `2N + 55` for N varying dimensions, or one if the nominal dimensions have no value. The points are always the same.
//!
//! Source of the noise level: Moré and Wild, Estimating Computational Noise, SIAM J. Sci. Comput. 33 (2011), algorithm ECnoise. The level
//! is the standard deviation from differences of order k of values at equal distances, at an order from which it no longer depends on k.

use std::time::Duration;

use crate::assembly::EvaluatorAccount;
use crate::assembly::{EvaluationError, ModelInfo, Points, Responses, Run};
use crate::evaluation::Evaluator;
use crate::problem::Problem;
use crate::summary::RunSummary;
use sensitol_numeric::power::Power;
use sensitol_numeric::time::Instant;

/// Points in the two passes that must agree.
const SCATTERED: usize = 8;
/// Order of the points in the second pass. Each point is approached alone, from the nominal point in steps of a third. A mere reversal
/// would cross the same edges, and a model that flips on a long step would flip at the same places.
const SHUFFLED: [usize; SCATTERED] = [5, 2, 7, 0, 3, 6, 1, 4];
/// Points on the way from the nominal point to another, both included.
const STEPS: usize = 4;
/// Points of the noise estimate.
const LINE: usize = 9;
/// Distance of the points of the noise estimate, as a part of the tolerances.
const CLOSE: f64 = 1e-5;
/// Place outside the tolerances, in half bands, at which the model is likely to fail.
const FAR: f64 = 30.0;
/// Error of a slope by noise, as a part of it, that is accepted at the least step.
const SPOILT: f64 = 1e-3;
/// Greatest differences and noise that are accepted, as a part of the range within the tolerances. The check of repeated nominal points
/// during an analysis ignores them too.
const HARMLESS: f64 = 1e-7;
/// Least differences and noise that are a fault, as a part of the range within the tolerances. A second difference of such noise is of the
/// size of real curvature.
const HARMFUL: f64 = 1e-3;
/// Greatest number of points without a value that a message names.
const NAMED: usize = 5;
/// Reciprocal of the greatest share of points without a value that is only doubtful.
const MANY: usize = 5;

/// Results of a probe.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Probe {
    /// Description that an external program gives of itself.
    pub adapter: Option<ModelInfo>,
    /// Points and time of the probe.
    pub run: RunSummary,
    /// Time from nothing until the model is ready.
    pub start: Duration,
    /// Time for a single point.
    pub alone: Duration,
    /// Time per point, for a batch of several.
    pub together: Duration,
    /// Checks with their findings.
    pub checks: Vec<Check>,
    /// Results of every characteristic.
    pub characteristics: Vec<Probed>,
}

/// Check of one property that a model should have.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Check {
    /// Property that is checked, in words.
    pub what: &'static str,
    /// Finding of the check.
    pub verdict: Finding,
}

/// Result of a check.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Finding {
    /// The model has the property.
    Passed,
    /// The model lacks the property, in a way that an analysis can handle.
    Doubtful(String),
    /// The model lacks the property.
    Failed(String),
    /// There were no values for the check.
    NotChecked,
}

impl Finding {
    /// Fault in words. Returns None if there is none.
    pub fn fault(&self) -> Option<&str> {
        match self {
            Self::Doubtful(fault) | Self::Failed(fault) => Some(fault),
            Self::Passed | Self::NotChecked => None,
        }
    }

    /// Finding from a fault: failed if there is one, else passed.
    fn of(fault: Option<String>) -> Self {
        fault.map_or(Self::Passed, Self::Failed)
    }
}

/// Results of one characteristic.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Probed {
    /// Name of the characteristic.
    pub name: String,
    /// Value at the nominal dimensions. None if there is none.
    pub nominal: Option<f64>,
    /// Standard deviation of the noise in a value. None if no level can be determined.
    pub noise: Option<f64>,
    /// Least step of every dimension, in sigmas, at which noise changes the slope by at most a thousandth. None if the characteristic does
    /// not react to the dimension, or the noise is unknown.
    pub least_step: Vec<Option<f64>>,
    /// Dimensions to which the characteristic does not react within one sigma.
    pub silent: Vec<String>,
}

impl Probe {
    /// True if no check failed, and every check was possible.
    pub fn passed(&self) -> bool {
        self.checks.iter().all(|check| matches!(check.verdict, Finding::Passed | Finding::Doubtful(_)))
    }
}

/// Checks that need values at the nominal dimensions.
const LATER: [&str; 8] = [TWICE, NOISE, WITHIN, ORDER, AFTER, FAILING, REACTS, RUNS];
const TWICE: &str = "the same point twice has the same values";
const NOISE: &str = "noise is small beside what the tolerances move";
const WITHIN: &str = "every point within the tolerances has values";
const ORDER: &str = "the order of the points does not matter";
const AFTER: &str = "the nominal values are the same after other points";
const FAILING: &str = "the nominal values are the same after points where it may fail";
const REACTS: &str = "every characteristic reacts to some dimension";
const RUNS: &str = "its processes go on running";

/// Greatest number of evaluations of a probe. There are fewer if the nominal dimensions have no values.
pub fn evaluations(problem: &Problem) -> usize {
    2 * ProbePoints { problem }.varying().len() + (1 + STEPS) * SCATTERED + LINE + 6
}

/// Probes the model of a problem. Without any value at the nominal dimensions, no other point is evaluated.
///
/// # Errors
/// If the model cannot be used at all.
pub fn probe(problem: &Problem, run: &Run<'_>) -> Result<Probe, EvaluationError> {
    let begun = Instant::now();
    let adapter = problem.function().prepare(problem.outputs())?;
    let start = begun.elapsed();
    let mut probing = Probing::new(problem, run);
    // The first point may warm something up.
    let (first, warming) = probing.ask_timed(&[probing.nominal.clone()]);
    probing.check_nominal(&first);
    let ([alone, together], characteristics) = if probing.has_values(&first) {
        let (passes, times) = probing.ask_passes(first);
        let noise = passes.noise(probing.names.len());
        probing.check_passes(&passes, &noise);
        let characteristics = probing.probed(&passes, &noise);
        probing.check(REACTS, reacts(&probing.names, &passes));
        probing.check(RUNS, runs(problem));
        (times, characteristics)
    } else {
        LATER.into_iter().for_each(|what| probing.check(what, Finding::NotChecked));
        ([warming; 2], probing.unknown())
    };
    let Probing { evaluator, checks, .. } = probing;
    let run = RunSummary {
        wall: begun.elapsed(),
        stopped: run.stop_reason(),
        evaluator: problem.evaluator(),
        ..evaluator.summary()
    };
    Ok(Probe { adapter, run, start, alone, together, checks, characteristics })
}

/// Answers of the model to the points of a probe, in the order of their evaluation.
struct Passes {
    /// At the nominal dimensions.
    first: Responses,
    /// There again.
    second: Responses,
    scattered: Answered,
    /// Answers on walks to the scattered points, in another order.
    walked: Responses,
    line: Answered,
    /// Answer at the nominal dimensions, after all of these.
    after: Responses,
    /// Answer at the nominal dimensions, after points at which the model may fail.
    failing: Responses,
    steps: Answered,
}

/// Points with the answers to them.
struct Answered {
    rows: Vec<Vec<f64>>,
    out: Responses,
}

impl Passes {
    /// The noise of every characteristic along the line.
    fn noise(&self, characteristics: usize) -> Vec<Option<f64>> {
        let values = |c: usize| (0..LINE).map(|row| self.line.out.value(row, c)).collect::<Option<Vec<f64>>>();
        (0..characteristics).map(|c| values(c).and_then(|values| level(&values))).collect()
    }

    /// The values of a characteristic at the steps of one sigma, if it has any.
    fn stepped(&self, c: usize) -> Vec<f64> {
        (0..self.steps.rows.len()).filter_map(|row| self.steps.out.value(row, c)).collect()
    }
}

/// Checks of a probe so far.
struct Probing<'a> {
    evaluator: Evaluator<'a>,
    points: ProbePoints<'a>,
    nominal: Vec<f64>,
    /// Names of the characteristics.
    names: Vec<String>,
    checks: Vec<Check>,
}

impl<'a> Probing<'a> {
    /// A probe of a problem's model before the first evaluation.
    fn new(problem: &'a Problem, run: &'a Run<'a>) -> Self {
        Self {
            evaluator: Evaluator::new(problem, run),
            points: ProbePoints { problem },
            nominal: problem.dimensions().iter().map(|dimension| dimension.nominal()).collect(),
            names: problem.characteristics().iter().map(|one| one.name().to_owned()).collect(),
            checks: Vec::new(),
        }
    }

    /// Adds a check with its result.
    fn check(&mut self, what: &'static str, verdict: Finding) {
        self.checks.push(Check { what, verdict });
    }

    /// Asks for points in one batch.
    fn ask(&self, rows: &[Vec<f64>]) -> Responses {
        self.evaluator.ask(&Points::from_rows(rows))
    }

    /// Asks for points, and returns the time that they took with the answers.
    fn ask_timed(&self, rows: &[Vec<f64>]) -> (Responses, Duration) {
        let begun = Instant::now();
        let out = self.ask(rows);
        (out, begun.elapsed())
    }

    /// Requests every point after the first one. Returns the times for a point by itself and for one of many, too.
    fn ask_passes(&self, first: Responses) -> (Passes, [Duration; 2]) {
        let nominal = self.nominal.clone();
        let (second, alone) = self.ask_timed(std::slice::from_ref(&nominal));
        let scattered: Vec<Vec<f64>> = (0..SCATTERED).map(|index| self.points.scattered(index)).collect();
        let (forward, forward_time) = self.ask_timed(&scattered);
        let together = forward_time / SCATTERED as u32;
        let walks: Vec<Vec<f64>> = SHUFFLED.iter().flat_map(|&row| walk(&nominal, &scattered[row])).collect();
        let walked = self.ask(&walks);
        let line: Vec<Vec<f64>> =
            (0..LINE).map(|index| self.points.along(&nominal, CLOSE * (index as f64 - 4.0))).collect();
        let close = self.ask(&line);
        let after = self.ask(std::slice::from_ref(&nominal));
        // Whether these fail is the model's business; what matters is what comes after.
        let outside: Vec<Vec<f64>> = [FAR, -FAR].map(|far| self.points.along(&nominal, far)).to_vec();
        self.ask(&outside);
        let failing = self.ask(std::slice::from_ref(&nominal));
        let steps: Vec<Vec<f64>> = self.points.steps(&nominal);
        let stepped = self.ask(&steps);
        let passes = Passes {
            first,
            second,
            scattered: Answered { rows: scattered, out: forward },
            walked,
            line: Answered { rows: line, out: close },
            after,
            failing,
            steps: Answered { rows: steps, out: stepped },
        };
        (passes, [alone, together])
    }

    /// Checks that every characteristic has a value at the nominal dimensions.
    fn check_nominal(&mut self, first: &Responses) {
        let missing = (0..self.names.len()).find(|&c| first.value(0, c).is_none());
        let fault = missing.map(|c| format!("`{}`: {}", self.names[c], reason(first, 0, c)));
        self.check("the nominal dimensions have values", Finding::of(fault));
    }

    /// Returns true if some characteristic has a value at the nominal dimensions.
    fn has_values(&self, first: &Responses) -> bool {
        (0..self.names.len()).any(|c| first.value(0, c).is_some())
    }

    /// Checks repeatability, noise, values within the tolerances and the order of the points.
    fn check_passes(&mut self, passes: &Passes, noise: &[Option<f64>]) {
        let Passes { first, second, scattered, walked, line, after, failing, steps } = passes;
        let characteristics = 0..self.names.len();
        // The ranges over which the tolerances move the outputs, by everything that was evaluated within them.
        let evaluated = [first, &scattered.out, walked, &steps.out];
        let moved: Vec<f64> = characteristics.clone().map(|c| spread(&evaluated, c)).collect();
        self.check(TWICE, repeats(&self.names, first, second, &moved));
        self.check(NOISE, quiet(&self.names, noise, &moved));
        self.check(WITHIN, self.points.within(&self.nominal, &[scattered, line, steps]));
        let ends: Vec<(usize, usize)> =
            SHUFFLED.iter().enumerate().map(|(turn, &row)| (row, STEPS * turn + STEPS - 1)).collect();
        // Values that repeat as well as that are the same.
        let by: Vec<f64> = characteristics.map(|c| (10.0 * noise[c].unwrap_or(0.0)).max(HARMLESS * moved[c])).collect();
        self.check(ORDER, same(&self.names, &ends, &scattered.out, walked, &by));
        self.check(AFTER, same(&self.names, &[(0, 0)], first, after, &by));
        self.check(FAILING, same(&self.names, &[(0, 0)], first, failing, &by));
    }

    /// The results of every characteristic.
    fn probed(&self, passes: &Passes, noise: &[Option<f64>]) -> Vec<Probed> {
        (0..self.names.len()).map(|c| self.probed_characteristic(passes, noise[c], c)).collect()
    }

    /// The noise, steps and silent dimensions of one characteristic.
    fn probed_characteristic(&self, passes: &Passes, noise: Option<f64>, c: usize) -> Probed {
        let dimensions = self.points.problem.dimensions();
        let (varying, stepped) = (self.points.varying(), &passes.steps.out);
        let change = |index: usize| Some((stepped.value(2 * index, c)? - stepped.value(2 * index + 1, c)?).abs() / 2.0);
        // Over a step of h sigmas noise makes `noise / h` of a slope that is `change` per sigma.
        let step = |index: usize| {
            let (change, noise) = (change(index)?, noise?);
            (change > 10.0 * noise && change > 0.0).then_some(noise / change / SPOILT)
        };
        let nominal = passes.first.value(0, c);
        let still = |row: usize| nominal.is_some() && stepped.value(row, c) == nominal;
        let silent = (0..varying.len()).filter(|&index| still(2 * index) && still(2 * index + 1));
        Probed {
            name: self.names[c].clone(),
            nominal,
            noise,
            least_step: (0..dimensions.len()).map(|d| varying.iter().position(|&v| v == d).and_then(step)).collect(),
            silent: silent.map(|index| dimensions[varying[index]].name().to_owned()).collect(),
        }
    }

    /// The results of a model that has no values at the nominal dimensions.
    fn unknown(&self) -> Vec<Probed> {
        let unknown = |name: &String| Probed {
            name: name.clone(),
            nominal: None,
            noise: None,
            least_step: vec![None; self.points.problem.dimensions().len()],
            silent: Vec::new(),
        };
        self.names.iter().map(unknown).collect()
    }
}

/// Returns a failure if a characteristic has its nominal value at all steps of one sigma.
fn reacts(names: &[String], passes: &Passes) -> Finding {
    let mute = |&c: &usize| {
        let known = passes.stepped(c);
        let is_nominal = |nominal: f64| !known.is_empty() && known.iter().all(|value| *value == nominal);
        passes.first.value(0, c).is_some_and(is_nominal)
    };
    let unknown = |c: usize| {
        passes.first.value(0, c).is_none() || (!passes.steps.rows.is_empty() && passes.stepped(c).is_empty())
    };
    match (0..names.len()).find(mute) {
        Some(c) => Finding::Failed(format!("`{}` is the same at every point within one sigma", names[c])),
        None if (0..names.len()).any(unknown) => Finding::NotChecked,
        None => Finding::Passed,
    }
}

/// Points in equal steps from one point to another, both included.
fn walk(from: &[f64], to: &[f64]) -> Vec<Vec<f64>> {
    let last = STEPS - 1;
    let part =
        |step: usize, (&a, &b): (&f64, &f64)| if step == last { b } else { a + (b - a) * step as f64 / last as f64 };
    (0..STEPS).map(|step| from.iter().zip(to).map(|pair| part(step, pair)).collect()).collect()
}

/// Points of a probe about a problem.
struct ProbePoints<'a> {
    problem: &'a Problem,
}

impl ProbePoints<'_> {
    fn varying(&self) -> Vec<usize> {
        (0..self.problem.dimensions().len()).filter(|&d| self.problem.dimensions()[d].sigma() > 0.0).collect()
    }

    /// Point with all dimensions off the nominal by this part of their half bands.
    fn along(&self, nominal: &[f64], part: f64) -> Vec<f64> {
        let dimensions = self.problem.dimensions();
        nominal.iter().zip(dimensions).map(|(x, dimension)| x + part * dimension.half_band()).collect()
    }

    /// Point within the tolerances, by fractions of the golden ratio, which fill any box evenly.
    fn scattered(&self, index: usize) -> Vec<f64> {
        let fraction = |d: usize| (0.5 + (1 + index + SCATTERED * d) as f64 * 0.618_033_988_749_894_9).fract();
        let place = |(d, dimension): (usize, &sensitol_numeric::dimension::Dimension)| {
            let [lower, upper] = dimension.reach();
            dimension.nominal() + lower + fraction(d) * (upper - lower)
        };
        self.problem.dimensions().iter().enumerate().map(place).collect()
    }

    /// Checks that all points within the tolerances have values, and names those without.
    fn within(&self, nominal: &[f64], asked: &[&Answered]) -> Finding {
        let outputs = self.problem.outputs().len();
        let mut failed: Vec<String> = Vec::new();
        let mut points = 0;
        for Answered { rows, out } in asked {
            points += rows.len();
            for (row, point) in rows.iter().enumerate() {
                if let Some(c) = (0..outputs).find(|&c| out.value(row, c).is_none()) {
                    failed.push(format!("{}: {}", self.place(nominal, point), reason(out, row, c)));
                }
            }
        }
        if failed.is_empty() {
            return Finding::Passed;
        }
        let shown = failed.iter().take(NAMED).cloned().collect::<Vec<_>>().join("; ");
        let more = failed.len().saturating_sub(NAMED);
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        let fault = format!("{} of {points} points had no value: {shown}{more}", failed.len());
        if failed.len() * MANY > points { Finding::Failed(fault) } else { Finding::Doubtful(fault) }
    }

    /// Text of a point: the dimensions that are not nominal.
    fn place(&self, nominal: &[f64], point: &[f64]) -> String {
        let moved = self.problem.dimensions().iter().zip(nominal.iter().zip(point)).filter(|(_, (x, at))| x != at);
        let mut words: Vec<String> = moved.map(|(dimension, (_, at))| format!("{} = {at}", dimension.name())).collect();
        if words.is_empty() {
            return "the nominal dimensions".to_owned();
        }
        if words.len() > NAMED {
            words.truncate(NAMED);
            words.push("...".to_owned());
        }
        words.join(", ")
    }

    /// Points one sigma up and one down for every dimension that varies.
    fn steps(&self, nominal: &[f64]) -> Vec<Vec<f64>> {
        let step = |d: usize, sigmas: f64| {
            let mut point = nominal.to_vec();
            point[d] += sigmas * self.problem.dimensions()[d].sigma();
            point
        };
        self.varying().into_iter().flat_map(|d| [step(d, 1.0), step(d, -1.0)]).collect()
    }
}

fn reason(out: &Responses, row: usize, c: usize) -> String {
    out.error(row, c).map_or("it was not evaluated".to_owned(), ToString::to_string)
}

/// Compares two answers to the same points within tolerances, by pairs of their rows.
fn same(names: &[String], rows: &[(usize, usize)], a: &Responses, b: &Responses, by: &[f64]) -> Finding {
    let mut compared = false;
    for &(row, other) in rows {
        for (c, name) in names.iter().enumerate() {
            let fault = match (a.value(row, c), b.value(other, c)) {
                (Some(x), Some(y)) if (x - y).abs() <= by[c] => {
                    compared = true;
                    continue;
                }
                (None, None) => continue,
                (Some(x), Some(y)) => format!("`{name}` was {x} and then {y}"),
                (Some(x), None) => format!("`{name}` was {x} and then had no value: {}", reason(b, other, c)),
                (None, Some(y)) => format!("`{name}` had no value ({}) and then was {y}", reason(a, row, c)),
            };
            return Finding::Failed(fault);
        }
    }
    if compared { Finding::Passed } else { Finding::NotChecked }
}

/// Range of a characteristic over these answers, 0 without any.
fn spread(answers: &[&Responses], c: usize) -> f64 {
    let values = || answers.iter().flat_map(|out| (0..out.rows()).filter_map(|row| out.value(row, c)));
    let [least, most] =
        values().fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| [least.min(value), most.max(value)]);
    (most - least).max(0.0)
}

/// Checks that the same point has the same values. A difference far below the range within the tolerances is doubtful only.
fn repeats(names: &[String], first: &Responses, second: &Responses, moved: &[f64]) -> Finding {
    let exact = same(names, &[(0, 0)], first, second, &vec![0.0; names.len()]);
    let Finding::Failed(fault) = exact else { return exact };
    let harmless = |c: usize| match (first.value(0, c), second.value(0, c)) {
        (Some(a), Some(b)) => (a - b).abs() < HARMFUL * moved[c],
        (None, None) => true,
        _ => false,
    };
    if (0..names.len()).all(harmless) { Finding::Doubtful(fault) } else { Finding::Failed(fault) }
}

/// Checks that the noise of every characteristic is small compared with its range within the tolerances.
fn quiet(names: &[String], noise: &[Option<f64>], moved: &[f64]) -> Finding {
    let share = |c: usize| noise[c].filter(|_| moved[c] > 0.0).map(|noise| noise / moved[c]);
    let Some((c, share)) = (0..names.len()).filter_map(|c| Some((c, share(c)?))).max_by(|a, b| a.1.total_cmp(&b.1))
    else {
        return Finding::Passed;
    };
    let fault = || {
        format!(
            "that of `{}` is {:.1e} at steps that should not matter, and the tolerances move it by {:.1e}: it scatters, or jumps at the \
             nominal dimensions",
            names[c],
            share * moved[c],
            moved[c]
        )
    };
    match share {
        share if share >= HARMFUL => Finding::Failed(fault()),
        share if share > HARMLESS => Finding::Doubtful(fault()),
        _ => Finding::Passed,
    }
}

/// Checks that the processes of an external model did not fail.
fn runs(problem: &Problem) -> Finding {
    let Some(account) = problem.function().account().filter(EvaluatorAccount::has_failures) else {
        return Finding::Passed;
    };
    let failures = account.counts.failures();
    let cause = account.last.map(|error| format!("; the last cause: {error}")).unwrap_or_default();
    Finding::Doubtful(format!("{failures} failed, and {} were started in all{cause}", account.counts.starts))
}

/// Noise in values at equal distances. Returns None if their differences show none.
fn level(values: &[f64]) -> Option<f64> {
    let mut differences = values.to_vec();
    let mut levels: Vec<(f64, bool)> = Vec::new();
    let mut gamma = 1.0;
    // Divide by a power of two, so that squares of extreme differences do not overflow or underflow.
    let unit = Power::of(values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max));
    for order in 1..values.len() {
        differences = differences.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let k = order as f64;
        gamma *= 0.5 * k / (2.0 * k - 1.0);
        let square = |d: &f64| unit.inverse().times(*d).powi(2);
        let mean_square = differences.iter().map(square).sum::<f64>() / differences.len() as f64;
        let both_signs = differences.iter().any(|&d| d > 0.0) && differences.iter().any(|&d| d < 0.0);
        levels.push((unit.times((gamma * mean_square).sqrt()), both_signs));
    }
    if values.windows(2).all(|pair| pair[0] == pair[1]) {
        return None;
    }
    // Three orders agree and differences have both signs: the rest is noise and no slope.
    let settled = |three: &[(f64, bool)]| {
        let (least, most) = three
            .iter()
            .fold((f64::INFINITY, 0.0f64), |(least, most), (level, _)| (least.min(*level), most.max(*level)));
        three[0].1 && most <= 4.0 * least
    };
    levels.windows(3).find(|three| settled(three)).map(|three| three[0].0)
}
