//! Curvilinear trapezoid: a rectangle whose ends are not known exactly.

use std::sync::Arc;

use crate::distribution::family::discretised::{Discretised, legendre};
use crate::distribution::inverse::root;
use crate::distribution::probability::checked;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, interval, positive,
};
use crate::power::Power;

/// Uniform distribution over an interval whose two ends are off by the same unknown amount, either both outward or both inward. The amount
/// is uniform up to an inexactness `d`. With the half-width `w` the variance is `w^2/3 + d^2/9`, and the density is
///
/// ```text
/// ln((w + d)/(w - d))/(4 d)    up to w - d from the middle
/// ln((w + d)/t)/(4 d)          at a distance t from there to w + d
/// ```
///
/// Source: GUM Supplement 1 (JCGM 101:2008), 6.4.3, CTrap.
///
/// ```
/// use sensitol_numeric::distribution::{CurvilinearTrapezoid, Distribution};
/// let given = CurvilinearTrapezoid::new(-0.1, 0.1, 0.025)?;
/// assert!((given.sigma().powi(2) - (0.01 / 3.0 + 0.025 * 0.025 / 9.0)).abs() < 1e-17);
/// assert_eq!(given.support(), [-0.125, 0.125]);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvilinearTrapezoid {
    middle: f64,
    half: f64,
    inexactness: f64,
}

/// `e + (1 - e) ln(1 - e)` without cancellation. For a small `e` it is the sum of `e^k/(k (k - 1))`.
fn wedge(e: f64) -> f64 {
    /// Argument above which the difference loses at most four roundings. Below it the terms of the series fall by this factor.
    const SMALL: f64 = 0.25;
    if e > SMALL {
        return if e >= 1.0 { 1.0 } else { e + (1.0 - e) * libm::log1p(-e) };
    }
    // 0.25^27 is below a rounding error.
    (2..=27).rev().fold(0.0, |sum, k| {
        let k = f64::from(k);
        e * sum + 1.0 / (k * (k - 1.0))
    }) * e
        * e
}

impl CurvilinearTrapezoid {
    /// Distribution between ends near `lower` and `upper`, each off by at most `inexactness`. That must be above 0 and below half their
    /// distance.
    pub fn new(lower: f64, upper: f64, inexactness: f64) -> Result<Self, DistributionError> {
        let [middle, half] = interval(lower, upper)?;
        Self::about(middle, half, inexactness)
    }

    /// Distribution from about `middle - half` to about `middle + half`.
    pub fn about(middle: f64, half: f64, inexactness: f64) -> Result<Self, DistributionError> {
        let (middle, half) = (finite("the middle", middle)?, positive("the half width", half)?);
        let value = finite("inexactness", inexactness)?;
        // A smaller inexactness than 1e-12 of the half-width cannot be distinguished from a rectangle.
        if !(value >= 1e-12 * half && value < half) {
            let range = "above 0 and below half the band";
            return Err(DistributionError::OutOfRange { parameter: "inexactness", value, range });
        }
        Ok(Self { middle, half, inexactness })
    }

    /// Ends of the flat part and of the support, as distances from the middle.
    fn ends(&self) -> [f64; 2] {
        [self.half - self.inexactness, self.half + self.inexactness]
    }

    /// Density over the flat part.
    fn height(&self) -> f64 {
        let part = self.inexactness / self.half;
        0.5 * libm::atanh(part) / self.inexactness
    }

    /// Probability beyond a point outside the flat part. The point lies at the fraction `e` of the way from the end of the support to the
    /// middle.
    fn beyond(&self, e: f64) -> f64 {
        let [_, end] = self.ends();
        end / (4.0 * self.inexactness) * wedge(e)
    }

    /// Probability beyond this signed distance from the middle, on one side.
    fn above(&self, t: f64) -> f64 {
        let [flat, end] = self.ends();
        match t {
            _ if t < 0.0 => 1.0 - self.above(-t),
            _ if t >= end => 0.0,
            _ if t >= flat => self.beyond((end - t) / end),
            _ => self.beyond(2.0 * self.inexactness / end) + (flat - t) * self.height(),
        }
    }

    /// Distance from the middle beyond which one side has the probability `p`, at most one half.
    fn at(&self, p: f64) -> f64 {
        let [flat, end] = self.ends();
        let (widest, beside) = (2.0 * self.inexactness / end, self.beyond(2.0 * self.inexactness / end));
        if p >= beside {
            return (flat - (p - beside) / self.height()).max(0.0);
        }
        if p == 0.0 {
            return end;
        }
        let wanted = p * 4.0 * self.inexactness / end;
        // `e^2/2` is the first term, so the root lies below this start.
        let start = (2.0 * wanted).sqrt().min(widest);
        let e = root([0.0, widest.next_up()], start, |e| (wedge(e) / wanted - 1.0, -libm::log1p(-e) / wanted));
        end - end * e
    }

    fn of_tails(&self, below: f64, above: f64) -> f64 {
        self.middle + if below <= above { -self.at(below) } else { self.at(above) }
    }
}

impl Distribution for CurvilinearTrapezoid {
    fn name(&self) -> &'static str {
        "curvilinear-trapezoid"
    }

    fn mean(&self) -> f64 {
        self.middle
    }

    fn sigma(&self) -> f64 {
        // Scale to a unit of its own, so that the square of an extreme width does not overflow.
        let unit = Power::of(self.half);
        let [half, inexactness] = [self.half, self.inexactness].map(|width| unit.inverse().times(width));
        unit.times((half * half / 3.0 + inexactness * inexactness / 9.0).sqrt())
    }

    /// Even moments. With `q = d/w` and the half-width as unit they are `((1 + q)^(n+1) - (1 - q)^(n+1))/(2 q (n+1)^2)`, carried out.
    fn standard_moments(&self) -> StandardMoments {
        let q = (self.inexactness / self.half).powi(2);
        let v = 1.0 / 3.0 + q / 9.0;
        let m4 = (5.0 + q * (10.0 + q)) / 25.0 / (v * v);
        let m6 = (7.0 + q * (35.0 + q * (21.0 + q))) / 49.0 / v.powi(3);
        let m8 = (9.0 + q * (84.0 + q * (126.0 + q * (36.0 + q)))) / 81.0 / v.powi(4);
        StandardMoments::from_standard([0.0, m4, 0.0, m6, 0.0, m8])
    }

    fn support(&self) -> [f64; 2] {
        let [_, end] = self.ends();
        [self.middle - end, self.middle + end]
    }

    /// Coefficients from Gauss-Legendre over the interval and over its inexactness, which is exact.
    fn jacobi(&self, order: usize) -> Jacobi {
        let (part, rule) = (self.inexactness / self.half, legendre(order + 2));
        let mut pieces = Discretised::default();
        for (off, weight) in &rule {
            let half = 1.0 + part * off;
            rule.iter().for_each(|(node, inner)| pieces.push(half * node, weight * inner));
        }
        pieces.standardise();
        pieces.symmetric_jacobi(order)
    }

    /// Copy with width and inexactness scaled alike.
    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::about(self.middle + moved, self.half * factor, self.inexactness * factor);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for CurvilinearTrapezoid {
    fn density(&self, x: f64) -> Option<f64> {
        let ([flat, end], t) = (self.ends(), (x - self.middle).abs());
        Some(match t {
            _ if t > end => 0.0,
            _ if t <= flat => self.height(),
            _ => -libm::log1p((t - end) / end) / (4.0 * self.inexactness),
        })
    }

    /// Ends of the flat part.
    fn corners(&self) -> Vec<f64> {
        let [flat, _] = self.ends();
        vec![self.middle - flat, self.middle + flat]
    }

    fn cdf(&self, x: f64) -> f64 {
        if x.is_nan() { x } else { self.above(self.middle - x) }
    }

    fn sf(&self, x: f64) -> f64 {
        if x.is_nan() { x } else { self.above(x - self.middle) }
    }

    fn quantile(&self, p: f64) -> f64 {
        let p = checked(p);
        if p.is_nan() { p } else { self.of_tails(p, 1.0 - p) }
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        let p = checked(p);
        if p.is_nan() { p } else { self.of_tails(1.0 - p, p) }
    }
}
