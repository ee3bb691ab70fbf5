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

use crate::allocation::optimise::root::root;
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::law::{LawTail, SurfaceLaw, TailChoices};
use sensitol_numeric::moments::Moments;

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
/// Most steps to bracket the root.
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
    pub(in crate::allocation) room: &'r dyn Fn(&Moments) -> Option<f64>,
    /// Derivatives of the logarithm of the slack by mean, skewness and excess.
    pub(in crate::allocation) room_slopes: &'r dyn Fn(&Moments) -> Option<[f64; 3]>,
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

    /// Computes the correction at a linearization point. Returns None if the mean lies beyond a limit, or the
    /// distribution has no value.
    pub(in crate::allocation) fn of(about: &About<'_>, rejected: f64) -> Option<Self> {
        let About { law, limits, room, .. } = *about;
        let n = about.dimensions;
        let ones = vec![1.0; n];
        let moments = (about.moments)(&ones)?;
        let (mean, sigma) = (moments.mean(), moments.sigma());
        let sides: Vec<(LawTail, f64, TailChoices)> = [
            (LawTail::Lower, limits.lower().map(|lower| lower - mean)),
            (LawTail::Upper, limits.upper().map(|upper| upper - mean)),
        ]
        .into_iter()
        .filter_map(|(tail, distance)| Some((tail, distance?, law.hold(mean + distance?, tail))))
        .collect();
        let outside = |(tail, distance, _): &(LawTail, f64, TailChoices)| match tail {
            LawTail::Lower => *distance >= 0.0,
            LawTail::Upper => *distance <= 0.0,
        };
        if sides.is_empty() || sides.iter().any(outside) || sigma <= 0.0 {
            return None;
        }
        let beyond = |law: &SurfaceLaw, mean: f64, r: f64| -> f64 {
            sides.iter().map(|(_, distance, held)| held.tail(law, mean + r * distance).value).sum()
        };
        let fitted = room(&moments)?;
        let r = level(&|r| beyond(law, mean, r), rejected, sigma / fitted)?;
        // d R/d ln r: the density at both moved limits times their move.
        let density: f64 =
            sides.iter().map(|(_, distance, _)| -law.density(mean + r * distance).value * r * distance.abs()).sum();
        let mut slopes: Vec<f64> = vec![0.0; n];
        let own: Vec<Option<Vec<f64>>> = (sides.iter())
            .map(|(tail, distance, _)| {
                let found = law.tail_derivatives(mean + r * distance, *tail)?;
                Some(found.iter().map(|figure| figure.value).collect())
            })
            .collect();
        let partial = about.slopes.as_ref().and_then(|_| (about.room_slopes)(&moments));
        let moving = about.varying.iter().enumerate().filter(|(_, (_, follows))| *follows != Follows::Still);
        for (position, &(d, follows)) in moving {
            // With exact slopes of the moments no difference is needed: the derivatives of the distribution minus those
            // of the moments.
            if let (Some(all), Some(partial)) = (&about.slopes, partial) {
                let [by_mean, by_sigma, by_skewness, by_excess] = all[d];
                let by_law = sides.iter().zip(&own).map(|((tail, distance, _), own)| {
                    let sign = if *tail == LawTail::Lower { 1.0 } else { -1.0 };
                    let moved = sign * law.density(mean + r * distance).value * (1.0 - r) * by_mean;
                    Some(own.as_ref()?.get(position)? + moved)
                });
                let by_law: Option<f64> = by_law.sum();
                if let Some(by_law) = by_law.filter(|slope| slope.is_finite() && density < 0.0) {
                    let by_room = partial[0] * by_mean + partial[1] * by_skewness + partial[2] * by_excess;
                    slopes[d] = by_sigma + by_law / density - by_room;
                    continue;
                }
            }
            let mut trial = ones.clone();
            let mut at = |step: f64| {
                trial[d] = libm::exp(step);
                let moments = (about.moments)(&trial)?;
                let room = room(&moments)?;
                Some((moments, room, trial.clone()))
            };
            let (Some((up, room_up, more)), Some((down, room_down, less))) = (at(STEP), at(-STEP)) else { continue };
            let slope = |up: f64, down: f64| (up - down) / (2.0 * STEP);
            let by_mean = slope(up.mean(), down.mean());
            let exact = (follows == Follows::Similar).then(|| {
                let each = sides.iter().zip(&own).map(|((tail, distance, _), own)| {
                    // The limit moves with the mean, outward or inward.
                    let sign = if *tail == LawTail::Lower { 1.0 } else { -1.0 };
                    let moved = sign * law.density(mean + r * distance).value * (1.0 - r) * by_mean;
                    let own = own.as_ref()?.get(position)?;
                    Some(own + moved)
                });
                each.sum::<Option<f64>>()
            });
            let by_law: Option<f64> = exact.flatten().filter(|slope: &f64| slope.is_finite()).or_else(|| {
                let (more, less) = ((about.law_at)(&more)?, (about.law_at)(&less)?);
                // The distance of a limit from the mean changes with the mean.
                let at = |law: &SurfaceLaw, mean_here: f64| -> f64 {
                    let moved = mean_here - mean;
                    sides
                        .iter()
                        .map(|(_, distance, held)| held.tail(law, mean_here + r * (distance - moved)).value)
                        .sum()
                };
                Some(slope(at(&more, up.mean()), at(&less, down.mean())))
            });
            let Some(by_law) = by_law.filter(|_| density < 0.0) else { continue };
            let by_sigma = slope(libm::log(up.sigma()), libm::log(down.sigma()));
            // ln s = ln sigma - ln r, and r responds to a change of the share at fixed r.
            slopes[d] = by_sigma + by_law / density - slope(libm::log(room_up), libm::log(room_down));
        }
        let ln = libm::log(sigma / r / fitted);
        (ln.is_finite() && slopes.iter().all(|slope: &f64| slope.is_finite())).then_some(Self { ln, slopes })
    }
}

/// Argument near `start` at which a decreasing share equals `rejected`.
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
