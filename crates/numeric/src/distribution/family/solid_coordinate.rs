//! Distribution of one coordinate of a point that is spread evenly over an octahedron or a double cone.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::{Arc, LazyLock};

use crate::distribution::family::discretised::{Discretised, legendre};
use crate::distribution::inverse::root;
use crate::distribution::probability::checked;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, positive,
};

/// Coordinate of a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolidAxis {
    /// Any coordinate of the octahedron `|x| + |y| + |z| <= 1`, or the one along the axis of the double cone
    /// `|z| + hypot(x, y) <= 1`. Its density is `3 (1 - |y|)^2/2`.
    Octahedron,
    /// A coordinate across the axis of that double cone. Its density is `3 (sqrt(1 - y^2) - y^2 acosh(1/|y|))/pi`.
    Bicone,
}

/// Distribution of one coordinate of a point that is spread evenly over an octahedron or a double cone.
///
/// A plane face that varies within a zone of profile has such coordinates: its offset and its tilts share the zone.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, SolidAxis, SolidCoordinate};
/// let offset = SolidCoordinate::about(SolidAxis::Octahedron, 0.0, 1.0)?;
/// assert!((offset.sigma().powi(2) - 0.1).abs() < 1e-15);
/// let tilt = SolidCoordinate::about(SolidAxis::Bicone, 0.0, 1.0)?;
/// assert!((tilt.sigma().powi(2) - 0.15).abs() < 1e-15);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolidCoordinate {
    axis: SolidAxis,
    middle: f64,
    half: f64,
}

/// Angle from the end below which the tail of a coordinate across a double cone is integrated: closed forms lose digits there.
const NEAR_END: f64 = 0.7;
/// Nodes of Gauss-Legendre for that integral. Its integrand is smooth up to a right angle.
const NODES: usize = 14;

impl SolidAxis {
    /// Variance on the interval from -1 to 1.
    pub(crate) fn variance(self) -> f64 {
        match self {
            Self::Octahedron => 0.1,
            Self::Bicone => 0.15,
        }
    }

    /// Density on the interval from -1 to 1.
    fn density(self, y: f64) -> f64 {
        let from_middle = y.abs().min(1.0);
        match self {
            Self::Octahedron => 1.5 * (1.0 - from_middle) * (1.0 - from_middle),
            Self::Bicone => {
                let sine = ((1.0 - from_middle) * (1.0 + from_middle)).sqrt();
                3.0 / PI * slice(from_middle, sine)
            }
        }
    }

    /// Probability of a value above `y`, which is at least 0. `end` is `1 - y` with all its digits.
    pub(crate) fn tail(self, y: f64, end: f64) -> f64 {
        let end = end.clamp(0.0, 1.0);
        match self {
            Self::Octahedron => 0.5 * end * end * end,
            Self::Bicone => {
                let sine = (end * (1.0 + y)).sqrt();
                let angle = libm::atan2(sine, y);
                if angle >= NEAR_END {
                    let cube = if y == 0.0 { 0.0 } else { y.powi(3) * inverse_cosine(y, sine) };
                    return (angle - 2.0 * y * sine + cube) / PI;
                }
                // Integral of the density over the angle, in which it is smooth.
                let part = |(node, weight): &(f64, f64)| {
                    let at = 0.5 * angle * (1.0 + node);
                    0.5 * angle * weight * libm::sin(at) * slice(libm::cos(at), libm::sin(at))
                };
                3.0 / PI * RULE.iter().map(part).sum::<f64>()
            }
        }
    }

    /// Value of at least 0 beyond which the probability is `tail`, which is at most 1/2. Returns the value and its distance from 1.
    pub(crate) fn beyond(self, tail: f64) -> [f64; 2] {
        match self {
            Self::Octahedron => {
                let end = libm::cbrt(2.0 * tail);
                [1.0 - end, end]
            }
            Self::Bicone => {
                if tail <= 0.0 {
                    return [1.0, 0.0];
                }
                // The tail is 2/(5 pi) of the fifth power of a small angle.
                let start = libm::pow(2.5 * PI * tail, 0.2).min(FRAC_PI_2);
                let angle = root([0.0, FRAC_PI_2], start, |angle| {
                    let (y, sine) = (libm::cos(angle), libm::sin(angle));
                    let end = 2.0 * libm::sin(0.5 * angle) * libm::sin(0.5 * angle);
                    let here = self.tail(y, end);
                    (libm::log(here / tail), 3.0 / PI * slice(y, sine) * sine / here)
                });
                let half = libm::sin(0.5 * angle);
                [libm::cos(angle), 2.0 * half * half]
            }
        }
    }
}

/// Gauss-Legendre rule of the tail near an end.
static RULE: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| legendre(NODES));

/// Inverse hyperbolic cosine of `1/y`. `sine` is `sqrt(1 - y^2)`.
fn inverse_cosine(y: f64, sine: f64) -> f64 {
    libm::log1p(sine) - libm::log(y)
}

/// Area `sqrt(1 - y^2) - y^2 acosh(1/y)` of a slice of a double cone, over 2. `sine` is `sqrt(1 - y^2)`.
fn slice(y: f64, sine: f64) -> f64 {
    /// Sine below which the difference is summed as a series.
    const SERIES: f64 = 0.75;
    /// Terms of the series: the last one is 0.75^120, below the rounding of the first one.
    const TERMS: usize = 60;
    if sine > SERIES {
        return if y == 0.0 { 1.0 } else { sine - y * y * inverse_cosine(y, sine) };
    }
    // With atanh s = s + s^3/3 + ..: the sum over k of 2 s^(2k + 1)/((2k - 1)(2k + 1)).
    let square = sine * sine;
    let (mut sum, mut power) = (0.0, sine);
    for k in 1..=TERMS {
        power *= square;
        let twice = 2.0 * k as f64;
        let term = 2.0 * power / ((twice - 1.0) * (twice + 1.0));
        sum += term;
        if term <= f64::EPSILON * 0.1 * sum {
            break;
        }
    }
    sum
}

impl SolidCoordinate {
    /// Distribution from `middle - half` to `middle + half`.
    pub fn about(axis: SolidAxis, middle: f64, half: f64) -> Result<Self, DistributionError> {
        Ok(Self { axis, middle: finite("the middle", middle)?, half: positive("the half width", half)? })
    }

    /// Probability above a place of the interval from -1 to 1.
    fn above(&self, y: f64) -> f64 {
        let y = y.clamp(-1.0, 1.0);
        let tail = self.axis.tail(y.abs(), 1.0 - y.abs());
        if y < 0.0 { 1.0 - tail } else { tail }
    }

    fn y(&self, x: f64) -> f64 {
        (x - self.middle) / self.half
    }

    /// Place whose tail on this side has the probability `p`.
    fn inverse(&self, p: f64, side: f64) -> f64 {
        if checked(p).is_nan() {
            return f64::NAN;
        }
        let place = if p <= 0.5 { self.axis.beyond(p)[0] } else { -self.axis.beyond(1.0 - p)[0] };
        self.middle + self.half * side * place
    }
}

impl Distribution for SolidCoordinate {
    fn name(&self) -> &'static str {
        match self.axis {
            SolidAxis::Octahedron => "octahedron",
            SolidAxis::Bicone => "bicone",
        }
    }

    fn mean(&self) -> f64 {
        self.middle
    }

    fn sigma(&self) -> f64 {
        self.half * self.axis.variance().sqrt()
    }

    /// Moments from the even ones over the interval from -1 to 1: `6/((n + 1)(n + 2)(n + 3))` along an axis. Across the double cone they are
    /// `6 c/((n + 2)(n + 3))`, with `c` the mean of the power `n` of a cosine.
    fn standard_moments(&self) -> StandardMoments {
        let variance = self.axis.variance();
        let even = |order: i32| {
            let n = f64::from(order);
            let raw = match self.axis {
                SolidAxis::Octahedron => 6.0 / ((n + 1.0) * (n + 2.0) * (n + 3.0)),
                SolidAxis::Bicone => {
                    let cosine = (1..=order / 2).map(|k| f64::from(2 * k - 1) / f64::from(2 * k)).product::<f64>();
                    6.0 * cosine / ((n + 2.0) * (n + 3.0))
                }
            };
            raw / variance.powi(order / 2)
        };
        // Fourth moments less 3: 20/7 - 3, and (3/56)/0.0225 - 3.
        let excess = match self.axis {
            SolidAxis::Octahedron => -1.0 / 7.0,
            SolidAxis::Bicone => -13.0 / 21.0,
        };
        StandardMoments::with_excess(0.0, excess, [0.0, even(6), 0.0, even(8)])
    }

    fn support(&self) -> [f64; 2] {
        [self.middle - self.half, self.middle + self.half]
    }

    /// Coefficients from Gauss-Legendre, which is exact along an axis. Across the double cone the rule is one of the radius, of density
    /// `6 r (1 - r)`, times one of the direction.
    fn jacobi(&self, order: usize) -> Jacobi {
        let mut pieces = Discretised::default();
        match self.axis {
            SolidAxis::Octahedron => {
                let rule = legendre(order + 2);
                pieces.piece([-1.0, 0.0], &rule, |y| self.axis.density(y));
                pieces.piece([0.0, 1.0], &rule, |y| self.axis.density(y));
            }
            SolidAxis::Bicone => {
                let directions = 2 * order + 4;
                for (node, weight) in legendre(order + 2) {
                    let radius = 0.5 * (1.0 + node);
                    for k in 0..directions {
                        let angle = PI * (k as f64 + 0.5) / directions as f64;
                        pieces.push(radius * libm::cos(angle), weight * radius * (1.0 - radius));
                    }
                }
            }
        }
        pieces.standardise();
        pieces.symmetric_jacobi(order)
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::about(self.axis, self.middle + moved, self.half * factor);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for SolidCoordinate {
    fn density(&self, x: f64) -> Option<f64> {
        let y = self.y(x);
        Some(if y.abs() > 1.0 { 0.0 } else { self.axis.density(y) / self.half })
    }

    /// The middle, where the slope of the density jumps.
    fn corners(&self) -> Vec<f64> {
        vec![self.middle]
    }

    fn cdf(&self, x: f64) -> f64 {
        if x.is_nan() { x } else { self.above(-self.y(x)) }
    }

    fn sf(&self, x: f64) -> f64 {
        if x.is_nan() { x } else { self.above(self.y(x)) }
    }

    fn quantile(&self, p: f64) -> f64 {
        self.inverse(p, -1.0)
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.inverse(p, 1.0)
    }
}
