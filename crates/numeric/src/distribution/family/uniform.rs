//! Uniform distribution.

use std::sync::Arc;

use rand::Rng;

use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, interval, positive,
    probability, ziggurat,
};

/// Uniform distribution between two limits.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Uniform};
/// let angle = Uniform::new(16.0, 18.0)?;
/// assert_eq!(angle.mean(), 17.0);
/// assert!((angle.sigma() - 1.0 / 3f64.sqrt()).abs() < 1e-15);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Uniform {
    mean: f64,
    half: f64,
}

impl Uniform {
    /// Distribution between `lower` and `upper`. `lower` must be below `upper`.
    pub fn new(lower: f64, upper: f64) -> Result<Self, DistributionError> {
        let [middle, half] = interval(lower, upper)?;
        Self::about(middle, half)
    }

    /// Distribution from `mean - half` to `mean + half`. `half` must be above 0.
    pub fn about(mean: f64, half: f64) -> Result<Self, DistributionError> {
        Ok(Self { mean: finite("the middle", mean)?, half: positive("the half width", half)? })
    }
}

impl Distribution for Uniform {
    fn name(&self) -> &'static str {
        "uniform"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.half / 3f64.sqrt()
    }

    /// Even moments are `3^(r/2)/(r+1)`: 9/5, 27/7 and 9. The other fields follow from them as fractions.
    fn standard_moments(&self) -> StandardMoments {
        StandardMoments {
            skewness: 0.0,
            excess: -6.0 / 5.0,
            m5: 0.0,
            m6: 27.0 / 7.0,
            m7: 0.0,
            m8: 9.0,
            h6: 16.0 / 35.0,
            h7: 0.0,
            h8: -96.0 / 175.0,
        }
    }

    fn support(&self) -> [f64; 2] {
        [self.mean - self.half, self.mean + self.half]
    }

    /// Coefficients `3 n^2/(4 n^2 - 1)` of Legendre polynomials on `-sqrt 3 ..= sqrt 3`.
    fn jacobi(&self, order: usize) -> Jacobi {
        let beta = (1..=order).map(|n| (n * n) as f64 * 3.0 / (4 * n * n - 1) as f64).collect();
        Jacobi::new(vec![0.0; order], beta)
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        Some(Self::about(self.mean + moved, self.half * factor).map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Uniform {
    fn density(&self, x: f64) -> Option<f64> {
        Some(if (x - self.mean).abs() <= self.half { 0.5 / self.half } else { 0.0 })
    }

    fn cdf(&self, x: f64) -> f64 {
        probability::clamped(0.5 * ((x - self.mean) / self.half + 1.0))
    }

    fn sf(&self, x: f64) -> f64 {
        probability::clamped(0.5 * (1.0 - (x - self.mean) / self.half))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.mean + self.half * (2.0 * probability::checked(p) - 1.0)
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.mean + self.half * (1.0 - 2.0 * probability::checked(p))
    }

    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        ziggurat::uniforms(rng, (self.mean, self.half), out);
    }
}
