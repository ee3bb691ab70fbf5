//! Two values, each with probability one half.

use std::sync::Arc;

use rand::{Rng, RngExt};

use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, interval, positive,
    probability,
};

/// Distribution of two values, each with probability one half, such as a pin that lies on one side of its hole or the other.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, TwoValues};
/// let side = TwoValues::new(-0.05, 0.05)?;
/// assert_eq!((side.mean(), side.sigma()), (0.0, 0.05));
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoValues {
    mean: f64,
    half: f64,
}

impl TwoValues {
    /// Distribution of `lower` and `upper`. `lower` must be below `upper`.
    pub fn new(lower: f64, upper: f64) -> Result<Self, DistributionError> {
        let [middle, half] = interval(lower, upper)?;
        Self::about(middle, half)
    }

    /// Distribution of `mean - half` and `mean + half`. `half` must be above 0.
    pub fn about(mean: f64, half: f64) -> Result<Self, DistributionError> {
        Ok(Self { mean: finite("the middle", mean)?, half: positive("the half width", half)? })
    }
}

impl Distribution for TwoValues {
    fn name(&self) -> &'static str {
        "two-point"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.half
    }

    /// Moments of `u`, which is -1 or 1: even moments are 1, and `u^2 - 1` is always 0.
    fn standard_moments(&self) -> StandardMoments {
        StandardMoments { skewness: 0.0, excess: -2.0, m5: 0.0, m6: 1.0, m7: 0.0, m8: 1.0, h6: 0.0, h7: 0.0, h8: 0.0 }
    }

    fn support(&self) -> [f64; 2] {
        [self.mean - self.half, self.mean + self.half]
    }

    /// Coefficients of two atoms: the polynomial of order 2 is 0 at both.
    fn jacobi(&self, order: usize) -> Jacobi {
        let order = order.min(2);
        Jacobi::new(vec![0.0; order], [1.0, 0.0][..order].to_vec())
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        Some(Self::about(self.mean + moved, self.half * factor).map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

/// Staircase of two steps.
impl Probability for TwoValues {
    /// Returns None, because both values are atoms.
    fn density(&self, _: f64) -> Option<f64> {
        None
    }

    fn atoms(&self) -> Vec<(f64, f64)> {
        self.support().map(|value| (value, 0.5)).to_vec()
    }

    fn cdf(&self, x: f64) -> f64 {
        let [lower, upper] = self.support();
        match x {
            x if x.is_nan() => x,
            x if x < lower => 0.0,
            x if x < upper => 0.5,
            _ => 1.0,
        }
    }

    fn sf(&self, x: f64) -> f64 {
        1.0 - self.cdf(x)
    }

    /// Least value whose `cdf` is at least `p`; for `p` of 0 the lower value.
    fn quantile(&self, p: f64) -> f64 {
        match probability::checked(p) {
            p if p.is_nan() => p,
            p if p <= 0.5 => self.support()[0],
            _ => self.support()[1],
        }
    }

    /// Least value with at most `p` above it.
    fn upper_quantile(&self, p: f64) -> f64 {
        match probability::checked(p) {
            p if p.is_nan() => p,
            p if p >= 0.5 => self.support()[0],
            _ => self.support()[1],
        }
    }

    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        let [lower, upper] = self.support();
        out.iter_mut().for_each(|value| *value = if rng.random() { upper } else { lower });
    }
}
