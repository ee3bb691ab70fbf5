//! Comparison of accuracy and cost: every method on one problem, measured against a reference with a known standard error.

use std::fmt;
use std::time::Duration;

use serde::Serialize;

use crate::analysis::{Analysis, CharacteristicAnalysis, analyze_with};
use crate::assembly::Run;
use crate::evaluation::{Restoration, Restore, at_any_size};
use crate::method;
use crate::method::{Method, Options, Procedure};
use crate::problem::Problem;
use crate::simulation::{ROWS, SimulatedCharacteristic, Simulation, SimulationError, SimulationOptions, simulate_with};
use crate::summary::RunSummary;
use sensitol_numeric::json_form::seconds;
use sensitol_numeric::parallel::threads;
use sensitol_numeric::power::{Rescale, Rescaling, rescale};
use sensitol_numeric::sampling::{Estimate, Sampler, one_error};
use sensitol_numeric::time::Instant;
use sensitol_numeric::verdict::Verdict;

/// Limits and seed of a comparison.
///
/// ```
/// use sensitol::compare::CompareOptions;
/// assert_eq!(CompareOptions::default().budget, None);
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CompareOptions {
    /// Greatest number of evaluations of one method, the reference excepted. None for the default rules.
    pub budget: Option<usize>,
    /// Points of the reference. None for the usual number.
    pub reference: Option<u64>,
    /// Seed of the methods that draw points. The reference has another one.
    pub seed: u64,
}

impl Default for CompareOptions {
    fn default() -> Self {
        Self { budget: None, reference: None, seed: 1 }
    }
}

impl CompareOptions {
    /// Sets the greatest number of evaluations of one method.
    #[must_use]
    pub fn with_budget(mut self, evaluations: usize) -> Self {
        self.budget = Some(evaluations);
        self
    }

    /// Sets the number of points of the reference.
    #[must_use]
    pub fn with_reference(mut self, points: u64) -> Self {
        self.reference = Some(points);
        self
    }

    /// Sets the seed.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }
}

/// Points of the reference of a cheap model. They are quasi-random, so that its own error is below the differences between methods.
const REFERENCE: u64 = 1 << 20;
/// Points of the reference of a costly model, which evaluates fewer.
const COSTLY_REFERENCE: u64 = 2000;
/// Sample sizes of the Monte Carlo methods, used if they are smaller than the reference.
const SAMPLES: [u64; 4] = [100, 1000, 10_000, 100_000];
/// Sample sizes of the quasi-random methods: 16 replicates of a power of two.
const QUASI: [u64; 3] = [256, 4096, 65_536];
/// Least ratio of a resolved error to the standard error of the reference.
pub const RESOLVED: f64 = 2.0;

/// Method as it was run: a derivative method, or a sample with this number of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(inline))]
#[serde(into = "String")]
#[non_exhaustive]
pub enum Contender {
    /// Derivative method of the registry.
    Method(Method),
    /// Monte Carlo with this number of random points.
    MonteCarlo(u64),
    /// Quasi-Monte Carlo with this number of Sobol' points.
    QuasiMonteCarlo(u64),
}

impl Contender {
    /// Name in reports, with the number of points of a sample.
    pub fn name(self) -> String {
        match self {
            Self::Method(method) => method.name().to_owned(),
            Self::MonteCarlo(samples) => format!("monte-carlo {samples}"),
            Self::QuasiMonteCarlo(samples) => format!("sobol {samples}"),
        }
    }
}

impl From<Contender> for String {
    fn from(contender: Contender) -> Self {
        contender.name()
    }
}

/// Results of a method for one characteristic. Unknown values are None.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Figures {
    /// Expected value.
    pub mean: Option<f64>,
    /// Standard deviation.
    pub sigma: Option<f64>,
    /// Third standardised moment.
    pub skewness: Option<f64>,
    /// Fourth standardised moment.
    pub kurtosis: Option<f64>,
    /// Share within the limits.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
}

rescale!(Figures { mean, sigma } without { skewness, kurtosis, yield_ });

/// Errors of a method against the reference: that of the mean in sigmas, that of sigma relative, the others absolute.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Errors {
    /// Absolute differences from the reference.
    #[serde(flatten)]
    pub off: Figures,
    /// Standard errors of the reference, in the same units. Differences up to twice these are not resolved.
    #[serde(rename = "reference_standard_error")]
    pub reference: Figures,
    /// Overall error, in sigmas: root of the sum of squares of the errors of mean and sigma. None if one of them is unknown.
    pub overall: Option<f64>,
    /// True if the overall error exceeds the part that may be due to the reference.
    pub resolved: bool,
}

impl Errors {
    /// Errors by the differences from the reference and its standard errors, in the same units.
    fn of(off: Figures, reference: Figures) -> Self {
        let overall = off.mean.zip(off.sigma).map(|(mean, sigma)| libm::hypot(mean, sigma));
        let errors = Self { off, reference, overall, resolved: false };
        Self { resolved: overall.is_some_and(|overall| overall > errors.floor()), ..errors }
    }

    /// Overall error below which the reference cannot resolve: twice its standard error.
    pub fn floor(&self) -> f64 {
        RESOLVED * libm::hypot(self.reference.mean.unwrap_or(0.0), self.reference.sigma.unwrap_or(0.0))
    }
}

/// Method that was run, with its results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ran {
    /// Method or sample that was run.
    #[serde(rename = "method")]
    pub contender: Contender,
    /// Points and time of the run.
    pub run: RunSummary,
    /// Points that the method needs, including those known from another method or an earlier run.
    pub evaluations: u64,
    /// Time within the model. Points that were known count with the average time of the others.
    #[serde(rename = "evaluation_s", serialize_with = "seconds")]
    pub evaluation: Duration,
    /// Time outside the model.
    #[serde(rename = "engine_s", serialize_with = "seconds")]
    pub engine: Duration,
    /// Figures for every characteristic.
    pub figures: Vec<Figures>,
    /// Errors of the figures, for every characteristic.
    pub errors: Vec<Errors>,
    /// Verdict of the method for every characteristic. None if it has no target yield.
    pub verdicts: Vec<Option<Verdict>>,
    /// True for each characteristic if no other method has a smaller error with as many evaluations or fewer.
    pub pareto: Vec<bool>,
}

/// Method that was not run, with the reason.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NotRun {
    /// Method or sample that was not run.
    #[serde(rename = "method")]
    pub contender: Contender,
    /// Evaluations that the method needs, if that is known.
    pub evaluations: Option<u64>,
    /// Time in seconds that the model would have taken, at the speed of the methods that ran.
    pub projected_s: Option<f64>,
    /// Reason for not running it.
    pub reason: NotRunReason,
}

/// Reason for not running a method.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum NotRunReason {
    /// The method needs more evaluations than the reference of a costly model, and no budget allows that.
    OverReference,
    /// The sample has as many points as the reference or more, which therefore cannot measure it.
    LongerThanReference,
    /// The method needs more evaluations than the budget.
    OverBudget,
    /// The run was stopped before this method.
    StoppedBefore,
    /// The run was stopped during this method.
    Stopped,
    /// The method does not fit the problem, or the model cannot be used.
    Impossible {
        /// Error message in words.
        message: String,
    },
}

impl fmt::Display for NotRunReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::OverReference => "more than the reference; a budget allows it",
            Self::LongerThanReference => "longer than the reference",
            Self::OverBudget => "more than the budget",
            Self::StoppedBefore => "stopped before",
            Self::Stopped => "stopped before it was done",
            Self::Impossible { message } => message,
        })
    }
}

/// Results of a comparison.
#[derive(Debug, Clone, Serialize)]
pub struct Comparison {
    /// Reference for all methods.
    pub reference: Simulation,
    /// Methods that ran, fewest evaluations first.
    pub ran: Vec<Ran>,
    /// Methods that were not run.
    pub not_run: Vec<NotRun>,
    /// Points and time of the whole comparison, including the reference, and the reason for an early end.
    #[serde(flatten)]
    pub run: RunSummary,
}

/// Error of a comparison.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// The reference cannot be computed.
    #[error(transparent)]
    Reference(#[from] SimulationError),
}

/// Runs every method that the budget allows, and a reference.
///
/// Evaluations: those of the methods, and of the reference. The reference has a million points for a cheap model and two thousand for a
/// costly one, unless the options set another number.
///
/// # Errors
/// If the problem cannot be simulated. A method that does not fit is no error: it is listed with the reason.
///
/// ```
/// use sensitol::compare::{CompareOptions, Contender, compare};
/// use sensitol::{Closure, Dimension, Method, Problem};
/// let dimensions = [Dimension::normal("a", 10.0, 0.3)?, Dimension::normal("b", 5.0, 0.6)?];
/// let area = Problem::new(dimensions, Closure::scalar("area", |x| x[0] * x[1]))?;
/// let found = compare(&area, &CompareOptions::default().with_reference(10_000))?;
/// let rss = found.ran.iter().find(|ran| ran.contender == Contender::Method(Method::Rss)).expect("rss fits everything");
/// assert_eq!(rss.evaluations, 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(problem: &Problem, options: &CompareOptions) -> Result<Comparison, CompareError> {
    compare_with(problem, options, &Run::to_the_end())
}

/// Runs [`compare`], and stops early if `run` is stopped.
pub fn compare_with(problem: &Problem, options: &CompareOptions, run: &Run<'_>) -> Result<Comparison, CompareError> {
    at_any_size(problem, run, |problem, run| compared(problem, options, run))
}

impl Restore for Comparison {
    fn restore(&mut self, back: &Restoration<'_>) {
        back.add_time(&mut self.run);
        self.reference.rescale(back);
        for ran in &mut self.ran {
            for (c, figures) in ran.figures.iter_mut().enumerate() {
                figures.rescale(&mut Rescaling::by(back.power(c)));
            }
        }
    }
}

impl Restore for CompareError {
    fn restore(&mut self, back: &Restoration<'_>) {
        let Self::Reference(error) = self;
        error.restore(back);
    }
}

fn compared(problem: &Problem, options: &CompareOptions, run: &Run<'_>) -> Result<Comparison, CompareError> {
    let begun = Instant::now();
    let costly = problem.function().signature().costly;
    let samples = options.reference.unwrap_or(if costly { COSTLY_REFERENCE } else { REFERENCE });
    let mut comparison =
        Comparer { problem, options, run, ran: Vec::new(), not_run: Vec::new(), lost: RunSummary::default() };
    // Run the cheap methods first, so that most results are known if time runs out.
    let adaptive = |procedure: &&&dyn Procedure| procedure.method() == Method::Auto;
    for procedure in method::ALL.iter().filter(|one| !adaptive(one)).chain(method::ALL.iter().filter(adaptive)) {
        comparison.method(procedure.method(), costly.then_some(samples));
    }
    let drawn = SAMPLES.map(Contender::MonteCarlo).into_iter().chain(QUASI.map(Contender::QuasiMonteCarlo));
    for contender in drawn {
        comparison.sampled(contender, samples);
    }
    let reference = simulate_with(
        problem,
        // Use another random stream than the methods that are compared with it.
        &SimulationOptions {
            samples,
            sampler: sampler(problem, costly),
            seed: !options.seed,
            ..SimulationOptions::default()
        },
        run,
        &|_| {},
    )?;
    let comparison = comparison.judged(reference);
    Ok(Comparison {
        run: RunSummary { wall: begun.elapsed(), evaluator: problem.evaluator(), ..comparison.run },
        ..comparison
    })
}

/// Quasi-random points if there are enough dimensions of them and the model is cheap. Random points of a costly model may be known already.
fn sampler(problem: &Problem, costly: bool) -> Sampler {
    let varying = problem.dimensions().iter().filter(|dimension| dimension.sigma() > 0.0).count();
    if costly || varying > sensitol_numeric::sampling::SOBOL_DIMENSIONS { Sampler::Random } else { Sampler::Sobol }
}

struct Comparer<'a> {
    problem: &'a Problem,
    options: &'a CompareOptions,
    run: &'a Run<'a>,
    ran: Vec<Ran>,
    not_run: Vec<NotRun>,
    /// Cost of methods that were stopped early.
    lost: RunSummary,
}

impl Comparer<'_> {
    fn refuse(&mut self, contender: Contender, evaluations: Option<u64>, reason: NotRunReason) {
        self.not_run.push(NotRun { contender, evaluations, projected_s: None, reason });
    }

    /// Runs a method. Without a budget, a costly method is refused if it needs more evaluations than the `reference`.
    fn method(&mut self, method: Method, reference: Option<u64>) {
        let contender = Contender::Method(method);
        // Compare the methods without verification, since the reference measures them.
        let options = Options { budget: self.options.budget, verify: Some(0), ..Options::from(method) };
        let cost = match method.procedure().fits(self.problem, &options) {
            Ok(cost) => Some(cost.evaluations as u64),
            Err(error) => return self.refuse(contender, error.needed(), impossible(&error)),
        };
        if self.run.stopped() {
            return self.refuse(contender, cost, NotRunReason::StoppedBefore);
        }
        if let (None, Some(most), Some(needed)) = (self.options.budget, reference, cost)
            && needed > most
        {
            return self.refuse(contender, cost, NotRunReason::OverReference);
        }
        let begun = Instant::now();
        match analyze_with(self.problem, &options, self.run) {
            Ok(analysis) if analysis.run.unfinished() => {
                self.lost = self.lost.and(&analysis.run);
                self.refuse(contender, cost, NotRunReason::Stopped);
            }
            Ok(analysis) => self.ran.push(of_analysis(contender, &analysis, begun.elapsed())),
            Err(mut error) => {
                // The message must show figures in the units of the problem as it was given.
                error.rescale(|name| self.problem.power_of(name));
                self.refuse(contender, cost, impossible(&error));
            }
        }
    }

    fn sampled(&mut self, contender: Contender, reference: u64) {
        let (samples, sampler) = match contender {
            Contender::MonteCarlo(samples) => (samples, Sampler::Random),
            Contender::QuasiMonteCarlo(samples) => (samples, Sampler::Sobol),
            Contender::Method(_) => return,
        };
        // The reference cannot measure a sample of its own size.
        if samples >= reference {
            return self.refuse(contender, Some(samples), NotRunReason::LongerThanReference);
        }
        if self.options.budget.is_some_and(|budget| samples > budget as u64) {
            return self.refuse(contender, Some(samples), NotRunReason::OverBudget);
        }
        if self.run.stopped() {
            return self.refuse(contender, Some(samples), NotRunReason::StoppedBefore);
        }
        let options = SimulationOptions { samples, sampler, seed: self.options.seed, ..SimulationOptions::default() };
        let begun = Instant::now();
        match simulate_with(self.problem, &options, self.run, &|_| {}) {
            Ok(found) if found.run.unfinished() => {
                self.lost = self.lost.and(&found.run);
                self.refuse(contender, Some(samples), NotRunReason::Stopped);
            }
            Ok(found) => {
                let costly = self.problem.function().signature().costly;
                self.ran.push(of_simulation(contender, &found, begun.elapsed(), costly));
            }
            Err(error) => self.refuse(contender, Some(samples), impossible(&error)),
        }
    }

    fn judged(mut self, reference: Simulation) -> Comparison {
        for ran in &mut self.ran {
            ran.errors =
                ran.figures.iter().zip(&reference.characteristics).map(|(found, of)| errors(found, of)).collect();
        }
        self.ran.sort_by_key(|ran| ran.evaluations);
        let fronts: Vec<Vec<bool>> = (0..reference.characteristics.len()).map(|c| front(&self.ran, c)).collect();
        for (index, ran) in self.ran.iter_mut().enumerate() {
            ran.pareto = fronts.iter().map(|front| front[index]).collect();
        }
        let own = |ran: &Ran| (ran.evaluation, ran.evaluations - ran.run.cached);
        let (spent, points) = self
            .ran
            .iter()
            .map(own)
            .fold((reference.run.in_model, reference.run.evaluations), |(time, points), (more, count)| {
                (time + more, points + count)
            });
        let each = spent.as_secs_f64() / points.max(1) as f64;
        for ran in self.ran.iter_mut().filter(|ran| ran.run.cached > 0) {
            ran.evaluation += Duration::try_from_secs_f64(each * ran.run.cached as f64).unwrap_or_default();
        }
        for one in &mut self.not_run {
            one.projected_s = one.evaluations.map(|count| each * count as f64);
        }
        let all = self.ran.iter().fold(reference.run.and(&self.lost), |all, ran| all.and(&ran.run));
        let stopped = reference.run.stopped.or(self.lost.stopped).or_else(|| self.run.stop_reason());
        let run = RunSummary { seed: Some(self.options.seed), stopped, ..all };
        Comparison { reference, ran: self.ran, not_run: self.not_run, run }
    }
}

fn impossible(error: &impl fmt::Display) -> NotRunReason {
    NotRunReason::Impossible { message: error.to_string() }
}

fn of_analysis(contender: Contender, analysis: &Analysis, took: Duration) -> Ran {
    let figures = analysis.characteristics.iter().map(|one| Figures {
        mean: one.moments.map(|moments| moments.mean()),
        sigma: one.moments.map(|moments| moments.sigma()),
        skewness: one.moments.and_then(|moments| moments.skewness()),
        kurtosis: one.moments.and_then(|moments| moments.kurtosis()),
        yield_: one.distribution.capability.and_then(|capability| capability.yield_()),
    });
    Ran {
        contender,
        run: analysis.run,
        evaluations: analysis.run.evaluations + analysis.run.cached,
        evaluation: analysis.run.in_model,
        engine: took.saturating_sub(analysis.run.in_model),
        verdicts: analysis.characteristics.iter().map(CharacteristicAnalysis::verdict).collect(),
        figures: figures.collect(),
        errors: Vec::new(),
        pareto: Vec::new(),
    }
}

fn of_simulation(contender: Contender, found: &Simulation, took: Duration, costly: bool) -> Ran {
    // A cheap model counts the time of all threads. A short sample does not use them all.
    let portions = found.samples.div_ceil(ROWS as u64).max(1);
    let at_once = if costly { 1 } else { u64::from(threads()).min(portions) as u32 };
    let evaluation = found.run.in_model / at_once;
    Ran {
        contender,
        run: found.run,
        evaluations: found.run.evaluations + found.run.cached,
        verdicts: found.characteristics.iter().map(SimulatedCharacteristic::verdict).collect(),
        evaluation,
        engine: took.saturating_sub(evaluation),
        figures: found.characteristics.iter().map(figures).collect(),
        errors: Vec::new(),
        pareto: Vec::new(),
    }
}

fn figures(one: &SimulatedCharacteristic) -> Figures {
    let value = |estimate: Option<Estimate>| estimate.map(|estimate| estimate.value);
    Figures {
        mean: value(one.mean),
        sigma: value(one.sigma),
        skewness: value(one.skewness),
        kurtosis: value(one.kurtosis),
        yield_: one.yield_.map(|share| share.value),
    }
}

fn errors(found: &Figures, reference: &SimulatedCharacteristic) -> Errors {
    let of = figures(reference);
    let unit = of.sigma.filter(|&sigma| sigma > 0.0);
    let off = |a: Option<f64>, b: Option<f64>, unit: Option<f64>| Some((a? - b?).abs() / unit?);
    let own = |estimate: Option<Estimate>, unit: Option<f64>| Some(estimate?.standard_error? / unit?);
    Errors::of(
        Figures {
            mean: off(found.mean, of.mean, unit),
            sigma: off(found.sigma, of.sigma, unit),
            skewness: off(found.skewness, of.skewness, Some(1.0)),
            kurtosis: off(found.kurtosis, of.kurtosis, Some(1.0)),
            yield_: off(found.yield_, of.yield_, Some(1.0)),
        },
        Figures {
            mean: own(reference.mean, unit),
            sigma: own(reference.sigma, unit),
            skewness: own(reference.skewness, Some(1.0)),
            kurtosis: own(reference.kurtosis, Some(1.0)),
            yield_: reference.yield_.map(|share| one_error(share.value, share.interval)),
        },
    )
}

/// True for every method that is not dominated on a characteristic. Errors below the resolution of the reference are equal: only the
/// cheapest of these methods is on the front.
fn front(ran: &[Ran], c: usize) -> Vec<bool> {
    let error = |ran: &Ran| ran.errors[c].overall.map(|overall| overall.max(ran.errors[c].floor()));
    let mut best = f64::INFINITY;
    let mut front = vec![false; ran.len()];
    for at in 0..ran.len() {
        // Among methods with equal evaluations only the smallest error counts.
        let equals = ran.iter().filter(|other| other.evaluations == ran[at].evaluations);
        let least = equals.filter_map(error).fold(f64::INFINITY, f64::min);
        let own = error(&ran[at]).unwrap_or(f64::INFINITY);
        front[at] = own == least && own < best;
        if ran.get(at + 1).is_none_or(|next| next.evaluations > ran[at].evaluations) {
            best = best.min(least);
        }
    }
    front
}
