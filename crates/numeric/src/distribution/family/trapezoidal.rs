//! Symmetric trapezoidal distribution.

use std::sync::Arc;

use crate::distribution::family::discretised::{Discretised, legendre};
use crate::distribution::probability::checked;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, between, finite, interval, positive,
};

/// Trapezoidal distribution over an interval: flat over its middle part, falling in straight lines to both ends. It is the sum of two
/// uniform variables.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Trapezoidal, Uniform};
/// let flat = Trapezoidal::new(16.0, 18.0, 1.0)?;
/// assert!((flat.sigma() - Uniform::new(16.0, 18.0)?.sigma()).abs() < 1e-15);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trapezoidal {
    middle: f64,
    half: f64,
    top: f64,
}

impl Trapezoidal {
    /// Distribution between `lower` and `upper`. `top` is the fraction of the interval over which the density is flat: 0 for a triangle, 1
    /// for a uniform distribution.
    pub fn new(lower: f64, upper: f64, top: f64) -> Result<Self, DistributionError> {
        let [middle, half] = interval(lower, upper)?;
        Self::about(middle, half, top)
    }

    /// Distribution from `middle - half` to `middle + half`.
    pub fn about(middle: f64, half: f64, top: f64) -> Result<Self, DistributionError> {
        let (middle, half) = (finite("the middle", middle)?, positive("the half width", half)?);
        Ok(Self { middle, half, top: between("top", top, [0.0, 1.0], "from 0 to 1")? })
    }

    /// Half-widths of the two uniform variables, in half-widths of the interval.
    fn halves(&self) -> [f64; 2] {
        [0.5 * (1.0 + self.top), 0.5 * (1.0 - self.top)]
    }

    /// Density in the middle, over the interval from -1 to 1.
    fn height(&self) -> f64 {
        1.0 / (1.0 + self.top)
    }

    /// Probability below `y` in the interval from -1 to 1.
    fn below(&self, y: f64) -> f64 {
        let (y, h, ramp) = (y.clamp(-1.0, 1.0), self.height(), 1.0 - self.top);
        if y > 0.0 {
            return 1.0 - self.below(-y);
        }
        let to_end = 1.0 + y;
        if to_end < ramp { 0.5 * h * to_end * to_end / ramp } else { h * (to_end - 0.5 * ramp) }
    }

    /// Value below which the probability is `p`, at most one half, in the interval from -1 to 1.
    fn lower_half(&self, p: f64) -> f64 {
        let (h, ramp) = (self.height(), 1.0 - self.top);
        if p < 0.5 * h * ramp { (2.0 * p * ramp / h).sqrt() - 1.0 } else { p / h + 0.5 * ramp - 1.0 }
    }

    fn of_tails(&self, below: f64, above: f64) -> f64 {
        let y = if below <= above { self.lower_half(below) } else { -self.lower_half(above) };
        self.middle + self.half * y
    }
}

impl Distribution for Trapezoidal {
    fn name(&self) -> &'static str {
        "trapezoidal"
    }

    fn mean(&self) -> f64 {
        self.middle
    }

    fn sigma(&self) -> f64 {
        let [a, b] = self.halves();
        self.half * ((a * a + b * b) / 3.0).sqrt()
    }

    /// Moments from the cumulants of two uniform variables of half-widths `a` and `b`, which add:
    /// `a^2/3, -2 a^4/15, 16 a^6/63, -16 a^8/15`.
    fn standard_moments(&self) -> StandardMoments {
        let [a, b] = self.halves().map(|half| half * half);
        let v = (a + b) / 3.0;
        let even = |factor: f64, power: i32| factor * (a.powi(power) + b.powi(power)) / v.powi(power);
        let cumulants = [0.0, even(-2.0 / 15.0, 2), 0.0, even(16.0 / 63.0, 3), 0.0, even(-16.0 / 15.0, 4)];
        StandardMoments::from_cumulants(cumulants)
    }

    fn support(&self) -> [f64; 2] {
        [self.middle - self.half, self.middle + self.half]
    }

    /// Coefficients from Gauss-Legendre on the three straight pieces, which is exact.
    fn jacobi(&self, order: usize) -> Jacobi {
        let (top, rule) = (self.top, legendre(order + 2));
        let mut pieces = Discretised::default();
        let ramp = |y: f64| (1.0 - y.abs()) / (1.0 - top);
        pieces.piece([-1.0, -top], &rule, ramp);
        pieces.piece([-top, top], &rule, |_| 1.0);
        pieces.piece([top, 1.0], &rule, ramp);
        pieces.standardise();
        pieces.symmetric_jacobi(order)
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::about(self.middle + moved, self.half * factor, self.top);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Trapezoidal {
    fn density(&self, x: f64) -> Option<f64> {
        let y = ((x - self.middle) / self.half).abs();
        let of_top = match y {
            _ if y > 1.0 => 0.0,
            _ if y <= self.top => 1.0,
            _ => (1.0 - y) / (1.0 - self.top),
        };
        Some(of_top * self.height() / self.half)
    }

    /// Ends of the flat part.
    fn corners(&self) -> Vec<f64> {
        match self.top {
            1.0 => Vec::new(),
            0.0 => vec![self.middle],
            top => vec![self.middle - self.half * top, self.middle + self.half * top],
        }
    }

    fn cdf(&self, x: f64) -> f64 {
        self.below((x - self.middle) / self.half)
    }

    fn sf(&self, x: f64) -> f64 {
        self.below(-(x - self.middle) / self.half)
    }

    fn quantile(&self, p: f64) -> f64 {
        let p = checked(p);
        self.of_tails(p, 1.0 - p)
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        let p = checked(p);
        self.of_tails(1.0 - p, p)
    }
}
