//! Triangular distribution.

use std::sync::Arc;

use crate::distribution::family::discretised::{Discretised, legendre};
use crate::distribution::probability::{checked, clamped};
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, between, finite, interval, positive,
};

/// Triangular distribution over an interval: its density rises in a straight line from one end to the mode and falls to the other end.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Triangular};
/// let slot = Triangular::new(9.9, 10.0, 10.1)?;
/// assert!((slot.sigma() - 0.1 / 6f64.sqrt()).abs() < 1e-15);
/// assert_eq!(slot.standard_moments().excess, -0.6);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangular {
    middle: f64,
    half: f64,
    lean: f64,
}

impl Triangular {
    /// Distribution between `lower` and `upper`, with the mode between them or at one of them.
    pub fn new(lower: f64, mode: f64, upper: f64) -> Result<Self, DistributionError> {
        let [middle, half] = interval(lower, upper)?;
        finite("mode", mode)?;
        if !(lower..=upper).contains(&mode) {
            return Err(DistributionError::OutOfRange {
                parameter: "mode",
                value: mode,
                range: "between the two ends",
            });
        }
        Self::about(middle, half, ((mode - middle) / half).clamp(-1.0, 1.0))
    }

    /// Distribution from `middle - half` to `middle + half` with the mode at `middle + lean half`, `lean` from -1 to 1.
    pub fn about(middle: f64, half: f64, lean: f64) -> Result<Self, DistributionError> {
        let (middle, half) = (finite("the middle", middle)?, positive("the half width", half)?);
        Ok(Self { middle, half, lean: between("lean", lean, [-1.0, 1.0], "from -1 to 1")? })
    }

    /// Position within the interval, from -1 to 1.
    fn y(&self, x: f64) -> f64 {
        ((x - self.middle) / self.half).clamp(-1.0, 1.0)
    }

    /// Probabilities below and above, each a sum of positive terms.
    fn masses(&self, y: f64) -> [f64; 2] {
        let e = self.lean;
        let (to_end, to_mode) = if y < e { (1.0 + y, 1.0 + e) } else { (1.0 - y, 1.0 - e) };
        let outer = if to_end == 0.0 { 0.0 } else { 0.5 * to_end * to_end / to_mode };
        let inner = if to_mode == 0.0 { 0.0 } else { 0.5 * (e - y).abs() * (to_end + to_mode) / to_mode };
        let other = clamped(0.5 * (1.0 + if y < e { -e } else { e }) + inner);
        if y < e { [outer, other] } else { [other, outer] }
    }

    fn of_tails(&self, below: f64, above: f64) -> f64 {
        let e = self.lean;
        let y = if below <= 0.5 * (1.0 + e) {
            (2.0 * below * (1.0 + e)).sqrt() - 1.0
        } else {
            1.0 - (2.0 * above * (1.0 - e)).sqrt()
        };
        self.middle + self.half * y
    }
}

impl Distribution for Triangular {
    fn name(&self) -> &'static str {
        "triangular"
    }

    fn mean(&self) -> f64 {
        self.middle + self.half * self.lean / 3.0
    }

    fn sigma(&self) -> f64 {
        self.half * ((3.0 + self.lean * self.lean) / 18.0).sqrt()
    }

    /// Moments as polynomials in the asymmetry `e`, over powers of the variance. On the interval from -1 to 1 the variance is `(3 +
    /// e^2)/18`, and `m3 = -e (9 - e^2)/135`. The kurtosis is always 12/5.
    fn standard_moments(&self) -> StandardMoments {
        let (d, e2) = (-self.lean, self.lean * self.lean);
        let v = (3.0 + e2) / 18.0;
        let (t, odd) = (18.0 * v, d * (9.0 - e2) / v.sqrt());
        StandardMoments::with_excess(
            odd / (135.0 * v),
            -0.6,
            [
                4.0 * odd * t / (1701.0 * v * v),
                (31.0 * e2.powi(3) + 171.0 * e2 * e2 + 1053.0 * e2 + 729.0) / (20412.0 * v.powi(3)),
                odd * t * t / (1458.0 * v.powi(3)),
                t * (13.0 * e2.powi(3) + 9.0 * e2 * e2 + 567.0 * e2 + 243.0) / (32805.0 * v.powi(4)),
            ],
        )
    }

    fn support(&self) -> [f64; 2] {
        [self.middle - self.half, self.middle + self.half]
    }

    /// Coefficients from Gauss-Legendre on the two straight pieces, which is exact.
    fn jacobi(&self, order: usize) -> Jacobi {
        let (e, rule) = (self.lean, legendre(order + 2));
        let mut pieces = Discretised::default();
        pieces.piece([-1.0, e], &rule, |y| (1.0 + y) / (1.0 + e));
        pieces.piece([e, 1.0], &rule, |y| (1.0 - y) / (1.0 - e));
        pieces.standardise();
        if e == 0.0 { pieces.symmetric_jacobi(order) } else { pieces.jacobi(order) }
    }

    /// Copy with the band scaled. The mode keeps its relative position.
    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::about(self.middle + moved, self.half * factor, self.lean);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Triangular {
    fn density(&self, x: f64) -> Option<f64> {
        let (y, e) = ((x - self.middle) / self.half, self.lean);
        let of_peak = match y {
            _ if y.abs() > 1.0 => 0.0,
            _ if y == e => 1.0,
            _ if y < e => (1.0 + y) / (1.0 + e),
            _ => (1.0 - y) / (1.0 - e),
        };
        Some(of_peak / self.half)
    }

    /// Mode, unless it is at an end.
    fn corners(&self) -> Vec<f64> {
        if self.lean.abs() < 1.0 { vec![self.middle + self.half * self.lean] } else { Vec::new() }
    }

    fn cdf(&self, x: f64) -> f64 {
        if x.is_nan() { x } else { self.masses(self.y(x))[0] }
    }

    fn sf(&self, x: f64) -> f64 {
        if x.is_nan() { x } else { self.masses(self.y(x))[1] }
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
