//! The share of assemblies that break a limit of some characteristics, as a function of the tolerances.
//!
//! ```text
//! R(T) = kappa(T) sum_c R_c(T),   ln kappa = ln kappa_0 + sum_j g_j ln(T_j/T_j0)
//! ```
//!
//! `R_c` is what the Pearson fit of the four moments at `T` rejects, and a little of what a normal distribution would. `kappa` makes value and slopes at the station those of the surface laws,
//! less what breaks several limits at once, so that what the rounds come to rest at is by the laws. Source: N. M. Alexandrov, R. M. Lewis,
//! Optimization and Engineering 2 (2001).

use std::sync::{Arc, PoisonError};

use super::reject_fit::RejectFit;
use super::response::Responses;
use crate::capability::{Capability, Law};
use crate::characteristic::SpecLimits;
use crate::distribution::standard_normal;
use crate::law::{HeldTail, LawTail, SurfaceLaw, rejected};
use crate::moments::Moments;

/// Farther than this from the station, in `ln T`, a slope is not followed.
const FAR: f64 = 0.7;
/// Half a difference of tails in `ln T`, along held contours: truncation and rounding 1e-8.
const STEP: f64 = 1e-4;
/// Half a difference of what breaks several limits, which points may count, or is exact to a part of all.
const WIDE: f64 = 0.05;
const NARROW: f64 = 1e-3;
const EXACT: f64 = 1e-12;
/// A part of the rejects that breaks several limits and whose slope is left out.
const FEW: f64 = 1e-6;
/// Dimensions beyond which the slopes of what breaks several limits take too long.
const MANY: usize = 60;
/// Less is rejected by nothing that doubles tell.
const LEAST: f64 = 1e-300;

impl RejectFit {
    /// Of these characteristics at a station.
    fn at(responses: &Responses, of: Vec<(usize, SpecLimits)>) -> Self {
        let slopes = vec![0.0; responses.dimensions.len()];
        let fitted = Self { of, ln: 0.0, nothing: false, slopes };
        fitted.corrected(responses).unwrap_or(fitted)
    }

    fn corrected(&self, responses: &Responses) -> Option<Self> {
        let n = responses.dimensions.len();
        let ones = vec![1.0; n];
        let laws: Vec<(&SurfaceLaw, SpecLimits)> =
            self.of.iter().map(|&(c, limits)| Some((responses.law(c)?, limits))).collect::<Option<_>>()?;
        let (tails, of_twice) = rejected(&laws);
        let twice = of_twice.value;
        let (truth, fit) = (tails - twice, self.share(responses, &ones, None)?);
        if truth <= LEAST {
            return Some(Self { nothing: true, ..self.clone() });
        }
        let mut by = vec![0.0; n];
        for &(c, limits) in &self.of {
            let of = responses.tail_slopes(c, limits)?;
            by.iter_mut().zip(of).for_each(|(by, of)| *by += of);
        }
        if twice > FEW * truth && responses.varying().len() <= MANY {
            for &d in responses.varying() {
                let step = if of_twice.error <= EXACT { NARROW } else { WIDE };
                by[d] -= self.slope_of_twice(responses, d, step).unwrap_or(0.0);
            }
        }
        let mut slopes = vec![0.0; n];
        for &d in responses.varying() {
            let mut factors = ones.clone();
            let mut ln = |step: f64| {
                factors[d] = libm::exp(step);
                Some(libm::log(self.share(responses, &factors, None)?.max(LEAST)))
            };
            slopes[d] = by[d] / truth - (ln(STEP)? - ln(-STEP)?) / (2.0 * STEP);
        }
        let ln = libm::log(truth / fit);
        (ln.is_finite() && slopes.iter().all(|slope| slope.is_finite())).then(|| Self { ln, slopes, ..self.clone() })
    }

    /// How what breaks several limits grows with `ln T` of a dimension.
    fn slope_of_twice(&self, responses: &Responses, d: usize, half: f64) -> Option<f64> {
        let twice = |step: f64| {
            let mut factors = vec![1.0; responses.dimensions.len()];
            factors[d] = libm::exp(step);
            let laws: Vec<(SurfaceLaw, SpecLimits)> = self
                .of
                .iter()
                .map(|&(c, limits)| Some((responses.law_at(c, &factors)?, limits)))
                .collect::<Option<_>>()?;
            let laws: Vec<(&SurfaceLaw, SpecLimits)> = laws.iter().map(|(law, limits)| (law, *limits)).collect();
            Some(rejected(&laws).1.value)
        };
        Some((twice(half)? - twice(-half)?) / (2.0 * half))
    }

    /// The share at factors of all tolerances, with nominals moved by `shifts`, in sigmas.
    pub(super) fn share(&self, responses: &Responses, factors: &[f64], shifts: Option<&[f64]>) -> Option<f64> {
        if self.nothing && shifts.is_none() && factors.iter().all(|&factor| factor == 1.0) {
            return Some(0.0);
        }
        let along = |(slope, factor): (&f64, &f64)| match *slope {
            0.0 => 0.0,
            slope => slope * libm::log(*factor).clamp(-FAR, FAR),
        };
        let ln = self.ln + self.slopes.iter().zip(factors).map(along).sum::<f64>();
        let mut all = 0.0;
        for &(c, limits) in &self.of {
            all += fitted(&responses.moments_shifted(c, factors, shifts)?, limits)?;
        }
        Some((all * libm::exp(ln)).min(1.0))
    }
}

/// The rejects by the Pearson fit, and a little of those by a normal distribution: a fit with ends may reject nothing, and have
/// no slope.
fn fitted(moments: &Moments, limits: SpecLimits) -> Option<f64> {
    const LITTLE: f64 = 1e-4;
    let law = Law::fit(moments).ok()?;
    let fit = Capability::of(&law, moments.mean(), moments.sigma(), limits).rejected()?;
    let score = |distance: f64| standard_normal::sf(distance / moments.sigma());
    let sides =
        [limits.lower().map(|lower| moments.mean() - lower), limits.upper().map(|upper| upper - moments.mean())];
    let normal: f64 = sides.into_iter().flatten().map(score).filter(|share| share.is_finite()).sum();
    Some(fit + LITTLE * normal)
}

/// How far the share is from what may be rejected, as the ratio of the normal scores `b = -Phi^-1(R)`: kept where it is at most 1, and nearly
/// in proportion to the tolerances. Below a score of a half its tangent goes on.
pub(super) fn of_scores(share: f64, allowed: f64) -> f64 {
    const LOW: f64 = 0.5;
    let wanted = standard_normal::upper_quantile(allowed);
    if wanted <= LOW {
        // More than a third may be rejected: the shares themselves.
        return share / allowed;
    }
    if share <= LEAST {
        return 0.0;
    }
    let score = standard_normal::upper_quantile(share.min(1.0 - f64::EPSILON));
    if score >= LOW { wanted / score } else { wanted / LOW * (1.0 + (LOW - score) / LOW) }
}

impl Responses {
    /// The joint rejects of these characteristics, as a function of the tolerances.
    pub(super) fn rejects(&self, of: &[usize]) -> Arc<RejectFit> {
        let known = || self.reject_fits.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(of) {
            return Arc::clone(found);
        }
        let found = Arc::new(RejectFit::at(self, of.iter().map(|&c| (c, self.of[c].limits)).collect()));
        known().insert(of.to_vec(), Arc::clone(&found));
        found
    }

    /// How what lies beyond the limits of a characteristic grows with `ln T` of every dimension, by its law at the station.
    fn tail_slopes(&self, c: usize, limits: SpecLimits) -> Option<Vec<f64>> {
        let law = self.law(c)?;
        let mut slopes = vec![0.0; self.dimensions.len()];
        let sides = [(LawTail::Lower, limits.lower()), (LawTail::Upper, limits.upper())];
        for (tail, limit) in sides.into_iter().filter_map(|(tail, limit)| Some((tail, limit?))) {
            let own = law.tail_derivatives(limit, tail);
            let held: HeldTail = law.hold(limit, tail);
            for (position, &d) in self.varying().iter().enumerate() {
                let exact = own.as_ref().filter(|_| self.keeps_mean_and_shape(position));
                let exact = exact.and_then(|own| own.get(position)).map(|figure| figure.value);
                slopes[d] += match exact.filter(|slope| slope.is_finite()) {
                    Some(slope) => slope,
                    None => {
                        let mut factors = vec![1.0; slopes.len()];
                        let mut at = |step: f64| {
                            factors[d] = libm::exp(step);
                            Some(held.tail(&self.law_at(c, &factors)?, limit).value)
                        };
                        (at(STEP)? - at(-STEP)?) / (2.0 * STEP)
                    }
                };
            }
        }
        Some(slopes)
    }
}
