//! Rare events: the probability beyond each limit, by importance sampling that the surrogate guides.
//!
//! A yield of 0.999997 is out of reach of plain sampling: a million evaluations find three rejects. A surrogate of a
//! few hundred evaluations predicts nearly where they lie. Points are drawn there from a mixture of densities: beyond
//! the surrogate's limit, near it, and the inputs' own. The model itself decides which of them are rejects. With `h_k`
//! the height of component k relative to the inputs' density and `a_k` its part of the n points,
//!
//! ```text
//! P = E[y beyond the limit] = (1/n) sum_i w_i [y(z_i) beyond],      w_i = 1/sum_k a_k h_k(z_i)
//! ```
//!
//! is unbiased for any surrogate (the balance heuristic: Veach and Guibas 1995; Owen and Zhou 2000). A poor surrogate
//! makes the weights unequal and the interval wide. After every stage the parts follow the rejects found so far.
//!
//! The surrogate may be wrong in places that it gives no sign of. Before points are drawn, the model is evaluated at
//! points that vary as the inputs do and up to four times as widely, and beside the model's switches. Rejects among
//! them that the surrogate's components do not cover get components of their own: half-spaces at the likeliest point of
//! the limit near them, or corners of jumps and contacts. So do rejects that the plain and wide points of a stage find
//! away from all places.
//!
//! A region may exist that no explored point met. The greatest probability of such a region is in the upper end of the
//! interval ([`Unmet`]).
//!
//! Places are of no use if rejects lie all around the means in many variables. If the interval of the weighted points
//! is wider than that of as many plain ones, or their weights are degenerate, the remaining points are plain, and they
//! alone make the estimate (`plain`). The result is never much worse than that of plain sampling.

mod design_point;
mod estimate;
mod exploration;
mod limit_point;
mod measured;
mod mixture;
mod model;
mod plain_points;
mod refuted_tail;
mod search;
mod target;
mod unmet;
mod warnings;
mod yield_estimate;

use serde::Serialize;

use crate::assembly::{EvaluationError, NonRepeatable, Run};
use crate::estimate::NormalSpace;
use crate::evaluation::{Evaluator, Restoration, Restore, at_any_size, history};
use crate::method::{Method, MethodError, Options};
use crate::problem::Problem;
use crate::simulation::{KnownSurrogate, Pace, SimulationError, Surrogates};
use crate::summary::RunSummary;
use crate::warning::Warning;
use crate::warning::serialize::warnings_last;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::json_form::text;
use sensitol_numeric::sampling::SamplingError;
use sensitol_numeric::sampling::SamplingInterval;
use sensitol_numeric::serialize_with_conclusion;
use sensitol_numeric::time::Instant;
use sensitol_numeric::verdict::Judged;
#[cfg(feature = "schema")]
use sensitol_numeric::{json_form::Concluded, verdict::Verdicts};

use crate::rare::design_point::{Place, places};
use crate::rare::exploration::Explored;
use model::Model;
pub use refuted_tail::MOST_TAIL_POINTS;
pub(crate) use refuted_tail::{RefutedTail, sample_refuted};
use search::Search;
use target::Target;
pub use unmet::Unmet;

/// Options of a search for rare events.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RareOptions {
    /// Greatest number of model points in addition to those of the surrogate.
    pub samples: u64,
    /// Seed of the random points. Another seed gives another sample.
    pub seed: u64,
    /// Greatest relative standard error: the search ends when that of every probability is below it. None if all
    /// samples are to be used.
    pub until: Option<f64>,
    /// Options of the surrogate. The method `auto` is `full` for up to 20 varying dimensions, and `six-n` beyond.
    pub surrogate: Options,
}

impl Default for RareOptions {
    fn default() -> Self {
        Self { samples: 10_000, seed: 1, until: None, surrogate: Options::default() }
    }
}

impl RareOptions {
    /// Sets the greatest number of model points in addition to those of the surrogate.
    #[must_use]
    pub fn with_samples(mut self, points: u64) -> Self {
        self.samples = points;
        self
    }

    /// Sets the seed of the random points.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Sets the relative standard error of every probability at which the search ends.
    #[must_use]
    pub fn with_until(mut self, error: f64) -> Self {
        self.until = Some(error);
        self
    }

    /// Sets the options of the surrogate's analysis.
    #[must_use]
    pub fn with_surrogate(mut self, analysis: Options) -> Self {
        self.surrogate = analysis;
        self
    }
}

/// Results of a search for rare events.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
pub struct RareEvents {
    /// Method of the surrogate.
    #[serde(rename = "surrogate")]
    pub method: Method,
    /// Evaluations and time, including those of the surrogate, and the reason for an end before all points or the
    /// accuracy.
    #[serde(flatten)]
    pub run: RunSummary,
    /// Points that were drawn and evaluated.
    pub samples: u64,
    /// Evaluations of the surrogate.
    pub surrogate_evaluations: u64,
    /// True if the requested accuracy was reached. None if none was requested.
    pub reached: Option<bool>,
    /// Evaluations in which the model returned another value than before at the nominal point.
    // Reported as warnings.
    #[serde(skip)]
    pub non_repeatable: Vec<NonRepeatable>,
    /// Joint yield. None for fewer than two characteristics with limits, if the means lie beyond a limit, and if no
    /// point lies beyond any.
    #[serde(rename = "joint_yield")]
    pub joint: Option<f64>,
    /// 95 % interval of the joint yield.
    #[serde(rename = "joint_yield_interval")]
    pub joint_interval: Option<[f64; 2]>,
    /// Verdict on the target of the joint yield. None if there is no target.
    pub joint_requirement: Option<Judged>,
    /// Results of every characteristic, in the problem's order.
    pub characteristics: Vec<RareCharacteristic>,
    /// Warnings about estimates that rest on few points, and about points without a value.
    #[serde(skip)]
    pub warnings: Vec<Warning>,
}

/// Results of one characteristic.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
pub struct RareCharacteristic {
    /// Characteristic, with its limits.
    #[serde(flatten)]
    #[cfg_attr(feature = "schema", schemars(with = "Concluded<Characteristic, Verdicts>"))]
    pub characteristic: Characteristic,
    /// Number of points at which the characteristic has no value.
    pub failed: u64,
    /// Error at the first of these points.
    #[serde(serialize_with = "text")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<String>"))]
    pub error: Option<EvaluationError>,
    /// Results below the lower limit. None if there is no lower limit.
    pub below: Option<Beyond>,
    /// Results above the upper limit. None if there is no upper limit.
    pub above: Option<Beyond>,
    /// Yield. None if the probability beyond one of the limits is unknown.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// 95 % interval of the yield.
    pub yield_interval: Option<[f64; 2]>,
    /// Error of the yield from the size of measured samples. None if no dimension is measured.
    #[serde(rename = "sampling_interval")]
    pub sampling: Option<SamplingInterval>,
    /// True if the run was stopped before all planned points were evaluated. There is no verdict then.
    pub unfinished: bool,
}

/// Results beyond one limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Beyond {
    /// Limit as it was given.
    pub limit: f64,
    /// Probability beyond the limit. None if no point lies there. The interval is then a bound, for a corner that
    /// none of the explored points met.
    pub probability: Option<f64>,
    /// Standard error of the probability.
    pub standard_error: Option<f64>,
    /// Probability in parts per million.
    pub ppm: Option<f64>,
    /// 95 % interval of the probability.
    pub interval: [f64; 2],
    /// Probability if no point without a value lies beyond, and if all of them do. None if every point has a value.
    pub bounds: Option<[f64; 2]>,
    /// Number of points beyond the limit.
    pub hits: u64,
    /// Number of equally weighted points with the same information: `(sum of weights)^2 / sum of their squares`.
    pub effective_samples: f64,
    /// Part of the estimate that the heaviest point has. If it is large, the surrogate has missed the place of the
    /// rejects.
    pub greatest_part: Option<f64>,
    /// Number of points of a plain random sample with the same standard error.
    pub plain_samples: Option<f64>,
    /// Most likely assembly at the limit, from the surrogate and from rejects of the model. None if none is known.
    pub design_point: Option<DesignPoint>,
    /// Bound of the probability of rejects that no point met. None if plain points make the estimate, whose interval
    /// has it already, and if no explored point has a value.
    pub unmet: Option<Unmet>,
    /// Number of plain points that make the estimate, if importance sampling was worse. It is reported as a warning.
    #[serde(skip)]
    pub plain_points: Option<u64>,
}

/// Most likely assembly at a limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DesignPoint {
    /// Distance from the middle, in standard deviations of independent normal variables.
    pub distance: f64,
    /// Value of every dimension, in the problem's order.
    pub values: Vec<f64>,
}

/// Reason why rare events cannot be searched.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RareError {
    /// No characteristic has a limit.
    #[error("no characteristic asked for has a limit: give it a lower or an upper one")]
    NoLimits,
    /// Number of points that is too small or too large.
    #[error("rare events take {least} to {most} points, not {samples}")]
    Samples {
        /// Number of points requested.
        samples: u64,
        /// Smallest number of points.
        least: u64,
        /// Greatest number of points.
        most: u64,
    },
    /// Characteristic whose target is that of the assemblies that keep another one's limits.
    #[error(
        "`{characteristic}` is given `{given}`, and rare events are shares of all assemblies: leave `given` out, or simulate"
    )]
    Given {
        /// Name of the characteristic.
        characteristic: String,
        /// Name of the one that decides which assemblies count.
        given: String,
    },
    /// Problem that cannot be simulated, or has no surrogate.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

impl From<SamplingError> for RareError {
    fn from(error: SamplingError) -> Self {
        Self::Simulation(error.into())
    }
}

impl From<MethodError> for RareError {
    fn from(error: MethodError) -> Self {
        Self::Simulation(error.into())
    }
}

/// Smallest number of points: a handful gives no estimate.
const LEAST: u64 = 50;
/// Greatest number of points: every point is kept in memory until the end.
const MOST: u64 = 10_000_000;
/// Smallest and greatest number of points of a stage from which places and parts are learnt.
const FIRST: [u64; 2] = [60, 2000];
/// Number of learning stages.
const LEARNING: u64 = 2;

/// Estimates the probability beyond every limit.
///
/// Cost: the evaluations of the surrogate's method, and the points requested. Accuracy: standard errors and 95 % intervals. With a good
/// surrogate some hundred points give a probability near 3e-6 to 5 %. The upper end of the interval has what they cannot exclude
/// ([`Unmet`]): some thousand points exclude a corner of three dimensions.
///
/// # Errors
/// When no characteristic has a limit, a dimension cannot be sampled, or there is no surrogate.
///
/// ```
/// use sensitol::rare::{RareOptions, rare};
/// use sensitol::{Characteristic, Closure, Dimension, Problem, SpecLimits};
/// let dimensions = [Dimension::normal("a", 10.0, 0.3)?, Dimension::normal("b", 5.0, 0.4)?];
/// let limits = SpecLimits::new(None, Some(5.75))?; // 4.5 sigma
/// let gap = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1]))?
///     .asking([Characteristic::new("gap").with_limits(limits)])?;
/// let found = rare(&gap, &RareOptions::default().with_samples(4000))?;
/// let [low, high] = found.characteristics[0].above.as_ref().unwrap().interval;
/// assert!(low < 3.3977e-6 && 3.3977e-6 < high && high < 1.3 * low);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rare(problem: &Problem, options: &RareOptions) -> Result<RareEvents, RareError> {
    rare_with(problem, options, &Run::to_the_end(), &|_| {})
}

/// Runs [`rare`] with reports of its pace, and stops when `run` is stopped.
pub fn rare_with(
    problem: &Problem,
    options: &RareOptions,
    run: &Run<'_>,
    pace: &dyn Fn(Pace),
) -> Result<RareEvents, RareError> {
    at_any_size(problem, run, |problem, run| sought(problem, options, run, pace))
}

warnings_last!(RareEvents);
serialize_with_conclusion!(RareCharacteristic);

impl Restore for RareEvents {
    fn restore(&mut self, back: &Restoration<'_>) {
        back.add_time(&mut self.run);
        for (c, one) in self.characteristics.iter_mut().enumerate() {
            one.characteristic = back.problem.characteristics()[c].clone();
            let limits = one.characteristic.limits();
            for (side, limit) in [(&mut one.below, limits.lower()), (&mut one.above, limits.upper())] {
                side.iter_mut().zip(limit).for_each(|(side, limit)| side.limit = limit);
            }
        }
        self.warnings.iter_mut().for_each(|warning| warning.rescale(|name| back.power_of(name)));
    }
}

impl Restore for RareError {
    fn restore(&mut self, back: &Restoration<'_>) {
        if let Self::Simulation(error) = self {
            error.restore(back);
        }
    }
}

fn sought(
    problem: &Problem,
    options: &RareOptions,
    run: &Run<'_>,
    pace: &dyn Fn(Pace),
) -> Result<RareEvents, RareError> {
    options.check(problem)?;
    if let Some((one, given)) = problem.characteristics().iter().find_map(|one| Some((one, one.given()?))) {
        return Err(RareError::Given { characteristic: one.name().to_owned(), given: given.to_owned() });
    }
    problem.function().prepare(problem.outputs()).map_err(|error| SimulationError::Model { error })?;
    // The surrogate comes first: its design points are the places at which points will be drawn.
    let begun = Instant::now();
    let surrogates = Surrogates::of(problem, &options.surrogate, run)?;
    let space = NormalSpace::with_far_tails(problem, surrogates.outcome.plan.varying())?;
    let targets = targets(problem, &surrogates.known, &space);
    let evaluator = Evaluator::new(problem, run).with_seed(options.seed);
    let mut model = Model::new(evaluator, &space);
    let places: Vec<Place> = targets.iter().enumerate().flat_map(|(index, target)| places(index, target)).collect();
    // Each place is checked against the model, which may cross the limit elsewhere.
    let places = correct(places, &targets, (options.samples / 4) as usize, &mut model);
    let mut search = Search::new(&targets, places, (options.samples, options.seed));
    // Points all over the inputs find rejects that the surrogate does not predict.
    if !targets.is_empty() {
        let explored = Explored::new(&targets, &search.reached(), options.samples, !options.seed, &mut model);
        search.learn(&explored, (options.samples / 6) as usize, &mut model);
    }
    let nothing_to_draw = surrogates.outcome.evaluated.stopped().is_some() || targets.is_empty();
    let mut sampled = SampledStages { problem, options, run, begun, model, search, reached: None };
    if !nothing_to_draw {
        sampled.draw(pace);
    }
    Ok(sampled.conclude(&surrogates, targets.is_empty()))
}

impl RareOptions {
    /// Checks the numbers, and that some characteristic has a limit.
    fn check(&self, problem: &Problem) -> Result<(), RareError> {
        if !(LEAST..=MOST).contains(&self.samples) {
            return Err(RareError::Samples { samples: self.samples, least: LEAST, most: MOST });
        }
        if let Some(value) = self.until.filter(|wanted| wanted.is_nan() || *wanted <= 0.0) {
            return Err(SimulationError::Wanted { value }.into());
        }
        if !problem.characteristics().iter().any(|one| one.limits().exist()) {
            return Err(RareError::NoLimits);
        }
        Ok(())
    }
}

/// Stages of points that are drawn until the accuracy or the number of points is reached.
struct SampledStages<'s> {
    problem: &'s Problem,
    options: &'s RareOptions,
    run: &'s Run<'s>,
    begun: Instant,
    model: Model<'s>,
    search: Search<'s>,
    /// True if the accuracy is reached; None without one.
    reached: Option<bool>,
}

impl SampledStages<'_> {
    /// Draws stage after stage; places and parts follow the rejects of each.
    fn draw(&mut self, pace: &dyn Fn(Pace)) {
        let options = self.options;
        let mut done = false;
        while !done {
            let left = options.samples.saturating_sub(self.model.answered);
            let stage = self.stage_points(left);
            let (search, model) = (&mut self.search, &mut self.model);
            done = search.stage(stage.min(left) as usize, model);
            if search.stages >= LEARNING || search.has_many_variables() {
                search.judge(model.answered);
            }
            let shortfall = search.shortfall();
            self.reached = options.until.map(|wanted| shortfall <= wanted && search.confirmed(wanted));
            let more = options.until.map_or(f64::INFINITY, |wanted| (shortfall / wanted).powi(2).max(1.0));
            let expected = (search.points as f64 * more).min((search.points + left) as f64);
            pace(Pace { samples: search.points, expected, elapsed: self.begun.elapsed() });
            done |= model.answered >= options.samples || self.reached == Some(true) || self.run.stopped();
            if !done && !search.is_plain() && (search.stages <= LEARNING || options.until.is_some()) {
                let left = options.samples - model.answered;
                search.follow((left / 4) as usize, model);
            }
        }
    }

    /// The points of the next stage, where so many are left.
    fn stage_points(&self, left: u64) -> u64 {
        let (search, samples) = (&self.search, self.options.samples);
        match self.options.until {
            Some(_) => search.points.max(FIRST[0]),
            // In many variables the first stage decides whether there is a second of its kind.
            None if search.stages == 0 && search.has_many_variables() => (samples / 20).clamp(FIRST[0], FIRST[1]),
            None if search.stages < LEARNING && !search.is_plain() => (samples / 5).clamp(FIRST[0], FIRST[1]),
            None => left,
        }
    }

    /// The points and time of the drawn points, without those of the surrogate.
    fn drawn(&self) -> RunSummary {
        let evaluator = &self.model.evaluator;
        RunSummary { wall: self.begun.elapsed(), seed: Some(evaluator.seed()), ..evaluator.summary() }
    }

    /// The results of all stages and of the surrogate.
    fn conclude(self, surrogates: &Surrogates, no_targets: bool) -> RareEvents {
        let drawn = self.drawn();
        let Self { problem, options, run, model, search, reached, .. } = self;
        let surrogate = &surrogates.outcome.evaluated;
        let spent = surrogate.ledger.run;
        let open = || reached != Some(true) && model.answered < options.samples && !no_targets;
        let stopped = surrogate.stopped().or_else(|| open().then(|| run.why_open()));
        let mut ledger = surrogate.ledger.clone();
        ledger.add(model.evaluator.ledger());
        let non_repeatable = ledger.non_repeatable;
        let samples = search.points;
        let (joint, joint_interval) = search.within_all(problem).unzip();
        let joint = joint.flatten();
        let characteristics = search.characteristics(&model, stopped.is_some());
        let characteristics = measured::with_sampling(problem, &surrogates.outcome, characteristics);
        let joint_interval = joint_interval.map(|interval| measured::joint(joint, interval, &characteristics));
        let joint_requirement = options.surrogate.target_joint_yield.filter(|_| joint_interval.is_some());
        let joint_requirement =
            joint_requirement.map(|target| Judged::of_yield(target, joint, joint_interval).unless(stopped.is_some()));
        let run = RunSummary { stopped, evaluator: problem.evaluator(), ..drawn.and(&spent) };
        let warnings = warnings::of(&characteristics, samples, run.evaluations);
        RareEvents {
            method: surrogates.outcome.method,
            run,
            samples,
            surrogate_evaluations: spent.evaluations,
            reached,
            warnings: warnings.into_iter().chain(history(problem, &non_repeatable)).collect(),
            non_repeatable,
            joint,
            joint_interval,
            joint_requirement,
            characteristics,
        }
    }
}

/// Targets: every limit of every characteristic whose surrogate varies.
fn targets<'a>(problem: &Problem, known: &'a [Option<KnownSurrogate>], space: &'a NormalSpace<'a>) -> Vec<Target<'a>> {
    let mut targets = Vec::new();
    for (c, characteristic) in problem.characteristics().iter().enumerate() {
        let Some(known) = known.get(c).and_then(Option::as_ref) else { continue };
        let (limits, [lower, upper]) = (characteristic.limits(), problem.kept_limits(c).ends());
        for (side, given, limit) in [(-1.0, limits.lower(), lower), (1.0, limits.upper(), upper)] {
            let Some(given) = given else { continue };
            let (surrogate, sigma) = (&known.surrogate, known.moments.sigma);
            let target = Target { space, characteristic: c, side, kept: false, given, limit, surrogate, sigma };
            let middle = target.margins(&vec![vec![0.0]; space.len()]);
            targets.push(Target { kept: middle.first().is_some_and(|&margin| margin > 0.0), ..target });
        }
    }
    targets
}

/// Evaluates the model on the way to each place, and moves the places to its crossings.
///
/// Nearest places come first, as many as the budget allows. These points are not drawn, so no estimate rests on them.
/// Places without a crossing of the model on the way are left out, unless a target has no other.
fn correct(places: Vec<Place>, targets: &[Target<'_>], budget: usize, model: &mut Model<'_>) -> Vec<Place> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    // The first place of every target comes before the second of any.
    let rank = |p: &usize| places[..*p].iter().filter(|other| other.target == places[*p].target).count();
    order.sort_by_key(|p| (rank(p), *p));
    let mut asked: Vec<(usize, f64)> = Vec::new();
    for p in order {
        let stations = places[p].stations();
        // Half as many points again are kept for the second round.
        if asked.len() + stations.len() > budget * 2 / 3 {
            break;
        }
        asked.extend(stations.into_iter().map(|t| (p, t)));
    }
    let mut places = places;
    let first = look(&mut places, targets, &asked, &[], model);
    let again = |(p, place): (usize, &Place)| if first.crosses[p] == Some(true) { place.closer() } else { Vec::new() };
    let again: Vec<(usize, f64)> =
        (places.iter().enumerate()).flat_map(|(p, place)| again((p, place)).into_iter().map(move |t| (p, t))).collect();
    let found = look(&mut places, targets, &again, &first.values, model);
    let crosses: Vec<Option<bool>> =
        first.crosses.iter().zip(&found.crosses).map(|(first, then)| then.or(*first)).collect();
    let known = |target: usize| {
        places.iter().zip(&crosses).any(|(place, crosses)| place.target == target && *crosses == Some(true))
    };
    let known: Vec<bool> = (0..targets.len()).map(known).collect();
    let kept =
        |(place, crosses): (Place, Option<bool>)| (crosses != Some(false) || !known[place.target]).then_some(place);
    places.into_iter().zip(crosses).filter_map(kept).collect()
}

/// Values of the model along the lines to some places.
struct Looked {
    /// Distances and values for every place, ascending.
    values: Vec<Vec<(f64, f64)>>,
    /// True if the model crosses the limit on the way to the place. None if it was not evaluated there.
    crosses: Vec<Option<bool>>,
}

/// Evaluates the model at these distances on the way to the places. Corrects the places by these values and the earlier
/// ones.
fn look(
    places: &mut [Place],
    targets: &[Target<'_>],
    asked: &[(usize, f64)],
    before: &[Vec<(f64, f64)>],
    model: &mut Model<'_>,
) -> Looked {
    let mut looked = Looked { values: vec![Vec::new(); places.len()], crosses: vec![None; places.len()] };
    if asked.is_empty() {
        return looked;
    }
    let column = |j: usize| asked.iter().map(|&(p, t)| t * places[p].direction[j]).collect();
    let answers = model.ask(&(0..model.space.len()).map(column).collect());
    for (row, &(p, t)) in asked.iter().enumerate() {
        if let Some(value) = answers.value(row, targets[places[p].target].characteristic) {
            looked.values[p].push((t, value));
        }
    }
    for (p, (place, values)) in places.iter_mut().zip(&mut looked.values).enumerate() {
        if values.is_empty() {
            continue;
        }
        values.extend(before.get(p).into_iter().flatten());
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        values.dedup_by(|a, b| a.0 == b.0);
        looked.crosses[p] = Some(place.correct(&targets[place.target], values));
    }
    looked
}
