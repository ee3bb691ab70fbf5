//! Distribution of a characteristic's surface: shares beyond the limits, quantiles, density.

use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::analysis::distribution::counted_surface as counted;
use crate::analysis::distribution::law_guard::{FaultyQuantiles, LawGuard, LawRefutation, LawTest, by_sample};
use crate::analysis::result::verification::{Verification, VerificationKind};
use crate::estimate::OrderedPoints;
use crate::method::Outcome;
use crate::problem::Problem;
use sensitol_numeric::capability::{Law, Quantiles};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::correlation::Correlation;
use sensitol_numeric::distribution::{Distribution, Normal};
use sensitol_numeric::law::{Branch, LawError, LawFigure, LawOptions, LawTail, REPORTED_QUANTILES, Sought, SurfaceLaw};
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::pearson::Pearson;
use sensitol_numeric::power::rescale;
use sensitol_numeric::surrogate::{Surrogate, Univariate};

/// Indices of the outer two and the median among them.
const OUTER: [usize; 3] = [0, 3, 6];

/// Unexplained variance, as a part of the surface's own, below which it moves no probability by more than 1e-10.
const IDLE: f64 = 1e-10;
/// Points for a limit in the sampled branch, for surfaces of up to [`TERMS`] terms.
const POINTS: usize = 1 << 12;
/// Number of terms of the surface above which fewer points are used.
const TERMS: usize = 1 << 10;
/// Smallest number of points for a limit in the sampled branch.
const FEWEST: usize = 1 << 9;
/// Greatest number of measured values of one input for which every point of a contour is a short sum.
const ATOMS: usize = 64;
/// Greatest number of terms at all points of a contour, if an input has more than [`ATOMS`] values. Above it the surface is counted at
/// points instead.
const TERMS_OF_ATOMS: f64 = 1e7;
/// Points of a contour times the part of sigma that has a density. The transform vanishes beyond 8 divided by the sigma of that part, and
/// the distance of points is a third divided by the whole sigma.
const POINTS_OF_SIGMA: f64 = 24.0;
/// Greatest number of points of a contour.
const MOST_POINTS: f64 = 2048.0;
/// Greatest number of values of a step function that are listed.
const STEPS: usize = 1 << 18;
/// Tail probability at which a drawn density ends.
const DRAWN: f64 = 1e-5;
/// Number of places of a drawn density: a pixel or two each.
const PLACES: usize = 240;
/// Places of a drawn density if each is a sum over points. Lines between them are within 0.1 % of the peak of a normal density.
const FEW_PLACES: usize = 96;

/// Shares of a characteristic by the distribution of its surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SurfaceShares {
    /// Kind of computation of the distribution: `exact`, `single` or `sampled`.
    pub branch: Branch,
    /// Number of surface points that were counted because the distribution could not be computed or is refuted. None if it was computed.
    #[serde(rename = "counted_points")]
    pub counted: Option<usize>,
    /// Contradiction because of which points replace the distribution. None if there is none.
    pub refuted: Option<LawRefutation>,
    /// True if the distribution is a step function: every input with an effect has measured values only.
    #[serde(rename = "step_function")]
    pub steps: bool,
    /// Share within the limits. None if there are no limits.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// Share below the lower limit. None if there is no such limit.
    #[serde(rename = "ppm_below", serialize_with = "ppm")]
    #[cfg_attr(
        feature = "schema",
        schemars(with = "Option<f64>", description = "Assemblies below the lower limit, per million.")
    )]
    pub below: Option<LawFigure>,
    /// Share above the upper limit. None if there is no such limit.
    #[serde(rename = "ppm_above", serialize_with = "ppm")]
    #[cfg_attr(
        feature = "schema",
        schemars(with = "Option<f64>", description = "Assemblies above the upper limit, per million.")
    )]
    pub above: Option<LawFigure>,
    /// Numerical error of the share within the limits: of the distribution of this surface, not of the surface.
    pub yield_error: Option<f64>,
    /// Quantiles at the reported probabilities. None if one of them is unknown: those of the Pearson fit are reported then.
    #[serde(serialize_with = "quantile_values")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<Quantiles>"))]
    pub quantiles: Option<[LawFigure; 7]>,
}

rescale!(SurfaceShares { refuted, quantiles } without {
    branch, counted, steps, yield_, below, above, yield_error,
});

/// Distribution of a characteristic's surface that has passed its tests, or points of the surface in its place. It is the only source of
/// shares, quantiles, intervals and density.
pub(in crate::analysis) struct GuardedLaw {
    pub(in crate::analysis) shares: SurfaceShares,
    /// Distribution that gives shares beyond limits. None if points replace it.
    pub(in crate::analysis) law: Option<SurfaceLaw>,
    /// Points of the surface that replace the distribution.
    pub(in crate::analysis) points: Option<OrderedPoints>,
}

/// Request of the distribution of a characteristic: its index, the seed of points, and its verification.
#[derive(Clone, Copy)]
pub(in crate::analysis) struct LawRequest<'a> {
    pub(in crate::analysis) problem: &'a Problem,
    pub(in crate::analysis) outcome: &'a Outcome,
    pub(in crate::analysis) c: usize,
    pub(in crate::analysis) seed: u64,
    pub(in crate::analysis) fit: Option<&'a Law>,
    pub(in crate::analysis) verification: Option<&'a Verification>,
}

impl GuardedLaw {
    /// Computes and tests the distribution. Returns None if the moments do not follow from a surface, or only moments are known of an
    /// input. The search for quantiles starts at those of `fit`.
    ///
    /// Unexplained variance is added as a normal input, unless there is a sample of the model, which contains it already.
    pub(in crate::analysis) fn of(request: LawRequest<'_>) -> Option<Self> {
        let LawRequest { problem, outcome, c, .. } = request;
        if outcome.fitted[c].integrated.is_some() {
            return None;
        }
        // A surface that is proven to equal the function leaves only rounding unexplained.
        let exact = request.verification.is_some_and(|of| of.kind == VerificationKind::Exact);
        let beside = request.verification.is_some_and(|of| of.kind == VerificationKind::Sample);
        let unexplained = outcome.climbed.as_ref().and_then(|climbed| climbed.unexplained(c));
        let unexplained = unexplained.filter(|_| !exact && !beside);
        let (surrogate, inputs) = surface(problem, outcome, c, unexplained)?;
        let correlation = outcome.plan.inputs().correlation();
        let options = options(problem, c, &surrogate);
        let limits = problem.characteristics()[c].limits();
        let whole = match known_law(&surrogate, &inputs, correlation, &options) {
            Some(Ok(law)) => law,
            None | Some(Err(LawError::NoVariance | LawError::NoEigenvalues | LawError::LongTail { .. })) => {
                return Self::counted(request, None);
            }
            Some(Err(_)) => return None,
        };
        let (below, above) = (limits.lower().map(|y| whole.below(y)), limits.upper().map(|y| whole.above(y)));
        let known = |figure: &LawFigure| figure.value.is_finite() && figure.error.is_finite();
        if ![below, above].iter().flatten().all(known) {
            return Self::counted(request, None);
        }
        let quantiles = quantiles(&whole, request.fit);
        let (branch, steps) = (whole.branch(), whole.is_step_function());
        let shares = SurfaceShares::of(branch, [below, above], quantiles);
        let shares = SurfaceShares { steps, ..shares };
        // A list of all values with their probabilities is a count itself.
        let refuted = if steps { None } else { shares.refutation(request, limits, unexplained) };
        match refuted {
            Some(refutation) => Self::counted(request, Some(refutation)),
            None => Some(Self { shares, law: Some(whole), points: None }),
        }
    }

    /// Counts points in place of a distribution that could not be computed, or is refuted.
    fn counted(request: LawRequest<'_>, refuted: Option<LawRefutation>) -> Option<Self> {
        let LawRequest { problem, outcome, c, seed, .. } = request;
        let points = counted::points(problem, outcome, (c, seed), (counted::POINTS, None))?;
        let (limits, [low, high]) = (problem.characteristics()[c].limits(), problem.kept_limits(c).ends());
        let beyond = [
            limits.lower().map(|_| points.estimate_beyond(LawTail::Lower, low)),
            limits.upper().map(|_| points.estimate_beyond(LawTail::Upper, high)),
        ];
        let quantiles = REPORTED_QUANTILES.map(|(tail, p)| points.quantile(tail, p));
        let shares = SurfaceShares::of(Branch::Sampled, beyond, Some(quantiles));
        let shares = SurfaceShares { counted: Some(points.len()), refuted, ..shares };
        Some(Self { shares, law: None, points: Some(points) })
    }

    /// Quantiles at these tails and probabilities, at most one half each, by a tested distribution or by the points that replace it.
    /// Returns None if one of them is unknown.
    pub(in crate::analysis) fn quantiles(&self, fit: Option<&Law>, of: &[(LawTail, f64)]) -> Option<Vec<LawFigure>> {
        if let Some(points) = &self.points {
            return Some(of.iter().map(|&(tail, p)| points.quantile(tail, p)).collect());
        }
        let law = self.law.as_ref()?;
        let found = law.quantiles(&sought(law, fit, of)).into_iter();
        found.map(|figure| Some(figure).filter(|figure| figure.value.is_finite())).collect()
    }

    /// Returns the density as a table, `[y, density, error]`. Returns None if the values are steps.
    pub(in crate::analysis) fn density(&self) -> Option<Vec<[f64; 3]>> {
        match (&self.law, &self.points) {
            (Some(law), _) => density(law, self.shares.quantiles.as_ref()),
            (None, Some(points)) if self.shares.refuted.is_some() => points.density(FEW_PLACES),
            (None, _) => None,
        }
    }

    /// Counts points in place of a distribution whose quantiles give no coverage intervals.
    pub(in crate::analysis) fn without(request: LawRequest<'_>, faulty: &FaultyQuantiles) -> Option<Self> {
        let mut counted = Self::counted(request, None)?;
        if let (FaultyQuantiles::Fall(p, y), Some(points)) = (faulty, &counted.points) {
            counted.shares.refuted = Some(LawGuard::new(points, 0.0).refutation(LawTest::Monotone, *y, *p));
        }
        Some(counted)
    }
}

/// Serializes a share in parts per million.
fn ppm<S: Serializer>(share: &Option<LawFigure>, serializer: S) -> Result<S::Ok, S::Error> {
    share.map(|figure| 1e6 * figure.value).serialize(serializer)
}

/// Serializes the values of quantiles by the names of their probabilities.
fn quantile_values<S: Serializer>(all: &Option<[LawFigure; 7]>, serializer: S) -> Result<S::Ok, S::Error> {
    all.map(|all| Quantiles(all.map(|figure| figure.value))).serialize(serializer)
}

impl SurfaceShares {
    /// Shares of a computed distribution, with the yield and its error by the shares beyond the limits.
    fn of(branch: Branch, [below, above]: [Option<LawFigure>; 2], quantiles: Option<[LawFigure; 7]>) -> Self {
        let (counted, refuted, steps) = (None, None, false);
        let (yield_, yield_error) = (None, None);
        let shares = Self { branch, counted, refuted, steps, yield_, below, above, yield_error, quantiles };
        let yield_ = shares.rejected().map(|rejected| 1.0 - rejected);
        Self { yield_, yield_error: yield_.map(|_| shares.error()), ..shares }
    }

    /// Tests shares and quantiles by points of the surface and by the sample of the model. `unexplained` is the variance that the
    /// distribution adds to the surface.
    fn refutation(
        &self,
        request: LawRequest<'_>,
        limits: SpecLimits,
        unexplained: Option<f64>,
    ) -> Option<LawRefutation> {
        let LawRequest { problem, outcome, c, seed, verification, .. } = request;
        let by_sample = verification.and_then(|of| by_sample(of, limits, [self.below, self.above]));
        if by_sample.is_some() {
            return by_sample;
        }
        let points = counted::points(problem, outcome, (c, seed), (counted::TESTED, unexplained))?;
        let guard = LawGuard::new(&points, problem.kept_limits(c).rounding());
        let quantiles: Vec<_> =
            self.quantiles.iter().flat_map(|all| REPORTED_QUANTILES.into_iter().zip(*all)).collect();
        let tails = [(limits.lower(), LawTail::Lower, self.below), (limits.upper(), LawTail::Upper, self.above)];
        let tail = |(limit, tail, share): (Option<f64>, LawTail, Option<LawFigure>)| {
            guard.tail((limit?, tail), share?, &quantiles)
        };
        guard.quantiles(&quantiles).or_else(|| tails.into_iter().find_map(tail))
    }

    /// Numerical error of the share within the limits.
    pub(crate) fn error(&self) -> f64 {
        [self.below, self.above].iter().flatten().map(|figure| figure.error).fold(0.0, libm::hypot)
    }

    /// Share of assemblies beyond the limits. Returns None if there are no limits.
    pub(crate) fn rejected(&self) -> Option<f64> {
        let beyond = [self.below, self.above];
        beyond.iter().any(Option::is_some).then(|| beyond.iter().flatten().map(|figure| figure.value).sum::<f64>())
    }
}

/// True if measured values are too many for sums at the points of a contour and for a list of combinations.
fn has_too_many_atoms(
    surrogate: &Surrogate,
    inputs: &[Arc<dyn Distribution>],
    correlation: Option<&Correlation>,
) -> bool {
    // Rows of a block are listed, or drawn: no contour sums over them.
    let drawn = |j: usize| correlation.is_some_and(|correlation| correlation.block_of(j).is_some());
    let of = |(j, law): (usize, &Arc<dyn Distribution>)| match law.probability() {
        Some(law) if !drawn(j) => law.atoms().len(),
        _ => 0,
    };
    let atoms: Vec<usize> = inputs.iter().enumerate().map(of).collect();
    if atoms.iter().all(|&count| count <= ATOMS) {
        return false;
    }
    let counts = |j: &usize| !drawn(*j) && surrogate.parts[*j].is_some_and(|part| part.largest() > 0.0);
    let counting = || (0..inputs.len()).filter(counts);
    let listed =
        counting().try_fold(1usize, |all, j| all.checked_mul(atoms[j]).filter(|&all| (1..=STEPS).contains(&all)));
    if listed.is_some() {
        return false;
    }
    let products = surrogate.interactions.pairs();
    if products.iter().any(|&(j, k, product)| product != 0.0 && atoms[j].max(atoms[k]) > ATOMS) {
        return true;
    }
    let spread = |smooth: bool| {
        let own = counting().filter(|&j| !smooth || atoms[j] == 0).filter_map(|j| surrogate.parts[j]);
        own.map(|part| part.largest().powi(2)).sum::<f64>().sqrt()
    };
    if spread(true) <= 0.0 {
        return true;
    }
    let points = (POINTS_OF_SIGMA * spread(false) / spread(true)).max(1.0);
    points > MOST_POINTS || points * atoms.iter().sum::<usize>() as f64 > TERMS_OF_ATOMS
}

/// Distribution of a characteristic's surface itself. Returns None if there is no surface, or only moments are known of an input.
pub(crate) fn surface_law(problem: &Problem, outcome: &Outcome, c: usize) -> Option<Result<SurfaceLaw, LawError>> {
    let (surrogate, inputs) = surface(problem, outcome, c, None)?;
    let rounding = problem.kept_limits(c).rounding();
    Some(law_over(&surrogate, &inputs, outcome.plan.inputs().correlation(), rounding))
}

/// Distribution of a surface over its inputs. Returns None if measured values are too many for a contour, and their sums too many for a
/// list.
fn known_law(
    surrogate: &Surrogate,
    inputs: &[Arc<dyn Distribution>],
    correlation: Option<&Correlation>,
    options: &LawOptions,
) -> Option<Result<SurfaceLaw, LawError>> {
    match has_too_many_atoms(surrogate, inputs, correlation) {
        true => SurfaceLaw::of_list(surrogate, inputs, correlation, options).map(Ok),
        false => Some(SurfaceLaw::of(surrogate, inputs, correlation, options)),
    }
}

/// Options for computing the distribution. Without limits a tail needs no twelve digits: quantiles of trees of products come from points.
fn options(problem: &Problem, c: usize, surrogate: &Surrogate) -> LawOptions {
    let (trees, kept) = (problem.characteristics()[c].limits().exist(), problem.kept_limits(c));
    LawOptions { points: points(surrogate), trees, rounding: kept.rounding(), ..LawOptions::default() }
}

/// Distribution of a surface over these inputs, with the number of points for reports. Rounding moves values by no more than `rounding`.
pub(crate) fn law_over(
    surrogate: &Surrogate,
    inputs: &[Arc<dyn Distribution>],
    correlation: Option<&Correlation>,
    rounding: f64,
) -> Result<SurfaceLaw, LawError> {
    let options = LawOptions { points: points(surrogate), trees: true, rounding, ..LawOptions::default() };
    SurfaceLaw::of(surrogate, inputs, correlation, &options)
}

/// A surface and the distributions of its inputs, with an unexplained variance as a further input.
pub(in crate::analysis) fn surface(
    problem: &Problem,
    outcome: &Outcome,
    c: usize,
    unexplained: Option<f64>,
) -> Option<(Surrogate, Vec<Arc<dyn Distribution>>)> {
    let inputs = outcome.plan.varying().iter().map(|&d| problem.dimensions()[d].law().cloned());
    Some(with(outcome.fitted[c].surrogate.as_ref()?, inputs.collect::<Option<_>>()?, unexplained))
}

/// Number of points for a limit in the sampled branch, fewer for a surface with many terms.
fn points(surrogate: &Surrogate) -> usize {
    let terms = surrogate.parts.len() + surrogate.interactions.each_pair().count();
    (POINTS * TERMS / terms.max(TERMS)).max(FEWEST)
}

/// Adds unexplained variance to the surface as a normal input of its own.
pub(in crate::analysis) fn with(
    own: &Surrogate,
    mut inputs: Vec<Arc<dyn Distribution>>,
    unexplained: Option<f64>,
) -> (Surrogate, Vec<Arc<dyn Distribution>>) {
    let mut surrogate = own.without_rounding();
    let least = IDLE * surrogate.parts.iter().flatten().map(|part| part.largest().powi(2)).sum::<f64>();
    let normal = Normal::new(0.0, 1.0).ok();
    if let (Some(variance), Some(normal)) = (unexplained.filter(|&variance| variance > least), normal) {
        inputs.push(Arc::new(normal));
        surrogate.parts.push(Some(Univariate::of_coefficients(&[variance.sqrt()])));
        surrogate.interactions = Interactions::of_pairs(inputs.len(), surrogate.interactions.pairs());
    }
    (surrogate, inputs)
}

/// Density at places from one far quantile to the other, `[y, density, error]`. Returns None if the values are steps, or if points are
/// drawn of which none can be integrated.
fn density(law: &SurfaceLaw, quantiles: Option<&[LawFigure; 7]>) -> Option<Vec<[f64; 3]>> {
    if law.is_step_function() {
        return None;
    }
    let sampled = law.branch() == Branch::Sampled;
    let places = if sampled { FEW_PLACES } else { PLACES };
    let [from, to] = match quantiles.filter(|_| sampled) {
        // Extends the range by half: for a normal distribution from 3 to 4.5 sigma.
        Some(all) => {
            let [low, middle, high] = OUTER.map(|index| all[index].value);
            let [least, most] = law.range();
            [(low + 0.5 * (low - middle)).max(least), (high + 0.5 * (high - middle)).min(most)]
        }
        None => [LawTail::Lower, LawTail::Upper].map(|tail| law.quantile(tail, DRAWN).value),
    };
    let place = |i: usize| from + (to - from) * i as f64 / places as f64;
    let at = |i: usize| {
        let figure = law.drawn_density(place(i));
        [place(i), figure.value, figure.error]
    };
    let table: Vec<[f64; 3]> = (0..=places).map(at).collect();
    // A density may be infinite at an end of its support.
    (from < to && table.iter().all(|[_, density, _]| *density >= 0.0)).then_some(table)
}

/// All quantiles of reports. The search starts at those of the Pearson fit, or of a normal distribution if there is no fit. Returns None if
/// one of them is unknown.
fn quantiles(law: &SurfaceLaw, fit: Option<&Law>) -> Option<[LawFigure; 7]> {
    let found = law.quantiles(&sought(law, fit, &REPORTED_QUANTILES));
    let known = found.iter().all(|figure| figure.value.is_finite());
    found.try_into().ok().filter(|_| known)
}

/// Quantile of a Pearson distribution at a tail.
pub(in crate::analysis) fn of_pearson(fit: &Pearson, (tail, p): (LawTail, f64)) -> f64 {
    match tail {
        LawTail::Lower => fit.quantile(p),
        LawTail::Upper => fit.upper_quantile(p),
    }
}

fn sought(law: &SurfaceLaw, fit: Option<&Law>, of: &[(LawTail, f64)]) -> Vec<Sought> {
    let normal = || Pearson::normal(law.mean(), law.sigma()).ok();
    let start = match fit {
        Some(Law::Pearson(fit)) => Some(fit.as_ref().clone()),
        _ => normal(),
    };
    let one = |&(tail, p): &(LawTail, f64)| {
        let near = start.as_ref().map(|fit| of_pearson(fit, (tail, p)));
        let density = start.as_ref().zip(near).map_or(f64::NAN, |(fit, near)| fit.pdf(near));
        Sought { tail, p, near: near.unwrap_or(f64::NAN), density }
    };
    of.iter().map(one).collect()
}
