//! Gamma distribution.

use std::sync::Arc;

use rand::{Rng, RngExt};

use crate::pearson::Pearson;

use crate::distribution::ends::End;
use crate::distribution::family::one_sided::ratio;
use crate::distribution::probability::checked;
use crate::distribution::{Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments};

/// Gamma distribution from an origin on, with given mean and sigma.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Gamma};
/// let wear = Gamma::new(0.0, 2.0, 1.0)?; // shape 4, scale 1/2
/// assert_eq!(wear.standard_moments().skewness, 1.0); // 2 by the root of the shape
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Gamma {
    origin: f64,
    mean: f64,
    sigma: f64,
    shape: f64,
    scale: f64,
    /// Distribution of the standardised variable.
    law: Pearson,
    /// Series next to the origin; None if the shape is too large for one.
    end: Option<End>,
}

/// Largest ratio of sigma to the distance of the mean from the origin.
const LARGEST: f64 = 30.0;

impl Gamma {
    /// Distribution from `origin` on. `mean` must lie above `origin`, and `sigma` be at most 30 times that distance. The shape is the
    /// square of the distance over sigma.
    pub fn new(origin: f64, mean: f64, sigma: f64) -> Result<Self, DistributionError> {
        let [_, ratio] = ratio(origin, mean, sigma, LARGEST)?;
        let shape = 1.0 / (ratio * ratio);
        let law = Pearson::with_excess(0.0, 1.0, 2.0 * ratio, 6.0 * ratio * ratio)
            .map_err(|error| DistributionError::NoLaw { reason: error.to_string() })?;
        Ok(Self { origin, mean, sigma, shape, scale: sigma * ratio, law, end: End::of_gamma(shape) })
    }

    /// Ratio of sigma to the distance of the mean from the origin.
    fn ratio(&self) -> f64 {
        self.scale / self.sigma
    }

    fn t(&self, x: f64) -> f64 {
        let t = (x - self.origin) / self.scale;
        if t < 0.0 { 0.0 } else { t }
    }

    fn u(&self, x: f64) -> f64 {
        (x - self.mean) / self.sigma
    }

    fn inverse(&self, below: f64, law: f64) -> f64 {
        match self.end.and_then(|end| end.quantile(below)) {
            Some(t) => self.origin + self.scale * t,
            None => (self.mean + self.sigma * law).max(self.origin),
        }
    }
}

impl Distribution for Gamma {
    fn name(&self) -> &'static str {
        "gamma"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Moments from the cumulants `(n-1)! shape^(1-n/2)`.
    fn standard_moments(&self) -> StandardMoments {
        let r = self.ratio();
        let cumulant = |(factorial, power): (f64, i32)| factorial * r.powi(power);
        StandardMoments::from_cumulants(
            [(2.0, 1), (6.0, 2), (24.0, 3), (120.0, 4), (720.0, 5), (5040.0, 6)].map(cumulant),
        )
    }

    fn support(&self) -> [f64; 2] {
        [self.origin, f64::INFINITY]
    }

    /// Coefficients of Laguerre polynomials: `alpha[n] = 2 n r` and `beta[n] = n (1 + (n-1) r^2)` with `r^2` one over the shape.
    fn jacobi(&self, order: usize) -> Jacobi {
        let r = self.ratio();
        let alpha = (0..order).map(|n| 2.0 * n as f64 * r).collect();
        let beta = (1..=order).map(|n| n as f64 * (1.0 + (n - 1) as f64 * r * r)).collect();
        Jacobi::new(alpha, beta)
    }

    /// Copy with sigma scaled. Mean and origin stay, so the shape changes.
    fn scaled(&self, factor: f64, _: f64) -> Option<Scaled> {
        Some(Self::new(self.origin, self.mean, self.sigma * factor).map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Gamma {
    fn density(&self, x: f64) -> Option<f64> {
        if x < self.origin {
            return Some(0.0);
        }
        if self.end.is_none() {
            return Some(self.law.pdf(self.u(x)) / self.sigma);
        }
        let (t, power) = (self.t(x), self.shape - 1.0);
        let log = if power == 0.0 { 0.0 } else { power * libm::log(t) };
        Some(libm::exp(log - t - libm::lgamma(self.shape)) / self.scale)
    }

    fn cdf(&self, x: f64) -> f64 {
        if x.is_nan() {
            return x;
        }
        self.end.and_then(|end| end.mass(self.t(x))).unwrap_or_else(|| self.law.cdf(self.u(x)))
    }

    fn sf(&self, x: f64) -> f64 {
        if x.is_nan() {
            return x;
        }
        let below = self.end.and_then(|end| end.mass(self.t(x)));
        below.map_or_else(|| self.law.sf(self.u(x)), |below| 1.0 - below)
    }

    fn quantile(&self, p: f64) -> f64 {
        if checked(p).is_nan() { f64::NAN } else { self.inverse(p, self.law.quantile(p)) }
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        if checked(p).is_nan() { f64::NAN } else { self.inverse(1.0 - p, self.law.upper_quantile(p)) }
    }

    /// Random values by the rejection method of Marsaglia and Tsang (2000), from `rand_distr`.
    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        let law = rand_distr::Gamma::new(self.shape, self.scale).expect("a positive shape and scale");
        out.iter_mut().for_each(|value| *value = self.origin + rng.sample(law));
    }
}
