//! Rare events: the probability beyond each limit, by importance sampling that is placed with the surrogate.
//!
//! A yield of 0.999997 is out of the reach of plain sampling: a million evaluations see three rejects. The surrogate of a few
//! hundred evaluations knows nearly where these lie. Points are drawn there, from a mixture of densities beyond the
//! surrogate's limit, near it, and the inputs' own, and the model itself says which of them are rejects. With `h_k` the
//! height of component k relative to the inputs' density and `a_k` its part of the n points,
//!
//! ```text
//! P = E[y beyond the limit] = (1/n) sum_i w_i [y(z_i) beyond],      w_i = 1/sum_k a_k h_k(z_i)
//! ```
//!
//! is unbiased whatever the surrogate is worth (the balance heuristic: Veach and Guibas 1995; Owen and Zhou 2000); a poor one
//! makes the weights unequal and the interval wide. After every stage the parts follow the rejects that were seen.
//!
//! A surrogate that is wrong does not know where it is wrong. Before points are drawn, some of the model itself are evaluated as the
//! inputs vary and up to three times as wide, and beside switches that the model tells of. Rejects among them that the surrogate's
//! components do not cover get components of their own: half-spaces at the likeliest point of the limit near them. So do rejects that
//! a stage finds by its plain and wide points where no place is.
//!
//! No place is of use where rejects lie all around the means in many variables. Where the interval of the weighted points is wider than that
//! of as many plain ones, the rest of the points are plain, and they alone make the estimate (`plain`): the result is never much worse
//! than that of plain sampling.

mod border;
mod estimate;
mod explore;
mod measured;
mod mixture;
mod model;
mod place;
mod plain;
mod search;
mod shape;
mod space;
mod target;
mod warnings;
mod within;

use serde::Serialize;

use crate::assembly::{EvaluationError, NonRepeatable, Run};
use crate::evaluation::{Restoration, Restore, at_any_size, history};
use crate::method::{Method, MethodError, Options};
use crate::problem::Problem;
use crate::simulation::{Pace, SimulationError, Surrogates};
use crate::summary::RunSummary;
use crate::warning::Warning;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::sampling::SamplingInterval;
use sensitol_numeric::sampling::{Estimate, SamplingError};
use sensitol_numeric::shape::{text, through};
use sensitol_numeric::time::Instant;
use sensitol_numeric::verdict::Judged;
#[cfg(feature = "schema")]
pub(crate) use shape::RareShape;

use explore::Explored;
use model::Model;
use place::{Place, places};
use search::Search;
use space::Space;
use target::Target;

/// How rare events are sought.
#[derive(Debug, Clone, PartialEq)]
pub struct RareOptions {
    /// Points of the model beside those of the surrogate, at most.
    pub samples: u64,
    /// Another seed is another sample.
    pub seed: u64,
    /// Ends when the standard error of every probability is below this part of it.
    pub until: Option<f64>,
    /// How the surrogate is had; `auto` is `full` to 20 varying dimensions, `six-n` beyond.
    pub surrogate: Options,
}

impl Default for RareOptions {
    fn default() -> Self {
        Self { samples: 10_000, seed: 1, until: None, surrogate: Options::default() }
    }
}

impl RareOptions {
    /// With at most so many points of the model beside those of the surrogate.
    #[must_use]
    pub fn with_samples(mut self, points: u64) -> Self {
        self.samples = points;
        self
    }

    /// With this seed.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Ending when the standard error of every probability is below this part of it.
    #[must_use]
    pub fn with_until(mut self, error: f64) -> Self {
        self.until = Some(error);
        self
    }

    /// With the surrogate of an analysis with these options.
    #[must_use]
    pub fn with_surrogate(mut self, analysis: Options) -> Self {
        self.surrogate = analysis;
        self
    }
}

/// The results for rare events.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
pub struct RareEvents {
    /// The method of the surrogate.
    #[serde(rename = "surrogate")]
    #[cfg_attr(feature = "schema", schemars(with = "String"))]
    pub method: Method,
    /// Its points and time, those of the surrogate included; why it ended before all points were drawn or the accuracy was
    /// reached.
    #[serde(flatten)]
    pub run: RunSummary,
    /// Points that were drawn and answered.
    pub samples: u64,
    /// Evaluations of the surrogate.
    pub surrogate_evaluations: u64,
    /// Whether what was wanted was reached; None where nothing was.
    pub reached: Option<bool>,
    /// Where the model answered the nominal point otherwise than before.
    // Told of as warnings.
    #[serde(skip)]
    pub non_repeatable: Vec<NonRepeatable>,
    /// The share of assemblies within the limits of all characteristics at once; None with fewer than two that have limits, where the
    /// means lie beyond one of them, and where no point lies beyond any.
    #[serde(rename = "joint_yield")]
    pub joint: Option<f64>,
    /// 95 % interval of that.
    #[serde(rename = "joint_yield_interval")]
    pub joint_interval: Option<[f64; 2]>,
    /// Whether that share reaches the target for all characteristics at once; None without such a target.
    #[cfg_attr(feature = "schema", schemars(with = "Option<sensitol_numeric::verdict::JudgedShape>"))]
    pub joint_requirement: Option<Judged>,
    /// The results of every characteristic, in the problem's order.
    #[cfg_attr(feature = "schema", schemars(with = "Vec<RareShape>"))]
    pub characteristics: Vec<RareCharacteristic>,
    /// Where the estimates rest on little, and where points have no value.
    #[serde(skip)]
    pub warnings: Vec<Warning>,
}

/// The results of one characteristic.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
pub struct RareCharacteristic {
    /// The characteristic, with its limits.
    #[serde(flatten)]
    pub characteristic: Characteristic,
    /// Points at which it has no value.
    pub failed: u64,
    /// Why not, of the first of them.
    #[serde(serialize_with = "text")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<String>"))]
    pub error: Option<EvaluationError>,
    /// Below its lower limit; None without one.
    #[serde(skip)]
    pub below: Option<Beyond>,
    /// Above its upper limit; None without one.
    #[serde(skip)]
    pub above: Option<Beyond>,
    /// The share of assemblies within the limits; None where that beyond one of them is unknown.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// 95 % interval of that.
    pub yield_interval: Option<[f64; 2]>,
    /// How far the yield may be off because measured dimensions are known by samples; None where there are none.
    #[serde(rename = "sampling_interval")]
    pub sampling: Option<SamplingInterval>,
    /// Whether the search was stopped before all points were drawn: no verdict follows from the others.
    pub unfinished: bool,
}

/// The results beyond one limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Beyond {
    /// The limit.
    pub limit: f64,
    /// The probability beyond it; None where no point lies there: its interval is then a bound, which takes it for a half-space that none of
    /// the explored points met.
    #[serde(flatten, serialize_with = "through::<shape::ProbabilityShape, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "shape::ProbabilityShape"))]
    pub probability: Option<Estimate>,
    /// 95 % interval.
    pub interval: [f64; 2],
    /// If no point without a value lies beyond, and if all of them do.
    #[serde(skip)]
    pub bounds: [f64; 2],
    /// Points beyond.
    pub hits: u64,
    /// Equally weighted points that would tell as much: `(sum of weights)^2 / sum of their squares`.
    pub effective_samples: f64,
    /// The part of the estimate that the heaviest point has: where that is large, the surrogate has missed where rejects are.
    pub greatest_part: Option<f64>,
    /// Points of a plain random sample that would have the same standard error.
    pub plain_samples: Option<f64>,
    /// The most likely assembly at the limit, as the surrogate and rejects of the model show it; None where none is known.
    pub design_point: Option<DesignPoint>,
    /// The plain points that make the estimate, where importance sampling was worse; told of as a warning.
    #[serde(skip)]
    pub plain_points: Option<u64>,
}

/// The most likely assembly at a limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct DesignPoint {
    /// How far it is from the middle, in standard deviations of independent normal variables.
    pub distance: f64,
    /// The value of every dimension, in the problem's order.
    pub values: Vec<f64>,
}

/// Why rare events cannot be sought.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RareError {
    /// There is nothing to be rare.
    #[error("no characteristic asked for has a limit: give it a lower or an upper one")]
    NoLimits,
    /// Too few points to say anything, or too many.
    #[error("rare events take {least} to {most} points, not {samples}")]
    Samples {
        /// The number asked for.
        samples: u64,
        /// The fewest.
        least: u64,
        /// The most.
        most: u64,
    },
    /// It cannot be simulated, or has no surrogate.
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

/// A handful says nothing.
const LEAST: u64 = 50;
/// Every point is kept until the end.
const MOST: u64 = 10_000_000;
/// Points of a stage from which places and parts are learnt: not fewer and not more.
const FIRST: [u64; 2] = [60, 2000];
/// Stages of this kind.
const LEARNING: u64 = 2;

/// Estimates the probability beyond every limit.
///
/// Evaluations: those of the surrogate's method, and the points asked for. Accuracy: standard errors and 95 % intervals;
/// where the surrogate is good, a probability near 3e-6 is known to 5 % by some hundred points.
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
/// let found = rare(&gap, &RareOptions::default().with_samples(400))?;
/// let [low, high] = found.characteristics[0].above.as_ref().unwrap().interval;
/// assert!(low < 3.3977e-6 && 3.3977e-6 < high && high < 1.3 * low);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn rare(problem: &Problem, options: &RareOptions) -> Result<RareEvents, RareError> {
    rare_with(problem, options, &Run::to_the_end(), &|_| {})
}

/// [`rare`], telling of its pace and stopping when told to.
pub fn rare_with(
    problem: &Problem,
    options: &RareOptions,
    run: &Run<'_>,
    pace: &dyn Fn(Pace),
) -> Result<RareEvents, RareError> {
    at_any_size(problem, run, |problem, run| sought(problem, options, run, pace))
}

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
    problem.function().prepare(problem.outputs()).map_err(|error| SimulationError::Model { error })?;
    let begun = Instant::now();
    let surrogates = Surrogates::of(problem, &options.surrogate, run)?;
    let space = Space::new(problem, &surrogates.outcome)?;
    let targets = targets(problem, &surrogates, &space);
    let mut model = Model::new(problem, &space, run);
    let places: Vec<Place> = targets.iter().enumerate().flat_map(|(index, target)| places(index, target)).collect();
    let places = correct(places, &targets, (options.samples / 4) as usize, &mut model);
    let mut search = Search::new(&targets, places, (options.samples, options.seed));
    if !targets.is_empty() {
        let explored = Explored::new(&targets, &search.reached(), options.samples, !options.seed, &mut model);
        search.learn(&explored, (options.samples / 10) as usize, &mut model);
    }
    let nothing_to_draw = surrogates.outcome.evaluated.stopped.is_some() || targets.is_empty();
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
        let model = &self.model;
        RunSummary {
            evaluations: model.answered.saturating_add_signed(model.extra),
            cached: model.reused,
            retried: model.retried,
            failed: model.failed,
            stages: model.stages,
            wall: self.begun.elapsed(),
            in_model: model.in_model,
            seed: Some(self.options.seed),
            ..RunSummary::default()
        }
    }

    /// The results of all stages and of the surrogate.
    fn conclude(self, surrogates: &Surrogates, no_targets: bool) -> RareEvents {
        let drawn = self.drawn();
        let Self { problem, options, run, model, search, reached, .. } = self;
        let surrogate = &surrogates.outcome.evaluated;
        let spent = surrogate.summary();
        let open = || reached != Some(true) && model.answered < options.samples && !no_targets;
        let stopped = surrogate.stopped.or_else(|| open().then(|| run.why_open()));
        let non_repeatable: Vec<NonRepeatable> =
            surrogate.non_repeatable.iter().chain(&model.non_repeatable).cloned().collect();
        let samples = search.points;
        let (joint, joint_interval) = search.within_all(problem).unzip();
        let joint = joint.flatten();
        let characteristics = search.characteristics(&model, stopped.is_some());
        let characteristics = measured::with_sampling(problem, &surrogates.outcome, characteristics);
        let joint_interval = joint_interval.map(|interval| measured::joint(joint, interval, &characteristics));
        let joint_requirement = options.surrogate.target_joint_yield.filter(|_| joint_interval.is_some());
        let joint_requirement = joint_requirement
            .map(|target| Judged::of(Requirement::Yield(target), joint, joint_interval).unless(stopped.is_some()));
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

/// Every limit of every characteristic that has a surrogate that varies.
fn targets<'a>(problem: &Problem, surrogates: &'a Surrogates, space: &'a Space<'a>) -> Vec<Target<'a>> {
    let mut targets = Vec::new();
    for (c, characteristic) in problem.characteristics().iter().enumerate() {
        let Some(known) = surrogates.known.get(c).and_then(Option::as_ref) else { continue };
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

/// Looks at the model itself on the way to each place, nearest first and as many as the budget allows, and moves the places
/// to where it crosses. These points are not drawn: no estimate rests on them. Places on the way to which the model crosses
/// nothing are left out, unless a target has no other.
fn correct(places: Vec<Place>, targets: &[Target<'_>], budget: usize, model: &mut Model<'_>) -> Vec<Place> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    // The first place of every target before the second of any.
    let rank = |p: &usize| places[..*p].iter().filter(|other| other.target == places[*p].target).count();
    order.sort_by_key(|p| (rank(p), *p));
    let mut asked: Vec<(usize, f64)> = Vec::new();
    for p in order {
        let stations = places[p].stations();
        // As many again and a half are for the second look.
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

/// The model's answers on the way to some places.
struct Looked {
    /// For every place, distances and values, ascending.
    values: Vec<Vec<(f64, f64)>>,
    /// Whether the model crosses on the way to it; None where it was not looked at.
    crosses: Vec<Option<bool>>,
}

/// Asks the model at these distances on the way to these places, and corrects them by that and what was known.
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
