//! The share of assemblies that break a limit of some characteristics, as a function of the tolerances.
//!
//! ```text
//! R(T) = 1 - exp(-kappa(T) L(T)),   L = -sum_c ln(1 - R_c(T)),   ln kappa = ln kappa_0 + sum_j g_j ln(T_j/T_j0)
//! ```
//!
//! `R_c` is what the Pearson fit of the four moments at `T` rejects, and a little of what a normal distribution would; few rejects add up, and
//! many are never more than all. `kappa` makes value and slopes at the station those of the surface laws, less what breaks several limits at
//! once, so that what the rounds come to rest at is by the laws. Source: N. M. Alexandrov, R. M. Lewis, Optimization and Engineering 2 (2001).
//!
//! Slopes go by the moments. With `z` the limits in sigmas off the mean and `p` the density of the fit at them:
//!
//! ```text
//! dR/d mean = p_above - p_below     dR/d ln sigma = sigma (z_above p_above - z_below p_below)     by skewness and excess: Pearson's equation
//! ```

use std::sync::{Arc, PoisonError};

use super::cost::Priced;
use super::reject_fit::RejectFit;
use super::response::Responses;
use sensitol_numeric::capability::Law;
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::distribution::standard_normal;
use sensitol_numeric::law::{HeldTail, LawTail, SurfaceLaw, rejected};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::parallel::prelude::*;

/// Farther than this from the station, in `ln T`, a slope is not followed.
const FAR: f64 = 0.7;
/// Half a difference of tails in `ln T`, along held contours: truncation and rounding 1e-8.
const STEP: f64 = 1e-4;
/// Half a difference of what breaks several limits, where that is exact to a part of all; where points count it, it is taken to grow as the rejects do.
const NARROW: f64 = 1e-3;
const EXACT: f64 = 1e-12;
/// A part of the rejects that breaks several limits and whose slope is left out.
const FEW: f64 = 1e-6;
/// Dimensions beyond which those differences take too long.
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
            // Differences of what points count would be larger than the slopes themselves.
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

    /// How what breaks several limits grows with `ln T` of a dimension.
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

    /// The share at factors of all tolerances, and how it grows with `ln T` of every group; None where that takes differences.
    pub(super) fn with_slopes(
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
        // Where nothing is kept no difference knows more.
        let known = kept == 0.0 || slopes.iter().all(|slope| slope.is_finite());
        known.then_some((-libm::expm1(-correction * all), slopes))
    }

    /// `ln kappa`.
    fn ln_correction(&self, factors: &[f64]) -> f64 {
        let along = |(slope, factor): (&f64, &f64)| match *slope {
            0.0 => 0.0,
            slope => slope * libm::log(*factor).clamp(-FAR, FAR),
        };
        self.ln + self.slopes.iter().zip(factors).map(along).sum::<f64>()
    }

    /// The share at factors of all tolerances, with nominals moved by `shifts`, in sigmas.
    pub(super) fn share(&self, responses: &Responses, factors: &[f64], shifts: Option<&[f64]>) -> Option<f64> {
        if self.nothing && shifts.is_none() && factors.iter().all(|&factor| factor == 1.0) {
            return Some(0.0);
        }
        let of = |&(c, limits): &(usize, SpecLimits)| fitted(&responses.moments_shifted(c, factors, shifts)?, limits);
        let all: f64 = self.of.par_iter().map(of).collect::<Option<Vec<f64>>>()?.into_iter().map(hazard).sum();
        Some(-libm::expm1(-libm::exp(self.ln_correction(factors)) * all))
    }
}

/// `-ln(1 - R)`: what adds up of rejects that know nothing of each other.
fn hazard(share: f64) -> f64 {
    // A sum of parts may round to more than all.
    -libm::log1p(-share.min(1.0))
}

fn ln_hazard(share: f64) -> f64 {
    libm::log(hazard(share).max(LEAST))
}

/// Its derivative by the share.
fn ln_hazard_slope(share: f64) -> f64 {
    1.0 / ((1.0 - share) * hazard(share).max(LEAST))
}

/// A normal distribution has a little part in the rejects: a fit with ends may reject nothing, and have no slope.
const LITTLE: f64 = 1e-4;

/// The rejects by the Pearson fit, and a little of those by a normal distribution.
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

/// The same with its derivatives by mean, `ln sigma`, skewness and excess; None where the density ends too abruptly for formulas.
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

/// How far the share is from what may be rejected, as the ratio of the normal scores `b = -Phi^-1(R)`: kept where it is at most 1, and nearly
/// in proportion to the tolerances. Below a score of a half its tangent goes on.
pub(super) fn of_scores(share: f64, allowed: f64) -> f64 {
    of_scores_with_slope(share, allowed)[0]
}

/// The same with its derivative by the share.
pub(super) fn of_scores_with_slope(share: f64, allowed: f64) -> [f64; 2] {
    const LOW: f64 = 0.5;
    let wanted = standard_normal::upper_quantile(allowed);
    if wanted <= LOW {
        // More than a third may be rejected: the shares themselves.
        return [share / allowed, 1.0 / allowed];
    }
    if share <= LEAST {
        return [0.0, 0.0];
    }
    let score = standard_normal::upper_quantile(share.min(1.0 - f64::EPSILON));
    // By the share a score falls by one over the density.
    let density = standard_normal::density(score);
    match score >= LOW {
        true => [wanted / score, wanted / (score * score * density)],
        false => [wanted / LOW * (1.0 + (LOW - score) / LOW), wanted / (LOW * LOW * density)],
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Differences of the share itself. A tail of a law is known to 1e-12, by whose part of the share the differences, of 1e-4, are off by 1e-8; their truncation is as much.
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

    /// Few rejects add up, and many are what independent characteristics reject together: of 0.6, 0.7 and 0.2 all but 0.4 x 0.3 x 0.8. The slope is a
    /// difference's.
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

    /// Differences again, on either side of the score below which the tangent goes on, and where shares themselves are compared.
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
