//! Exponential distribution.

use crate::distribution::family::one_sided::above_origin;
use crate::distribution::probability::checked;
use crate::distribution::{Distribution, DistributionError, Jacobi, Probability, StandardMoments};

/// Exponential distribution from an origin on. Its sigma is the distance of the mean from the origin.
///
/// It does not scale with a tolerance, because its mean fixes it.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Exponential};
/// let film = Exponential::new(0.0, 0.5)?;
/// assert_eq!((film.sigma(), film.standard_moments().excess), (0.5, 6.0));
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponential {
    origin: f64,
    mean: f64,
    sigma: f64,
}

impl Exponential {
    /// Distribution from `origin` on. `mean` must lie above `origin`.
    pub fn new(origin: f64, mean: f64) -> Result<Self, DistributionError> {
        Ok(Self { origin, mean, sigma: above_origin(origin, mean)? })
    }

    /// Distance from the origin in sigmas, 0 below the origin.
    fn t(&self, x: f64) -> f64 {
        let t = (x - self.origin) / self.sigma;
        if t < 0.0 { 0.0 } else { t }
    }

    fn x(&self, t: f64) -> f64 {
        self.origin + self.sigma * t
    }
}

impl Distribution for Exponential {
    fn name(&self) -> &'static str {
        "exponential"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Moments from the cumulants `(n-1)!`.
    fn standard_moments(&self) -> StandardMoments {
        StandardMoments::from_cumulants([2.0, 6.0, 24.0, 120.0, 720.0, 5040.0])
    }

    fn support(&self) -> [f64; 2] {
        [self.origin, f64::INFINITY]
    }

    /// Coefficients `2 n` and `n^2` of Laguerre polynomials.
    fn jacobi(&self, order: usize) -> Jacobi {
        Jacobi::new((0..order).map(|n| 2.0 * n as f64).collect(), (1..=order).map(|n| (n * n) as f64).collect())
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Exponential {
    fn density(&self, x: f64) -> Option<f64> {
        Some(if x < self.origin { 0.0 } else { libm::exp(-self.t(x)) / self.sigma })
    }

    fn cdf(&self, x: f64) -> f64 {
        -libm::expm1(-self.t(x))
    }

    fn sf(&self, x: f64) -> f64 {
        libm::exp(-self.t(x))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.x(-libm::log1p(-checked(p)))
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.x(-libm::log(checked(p)))
    }
}
