//! Verification for every method: an error estimate for each figure, from the model itself.
//!
//! The rule: no figure is printed without an error estimate, and the true value lies within three estimates. It is independent of the
//! method: the model is evaluated again for any figure `m`.
//!
//! - A cheap model is [sampled](verify_by_sampling) at some 45 000 points in strata. A figure's error is `hypot(m - s, se)` with the
//!   sample's `s` and its standard error `se`.
//! - A costly model is evaluated at points that the method has not used: 12 near the means, and 6 to 18 where decisions fall.
//! - A formula needs neither if its own tree proves that the method's surface equals the function.

mod check_points;
mod check_ray;
mod checked_surface;
mod costly_model;
mod decision_points;
mod far_effect;
mod far_residual;
mod likeliest_point;
mod plan_nodes;
mod refuted_limit;
mod residual_error;
mod unseen_share;

pub use crate::estimate::{
    Crossing, FoundSwitch, OutputCorrelation, SampleTails, Share, TailPoint, Verified, variance_shares,
};
pub(crate) use crate::estimate::{SampleQuantile, WeightedSample, variance_shares_during};
pub use crate::verification::check_ray::MOST_LOCATING;
pub use crate::verification::costly_model::{Checked, CheckedFigures, Target, check_points, verify_by_checks};
pub use crate::verification::far_residual::FarResidual;
pub use crate::verification::plan_nodes::PlanNode;
pub(crate) use crate::verification::residual_error::{OVERLOOKED, OVERLOOKED_BY, TOO_SMALL};
pub(crate) use crate::verification::unseen_share::CONFIDENCE;
pub use crate::verification::unseen_share::unseen;

use crate::assembly::Run;
use crate::estimate::cheap_model::CheapModel;
use crate::estimate::figures::moments;
use crate::estimate::stratified_sample::{PILOT, StratifiedSample, TAIL};
use crate::estimate::switch_side;
use crate::estimate::variance_shares::most_points as most_points_of_exchange;
use crate::problem::Problem;
use sensitol_numeric::sampling::Normals;
use sensitol_numeric::surrogate::Surrogate;

/// Default number of points in the core of a sample.
pub(crate) const CORE: usize = 1 << 15;

/// Points for the share of the variance that a surface leaves unexplained.
pub(crate) const BESIDE: usize = 1 << 10;

/// Greatest number of evaluations of a sample with `core` points in its core, including those of [`unexplained`].
pub(crate) const fn most_points(core: usize) -> usize {
    PILOT + (switch_side::MOST + 2) * TAIL + core + BESIDE
}

/// Points in the core of the largest sample within `most` evaluations for a characteristic. It is at most [`CORE`], and at least the number
/// of points of a tail. Returns None if the evaluations do not suffice for that.
pub(crate) fn core_within(problem: &Problem, c: usize, most: Option<usize>) -> Option<usize> {
    let Some(most) = most else { return Some(CORE) };
    // Without switches there are no strata for seldom sides.
    let switches = problem.function().switches(problem.outputs()[c]).map_or(0, |switches| switches.list.len());
    let sides = if switches == 0 { switch_side::MOST } else { 0 };
    let others = most_points(0) - sides * TAIL;
    let halved = std::iter::successors(Some(CORE), |core| Some(core / 2));
    halved.take_while(|&core| core >= TAIL).find(|&core| others + core <= most)
}

/// Greatest number of evaluations of [`unexplained`] followed by [`variance_shares_during`] over this number of inputs.
pub(crate) fn most_points_of_shares(inputs: usize) -> usize {
    BESIDE + most_points_of_exchange(inputs)
}

/// Figures of one characteristic from a sample of the model.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SampledFigures {
    /// Number of evaluated points.
    pub points: usize,
    /// Mean. None if no point has a value.
    pub mean: Option<Verified>,
    /// Standard deviation.
    pub sigma: Option<Verified>,
    /// Skewness. None if nothing varies.
    pub skewness: Option<Verified>,
    /// Kurtosis. None if nothing varies.
    pub kurtosis: Option<Verified>,
    /// Share within the limits, of those assemblies that have a value. None if there are no limits.
    pub yield_: Option<Verified>,
    /// Shares below the lower limit, and above the upper one.
    pub beyond: [Option<Verified>; 2],
    /// Weight of one point: the share that may be missed although no point shows it.
    pub point: f64,
    /// Difference of the shares of model and surface within the limits, below and above them. None if no surface was given, and if some
    /// points have no value.
    pub difference: Option<[Verified; 3]>,
    /// Share of the assemblies that have a value.
    pub valid: Verified,
    /// Switches that were met. None if the model does not report where it changes its form.
    pub switches: Option<Vec<FoundSwitch>>,
    /// True if the model reported all of its switches.
    pub switches_complete: bool,
    /// The sample itself.
    pub(crate) sample: Option<WeightedSample>,
}

/// Samples a cheap model: every figure of every characteristic from the model itself, with its error.
///
/// Pure in problem and seed; the number of threads does not matter.
///
/// Evaluations: for every characteristic 1024 points to find the tails, up to 24 576 in half-spaces of seldom sides of switches, 8192 in
/// the two tails and 32 768 in the core. There are fewer for more than 30 dimensions, because a stratum has a million numbers at most.
///
/// Accuracy: the error of sigma is 4e-4 of it in the median of 88 characteristics. Points without a value are left out of numerator and
/// denominator alike.
///
/// ```
/// use sensitol::{Closure, Dimension, Problem};
/// use sensitol::verification::verify_by_sampling;
/// let dimensions = [Dimension::normal("a", 0.0, 3.0)?, Dimension::normal("b", 0.0, 3.0)?];
/// let problem = Problem::new(dimensions, Closure::scalar("larger", |x| x[0].max(x[1])))?;
/// let mean = verify_by_sampling(&problem, 1)[0].mean.unwrap();
/// let exact = 1.0 / std::f64::consts::PI.sqrt(); // Clark 1961
/// assert!((mean.value - exact).abs() < 3.0 * mean.error && mean.error < 1e-3);
/// # Ok::<(), sensitol::Error>(())
/// ```
pub fn verify_by_sampling(problem: &Problem, seed: u64) -> Vec<SampledFigures> {
    let run = Run::to_the_end();
    (0..problem.characteristics().len())
        .filter_map(|c| verify_characteristic(problem, c, (seed, CORE), None, &run))
        .collect()
}

/// Share of a characteristic's variance that a surface over the dimensions at `varying` leaves unexplained, from 1024 points of the model.
/// Returns None if the surface has no value, or the model none at any point.
pub(crate) fn unexplained(
    problem: &Problem,
    c: usize,
    (varying, surrogate): (&[usize], &Surrogate),
    seed: u64,
    run: &Run<'_>,
) -> Option<f64> {
    let model = CheapModel::over(problem, c, varying).during(run);
    let z = Normals::new(varying.len(), seed).columns(1 << 35, BESIDE);
    let rises = surrogate.rises(&model.standardised(&z))?;
    let y = model.values(&z);
    if model.stopped() {
        return None;
    }
    let (valid, off): (Vec<f64>, Vec<f64>) = (y.iter().zip(&rises))
        .filter(|(y, _)| y.is_finite())
        .map(|(y, rise)| (*y, y - surrogate.centre - rise))
        .unzip();
    let variance = moments(&valid, &vec![1.0; valid.len()])[1].powi(2);
    let square = off.iter().map(|d| d * d).sum::<f64>() / off.len() as f64;
    (variance > 0.0).then_some(square / variance)
}

/// Verifies one characteristic by a sample with `core` points in the core, and compares it with its surface `beside`. Returns None if the
/// run was stopped meanwhile, because an incomplete set of strata is no sample.
pub(crate) fn verify_characteristic(
    problem: &Problem,
    c: usize,
    (seed, core): (u64, usize),
    beside: Option<(&[usize], &Surrogate)>,
    run: &Run<'_>,
) -> Option<SampledFigures> {
    let model = CheapModel::new(problem, c).during(run);
    let limits = problem.characteristics()[c].limits();
    let [low, high] = problem.kept_limits(c).ends();
    if model.len() == 0 {
        return Some(constant(&model, [low, high])).filter(|_| !model.stopped());
    }
    let StratifiedSample { sample, points, sides } = StratifiedSample::draw(&model, seed, core, beside);
    if model.stopped() {
        return None;
    }
    let beyond = [[f64::NEG_INFINITY, low.next_down()], [high.next_up(), f64::INFINITY]];
    let figures = sample.figures(&[[low, high], beyond[0], beyond[1]]);
    let void = sample.is_void();
    let known = |index: usize| Some(figures.estimates[index]).filter(|figure| !void && figure.value.is_finite());
    let varies = known(1).is_some_and(|sigma| sigma.value > 0.0);
    let difference = sample.difference([[low, high], beyond[0], beyond[1]]).filter(|_| limits.exist());
    Some(SampledFigures {
        points,
        mean: known(0),
        sigma: known(1),
        skewness: known(2).filter(|_| varies),
        kurtosis: known(3).filter(|_| varies),
        yield_: known(4).filter(|_| limits.exist()),
        beyond: [known(5).filter(|_| limits.lower().is_some()), known(6).filter(|_| limits.upper().is_some())],
        point: sample.point(),
        difference,
        valid: figures.valid,
        switches: sides.switches,
        switches_complete: sides.complete,
        sample: Some(sample),
    })
}

/// Figures of a characteristic that does not vary, from one point.
fn constant(model: &CheapModel<'_>, [low, high]: [f64; 2]) -> SampledFigures {
    let value = model.values(&Vec::new())[0];
    let exact = |value: f64| Some(Verified { value, error: 0.0 });
    let share = |holds: bool| Some(Verified { value: f64::from(u8::from(holds)), error: 0.0 });
    let known = value.is_finite();
    let limited = [low.is_finite(), high.is_finite()];
    SampledFigures {
        points: 1,
        mean: exact(value).filter(|_| known),
        sigma: exact(0.0).filter(|_| known),
        skewness: None,
        kurtosis: None,
        yield_: share(low <= value && value <= high).filter(|_| known && (limited[0] || limited[1])),
        beyond: [
            share(value < low).filter(|_| known && limited[0]),
            share(value > high).filter(|_| known && limited[1]),
        ],
        point: 0.0,
        difference: None,
        valid: Verified { value: f64::from(u8::from(known)), error: 0.0 },
        switches: None,
        switches_complete: true,
        sample: None,
    }
}
