//! Verification for every method: an error estimate for each figure, from the model itself.
//!
//! The rule: no figure is printed without an error estimate, and the true value lies within three estimates. It is independent of the
//! method: the model is evaluated again for any figure `m`.
//!
//! - A cheap model is [sampled](verify_by_sampling) at some 45 000 points in strata. A figure's error is `hypot(m - s, se)` with the
//!   sample's `s` and its standard error `se`.
//! - A costly model is evaluated at 12 to 18 points that the method has not used.
//! - A formula needs neither if its own tree proves that the method's surface equals the function.

mod check_points;
mod costly_model;
mod figures;
mod model;
mod output_correlation;
mod residual_error;
mod sample;
mod sample_quantile;
mod strata;
mod switch_side;
mod tails;
mod variance_shares;
mod weighted;

pub(crate) use crate::verification::costly_model::CONFIDENCE;
pub use crate::verification::costly_model::{Checked, CheckedFigures, MOST_CHECKS, Target, unseen, verify_by_checks};
pub use crate::verification::output_correlation::OutputCorrelation;
pub(crate) use crate::verification::output_correlation::{common_rejects, most_points_together, output_correlations};
pub(crate) use crate::verification::residual_error::{OVERLOOKED, OVERLOOKED_BY, TOO_SMALL};
pub use crate::verification::switch_side::{Crossing, FoundSwitch};
pub use crate::verification::variance_shares::Share;
pub(crate) use figures::{MOMENTS, carried_by, effective, jackknife, standard, student, totals};
pub(crate) use sample::REPLICATES;
pub(crate) use sample_quantile::{SampleQuantile, reported_quantiles};
pub use tails::{SampleTails, TailPoint};
pub(crate) use weighted::WeightedSample;

use serde::Serialize;

use crate::assembly::{Points, Run};
use crate::estimate::Columns;
use crate::problem::Problem;
use figures::moments;
use model::Model;
use sample::Sample;
use sensitol_numeric::correlation::factors;
use sensitol_numeric::power::{Losable, Rescale, Rescaling};
use sensitol_numeric::sampling::Normals;
use sensitol_numeric::surrogate::Surrogate;

/// Default number of points in the core of a sample.
pub(crate) const CORE: usize = 1 << 15;

/// Points for the share of the variance that a surface leaves unexplained.
pub(crate) const BESIDE: usize = 1 << 10;

/// Most evaluations of a sample with `core` points in its core, including those of [`unexplained`].
pub(crate) const fn most_points(core: usize) -> usize {
    sample::PILOT + (crate::verification::switch_side::MOST + 2) * sample::TAIL + core + BESIDE
}

/// Points in the core of the largest sample within `most` evaluations for a characteristic. It is at most [`CORE`], and at least the number
/// of points of a tail. Returns None if the evaluations do not suffice for that.
pub(crate) fn core_within(problem: &Problem, c: usize, most: Option<usize>) -> Option<usize> {
    let Some(most) = most else { return Some(CORE) };
    // Without switches there are no strata for seldom sides.
    let switches = problem.function().switches(problem.outputs()[c]).map_or(0, |switches| switches.list.len());
    let sides = if switches == 0 { crate::verification::switch_side::MOST } else { 0 };
    let others = most_points(0) - sides * sample::TAIL;
    let halved = std::iter::successors(Some(CORE), |core| Some(core / 2));
    halved.take_while(|&core| core >= sample::TAIL).find(|&core| others + core <= most)
}

/// Most evaluations of [`unexplained`] followed by [`variance_shares_during`] over this number of inputs.
pub(crate) fn most_points_of_shares(inputs: usize) -> usize {
    BESIDE + crate::verification::variance_shares::most(inputs)
}

/// A figure by the model itself, with its error. The true value lies within three of these errors whenever it lies within three standard
/// errors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Verified {
    /// The value.
    pub value: f64,
    /// Estimated error of the value.
    pub error: f64,
}

impl Rescale for Verified {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.value.rescale(by);
        self.error.rescale(by);
    }
}

impl Losable for Verified {
    fn is_unknown(&self) -> bool {
        self.value.is_nan()
    }
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

impl Verified {
    /// Error of another value for the same figure: `hypot(value - own, error)`. The true value lies within three of it whenever it lies
    /// within three of the own error.
    ///
    /// ```
    /// use sensitol::analysis::Verified;
    /// assert_eq!(Verified { value: 1.0, error: 3.0 }.error_of(5.0), 5.0);
    /// ```
    pub fn error_of(&self, value: f64) -> f64 {
        libm::hypot(value - self.value, self.error)
    }
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

/// Likeliest points beyond the seldom switches of a cheap model, in independent normal variables of the dimensions at `varying`. Empty if
/// the model does not report its switches.
pub(crate) fn seldom_points(problem: &Problem, c: usize, varying: &[usize], seed: u64) -> Vec<Vec<f64>> {
    let model = Model::over(problem, c, varying);
    let found = crate::verification::switch_side::sides(&model, &Normals::new(varying.len(), seed), 1.0);
    let point = |space: strata::HalfSpace| {
        space.direction.iter().map(|part| part * (space.from + crate::verification::switch_side::BEFORE)).collect()
    };
    found.half_spaces.into_iter().map(point).collect()
}

/// Switches of a characteristic, and points beyond those that are seldom met.
pub(crate) struct RareSides {
    pub(crate) switches: Vec<FoundSwitch>,
    /// Points of the half-spaces that contain the seldom sides. Their `values` are NaN if the model has none.
    pub(crate) points: Points,
    pub(crate) values: Vec<f64>,
    /// Weights of the points, which sum to the probability of the half-spaces.
    pub(crate) weights: Vec<f64>,
}

/// Searches for the switches of a characteristic whose values have the spread `scale`. Returns None if the model is costly, does not report
/// its switches, or if the run was stopped.
///
/// Evaluations: 256 for every half-space, six at most. The margins of switches, and some values beside them, are evaluated in addition.
pub(crate) fn seldom_sides(problem: &Problem, c: usize, (seed, scale): (u64, f64), run: &Run<'_>) -> Option<RareSides> {
    /// Number of points of a half-space. Its part of a moment is known to about a tenth.
    const WITHIN: usize = 1 << 8;
    let function = problem.function();
    let told = function.switches(problem.outputs()[c]).filter(|told| !told.list.is_empty());
    told.filter(|_| !function.signature().costly)?;
    let model = Model::new(problem, c).during(run);
    let normals = Normals::new(model.len(), seed);
    let found = crate::verification::switch_side::sides(&model, &normals, if scale > 0.0 { scale } else { 1.0 });
    let mut all: Columns = vec![Vec::new(); model.len()];
    let mut weights = Vec::new();
    for (index, space) in found.half_spaces.iter().enumerate() {
        let mut z = normals.columns((1 << 34) + index as u64, WITHIN);
        let own = space.enter(&mut z);
        // A point counts in the first half-space that contains it.
        let mut held = vec![false; WITHIN];
        for earlier in &found.half_spaces[..index] {
            held.iter_mut().zip(earlier.holds(&z)).for_each(|(held, by)| *held |= by);
        }
        for (all, column) in all.iter_mut().zip(z) {
            all.extend(column.iter().zip(&held).filter(|(_, held)| !**held).map(|(z, _)| *z));
        }
        weights.extend(own.iter().zip(&held).filter(|(_, held)| !**held).map(|(weight, _)| weight / WITHIN as f64));
    }
    let (points, values) = model.points_and_values(&all);
    (!model.stopped()).then(|| RareSides { switches: found.switches.unwrap_or_default(), points, values, weights })
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
    let model = Model::over(problem, c, varying).during(run);
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

/// Shares of the variance by a sampled model: the first-order and the total share of every dimension on which a characteristic depends, by
/// exchanging inputs of the model itself.
///
/// Returns None with correlated dimensions, whose shares add up differently, with more than 256 dimensions, and if nothing varies.
/// Evaluations: 65 536, for more than 126 inputs 512 for each. Accuracy: 311 of 312 shares of six functions with closed forms lay within
/// three errors, the largest error 0.026.
///
/// ```
/// use sensitol::{Closure, Dimension, Problem};
/// use sensitol::verification::variance_shares;
/// let dimensions = [Dimension::normal("a", 0.0, 3.0)?, Dimension::normal("b", 0.0, 3.0)?];
/// let problem = Problem::new(dimensions, Closure::scalar("y", |x| x[0] + x[0] * x[1]))?;
/// let shares = variance_shares(&problem, 0, 1).unwrap();
/// let [(0, [first, total]), (1, _)] = shares[..] else { panic!("two dimensions") };
/// assert!((first.value - 0.5).abs() < 0.02 && (total.value - 1.0).abs() < 0.02); // a alone, and with b
/// # Ok::<(), sensitol::Error>(())
/// ```
pub fn variance_shares(problem: &Problem, characteristic: usize, seed: u64) -> Option<Vec<(usize, [Share; 2])>> {
    variance_shares_during(problem, characteristic, seed, &Run::to_the_end())
}

/// [`variance_shares`] under the conditions of a run. Returns None if the run was stopped meanwhile.
pub(crate) fn variance_shares_during(
    problem: &Problem,
    characteristic: usize,
    seed: u64,
    run: &Run<'_>,
) -> Option<Vec<(usize, [Share; 2])>> {
    if problem.correlation().is_some() {
        return None;
    }
    let found = factor_shares(problem, characteristic, seed, run)?;
    Some(found.into_iter().map(|(factor, shares)| (factor[0], shares)).collect())
}

/// [`variance_shares`] of factors: dimensions that vary together are exchanged together. Each factor is given by those of its dimensions on
/// which the characteristic depends.
pub(crate) fn factor_shares(
    problem: &Problem,
    characteristic: usize,
    seed: u64,
    run: &Run<'_>,
) -> Option<Vec<(Vec<usize>, [Share; 2])>> {
    let model = Model::new(problem, characteristic).during(run);
    let dimensions: Vec<usize> = model.dimensions().collect();
    let places = factors(problem.correlation(), &dimensions);
    let found = crate::verification::variance_shares::shares(&model, &places, seed)?;
    let named = places.into_iter().map(|factor| factor.into_iter().map(|place| dimensions[place]).collect());
    (!model.stopped()).then(|| named.zip(found).collect())
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
    let model = Model::new(problem, c).during(run);
    let limits = problem.characteristics()[c].limits();
    let [low, high] = problem.kept_limits(c).ends();
    if model.len() == 0 {
        return Some(constant(&model, [low, high])).filter(|_| !model.stopped());
    }
    let sample = Sample::draw(&model, seed, core, beside);
    if model.stopped() {
        return None;
    }
    let sides = sample.sides.clone();
    let beyond = [[f64::NEG_INFINITY, low.next_down()], [high.next_up(), f64::INFINITY]];
    let figures = sample.figures(&[[low, high], beyond[0], beyond[1]]);
    let void = sample.is_void();
    let known = |index: usize| {
        let (value, error) = (figures.values[index], figures.errors[index]);
        (!void && value.is_finite()).then_some(Verified { value, error })
    };
    let varies = known(1).is_some_and(|sigma| sigma.value > 0.0);
    let difference = sample.difference(&[[low, high], beyond[0], beyond[1]]).filter(|_| limits.exist());
    let (points, point) = (sample.points, sample.point());
    Some(SampledFigures {
        points,
        mean: known(0),
        sigma: known(1),
        skewness: known(2).filter(|_| varies),
        kurtosis: known(3).filter(|_| varies),
        yield_: known(4).filter(|_| limits.exist()),
        beyond: [known(5).filter(|_| limits.lower().is_some()), known(6).filter(|_| limits.upper().is_some())],
        point,
        difference,
        valid: Verified { value: figures.valid.0, error: figures.valid.1 },
        switches: sides.switches,
        switches_complete: sides.complete,
        sample: Some(sample.kept()),
    })
}

/// Figures of a characteristic that does not vary, from one point.
fn constant(model: &Model<'_>, [low, high]: [f64; 2]) -> SampledFigures {
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
