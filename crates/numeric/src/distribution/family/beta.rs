//! Beta distribution over a band.

use std::sync::Arc;

use rand::{Rng, RngExt};

use crate::pearson::Pearson;

use crate::distribution::ends::End;
use crate::distribution::probability::checked;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, between, finite, interval, positive,
};

/// Beta distribution over an interval, with density `t^(alpha-1) (1-t)^(beta-1)` at the fraction `t` of the interval.
///
/// ```
/// use sensitol_numeric::distribution::{Beta, Distribution};
/// let slot = Beta::new(0.0, 7.0, 2.0, 5.0)?;
/// assert_eq!(slot.mean(), 2.0);
/// assert!((slot.sigma().powi(2) - 49.0 * 10.0 / (49.0 * 8.0)).abs() < 1e-15);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Beta {
    middle: f64,
    half: f64,
    alpha: f64,
    beta: f64,
    /// Distribution of the standardised variable.
    law: Pearson,
    /// Series next to the two ends; None if an exponent is too large for one.
    ends: [Option<End>; 2],
}

/// Range of the shape parameters. Beyond it the distribution cannot be distinguished from two atoms or from a normal distribution.
const RANGE: [f64; 2] = [1e-3, 1e9];
const RANGE_WORDS: &str = "from 0.001 to 1e9";

impl Beta {
    /// Distribution between `lower` and `upper`, with exponents from 0.001 to 1e9.
    pub fn new(lower: f64, upper: f64, alpha: f64, beta: f64) -> Result<Self, DistributionError> {
        let [middle, half] = interval(lower, upper)?;
        Self::about(middle, half, alpha, beta)
    }

    /// Distribution from `middle - half` to `middle + half`.
    pub fn about(middle: f64, half: f64, alpha: f64, beta: f64) -> Result<Self, DistributionError> {
        let (middle, half) = (finite("the middle", middle)?, positive("the half width", half)?);
        let alpha = between("alpha", alpha, RANGE, RANGE_WORDS)?;
        let beta = between("beta", beta, RANGE, RANGE_WORDS)?;
        let moments = standard_moments(alpha, beta);
        let law = Pearson::with_excess(0.0, 1.0, moments.skewness, moments.excess)
            .map_err(|error| DistributionError::NoLaw { reason: error.to_string() })?;
        let ends = [End::of_beta(alpha, beta), End::of_beta(beta, alpha)];
        Ok(Self { middle, half, alpha, beta, law, ends })
    }

    /// Mean and sigma on the interval from 0 to 1.
    fn unit(&self) -> [f64; 2] {
        let n = self.alpha + self.beta;
        [self.alpha / n, (self.alpha / n * (self.beta / n) / (n + 1.0)).sqrt()]
    }

    fn width(&self) -> f64 {
        2.0 * self.half
    }

    /// Deviation from the mean in sigmas.
    fn u(&self, x: f64) -> f64 {
        (x - self.mean()) / self.sigma()
    }

    /// Fractions of the interval below and above `x`.
    fn shares(&self, x: f64) -> [f64; 2] {
        let off = x - self.middle;
        [self.half + off, self.half - off].map(|distance| (distance / self.width()).clamp(0.0, 1.0))
    }

    /// Probabilities below and above `x`.
    fn masses(&self, x: f64) -> [f64; 2] {
        let [low, high] = self.shares(x);
        if let Some(below) = self.ends[0].and_then(|end| end.mass(low)) {
            return [below, 1.0 - below];
        }
        if let Some(above) = self.ends[1].and_then(|end| end.mass(high)) {
            return [1.0 - above, above];
        }
        let u = self.u(x);
        [self.law.cdf(u), self.law.sf(u)]
    }

    /// Value with these probabilities below and above it. `between` gives its deviation in sigmas where neither end has a series.
    fn inverse(&self, [below, above]: [f64; 2], between: impl Fn() -> f64) -> f64 {
        let [lower, upper] = self.support();
        if let Some(share) = self.ends[0].and_then(|end| end.quantile(below)) {
            return lower + self.width() * share;
        }
        if let Some(share) = self.ends[1].and_then(|end| end.quantile(above)) {
            return upper - self.width() * share;
        }
        (self.mean() + self.sigma() * between()).clamp(lower, upper)
    }
}

/// `c1 = (beta - alpha)/sqrt(alpha beta (n+1))` and `c2 = -1/(n+1)` with `n = alpha + beta`.
fn standard_moments(alpha: f64, beta: f64) -> StandardMoments {
    let n = alpha + beta;
    let c1 = (beta - alpha) / (alpha.sqrt() * beta.sqrt() * (n + 1.0).sqrt());
    StandardMoments::of_pearson(c1, -1.0 / (n + 1.0))
}

impl Distribution for Beta {
    fn name(&self) -> &'static str {
        "beta"
    }

    fn mean(&self) -> f64 {
        let (alpha, beta) = (self.alpha, self.beta);
        self.middle + self.half * ((alpha - beta) / (alpha + beta))
    }

    fn sigma(&self) -> f64 {
        self.width() * self.unit()[1]
    }

    fn standard_moments(&self) -> StandardMoments {
        standard_moments(self.alpha, self.beta)
    }

    fn support(&self) -> [f64; 2] {
        [self.middle - self.half, self.middle + self.half]
    }

    /// Coefficients of Jacobi polynomials, with the differences from the mean carried out:
    /// `alpha[k] = 2 k (k+n-1) (beta - alpha) / (sigma n (2k+n-2)(2k+n))`,
    /// `beta[k] = k (k+alpha-1)(k+beta-1)(k+n-2) / (sigma^2 (2k+n-2)^2 (2k+n-1)(2k+n-3))`, sigma on an interval of 1.
    fn jacobi(&self, order: usize) -> Jacobi {
        let (a, b, n, [_, sigma]) = (self.alpha, self.beta, self.alpha + self.beta, self.unit());
        let alpha = |k: usize| {
            let k = k as f64;
            2.0 * k * (k + n - 1.0) * (b - a) / (sigma * n * (2.0 * k + n - 2.0) * (2.0 * k + n))
        };
        let beta = |k: usize| {
            let k = k as f64;
            let twice = 2.0 * k + n - 2.0;
            k / twice * ((k + a - 1.0) / twice) * ((k + b - 1.0) / (twice + 1.0)) * ((k + n - 2.0) / (twice - 1.0))
                / (sigma * sigma)
        };
        // The first coefficients are those of every standardised variable. The formulas would give 0/0 for n = 1 and 2.
        let alphas = (0..order).map(|k| if k == 0 { 0.0 } else { alpha(k) });
        let betas = (1..=order).map(|k| if k == 1 { 1.0 } else { beta(k) });
        Jacobi::new(alphas.collect(), betas.collect())
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::about(self.middle + moved, self.half * factor, self.alpha, self.beta);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Beta {
    fn density(&self, x: f64) -> Option<f64> {
        let [low, high] = self.shares(x);
        if (x - self.middle).abs() > self.half {
            return Some(0.0);
        }
        let (a, b) = (self.alpha, self.beta);
        let factor = self.ends.iter().flatten().map(End::log_density_factor).next();
        let Some(log_factor) = factor else { return Some(self.law.pdf(self.u(x)) / self.sigma()) };
        // The smaller fraction has all its digits, and the larger one is its complement.
        let [log_low, log_high] = match low < high {
            true => [libm::log(low), libm::log1p(-low)],
            false => [libm::log1p(-high), libm::log(high)],
        };
        // At an end the power of 0 is infinite, 1 or 0.
        let power = |log: f64, exponent: f64| if exponent == 0.0 { 0.0 } else { exponent * log };
        Some(libm::exp(log_factor + power(log_low, a - 1.0) + power(log_high, b - 1.0)) / self.width())
    }

    fn cdf(&self, x: f64) -> f64 {
        if x.is_nan() { x } else { self.masses(x)[0] }
    }

    fn sf(&self, x: f64) -> f64 {
        if x.is_nan() { x } else { self.masses(x)[1] }
    }

    fn quantile(&self, p: f64) -> f64 {
        if checked(p).is_nan() { f64::NAN } else { self.inverse([p, 1.0 - p], || self.law.quantile(p)) }
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        if checked(p).is_nan() { f64::NAN } else { self.inverse([1.0 - p, p], || self.law.upper_quantile(p)) }
    }

    /// Random values by the rejection methods of Cheng (1978), from `rand_distr`.
    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        let law = rand_distr::Beta::new(self.alpha, self.beta).expect("exponents within a range of their own");
        let [lower, upper] = self.support();
        out.iter_mut().for_each(|value| *value = (lower + self.width() * rng.sample(law)).clamp(lower, upper));
    }
}
