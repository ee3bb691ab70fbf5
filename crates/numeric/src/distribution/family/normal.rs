//! Normal distribution.

use std::sync::Arc;

use rand::Rng;

use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, positive, standard_normal,
    ziggurat,
};

/// Normal distribution with given mean and sigma.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Normal};
/// let bore = Normal::new(25.0, 0.01)?;
/// assert_eq!(bore.standard_moments().m6, 15.0);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normal {
    mean: f64,
    sigma: f64,
}

impl Normal {
    /// Name in study files.
    pub const NAME: &'static str = "normal";

    /// Distribution with this mean and sigma. `sigma` must be above 0.
    pub fn new(mean: f64, sigma: f64) -> Result<Self, DistributionError> {
        Ok(Self { mean: finite("mean", mean)?, sigma: positive("sigma", sigma)? })
    }
}

impl Distribution for Normal {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    fn standard_moments(&self) -> StandardMoments {
        StandardMoments::NORMAL
    }

    fn support(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// Coefficients of Hermite polynomials: `He[n+1] = u He[n] - n He[n-1]`.
    fn jacobi(&self, order: usize) -> Jacobi {
        Jacobi::new(vec![0.0; order], (1..=order).map(|n| n as f64).collect())
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        Some(Self::new(self.mean + moved, self.sigma * factor).map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Normal {
    fn z(&self, x: f64) -> f64 {
        (x - self.mean) / self.sigma
    }
}

impl Probability for Normal {
    fn density(&self, x: f64) -> Option<f64> {
        Some(standard_normal::density(self.z(x)) / self.sigma)
    }

    fn cdf(&self, x: f64) -> f64 {
        standard_normal::cdf(self.z(x))
    }

    fn sf(&self, x: f64) -> f64 {
        standard_normal::sf(self.z(x))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.mean + self.sigma * standard_normal::quantile(p)
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.mean + self.sigma * standard_normal::upper_quantile(p)
    }

    fn quantiles(&self, tails: &mut [f64]) {
        standard_normal::quantiles_about((self.mean, self.sigma), tails);
    }

    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        ziggurat::normals(rng, (self.mean, self.sigma), out);
    }
}
