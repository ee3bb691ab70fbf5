//! Monte Carlo simulation: the assembly function at points of the inputs' distribution, with standard errors.

mod characteristic;
mod conclusion;
mod control_variate;
mod count;
mod indices;
mod inspection;
mod joint_result;
mod measured_interval;
mod portions;
mod rare_switch_side;
mod replicate_error;
mod replicate_moments;
mod sample_groups;
mod serialisation;
mod shard;
mod shard_sums;
mod surface_difference;
mod surrogates;
mod tally;

pub use crate::simulation::conclusion::SimulatedConclusion;

pub(crate) use characteristic::{BINS, CHOICE};
pub use characteristic::{Histogram, Reduction, SimulatedCharacteristic, SurrogateControl, YieldEstimate};
pub use indices::{IndexEstimate, SampledFactor};
pub use sensitol_numeric::sampling::{Estimate, Sampler, SamplingError};
pub use shard::{merge_shards, simulate_shard};
pub use shard_sums::{Shard, ShardError, ShardSums};

use std::ops::Range;
use std::time::Duration;

use serde::Serialize;

use crate::assembly::{EvaluationError, NonRepeatable, Points, Responses, Run};
use crate::estimate::OutputCorrelation;
use crate::evaluation::{Evaluator, Restoration, Restore, at_any_size};
use crate::method::{Method, MethodError, Options, Outcome};
use crate::problem::Problem;
use crate::simulation::control_variate::Control;
use crate::simulation::sample_groups::MeasuredGroups;
use crate::summary::RunSummary;
use crate::warning::{Advice, Warning};
use count::CountingScale;
use portions::Portions;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::parallel::{Rooms, join};
use sensitol_numeric::power::{Rescale, Rescaling};
use sensitol_numeric::sampling::{Draws, Portion, Room, all_known};
use sensitol_numeric::time::Instant;
use sensitol_numeric::verdict::Judged;
pub(crate) use surrogates::{KnownSurrogate, Surrogates, chosen};
use tally::{Block, Tally};

/// Options of a simulation.
///
/// ```
/// use sensitol::simulation::SimulationOptions;
/// let options = SimulationOptions::default().with_samples(10_000);
/// assert_eq!((options.samples, options.seed), (10_000, 1));
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SimulationOptions {
    /// Greatest number of points. Sobol' points are rounded up to the next power of two in each replicate.
    pub samples: u64,
    /// Sampler of the points.
    pub sampler: Sampler,
    /// Seed of the random numbers. A different seed gives a different sample.
    pub seed: u64,
    /// Standard error of every sigma, as a part of it, at which the simulation ends.
    pub until: Option<f64>,
    /// Half-width of the interval of every yield at which the simulation ends.
    pub until_yield: Option<f64>,
    /// Options of an analysis whose surrogate is the control variate: only its difference to the model is sampled, with smaller standard
    /// errors. `auto` is `full` up to 20 varying dimensions, `six-n` beyond. Quantiles and histogram stay those of the sample.
    ///
    /// If the model fails at some points, their differences are assumed to be like the others'. If the model is far from the surrogate, the
    /// standard error of the kurtosis needs more points than that of a plain sample. For a lognormal distribution with log-sd 0.15, two
    /// standard errors cover 88 % at 20 000 random points and 94 % at 100 000.
    pub control: Option<Options>,
    /// Target for the share of assemblies that keep the limits of all characteristics at once.
    pub target_joint_yield: Option<f64>,
    /// Number n of base points for Sobol' indices, by exchanging inputs: n (N + 2) evaluations more. None for no indices.
    pub sobol: Option<u64>,
    /// Greatest number of evaluations for Sobol' indices. If it is None, a costly model is evaluated 10 000 times for them at most.
    pub budget: Option<u64>,
}

impl Default for SimulationOptions {
    fn default() -> Self {
        Self {
            samples: 100_000,
            sampler: Sampler::Random,
            seed: 1,
            until: None,
            until_yield: None,
            control: None,
            target_joint_yield: None,
            sobol: None,
            budget: None,
        }
    }
}

impl SimulationOptions {
    /// Sets the greatest number of points.
    #[must_use]
    pub fn with_samples(mut self, points: u64) -> Self {
        self.samples = points;
        self
    }

    /// Sets the sampler.
    #[must_use]
    pub fn with_sampler(mut self, sampler: Sampler) -> Self {
        self.sampler = sampler;
        self
    }

    /// Sets the seed.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Sets the standard error of every sigma, as a part of it, at which the simulation ends.
    #[must_use]
    pub fn with_until(mut self, error: f64) -> Self {
        self.until = Some(error);
        self
    }

    /// Sets the half-width of the interval of every yield at which the simulation ends.
    #[must_use]
    pub fn with_until_yield(mut self, half: f64) -> Self {
        self.until_yield = Some(half);
        self
    }

    /// Sets the target for the share that keeps the limits of all characteristics at once.
    #[must_use]
    pub fn with_target_joint_yield(mut self, share: f64) -> Self {
        self.target_joint_yield = Some(share);
        self
    }

    /// Requests Sobol' indices with this number of base points.
    #[must_use]
    pub fn with_sobol(mut self, points: u64) -> Self {
        self.sobol = Some(points);
        self
    }

    /// Sets the greatest number of evaluations for Sobol' indices.
    #[must_use]
    pub fn with_budget(mut self, evaluations: u64) -> Self {
        self.budget = Some(evaluations);
        self
    }

    /// Requests the surrogate of an analysis with these options as control variate.
    #[must_use]
    pub fn with_control(mut self, analysis: Options) -> Self {
        self.control = Some(analysis);
        self
    }
}

/// Number of replicates of Sobol' points, each scrambled independently: their scatter is the standard error.
pub(crate) const REPLICATES: u64 = crate::estimate::REPLICATES as u64;
/// Points that a task evaluates together.
pub(crate) const ROWS: usize = 1024;
/// Number of tasks between two checks of the clock and of the accuracy.
const TASKS: usize = 64;
/// Points of a costly model between two checks.
const COSTLY: usize = 4096;
/// Points after which a sample with a requested accuracy ends if its moments have not settled.
const UNSETTLED: u64 = 1 << 24;

/// Results of a simulation.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
pub struct Simulation {
    /// Sampler of the points.
    pub sampler: Sampler,
    /// Points and time, including those of the surrogate, and the reason of an end before all points were drawn or the accuracy was
    /// reached.
    #[serde(flatten)]
    pub run: RunSummary,
    /// Number of points that were answered.
    pub samples: u64,
    /// Evaluations of the surrogate. None if none was requested.
    pub surrogate_evaluations: Option<u64>,
    /// True if the requested accuracy was reached. None if none was requested.
    pub reached: Option<bool>,
    /// Answers of the model that differ when a point is evaluated again.
    // Reported as warnings.
    #[serde(skip)]
    pub non_repeatable: Vec<NonRepeatable>,
    /// Share of assemblies that keep the limits of all characteristics at once. None if fewer than two have limits.
    #[serde(rename = "joint_yield")]
    pub joint: Option<YieldEstimate>,
    /// Verdict on the target for the joint yield. None if there is no such target.
    pub joint_requirement: Option<Judged>,
    /// Correlations of every two characteristics. Empty with one characteristic, and with more than 40.
    #[serde(rename = "characteristic_correlation")]
    pub correlations: Vec<OutputCorrelation>,
    /// The results of every characteristic, in the problem's order.
    pub characteristics: Vec<SimulatedCharacteristic>,
    /// Warnings, such as of points without a value, and of a model that is not repeatable.
    #[serde(skip)]
    pub warnings: Vec<Warning>,
}

/// Progress of a simulation.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pace {
    /// Number of points answered.
    pub samples: u64,
    /// Number of points that will be needed: all of them, or an estimate for the requested accuracy from the standard errors so far.
    pub expected: f64,
    /// Elapsed time.
    pub elapsed: Duration,
}

impl Pace {
    /// Expected total time at the speed so far, in seconds.
    pub fn expected_s(&self) -> f64 {
        self.elapsed.as_secs_f64() * self.expected / self.samples.max(1) as f64
    }
}

/// Simulates a problem.
///
/// Evaluations: as many as samples. Memory: independent of the number of samples: a third of a megabyte of counts for each characteristic,
/// five for Sobol' points. The numbers are the same for any number of threads.
///
/// # Errors
/// Returns an error if a dimension cannot be sampled, or the model cannot be used at all. Nothing is evaluated then.
///
/// ```
/// use sensitol::simulation::{SimulationOptions, simulate};
/// use sensitol::{Closure, Dimension, Problem};
/// let dimensions = [Dimension::normal("a", 10.0, 0.3)?, Dimension::uniform("b", 5.0, 0.3)?];
/// let gap = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1]))?;
/// let found = simulate(&gap, &SimulationOptions::default())?;
/// let sigma = found.characteristics[0].sigma.unwrap();
/// let exact = (0.1f64.powi(2) + 0.3f64.powi(2) / 3.0).sqrt();
/// assert!((sigma.value - exact).abs() < 4.0 * sigma.standard_error.unwrap());
/// # Ok::<(), sensitol::Error>(())
/// ```
pub fn simulate(problem: &Problem, options: &SimulationOptions) -> Result<Simulation, SimulationError> {
    simulate_with(problem, options, &Run::to_the_end(), &|_| {})
}

/// Reason why a problem cannot be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// A dimension cannot be sampled.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// The model cannot be used at all.
    #[error("{error}")]
    Model {
        /// Error of the model.
        error: EvaluationError,
    },
    /// The surrogate's method cannot be run on the problem.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// A characteristic has no surrogate that could serve as control variate.
    #[error("`{characteristic}` has no surrogate by {method}: {reason}; simulate it by itself")]
    NoSurrogate {
        /// Name of the characteristic.
        characteristic: String,
        /// Method of the surrogate.
        method: Method,
        /// Reason why there is none.
        reason: String,
    },
    /// Too few or too many points.
    #[error("a simulation takes 2 to {most} points, not {samples}")]
    Samples {
        /// Requested number of points.
        samples: u64,
        /// Greatest number of points.
        most: u64,
    },
    /// Sobol' indices of a costly model need more evaluations than are allowed.
    #[error(
        "Sobol' indices of {factors} inputs at {points} points take {evaluations} evaluations (points x (inputs + 2)), and {most} are \
         allowed: choose fewer points or a greater budget"
    )]
    CostlyIndices {
        /// Number of base points.
        points: u64,
        /// Number of factors that vary independently.
        factors: usize,
        /// Evaluations that the indices need.
        evaluations: u64,
        /// Evaluations that are allowed.
        most: u64,
    },
    /// An accuracy of the yield is requested, but there is no limit.
    #[error("a yield is to be known that well, but no characteristic asked for has a limit")]
    NoLimits,
    /// Requested standard error that is not a positive number.
    #[error("what is wanted of a standard error is a number above 0, not {value}")]
    Wanted {
        /// Requested value.
        value: f64,
    },
}

impl SimulationError {
    /// Actions that solve the error.
    pub fn advice(&self) -> Vec<Advice> {
        match self {
            Self::NoSurrogate { method, .. } if !method.has_surrogate() => {
                vec![Advice::UseMethod { methods: vec![Method::Full] }]
            }
            Self::Method(error) => error.advice(),
            _ => Vec::new(),
        }
    }
}

/// Greatest number of points: counts are exact in a double up to here.
const MOST: u64 = 1 << 52;

/// [`simulate`] with reports of progress and a way to stop.
pub fn simulate_with(
    problem: &Problem,
    options: &SimulationOptions,
    run: &Run<'_>,
    pace: &dyn Fn(Pace),
) -> Result<Simulation, SimulationError> {
    at_any_size(problem, run, |problem, run| simulated(problem, options, run, pace))
}

fn simulated(
    problem: &Problem,
    options: &SimulationOptions,
    run: &Run<'_>,
    pace: &dyn Fn(Pace),
) -> Result<Simulation, SimulationError> {
    if !(2..=MOST).contains(&options.samples) {
        return Err(SimulationError::Samples { samples: options.samples, most: MOST });
    }
    let no_wish = |wanted: &f64| wanted.is_nan() || *wanted <= 0.0;
    if let Some(value) = [options.until, options.until_yield].into_iter().flatten().find(no_wish) {
        return Err(SimulationError::Wanted { value });
    }
    if options.until_yield.is_some() && !problem.characteristics().iter().any(|one| one.limits().exist()) {
        return Err(SimulationError::NoLimits);
    }
    if let Some(points) = options.sobol {
        indices::affordable(problem, points, options.budget)?;
    }
    let begun = Instant::now();
    all_known(problem.dimensions())?;
    let draws = Draws::new(problem.dimensions(), problem.correlation(), options.sampler, options.seed)?;
    problem.function().prepare(problem.outputs()).map_err(|error| SimulationError::Model { error })?;
    let control = options.control.as_ref().map(|asked| Control::of(problem, asked, options, run)).transpose()?;
    let found = drawn(problem, options, (&draws, control.as_ref(), true), run, (begun, pace));
    Ok(match options.sobol {
        Some(points) if !found.run.unfinished() => found.with_indices(problem, (points, options.seed), run, pace),
        _ => found,
    })
}

impl Restore for Simulation {
    fn restore(&mut self, back: &Restoration<'_>) {
        back.add_time(&mut self.run);
        self.rescale(back);
    }
}

impl Restore for SimulationError {
    fn restore(&mut self, back: &Restoration<'_>) {
        if let Self::Method(error) = self {
            error.restore(back);
        }
    }
}

impl Simulation {
    /// Multiplies every figure in the unit of a characteristic.
    pub(crate) fn rescale(&mut self, back: &Restoration<'_>) {
        if back.is_nothing() {
            return;
        }
        for (c, one) in self.characteristics.iter_mut().enumerate() {
            let mut rescaling = Rescaling::by(back.power(c));
            one.characteristic = back.problem.characteristics()[c].clone();
            one.rescale(&mut rescaling);
            if rescaling.has_lost() {
                self.warnings.push(Warning::Unrepresentable { characteristic: one.characteristic.name().to_owned() });
            }
        }
        self.warnings.iter_mut().for_each(|warning| warning.rescale(|name| back.power_of(name)));
    }

    /// Adds Sobol' indices from further evaluations.
    fn with_indices(
        mut self,
        problem: &Problem,
        (points, seed): (u64, u64),
        run: &Run<'_>,
        pace: &dyn Fn(Pace),
    ) -> Self {
        let origins: Vec<f64> =
            self.characteristics.iter().map(|one| one.mean.map_or(0.0, |mean| mean.value)).collect();
        let evaluator = Evaluator::new(problem, run).with_seed(seed);
        let begun = Instant::now();
        let found = indices::indices(&evaluator, points, &origins, pace);
        self.characteristics.iter_mut().zip(found).for_each(|(one, found)| one.indices = found);
        let spent = RunSummary { wall: begun.elapsed(), seed: Some(seed), ..evaluator.summary() };
        self.run = RunSummary { evaluator: problem.evaluator(), ..self.run.and(&spent) };
        self
    }
}

/// Samples the model with the surrogates of an existing analysis as control variates, as far as it has them. Counts only evaluations of
/// this sample.
pub(crate) fn simulate_beside(
    problem: &Problem,
    options: &SimulationOptions,
    outcome: &Outcome,
    run: &Run<'_>,
) -> Result<Simulation, SimulationError> {
    let begun = Instant::now();
    let draws = Draws::new(problem.dimensions(), problem.correlation(), options.sampler, options.seed)?;
    let control = Control::beside_of(problem, outcome, options)?;
    // Callers have error estimates of their own, so standard errors need not be watched.
    Ok(drawn(problem, options, (&draws, Some(&control), false), run, (begun, &|_| {})))
}

fn drawn(
    problem: &Problem,
    options: &SimulationOptions,
    (draws, control, watched): (&Draws<'_>, Option<&Control<'_>>, bool),
    run: &Run<'_>,
    (begun, pace): (Instant, &dyn Fn(Pace)),
) -> Simulation {
    let measured = MeasuredGroups::of(problem, options.samples);
    let evaluator = Evaluator::new(problem, run).with_seed(options.seed);
    let mut tally = Tally::new(problem, control, options.sampler);
    let mut portions = Portions::new(options, problem.function().signature().costly, problem.dimensions().len());
    let sample = Sample { options, draws, control, measured: measured.as_ref(), watched };
    let reached = sample.fill(&evaluator, &mut portions, &mut tally, (begun, pace));
    if watched {
        tally.watch(options.seed, run);
    }
    // A sample whose moments have not settled is complete after `UNSETTLED` points: it was not stopped.
    let settles = !tally.shortfall(options).is_some_and(f64::is_infinite) || tally.samples() < UNSETTLED;
    let open = tally.stopped() || reached != Some(true) && settles && !portions.done();
    let stopped = control.and_then(Control::stopped).or_else(|| open.then(|| run.why_open()));
    let simulation = tally.finish(options, measured.as_ref(), stopped, reached);
    Simulation {
        run: RunSummary { wall: begun.elapsed(), evaluator: problem.evaluator(), ..simulation.run },
        ..simulation
    }
}

/// Choices by which points are drawn and counted.
struct Sample<'a> {
    options: &'a SimulationOptions,
    draws: &'a Draws<'a>,
    control: Option<&'a Control<'a>>,
    measured: Option<&'a MeasuredGroups<'a>>,
    /// True if standard errors are left out that depend on assemblies the sample hardly contains.
    watched: bool,
}

impl Sample<'_> {
    /// Evaluates portions until there are no more, the requested accuracy is reached, or the run is stopped. Returns if the accuracy was
    /// reached, None if none is requested.
    fn fill(
        &self,
        evaluator: &Evaluator<'_>,
        portions: &mut Portions,
        tally: &mut Tally<'_>,
        (begun, pace): (Instant, &dyn Fn(Pace)),
    ) -> Option<bool> {
        /// Duration below which the next batch has more tasks, and the factor on their number.
        const SHORT: (Duration, usize) = (Duration::from_millis(50), 4);
        let (options, run) = (self.options, evaluator.run());
        let rooms = Rooms::none();
        let room = || (Room::default(), Points::repeated(&[], 0), Responses::open(0, 0));
        // If the number of points is known beforehand, a batch is counted while the next one is evaluated.
        let ahead = !portions.costly && options.until.is_none() && options.until_yield.is_none();
        let mut waiting: (Vec<Portion>, Vec<Block>) = Default::default();
        let (mut reached, mut expected) = (None, portions.total as f64);
        loop {
            let ends = run.stopped() || tally.stopped() || reached == Some(true);
            let batch = if ends { Vec::new() } else { portions.next_batch() };
            if batch.is_empty() && waiting.0.is_empty() {
                break;
            }
            let lenses = tally.lenses().to_vec();
            let one = |portion: &Portion| {
                rooms.within(room, |(room, points, out)| {
                    self.draws.write(*portion, room, points);
                    keep_rows(points, portions.slice(*portion));
                    self.block(evaluator, (points, out), *portion, &lenses)
                })
            };
            let asked = Instant::now();
            let costly = portions.costly;
            // Workers of a costly model share each batch, so its portions are evaluated one after the other.
            let blocks = || match costly {
                true => batch.iter().map(one).collect(),
                false => batch.par_iter().map(one).collect(),
            };
            if ahead {
                let (before, answers) = std::mem::take(&mut waiting);
                let ((), blocks) = join(|| tally.add(&before, answers), blocks);
                waiting = (batch, blocks);
                portions.at_once = if asked.elapsed() < SHORT.0 { SHORT.1 } else { 1 };
            } else {
                let blocks = blocks();
                tally.add(&batch, blocks);
            }
            if self.watched && !ahead {
                tally.watch(options.seed, run);
            }
            if let Some(ratio) = tally.shortfall(options) {
                // Standard errors shrink with the root of the sample size.
                expected = expected.min(tally.samples() as f64 * (ratio * ratio).max(1.0));
                reached = Some(ratio <= 1.0);
                if ratio.is_infinite() && tally.samples() >= UNSETTLED {
                    break;
                }
            }
            if tally.samples() > 0 {
                pace(Pace { samples: tally.samples(), expected, elapsed: begun.elapsed() });
            }
        }
        reached
    }

    /// Evaluates one portion, with surrogates and groups of measured samples.
    fn block(
        &self,
        evaluator: &Evaluator<'_>,
        (points, out): (&Points, &mut Responses),
        portion: Portion,
        lenses: &[CountingScale],
    ) -> Block {
        let part = evaluator.part();
        part.ask_into(points, evaluator.problem().outputs(), out);
        let beside = self.control.map_or_else(Vec::new, |control| control.beside(points));
        let groups = self.measured.map(|measured| (measured, measured.groups(points)));
        let place = (lenses, self.options.sampler, portion.replicate);
        Block::of(out, part.into_ledger(), place, &beside, groups.as_ref())
    }
}

/// Keeps a range of the rows of points.
fn keep_rows(points: &mut Points, rows: Range<usize>) {
    if rows.len() == points.rows() {
        return;
    }
    let columns: Vec<Vec<f64>> = (0..points.dimensions()).map(|d| points.column(d)[rows.clone()].to_vec()).collect();
    *points = Points::from_columns(rows.len(), &columns);
}
