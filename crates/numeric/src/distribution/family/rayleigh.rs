//! Rayleigh distribution.

use std::f64::consts::PI;

use crate::distribution::family::one_sided::above_origin;
use crate::distribution::{Distribution, DistributionError, Jacobi, Probability, StandardMoments, Weibull};

/// Rayleigh distribution from an origin on: the length of a vector with two equal normal components, such as the offset of two axes. Its
/// sigma is `sqrt(4/pi - 1)` times the distance of the mean from the origin.
///
/// It is the Weibull distribution of shape 2. It does not scale with a tolerance, because its mean fixes it.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Rayleigh};
/// let offset = Rayleigh::new(0.0, 1.0)?;
/// assert!((offset.sigma() - (4.0 / std::f64::consts::PI - 1.0).sqrt()).abs() < 1e-15);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Rayleigh {
    law: Weibull,
    sigma: f64,
}

impl Rayleigh {
    /// Distribution from `origin` on. `mean` must lie above `origin`.
    pub fn new(origin: f64, mean: f64) -> Result<Self, DistributionError> {
        let sigma = above_origin(origin, mean)? * (4.0 / PI - 1.0).sqrt();
        Ok(Self { law: Weibull::with_shape(origin, mean, 2.0)?, sigma })
    }
}

impl Distribution for Rayleigh {
    fn name(&self) -> &'static str {
        "rayleigh"
    }

    fn mean(&self) -> f64 {
        self.law.mean()
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    fn standard_moments(&self) -> StandardMoments {
        self.law.standard_moments()
    }

    fn support(&self) -> [f64; 2] {
        self.law.support()
    }

    /// Coefficients up to order 16.
    fn jacobi(&self, order: usize) -> Jacobi {
        self.law.jacobi(order)
    }

    fn probability(&self) -> Option<&dyn Probability> {
        self.law.probability()
    }
}
