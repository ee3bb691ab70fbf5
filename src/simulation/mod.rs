//! Monte Carlo: the assembly function itself on points of the inputs' distribution, with standard errors.

mod characteristic;
mod control;
mod count;
mod difference;
mod groups;
mod indices;
mod inspected;
mod measured;
mod replicate;
mod seldom;
mod shape;
mod surrogates;
mod tally;
mod together;
mod written;

pub use written::SimulatedShape;

pub(crate) use characteristic::{BINS, CHOICE};
pub use characteristic::{Histogram, SimulatedCharacteristic, SurrogateControl, YieldEstimate};
pub use indices::{IndexEstimate, SampledFactor};
pub use sensitol_numeric::sampling::{Estimate, Sampler, SamplingError};

use std::time::Duration;

use serde::Serialize;

use crate::assembly::{EvaluationError, NonRepeatable, Points, Request, Responses, Run, near_rows};
use crate::evaluation::{Restoration, Restore, at_any_size};
use crate::method::{Method, MethodError, Options, Outcome};
use crate::problem::Problem;
use crate::summary::RunSummary;
use crate::verification::OutputCorrelation;
use crate::warning::{Advice, Warning};
use control::Control;
use count::Lens;
use groups::MeasuredGroups;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::parallel::{Rooms, join};
use sensitol_numeric::power::{Rescale, Rescaling};
use sensitol_numeric::sampling::{Draws, Portion, Room};
use sensitol_numeric::shape::through;
use sensitol_numeric::time::Instant;
use sensitol_numeric::verdict::Judged;
pub(crate) use surrogates::{Surrogates, chosen};
use tally::{Block, Tally};

/// How a problem is simulated.
///
/// ```
/// use sensitol::simulation::SimulationOptions;
/// let options = SimulationOptions::default().with_samples(10_000);
/// assert_eq!((options.samples, options.seed), (10_000, 1));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationOptions {
    /// Points, at most; Sobol's are rounded up to the next power of two in each replicate.
    pub samples: u64,
    /// How they are drawn.
    pub sampler: Sampler,
    /// Another seed is another sample.
    pub seed: u64,
    /// Ends when the standard error of every sigma is below this part of it.
    pub until: Option<f64>,
    /// Ends when half the interval of every yield is below this.
    pub until_yield: Option<f64>,
    /// Whether the surrogate of an analysis with these options stands beside the model as control variate: its moments are
    /// exact, only the difference is sampled, and standard errors shrink by what it explains. `auto` is `full` to 20
    /// varying dimensions, `six-n` beyond. Quantiles and histogram stay those of the sample.
    ///
    /// Where the model fails at some points, their differences are taken to be like the others'. The kurtosis of what is far
    /// from the surrogate wants more points than a plain one before its standard error is right: of a lognormal with log-sd
    /// 0.15 two of them hold 88 % at 20 000 random points and 94 % at 100 000.
    pub control: Option<Options>,
    /// The share of assemblies that must keep the limits of all characteristics at once.
    pub target_joint_yield: Option<f64>,
    /// Whether there are Sobol' indices too, by exchanging inputs at so many base points, n of them: n (N + 2) evaluations more.
    pub sobol: Option<u64>,
    /// Most evaluations of these; without it a costly model is evaluated 10 000 times for them at most.
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
    /// With at most so many points.
    #[must_use]
    pub fn with_samples(mut self, points: u64) -> Self {
        self.samples = points;
        self
    }

    /// With points drawn so.
    #[must_use]
    pub fn with_sampler(mut self, sampler: Sampler) -> Self {
        self.sampler = sampler;
        self
    }

    /// With this seed.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Ending when the standard error of every sigma is below this part of it.
    #[must_use]
    pub fn with_until(mut self, error: f64) -> Self {
        self.until = Some(error);
        self
    }

    /// Ending when half the interval of every yield is below this.
    #[must_use]
    pub fn with_until_yield(mut self, half: f64) -> Self {
        self.until_yield = Some(half);
        self
    }

    /// With this target for the share that keeps the limits of all characteristics at once.
    #[must_use]
    pub fn with_target_joint_yield(mut self, share: f64) -> Self {
        self.target_joint_yield = Some(share);
        self
    }

    /// With Sobol' indices by so many base points.
    #[must_use]
    pub fn with_sobol(mut self, points: u64) -> Self {
        self.sobol = Some(points);
        self
    }

    /// With at most so many evaluations for Sobol' indices.
    #[must_use]
    pub fn with_budget(mut self, evaluations: u64) -> Self {
        self.budget = Some(evaluations);
        self
    }

    /// With the surrogate of an analysis with these options as control variate.
    #[must_use]
    pub fn with_control(mut self, analysis: Options) -> Self {
        self.control = Some(analysis);
        self
    }
}

/// Replicates of Sobol's points, each scrambled by itself: what they differ by is the standard error.
pub(crate) const REPLICATES: u64 = crate::verification::REPLICATES as u64;
/// Points that a task evaluates together.
pub(crate) const ROWS: usize = 1024;
/// Tasks between two looks at the clock and at what is wanted.
const TASKS: usize = 64;
/// Points of a costly model between two looks.
const COSTLY: usize = 4096;
/// Points after which a sample ends whose moments have not settled, where it would go on until they are known.
const UNSETTLED: u64 = 1 << 24;

/// The results of a simulation.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
pub struct Simulation {
    /// How points were drawn.
    #[serde(flatten, serialize_with = "through::<shape::SamplerShape, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "shape::SamplerShape"))]
    pub sampler: Sampler,
    /// Its points and time, those of the surrogate included; why it ended before all points were drawn or the accuracy was
    /// reached.
    #[serde(flatten)]
    pub run: RunSummary,
    /// Points that were answered.
    pub samples: u64,
    /// Evaluations of the surrogate; None where none was asked for.
    pub surrogate_evaluations: Option<u64>,
    /// Whether what was wanted was reached; None where nothing was.
    pub reached: Option<bool>,
    /// Where the model answered the nominal point otherwise than before.
    // Told of as warnings.
    #[serde(skip)]
    pub non_repeatable: Vec<NonRepeatable>,
    /// The share of assemblies that keep the limits of all characteristics at once; None with fewer than two that have limits.
    #[serde(rename = "joint_yield")]
    pub joint: Option<YieldEstimate>,
    /// Whether that share reaches the target for all characteristics at once; None without such a target.
    #[cfg_attr(feature = "schema", schemars(with = "Option<sensitol_numeric::verdict::JudgedShape>"))]
    pub joint_requirement: Option<Judged>,
    /// How every two characteristics vary together; empty with one characteristic, and with more than 40.
    #[serde(rename = "characteristic_correlation")]
    pub correlations: Vec<OutputCorrelation>,
    /// The results of every characteristic, in the problem's order.
    #[cfg_attr(feature = "schema", schemars(with = "Vec<SimulatedShape>"))]
    pub characteristics: Vec<SimulatedCharacteristic>,
    /// Where points have no value, and where the model contradicted itself.
    #[serde(skip)]
    pub warnings: Vec<Warning>,
}

/// How far a simulation is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pace {
    /// Points answered.
    pub samples: u64,
    /// Points that it will take: all of them, or what the standard errors so far say that the wanted one takes.
    pub expected: f64,
    /// Time so far.
    pub elapsed: Duration,
}

impl Pace {
    /// The time that it will take in all, at the speed so far, in seconds.
    pub fn expected_s(&self) -> f64 {
        self.elapsed.as_secs_f64() * self.expected / self.samples.max(1) as f64
    }
}

/// Simulates a problem.
///
/// Evaluations: as many as samples. Memory: flat in the number of samples: a third of a megabyte of counts for each
/// characteristic, five for Sobol's points. The numbers are the same for any number of threads.
///
/// # Errors
/// When a dimension cannot be sampled, or the model cannot be used at all; nothing is evaluated then.
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

/// Why a problem cannot be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// It cannot be sampled.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// The model cannot be used at all.
    #[error("{error}")]
    Model {
        /// Why not.
        error: EvaluationError,
    },
    /// The surrogate's method cannot be run on the problem.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// There is no surrogate to stand beside a characteristic.
    #[error("`{characteristic}` has no surrogate by {method}: {reason}; simulate it by itself")]
    NoSurrogate {
        /// The characteristic.
        characteristic: String,
        /// The method.
        method: Method,
        /// The reason why there is none.
        reason: String,
    },
    /// No or too many points.
    #[error("a simulation takes 2 to {most} points, not {samples}")]
    Samples {
        /// The number asked for.
        samples: u64,
        /// The greatest.
        most: u64,
    },
    /// Sobol' indices of a costly model.
    #[error(
        "Sobol' indices of {factors} inputs at {points} points take {evaluations} evaluations (points x (inputs + 2)), and {most} are \
         allowed: choose fewer points or a greater budget"
    )]
    CostlyIndices {
        /// Base points.
        points: u64,
        /// Inputs that vary by themselves.
        factors: usize,
        /// Evaluations that they take together.
        evaluations: u64,
        /// Evaluations that are allowed.
        most: u64,
    },
    /// A yield is wanted where there is no limit.
    #[error("a yield is to be known that well, but no characteristic asked for has a limit")]
    NoLimits,
    /// The target of a standard error is not a positive number.
    #[error("what is wanted of a standard error is a number above 0, not {value}")]
    Wanted {
        /// The value.
        value: f64,
    },
}

impl SimulationError {
    /// The actions to take.
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

/// Counts are exact in a double up to here.
const MOST: u64 = 1 << 52;

/// [`simulate`], telling of its pace and stopping when told to.
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

    /// With Sobol' indices.
    fn with_indices(
        mut self,
        problem: &Problem,
        (points, seed): (u64, u64),
        run: &Run<'_>,
        pace: &dyn Fn(Pace),
    ) -> Self {
        let origins: Vec<f64> =
            self.characteristics.iter().map(|one| one.mean.map_or(0.0, |mean| mean.value)).collect();
        let (found, spent) = indices::indices(problem, (points, seed), &origins, run, pace);
        self.characteristics.iter_mut().zip(found).for_each(|(one, found)| one.indices = found);
        self.run = RunSummary { evaluator: problem.evaluator(), ..self.run.and(&spent) };
        self
    }
}

/// Samples the model beside the surrogates of an analysis that has been made; those that it has not stand beside nothing.
/// Counts what is evaluated now only.
pub(crate) fn simulate_beside(
    problem: &Problem,
    options: &SimulationOptions,
    outcome: &Outcome,
    run: &Run<'_>,
) -> Result<Simulation, SimulationError> {
    let begun = Instant::now();
    let draws = Draws::new(problem.dimensions(), problem.correlation(), options.sampler, options.seed)?;
    let control = Control::beside_of(problem, outcome, options)?;
    // Who asks for them here has error estimates of their own.
    Ok(drawn(problem, options, (&draws, Some(&control), false), run, (begun, &|_| {})))
}

fn drawn(
    problem: &Problem,
    options: &SimulationOptions,
    (draws, control, watched): (&Draws<'_>, Option<&Control<'_>>, bool),
    run: &Run<'_>,
    (begun, pace): (Instant, &dyn Fn(Pace)),
) -> Simulation {
    /// Where a batch takes less time than this, the next one has so many times as many tasks.
    const SHORT: (Duration, usize) = (Duration::from_millis(50), 4);
    let measured = MeasuredGroups::of(problem, options.samples);
    let mut tally = Tally::new(problem, control, options.sampler);
    let mut portions = Portions::new(options, problem.function().signature().costly, problem.dimensions().len());
    let rooms = Rooms::none();
    let room = || (Room::default(), Points::repeated(&[], 0), Responses::open(0, 0));
    // Where the number of points is known beforehand, a batch is counted while the next one is evaluated.
    let ahead = !portions.costly && options.until.is_none() && options.until_yield.is_none();
    let mut waiting: (Vec<Portion>, Vec<Block>) = Default::default();
    let (mut reached, mut expected) = (None, portions.total as f64);
    loop {
        let ends = run.stopped() || tally.stopped || reached == Some(true);
        let batch = if ends { Vec::new() } else { portions.next_batch() };
        if batch.is_empty() && waiting.0.is_empty() {
            break;
        }
        let lenses = tally.lenses().to_vec();
        let one = |portion: &Portion| {
            rooms.within(room, |(room, points, out)| {
                draws.write(*portion, room, points);
                block(problem, (points, out), *portion, run, (&lenses, control, measured.as_ref(), options.sampler))
            })
        };
        let asked = Instant::now();
        let costly = portions.costly;
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
            tally.add(&batch, blocks());
        }
        if watched && !ahead {
            tally.watch(options.seed, run);
        }
        if let Some(ratio) = tally.shortfall(options) {
            // Standard errors shrink with the root of the sample.
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
    if watched {
        tally.watch(options.seed, run);
    }
    let settles = !tally.shortfall(options).is_some_and(f64::is_infinite) || tally.samples() < UNSETTLED;
    let open = tally.stopped || reached != Some(true) && settles && !portions.done();
    let stopped = control.and_then(Control::stopped).or_else(|| open.then(|| run.why_open()));
    let simulation = tally.finish(options, measured.as_ref(), stopped, reached);
    Simulation {
        run: RunSummary { wall: begun.elapsed(), evaluator: problem.evaluator(), ..simulation.run },
        ..simulation
    }
}

/// Evaluates one portion.
fn block(
    problem: &Problem,
    (points, out): (&Points, &mut Responses),
    portion: Portion,
    run: &Run<'_>,
    (lenses, control, measured, sampler): (&[Lens], Option<&Control<'_>>, Option<&MeasuredGroups<'_>>, Sampler),
) -> Block {
    out.reopen(portion.rows, problem.outputs().len());
    let begun = Instant::now();
    problem.function().evaluate(&Request::values(points, problem.outputs()), run, out);
    let took = begun.elapsed();
    let beside = control.map_or_else(Vec::new, |control| control.beside(points));
    let groups = measured.map(|measured| (measured, measured.groups(points)));
    Block::of(out, took, (lenses, sampler, portion.replicate), &beside, groups.as_ref())
}

/// The portions of a sample, a batch at a time, every replicate as far as the others.
struct Portions {
    replicates: u64,
    rows: u64,
    /// Points in all.
    total: u64,
    /// Of a replicate.
    each: u64,
    done: u64,
    costly: bool,
    /// How many times as many as usual between two looks.
    at_once: usize,
}

impl Portions {
    fn new(options: &SimulationOptions, costly: bool, dimensions: usize) -> Self {
        let (replicates, each) = match options.sampler {
            Sampler::Random => (1, options.samples),
            Sampler::Sobol => (REPLICATES, options.samples.div_ceil(REPLICATES).next_power_of_two()),
        };
        let rows = if costly && replicates == 1 { COSTLY } else { ROWS.min(near_rows(dimensions)) } as u64;
        Self { replicates, rows: rows.min(each), total: replicates * each, each, done: 0, costly, at_once: 1 }
    }

    fn done(&self) -> bool {
        self.done >= self.each
    }

    fn next_batch(&mut self) -> Vec<Portion> {
        let tasks = if self.costly { 1 } else { (self.at_once * TASKS) as u64 / self.replicates };
        let mut batch = Vec::new();
        for _ in 0..tasks {
            if self.done() {
                break;
            }
            let rows = self.rows.min(self.each - self.done) as usize;
            batch.extend((0..self.replicates).map(|replicate| Portion { replicate, first: self.done, rows }));
            self.done += rows as u64;
        }
        batch
    }
}
