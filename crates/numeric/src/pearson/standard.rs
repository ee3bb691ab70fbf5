//! A Pearson law with mean 0, variance 1 and a skewness that is not negative.

use crate::pearson::PearsonError;
use crate::pearson::coefficients::{PearsonType, Roots, Shape};
use crate::pearson::ending::Ending;
use crate::pearson::equation::Equation;
use crate::pearson::side::{Place, Side};
use crate::pearson::slopes::{Slopes, Walk};

/// Two sides that meet at the anchor.
#[derive(Debug, Clone)]
pub(super) struct Standard {
    pub(super) kind: PearsonType,
    pub(super) support: [f64; 2],
    anchor: f64,
    left: Side,
    right: Side,
    /// Mass of both sides, with the density at the anchor as unit.
    total: f64,
}

impl Standard {
    pub(super) fn new(skewness: f64, kurtosis: [f64; 2]) -> Result<Self, PearsonError> {
        let shape = Shape::new(skewness, kurtosis)?;
        let equation = Equation::of(&shape);
        let (mut lower, mut upper) = (f64::NEG_INFINITY, f64::INFINITY);
        let (mut left, mut right) = (None, None);
        match shape.roots {
            Roots::Real { near, far, ends } => {
                lower = near;
                left = Ending::finite(near, -1.0, &ends[0]);
                if far > 0.0 {
                    upper = far;
                    right = Ending::finite(far, 1.0, &ends[1]);
                }
            }
            Roots::Double { at } => lower = at,
            Roots::Complex { .. } | Roots::None => {}
        }
        if let Some(infinity) = shape.infinity() {
            let ratio = shape.c1 / shape.c2;
            right = Ending::infinite(&infinity, 1.0, ratio);
            if lower.is_infinite() {
                left = Ending::infinite(&infinity, -1.0, ratio);
            }
        }
        // If nearly all of the mass lies at the lower end, the series there is a better start than the mean.
        let anchor = match &left {
            Some(left) if left.is_finite() && left.covers(0.0) => left.border(),
            _ => 0.0,
        };
        let left = Side::new(equation, anchor, -1.0, left, lower);
        let right = Side::new(equation, anchor, 1.0, right, upper);
        let total = left.mass + right.mass;
        Ok(Self { kind: shape.kind, support: [lower, upper], anchor, left, right, total })
    }

    fn place(&self, z: f64) -> Place {
        if z < self.anchor { self.left.at(z) } else { self.right.at(z) }
    }

    pub(super) fn log_pdf(&self, z: f64) -> f64 {
        self.place(z).log_density - libm::log(self.total)
    }

    /// Probabilities below and above `z`, each with full relative accuracy.
    pub(super) fn cdf_sf(&self, z: f64) -> [f64; 2] {
        let place = self.place(z);
        let beyond = libm::exp(place.log_mass());
        let (side, other) = if z < self.anchor { (&self.left, &self.right) } else { (&self.right, &self.left) };
        let inner = side.inner(z).unwrap_or(side.mass - beyond).max(0.0);
        let (outer, rest) = ((beyond / self.total).min(1.0), ((other.mass + inner) / self.total).min(1.0));
        if z < self.anchor { [outer, rest] } else { [rest, outer] }
    }

    /// Derivatives by skewness and excess of the probability below one place plus that above another. Returns None if the density ends too
    /// abruptly.
    pub(super) fn outside_by_shape(&self, shape: [f64; 2], below: Option<f64>, above: Option<f64>) -> Option<Slopes> {
        let growth = Shape::growth(shape[0], shape[1]);
        let (left, right) = (Walk::along(&self.left, growth)?, Walk::along(&self.right, growth)?);
        let mean: Slopes = std::array::from_fn(|i| (left.all()[i] + right.all()[i]) / self.total);
        // Subtracting the mean slope keeps the total probability at 1.
        let of = |z: f64, above: bool| {
            let outside = if z < self.anchor { &left } else { &right };
            let sign = if (z < self.anchor) == above { -1.0 } else { 1.0 };
            outside.beyond((z - self.anchor).abs(), mean).map(|slope| sign * slope / self.total)
        };
        let (below, above) = (below.map_or([0.0; 2], |z| of(z, false)), above.map_or([0.0; 2], |z| of(z, true)));
        Some([below[0] + above[0], below[1] + above[1]]).filter(|all| all.iter().all(|slope| slope.is_finite()))
    }

    /// Logarithms of the probabilities below and above `z`, finite also where the probabilities underflow to 0.
    pub(super) fn log_cdf_sf(&self, z: f64) -> [f64; 2] {
        let [below, above] = self.cdf_sf(z);
        let outer = self.place(z).log_mass() - libm::log(self.total);
        // A probability close to 1 is computed from its complement.
        let of = |probability: f64, other: f64| if other < 0.5 { libm::log1p(-other) } else { libm::log(probability) };
        if z < self.anchor { [outer.min(0.0), of(above, below)] } else { [of(below, above), outer.min(0.0)] }
    }

    /// Place with these probabilities below and above, whose sum is 1. The smaller one is exact, the other its complement.
    pub(super) fn quantile(&self, [below, above]: [f64; 2]) -> f64 {
        if below * self.total > self.left.mass {
            return self.right.with_mass_beyond(libm::log(above * self.total));
        }
        let inner = if below > 0.5 { self.left.with_inner_mass(above * self.total - self.right.mass) } else { None };
        inner.unwrap_or_else(|| self.left.with_mass_beyond(libm::log(below * self.total)))
    }
}
