//! U-shaped distribution.

use std::sync::Arc;

use crate::distribution::family::discretised::{Discretised, legendre};
use crate::distribution::probability::checked;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, interval, positive,
};

/// U-shaped distribution over an interval. The density grows with the square of the distance from the middle, `3 y^2/2` over the interval
/// from -1 to 1. Its sigma is `sqrt(3/5)` times the half-width.
///
/// It describes values that stay near either end, such as a size that is reworked until it just fits.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, UShaped};
/// let reworked = UShaped::new(9.0, 11.0)?;
/// assert!((reworked.sigma() - 0.6f64.sqrt()).abs() < 1e-15);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UShaped {
    middle: f64,
    half: f64,
}

impl UShaped {
    /// Distribution between `lower` and `upper`.
    pub fn new(lower: f64, upper: f64) -> Result<Self, DistributionError> {
        let [middle, half] = interval(lower, upper)?;
        Self::about(middle, half)
    }

    /// Distribution from `middle - half` to `middle + half`.
    pub fn about(middle: f64, half: f64) -> Result<Self, DistributionError> {
        Ok(Self { middle: finite("the middle", middle)?, half: positive("the half width", half)? })
    }

    /// Probability above `y` in the interval from -1 to 1, with the digits of its distance from the end.
    fn above(y: f64) -> f64 {
        let y = y.clamp(-1.0, 1.0);
        0.5 * (1.0 - y) * (1.0 + y + y * y)
    }

    fn y(&self, x: f64) -> f64 {
        (x - self.middle) / self.half
    }
}

impl Distribution for UShaped {
    fn name(&self) -> &'static str {
        "u-shaped"
    }

    fn mean(&self) -> f64 {
        self.middle
    }

    fn sigma(&self) -> f64 {
        self.half * 0.6f64.sqrt()
    }

    /// Moments from the even ones over the interval from -1 to 1, which are `3/(n + 3)`.
    fn standard_moments(&self) -> StandardMoments {
        let even = |order: i32| 3.0 / f64::from(order + 3) / 0.6f64.powi(order / 2);
        StandardMoments::with_excess(0.0, -38.0 / 21.0, [0.0, even(6), 0.0, even(8)])
    }

    fn support(&self) -> [f64; 2] {
        [self.middle - self.half, self.middle + self.half]
    }

    /// Coefficients from Gauss-Legendre, which is exact.
    fn jacobi(&self, order: usize) -> Jacobi {
        let mut pieces = Discretised::default();
        // An even number of nodes, because a node at the middle would have no weight.
        pieces.piece([-1.0, 1.0], &legendre(2 * order.div_ceil(2) + 2), |y| 1.5 * y * y);
        pieces.standardise();
        pieces.symmetric_jacobi(order)
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::about(self.middle + moved, self.half * factor);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for UShaped {
    fn density(&self, x: f64) -> Option<f64> {
        let y = self.y(x);
        Some(if y.abs() > 1.0 { 0.0 } else { 1.5 * y * y / self.half })
    }

    fn cdf(&self, x: f64) -> f64 {
        Self::above(-self.y(x))
    }

    fn sf(&self, x: f64) -> f64 {
        Self::above(self.y(x))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.middle + self.half * libm::cbrt(2.0 * checked(p) - 1.0)
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.middle + self.half * libm::cbrt(1.0 - 2.0 * checked(p))
    }
}
