//! Probability of a quadrant of two normal variables.
//!
//! ```text
//! P(X > h, Y > k) = Q(h) Q(k) + 1/(2 pi) int_0^asin(rho) exp(-(h^2 + k^2 - 2 h k sin t)/(2 cos^2 t)) dt
//! ```
//!
//! Source: R. L. Plackett, "A reduction formula for normal multivariate integrals", Biometrika 41 (1954). The integral is summed over
//! panels by Gauss's rule with sixteen nodes. Its error is the difference from half as many panels.

use crate::characteristic::SpecLimits;
use crate::distribution::standard_normal;
use crate::law::surface::Surface;
use crate::law::{LawFigure, SurfaceLaw};
use crate::pearson::LEGENDRE;

/// Number of panels of the finer of two rules.
const PANELS: usize = 16;
/// Greatest error of a quadrant. Beyond it points are used instead.
const WORST: f64 = 1e-9;

/// Probability that two standard normal variables of this correlation lie beyond `h` and `k` at once.
fn quadrant(h: f64, k: f64, correlation: f64) -> LawFigure {
    let end = libm::asin(correlation.clamp(-1.0, 1.0));
    let inner = |t: f64| {
        let (sin, cos) = libm::sincos(t);
        libm::exp(-(h * h + k * k - 2.0 * h * k * sin) / (2.0 * cos * cos))
    };
    let sum = |panels: usize| -> f64 {
        let half = 0.5 * end / panels as f64;
        let panel = |index: usize| -> f64 {
            let middle = (2 * index + 1) as f64 * half;
            LEGENDRE
                .iter()
                .map(|(node, weight)| weight * (inner(middle + half * node) + inner(middle - half * node)))
                .sum()
        };
        half * (0..panels).map(panel).sum::<f64>() / (2.0 * std::f64::consts::PI)
    };
    let (coarse, fine) = (sum(PANELS / 2), sum(PANELS));
    let value = standard_normal::sf(h) * standard_normal::sf(k) + fine;
    LawFigure::new(value.max(0.0), (fine - coarse).abs() + f64::EPSILON)
}

/// Probability that two sums of normal inputs both exceed a limit. Returns None for all other surfaces.
pub(super) fn both_broken([first, second]: [(&SurfaceLaw, SpecLimits); 2]) -> Option<LawFigure> {
    let [a, b] = [slopes(&first.0.surface)?, slopes(&second.0.surface)?];
    let positions = first.0.surface.places.len().max(second.0.surface.places.len());
    let at = |of: &[(usize, f64)], position: usize| {
        of.iter().find(|(known, _)| *known == position).map_or(0.0, |(_, slope)| *slope)
    };
    let mut covariance: f64 = (0..positions).map(|position| at(&a, position) * at(&b, position)).sum();
    if let Some(correlation) = first.0.correlation.as_ref().or(second.0.correlation.as_ref()) {
        let members = correlation.members();
        for (row, &one) in members.iter().enumerate() {
            for (column, &other) in members.iter().enumerate().filter(|(column, _)| *column != row) {
                covariance += at(&a, one) * at(&b, other) * correlation.normal()[(row, column)];
            }
        }
    }
    let [sigma_a, sigma_b] = [first.0.sigma, second.0.sigma];
    let correlation = covariance / (sigma_a * sigma_b);
    let sides = |(law, limits): (&SurfaceLaw, SpecLimits)| {
        let of = |limit: Option<f64>, sign: f64| limit.map(|limit| (sign, sign * (limit - law.mean) / law.sigma));
        [of(limits.lower(), -1.0), of(limits.upper(), 1.0)]
    };
    let mut all = LawFigure::new(0.0, 0.0);
    for (sign, h) in sides(first).into_iter().flatten() {
        for (other, k) in sides(second).into_iter().flatten() {
            let one = quadrant(h, k, sign * other * correlation);
            all = LawFigure::new(all.value + one.value, all.error + one.error);
        }
    }
    (all.error <= WORST && all.value.is_finite()).then_some(all)
}

/// Slope of every input by its position. Returns None if the surface is not a sum of normal inputs.
fn slopes(surface: &Surface) -> Option<Vec<(usize, f64)>> {
    let straight = |place: usize| {
        let bent = surface.parts[place][2..].iter().any(|&coefficient| coefficient != 0.0);
        !bent && surface.inputs[place].is_normal() && surface.neighbours[place].is_empty()
    };
    if !(0..surface.len()).all(straight) {
        return None;
    }
    let of = |(position, place): (usize, &Option<usize>)| place.map(|place| (position, surface.parts[place][1]));
    Some(surface.places.iter().enumerate().filter_map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At the origin the quadrant is 1/4 + asin(rho)/(2 pi) (Sheppard 1899). Two independent variables multiply, and the same variable
    /// twice leaves one tail. The rule is exact to rounding except near a correlation of 1, which the panels resolve only coarsely.
    #[test]
    fn quadrants_are_those_of_closed_forms() {
        for rho in [-0.99, -0.4, 0.0, 0.3, 0.95] {
            let expected = 0.25 + f64::asin(rho) / (2.0 * std::f64::consts::PI);
            assert!((quadrant(0.0, 0.0, rho).value - expected).abs() < 1e-14, "{rho}");
        }
        let product = standard_normal::sf(3.0) * standard_normal::sf(2.5);
        assert!((quadrant(3.0, 2.5, 0.0).value - product).abs() < 1e-17);
        let same = quadrant(2.0, 2.0, 1.0 - 1e-12);
        assert!((same.value - standard_normal::sf(2.0)).abs() < 1e-6 + same.error, "{same:?}");
    }
}
