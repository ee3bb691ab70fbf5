//! Share of assemblies that break a limit of some characteristics, as a function of the tolerances.
//!
//! ```text
//! R(T) = 1 - exp(-kappa(T) L(T)),   L = -sum_c ln(1 - R_c(T)),   ln kappa = ln kappa_0 + sum_j g_j ln(T_j/T_j0)
//! ```
//!
//! `R_c` is the share that the Pearson fit of the four moments at `T` rejects, mixed with a little of the share of a
//! normal distribution. Small shares add up, and large ones never exceed 1. `kappa` gives value and slopes of the
//! surface distributions at the linearization point, minus the share that breaks several limits at once. The rounds
//! therefore converge to an optimum by these distributions. Source: N. M. Alexandrov, R. M. Lewis, Optimization and
//! Engineering 2 (2001).
//!
//! Slopes come from those of the moments. With `z` the limits in sigmas off the mean and `p` the density of the fit at
//! them:
//!
//! ```text
//! dR/d mean = p_above - p_below     dR/d ln sigma = sigma (z_above p_above - z_below p_below)     by skewness and excess: Pearson's equation
//! ```

use std::sync::{Arc, PoisonError};

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::surface::reject_fit::RejectFit;
use crate::allocation::surface::response::Responses;
use sensitol_numeric::capability::Law;
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::distribution::standard_normal;
use sensitol_numeric::law::{LawTail, SurfaceLaw, TailChoices, rejected};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::parallel::prelude::*;

/// Greatest distance from the linearization point, in `ln T`, at which a slope is followed.
const FAR: f64 = 0.7;
/// Half of the difference of tails in `ln T`, along held contours. Truncation and rounding are 1e-8.
const STEP: f64 = 1e-4;
/// Half of the difference in `ln T` for the share that breaks several limits, if that share is exact.
const NARROW: f64 = 1e-3;
/// Error of that share up to which it is exact. A share counted by points is instead taken to grow as the rejects do.
const EXACT: f64 = 1e-12;
/// Part of the rejects that breaks several limits, up to which its slope is left out.
const FEW: f64 = 1e-6;
/// Greatest number of dimensions for these differences, which would otherwise take too long.
const MANY: usize = 60;
/// Least share that is distinguished from 0.
const LEAST: f64 = 1e-300;

impl RejectFit {
    /// Joint rejects of these characteristics at a linearization point.
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
        let (truth, fit) = ((tails - twice).min(1.0 - f64::EPSILON), self.share(responses, &ones, None)?);
        if truth <= LEAST {
            return Some(Self { nothing: true, ..self.clone() });
        }
        let mut by = vec![0.0; n];
        for &(c, limits) in &self.of {
            let of = responses.tail_slopes(c, limits)?;
            by.iter_mut().zip(of).for_each(|(by, of)| *by += of);
        }
        let varying = responses.varying();
        if of_twice.error > EXACT {
            // Differences of a counted share would have a larger error than the slopes themselves.
            by.iter_mut().for_each(|by| *by *= truth / tails);
        } else if twice > FEW * truth && varying.len() <= MANY {
            let of_twice = varying.par_iter().map(|&d| self.slope_of_twice(responses, d).unwrap_or(0.0));
            varying.iter().zip(of_twice.collect::<Vec<f64>>()).for_each(|(&d, of)| by[d] -= of);
        }
        let each: Vec<Priced> = varying.iter().map(|&d| Priced::without_cost(d)).collect();
        let of_fit = self.with_slopes(responses, &each, &ones).map(|(share, slopes)| {
            slopes.into_iter().map(|slope| slope * ln_hazard_slope(share)).collect::<Vec<f64>>()
        });
        let mut slopes = vec![0.0; n];
        for (place, &d) in varying.iter().enumerate() {
            let mut factors = ones.clone();
            let mut ln = |step: f64| {
                factors[d] = libm::exp(step);
                Some(ln_hazard(self.share(responses, &factors, None)?))
            };
            let own = match &of_fit {
                Some(of_fit) => of_fit[place],
                None => (ln(STEP)? - ln(-STEP)?) / (2.0 * STEP),
            };
            slopes[d] = by[d] * ln_hazard_slope(truth) - own;
        }
        let ln = ln_hazard(truth) - ln_hazard(fit);
        (ln.is_finite() && slopes.iter().all(|slope| slope.is_finite())).then(|| Self { ln, slopes, ..self.clone() })
    }

    /// Derivative of the share that breaks several limits by `ln T` of a dimension.
    fn slope_of_twice(&self, responses: &Responses, d: usize) -> Option<f64> {
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
        Some((twice(NARROW)? - twice(-NARROW)?) / (2.0 * NARROW))
    }

    /// Share at factors of all tolerances, and its derivatives by `ln T` of every group. Returns None if differences
    /// are needed.
    pub(in crate::allocation) fn with_slopes(
        &self,
        responses: &Responses,
        priced: &[Priced],
        factors: &[f64],
    ) -> Option<(f64, Vec<f64>)> {
        if self.nothing && factors.iter().all(|&factor| factor == 1.0) {
            return None;
        }
        let of = |&(c, limits): &(usize, SpecLimits)| -> Option<(f64, Vec<f64>)> {
            let (share, partial) = fitted_with_slopes(&responses.moments(c, factors)?, limits)?;
            let by_group = responses.moment_slopes(c, priced, factors)?;
            let along = |by: [f64; 4]| partial.iter().zip(by).map(|(partial, by)| partial * by).sum();
            Some((share, by_group.into_iter().map(along).collect()))
        };
        let each = self.of.par_iter().map(of).collect::<Option<Vec<(f64, Vec<f64>)>>>()?;
        let (mut all, mut slopes) = (0.0, vec![0.0; priced.len()]);
        for (share, own) in each {
            all += hazard(share);
            slopes.iter_mut().zip(own).for_each(|(slope, own)| *slope += own / (1.0 - share));
        }
        let correction = libm::exp(self.ln_correction(factors));
        let kept = libm::exp(-correction * all);
        for (slope, group) in slopes.iter_mut().zip(priced) {
            let own = group.members.iter().filter(|&&d| libm::log(factors[d]).abs() < FAR).map(|&d| self.slopes[d]);
            *slope = kept * correction * (*slope + all * own.sum::<f64>());
        }
        // If nothing is kept, differences give no slope either.
        let known = kept == 0.0 || slopes.iter().all(|slope| slope.is_finite());
        known.then_some((-libm::expm1(-correction * all), slopes))
    }

    /// Logarithm of the correction `kappa` at these factors.
    fn ln_correction(&self, factors: &[f64]) -> f64 {
        let along = |(slope, factor): (&f64, &f64)| match *slope {
            0.0 => 0.0,
            slope => slope * libm::log(*factor).clamp(-FAR, FAR),
        };
        self.ln + self.slopes.iter().zip(factors).map(along).sum::<f64>()
    }

    /// Share at factors of all tolerances, with nominals moved by `shifts`, in sigmas.
    pub(in crate::allocation) fn share(
        &self,
        responses: &Responses,
        factors: &[f64],
        shifts: Option<&[f64]>,
    ) -> Option<f64> {
        if self.nothing && shifts.is_none() && factors.iter().all(|&factor| factor == 1.0) {
            return Some(0.0);
        }
        let of = |&(c, limits): &(usize, SpecLimits)| fitted(&responses.moments_shifted(c, factors, shifts)?, limits);
        let all: f64 = self.of.par_iter().map(of).collect::<Option<Vec<f64>>>()?.into_iter().map(hazard).sum();
        Some(-libm::expm1(-libm::exp(self.ln_correction(factors)) * all))
    }
}

/// Hazard `-ln(1 - R)`, which adds up for independent rejects.
fn hazard(share: f64) -> f64 {
    // Clamp shares that rounding lifts above 1.
    -libm::log1p(-share.min(1.0))
}

fn ln_hazard(share: f64) -> f64 {
    libm::log(hazard(share).max(LEAST))
}

/// Derivative of [`ln_hazard`] by the share.
fn ln_hazard_slope(share: f64) -> f64 {
    1.0 / ((1.0 - share) * hazard(share).max(LEAST))
}

/// Weight of a normal distribution in the rejects. A bounded fit alone may reject nothing and have no slope.
const LITTLE: f64 = 1e-4;

/// Share rejected by the Pearson fit, with a little of that by a normal distribution.
fn fitted(moments: &Moments, limits: SpecLimits) -> Option<f64> {
    rejected_by(&Law::fit(moments).ok()?, moments, limits)
}

fn rejected_by(law: &Law, moments: &Moments, limits: SpecLimits) -> Option<f64> {
    if !limits.exist() {
        return None;
    }
    let below = limits.lower().map_or(0.0, |lower| law.below(lower));
    let fit = (below + limits.upper().map_or(0.0, |upper| law.above(upper))).min(1.0);
    let score = |distance: f64| standard_normal::sf(distance / moments.sigma());
    let sides =
        [limits.lower().map(|lower| moments.mean() - lower), limits.upper().map(|upper| upper - moments.mean())];
    let normal: f64 = sides.into_iter().flatten().map(score).filter(|share| share.is_finite()).sum();
    Some((1.0 - LITTLE) * fit + LITTLE * normal)
}

/// Rejected share with its derivatives by mean, `ln sigma`, skewness and excess. Returns None if the density ends too
/// abruptly for formulas.
fn fitted_with_slopes(moments: &Moments, limits: SpecLimits) -> Option<(f64, [f64; 4])> {
    let Ok(Law::Pearson(law)) = Law::fit(moments) else { return None };
    let (mean, sigma) = (moments.mean(), moments.sigma());
    let [by_skewness, by_excess] =
        law.outside_by_shape(limits.lower(), limits.upper())?.map(|slope| (1.0 - LITTLE) * slope);
    let mut slopes = [0.0, 0.0, by_skewness, by_excess];
    let sides = [(limits.lower(), -1.0), (limits.upper(), 1.0)];
    for (limit, sign) in sides.into_iter().filter_map(|(limit, sign)| Some((limit?, sign))) {
        let z = (limit - mean) / sigma;
        let fit = (1.0 - LITTLE) * law.pdf(limit);
        let density = sign * (fit + LITTLE * standard_normal::density(z) / sigma);
        slopes[0] += density;
        slopes[1] += density * (limit - mean);
    }
    let share = rejected_by(&Law::Pearson(law), moments, limits)?;
    slopes.iter().all(|slope| slope.is_finite()).then_some((share, slopes))
}

/// Distance of the share from the allowed one as the ratio of the normal scores `b = -Phi^-1(R)`. It is at most 1 if
/// the share is allowed, and nearly proportional to the tolerances. Below a score of a half it continues as its
/// tangent.
pub(in crate::allocation) fn of_scores(share: f64, allowed: f64) -> f64 {
    of_scores_with_slope(share, allowed)[0]
}

/// Ratio of the normal scores with its derivative by the share.
pub(in crate::allocation) fn of_scores_with_slope(share: f64, allowed: f64) -> [f64; 2] {
    /// Score below which the tangent continues the ratio: a score of 0 would be a pole.
    const LOW: f64 = 0.5;
    let wanted = standard_normal::upper_quantile(allowed);
    if wanted <= LOW {
        // If more than a third may be rejected, the shares themselves are compared.
        return [share / allowed, 1.0 / allowed];
    }
    if share <= LEAST {
        return [0.0, 0.0];
    }
    let score = standard_normal::upper_quantile(share.min(1.0 - f64::EPSILON));
    // The derivative of a score by the share is minus one over the density.
    let density = standard_normal::density(score);
    match score >= LOW {
        true => [wanted / score, wanted / (score * score * density)],
        false => [wanted / LOW * (1.0 + (LOW - score) / LOW), wanted / (LOW * LOW * density)],
    }
}

impl Responses {
    /// Joint rejects of these characteristics, as a function of the tolerances.
    pub(in crate::allocation) fn rejects(&self, of: &[usize]) -> Arc<RejectFit> {
        let known = || self.reject_fits.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(of) {
            return Arc::clone(found);
        }
        let found = Arc::new(RejectFit::at(self, of.iter().map(|&c| (c, self.of[c].limits)).collect()));
        known().insert(of.to_vec(), Arc::clone(&found));
        found
    }

    /// Derivatives of the share beyond the limits of a characteristic by `ln T` of every dimension, by its surface
    /// distribution at the linearization point.
    fn tail_slopes(&self, c: usize, limits: SpecLimits) -> Option<Vec<f64>> {
        let law = self.law(c)?;
        let mut slopes = vec![0.0; self.dimensions.len()];
        let sides = [(LawTail::Lower, limits.lower()), (LawTail::Upper, limits.upper())];
        for (tail, limit) in sides.into_iter().filter_map(|(tail, limit)| Some((tail, limit?))) {
            let own = law.tail_derivatives(limit, tail);
            let held: TailChoices = law.hold(limit, tail);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Differences of the share itself. A tail of a distribution is known to 1e-12 of the share. The differences, with
    /// steps of 1e-4, are therefore off by 1e-8, and their truncation is as large.
    #[test]
    fn slopes_are_the_differences_of_the_share() {
        let share = |[mean, ln, skewness, excess]: [f64; 4], limits: SpecLimits| {
            fitted_with_slopes(&Moments::new(mean, libm::exp(ln), skewness, excess), limits).unwrap()
        };
        let both = [[Some(-3.0), Some(3.5)], [Some(-3.0), None], [None, Some(3.5)], [Some(-1.0), Some(0.5)]];
        for place in [[0.1, 0.1, 0.2, 0.3], [-0.2, -0.2, -0.4, 0.5], [0.0, 0.0, 0.1, -0.3], [0.05, 0.2, 0.6, 0.55]] {
            for [lower, upper] in both {
                let limits = SpecLimits::new(lower, upper).unwrap();
                let (value, slopes) = share(place, limits);
                for (index, found) in slopes.into_iter().enumerate() {
                    let at = |step: f64| {
                        let mut place = place;
                        place[index] += step;
                        share(place, limits).0
                    };
                    let expected = (at(1e-4) - at(-1e-4)) / 2e-4;
                    assert!(
                        (found - expected).abs() <= 1e-6 * value.max(0.01),
                        "{place:?}, {limits:?}, {index}: {found}, {expected}"
                    );
                }
            }
        }
    }

    /// Small shares add up, and large ones combine as for independent characteristics: of 0.6, 0.7 and 0.2 all but 0.4
    /// x 0.3 x 0.8. The slope is that of a difference.
    #[test]
    fn rejects_are_never_more_than_all() {
        let together = |shares: &[f64]| -libm::expm1(-shares.iter().copied().map(hazard).sum::<f64>());
        assert!((together(&[0.6, 0.7, 0.2]) - 0.904).abs() < 1e-15);
        assert!((together(&[1e-12, 2e-12]) / 3e-12 - 1.0).abs() < 1e-11);
        assert_eq!((together(&[1.0, 0.5]), together(&[1.0f64.next_up()]), together(&[0.0, 0.0])), (1.0, 1.0, 0.0));
        for share in [1e-9, 0.0027, 0.3, 0.9] {
            let step = 1e-6 * share;
            let expected = (ln_hazard(share + step) - ln_hazard(share - step)) / (2.0 * step);
            let found = ln_hazard_slope(share);
            assert!((found - expected).abs() < 1e-8 * found, "{share}: {found}, {expected}");
        }
    }

    /// Differences on either side of the score at which the tangent begins, and for compared shares.
    #[test]
    fn scores_have_the_slopes_of_their_differences() {
        for (share, allowed) in [(1e-6, 0.0027), (0.0027, 0.0027), (0.1, 0.01), (0.45, 0.01), (0.2, 0.4)] {
            let [value, found] = of_scores_with_slope(share, allowed);
            let step = 1e-5 * share;
            let expected = (of_scores(share + step, allowed) - of_scores(share - step, allowed)) / (2.0 * step);
            assert!(
                (found - expected).abs() <= 1e-8 * (value / share).abs(),
                "{share}, {allowed}: {found}, {expected}"
            );
        }
    }
}
