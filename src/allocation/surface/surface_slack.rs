//! Correction of the slack for a required yield, by the surface distribution and the interval of the yield.
//!
//! Trial tolerances are judged by four moments, which is fast but only an approximation. At a linearization point the
//! exact slack is known. It is the largest sigma at which the surface distribution, with its mean and shape, leaves
//! just the allowed share beyond the limits.
//!
//! ```text
//! R(r)     = P(y < m + r (L - m)) + P(y > m + r (U - m))          limits moved to r times their distance from the mean m
//! s_law    = sigma/r with R(r) = q                                 q: allowed reject rate, minus the uncertainty
//! ln kappa = ln(s_law/s_Pearson) + sum_j g_j ln(T_j/T_j0)          g_j: how both change with a tolerance
//! ```
//!
//! `kappa s_Pearson` has the value and the slopes of the surface distribution at the linearization point. The rounds
//! therefore converge to an optimum by that distribution. The slopes of its tails come from the distribution itself
//! ([`SurfaceLaw::tail_derivatives`]). If a shape changes otherwise with its tolerance, they come from differences
//! along held contours. Source: N. M. Alexandrov, R. M. Lewis, "An overview of first-order model management for
//! engineering optimization", Optimization and Engineering 2 (2001).

use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::law::{LawTail, SurfaceLaw, TailChoices};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::optimise::root::root;

/// Least part of the allowed rejects that remains after the uncertainty is subtracted. A greater uncertainty cannot be
/// met.
const LEFT: f64 = 0.1;
/// Greatest distance from the linearization point, in `ln T`, at which a slope is followed.
const FAR: f64 = 0.7;
/// Step in `ln T` of differences along held contours. Its truncation is 1e-8, and so is the rounding of a distribution
/// known to 1e-12.
const STEP: f64 = 1e-4;
/// Relative accuracy of a root of the share.
const NEAR: f64 = 1e-13;
/// Greatest number of steps to bracket the root.
const STEPS: usize = 60;

/// Change of a varying dimension with its tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::allocation) enum Follows {
    /// Same shape about the same mean.
    Similar,
    /// Change of mean or shape.
    Otherwise,
    /// No change, or no effect on the characteristic.
    Still,
}

/// Characteristic about a linearization point, as a function of the factors of all tolerances.
pub(in crate::allocation) struct About<'r> {
    pub(in crate::allocation) law: &'r SurfaceLaw,
    pub(in crate::allocation) limits: SpecLimits,
    pub(in crate::allocation) dimensions: usize,
    /// Varying dimensions, in the order of the surface's parts.
    pub(in crate::allocation) varying: Vec<(usize, Follows)>,
    pub(in crate::allocation) moments: &'r dyn Fn(&[f64]) -> Option<Moments>,
    pub(in crate::allocation) law_at: &'r dyn Fn(&[f64]) -> Option<SurfaceLaw>,
    /// Slack by four moments.
    pub(in crate::allocation) slack: &'r dyn Fn(&Moments) -> Option<f64>,
    /// Derivatives of the logarithm of the slack by mean, skewness and excess.
    pub(in crate::allocation) slack_slopes: &'r dyn Fn(&Moments) -> Option<[f64; 3]>,
    /// Exact derivatives of mean, `ln sigma`, skewness and excess by `ln T` of every dimension. They exist only if
    /// every shape stays.
    pub(in crate::allocation) slopes: Option<Vec<[f64; 4]>>,
}

/// Ratio of the slack by the surface distribution to the slack by four moments.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::allocation) struct Correction {
    /// Value of `ln kappa` at the linearization point.
    ln: f64,
    /// Slopes of `ln kappa` by `ln T` of every dimension.
    slopes: Vec<f64>,
}

impl Correction {
    /// Correction without effect.
    pub(in crate::allocation) fn none(dimensions: usize) -> Self {
        Self { ln: 0.0, slopes: vec![0.0; dimensions] }
    }

    /// Allowed reject rate after the uncertainty `reach` of the yield is subtracted.
    pub(in crate::allocation) fn allowed(required: f64, reach: f64) -> f64 {
        let rejected = 1.0 - required;
        (rejected - reach).max(LEFT * rejected)
    }

    /// Factor of the slack by four moments at these factors of the tolerances.
    pub(in crate::allocation) fn factor(&self, factors: &[f64]) -> f64 {
        let along = |(slope, factor): (&f64, &f64)| match *slope {
            0.0 => 0.0,
            slope => slope * libm::log(*factor).clamp(-FAR, FAR),
        };
        libm::exp(self.ln + self.slopes.iter().zip(factors).map(along).sum::<f64>())
    }

    /// Slope of the logarithm of the factor by `ln T` of a dimension.
    pub(in crate::allocation) fn slope(&self, dimension: usize, factors: &[f64]) -> f64 {
        if libm::log(factors[dimension]).abs() < FAR { self.slopes[dimension] } else { 0.0 }
    }

    /// Correction at a linearization point. Returns None if the mean lies beyond a limit, or the distribution has no tail there.
    pub(super) fn of(about: &About<'_>, rejected: f64) -> Option<Self> {
        let moments = (about.moments)(&vec![1.0; about.dimensions])?;
        let (mean, sigma) = (moments.mean(), moments.sigma());
        let sides = Side::all(about, mean);
        if sides.is_empty() || sides.iter().any(Side::is_beyond_mean) || sigma <= 0.0 {
            return None;
        }
        let fitted = (about.slack)(&moments)?;
        let r = level(&|r| share_beyond(&sides, about.law, mean, (r, 0.0)), rejected, sigma / fitted)?;
        let moved = MovedLimits::new(about, mean, r, sides);
        let partial = about.slopes.as_ref().and_then(|_| (about.slack_slopes)(&moments));
        let mut slopes: Vec<f64> = vec![0.0; about.dimensions];
        let moving = about.varying.iter().enumerate().filter(|(_, (_, follows))| *follows != Follows::Still);
        for (position, &(d, follows)) in moving {
            let exact = partial.and_then(|partial| moved.exact_slope(position, d, partial));
            if let Some(slope) = exact.or_else(|| moved.slope_by_differences(position, d, follows)) {
                slopes[d] = slope;
            }
        }
        let ln = libm::log(sigma / r / fitted);
        (ln.is_finite() && slopes.iter().all(|slope: &f64| slope.is_finite())).then_some(Self { ln, slopes })
    }
}

/// A limit with the contour of the law beyond it.
struct Side {
    tail: LawTail,
    /// Distance from the mean, negative below it.
    distance: f64,
    held: TailChoices,
}

impl Side {
    /// The limits that a characteristic has.
    fn all(about: &About<'_>, mean: f64) -> Vec<Self> {
        [
            (LawTail::Lower, about.limits.lower().map(|lower| lower - mean)),
            (LawTail::Upper, about.limits.upper().map(|upper| upper - mean)),
        ]
        .into_iter()
        .filter_map(|(tail, distance)| {
            Some(Self { tail, distance: distance?, held: about.law.hold(mean + distance?, tail) })
        })
        .collect()
    }

    /// Returns true if the mean is at the limit or beyond it.
    fn is_beyond_mean(&self) -> bool {
        match self.tail {
            LawTail::Lower => self.distance >= 0.0,
            LawTail::Upper => self.distance <= 0.0,
        }
    }
}

/// `R(r)` by a distribution about `mean`. The limits are nearer to the mean by `shift` than at the linearization point.
fn share_beyond(sides: &[Side], law: &SurfaceLaw, mean: f64, (r, shift): (f64, f64)) -> f64 {
    sides.iter().map(|side| side.held.tail(law, mean + r * (side.distance - shift)).value).sum()
}

/// Distribution at a linearization point. Its limits are moved to `r` times their distance from the mean, so that it rejects just the
/// allowed share.
struct MovedLimits<'a, 'r> {
    about: &'a About<'r>,
    mean: f64,
    r: f64,
    sides: Vec<Side>,
    /// Slopes of the share beyond each limit by `ln T` of the varying dimensions about their means.
    tails: Vec<Option<Vec<f64>>>,
    /// `d R/d ln r`: the density at both moved limits by how they move.
    density: f64,
}

impl<'a, 'r> MovedLimits<'a, 'r> {
    /// Asks the law for its density and slopes at the moved limits.
    fn new(about: &'a About<'r>, mean: f64, r: f64, sides: Vec<Side>) -> Self {
        let law = about.law;
        let density: f64 = (sides.iter())
            .map(|Side { distance, .. }| -law.density(mean + r * distance).value * r * distance.abs())
            .sum();
        let tails = (sides.iter())
            .map(|Side { tail, distance, .. }| {
                let found = law.tail_derivatives(mean + r * distance, *tail)?;
                Some(found.iter().map(|figure| figure.value).collect())
            })
            .collect();
        Self { about, mean, r, sides, tails, density }
    }

    /// The slope of the share by `ln T` of a dimension that keeps its shape while the mean grows by `by_mean`.
    fn share_slope(&self, position: usize, by_mean: f64) -> Option<f64> {
        let each = self.sides.iter().zip(&self.tails).map(|(side, own)| {
            // The limit moves with the mean, outward or inward.
            let sign = if side.tail == LawTail::Lower { 1.0 } else { -1.0 };
            let density = self.about.law.density(self.mean + self.r * side.distance).value;
            let moved = sign * density * (1.0 - self.r) * by_mean;
            Some(own.as_ref()?.get(position)? + moved)
        });
        each.sum::<Option<f64>>().filter(|slope| slope.is_finite())
    }

    /// The derivatives by the law itself, less those by the moments, without a difference where their slopes are exact.
    fn exact_slope(&self, position: usize, d: usize, partial: [f64; 3]) -> Option<f64> {
        let [by_mean, by_sigma, by_skewness, by_excess] = self.about.slopes.as_ref()?[d];
        let by_law = self.share_slope(position, by_mean).filter(|_| self.density < 0.0)?;
        let by_slack = partial[0] * by_mean + partial[1] * by_skewness + partial[2] * by_excess;
        Some(by_sigma + by_law / self.density - by_slack)
    }

    /// The slope by differences of the moments, and of the law where the dimension does not keep its shape.
    fn slope_by_differences(&self, position: usize, d: usize, follows: Follows) -> Option<f64> {
        let (up, down) = (self.neighbour(d, STEP)?, self.neighbour(d, -STEP)?);
        let by_mean = central(up.moments.mean(), down.moments.mean());
        let exact = (follows == Follows::Similar).then(|| self.share_slope(position, by_mean)).flatten();
        let by_law = exact.or_else(|| {
            let (more, less) = ((self.about.law_at)(&up.factors)?, (self.about.law_at)(&down.factors)?);
            Some(central(self.share_at(&more, up.moments.mean()), self.share_at(&less, down.moments.mean())))
        });
        let by_law = by_law.filter(|_| self.density < 0.0)?;
        let by_sigma = central(libm::log(up.moments.sigma()), libm::log(down.moments.sigma()));
        // ln s = ln sigma - ln r, and r answers a change of the share at fixed r.
        Some(by_sigma + by_law / self.density - central(libm::log(up.slack), libm::log(down.slack)))
    }

    /// The moments and their slack with the tolerance of one dimension changed by a step of `ln T`.
    fn neighbour(&self, d: usize, step: f64) -> Option<Neighbour> {
        let mut factors = vec![1.0; self.about.dimensions];
        factors[d] = libm::exp(step);
        let moments = (self.about.moments)(&factors)?;
        Some(Neighbour { moments, slack: (self.about.slack)(&moments)?, factors })
    }

    /// The share beyond the limits by another law. The distance of a limit from the mean changes with the mean.
    fn share_at(&self, law: &SurfaceLaw, mean: f64) -> f64 {
        share_beyond(&self.sides, law, mean, (self.r, mean - self.mean))
    }
}

/// Linearization point beside another one.
struct Neighbour {
    moments: Moments,
    slack: f64,
    factors: Vec<f64>,
}

/// The slope between values that are two [steps](STEP) apart.
fn central(up: f64, down: f64) -> f64 {
    (up - down) / (2.0 * STEP)
}

/// Root at which a decreasing share is `rejected`, near `start`.
fn level(share: &dyn Fn(f64) -> f64, rejected: f64, start: f64) -> Option<f64> {
    let gap = |ln: f64| libm::log(share(libm::exp(ln)).max(f64::MIN_POSITIVE) / rejected);
    let (mut low, mut high) = (libm::log(start), libm::log(start));
    let (mut at_low, mut at_high) = (gap(low), gap(low));
    for _ in 0..STEPS {
        match (at_low >= 0.0, at_high <= 0.0) {
            (true, true) => break,
            (false, _) => (low, at_low) = (low - 0.1, gap(low - 0.1)),
            (_, false) => (high, at_high) = (high + 0.1, gap(high + 0.1)),
        }
    }
    if !(at_low >= 0.0 && at_high <= 0.0) {
        return None;
    }
    Some(libm::exp(root(|ln| -gap(ln), [low, high], NEAR)))
}
