//! Effects that the five points of an axis show in addition to its polynomial: kinks, jumps, and powers that matter.
//!
//! With second divided differences over the left three, the middle three and the right three points,
//!
//! ```text
//! L = f[u1, u2, 0]     M = f[u2, 0, u3]     R = f[0, u3, u4]
//! ```
//!
//! A parabola has `L = M = R`, and for functions that are smooth at the scale of the points they vary slowly. A kink at the mean shows in
//! `M` alone. Such a curvature does not scale, because differences over steps `h` go like `1/h`. A kink beside the mean shows in two
//! neighbours but not in the third. A jump shows in two neighbours with opposite signs.

use sensitol_numeric::surrogate::Univariate;

/// Shape along an axis other than smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::analysis) enum Shape {
    /// Place at which two slopes meet.
    Kink {
        /// Slopes on the left and on the right, per sigma.
        slopes: [f64; 2],
        /// Places on either side of the kink, in sigmas.
        between: [f64; 2],
    },
    /// Place at which the value jumps.
    Jump {
        /// Height of the jump, in the unit of the values.
        by: f64,
        /// Places on either side of the jump, in sigmas.
        between: [f64; 2],
    },
}

/// Ratio of the middle second difference to its neighbours above which there is a kink between the inner points.
const KINK: f64 = 4.0;
/// Ratio of second differences below which the smaller one is rounding.
const NONE: f64 = 1e-6;
/// Greatest difference of the slopes on both sides of a jump, as a part of the jump.
const JUMP: f64 = 0.05;

/// Returns the kink or jump that the values at four nodes show, two on either side of the mean. Values are differences to the centre.
/// `least` is a second difference that does not matter.
pub(in crate::analysis) fn shape(samples: &[(f64, f64)], least: f64) -> Option<Shape> {
    let [(u1, y1), (u2, y2), (u3, y3), (u4, y4)] = *samples else { return None };
    if !(u1 < u2 && u2 < 0.0 && 0.0 < u3 && u3 < u4) {
        return None;
    }
    let far_left = (y2 - y1) / (u2 - u1);
    let (left, right) = (y2 / u2, y3 / u3);
    let far_right = (y4 - y3) / (u4 - u3);
    let [l, m, r] = [(left - far_left) / -u1, (right - left) / (u3 - u2), (far_right - right) / u4];
    let largest = l.abs().max(m.abs()).max(r.abs());
    if largest.is_nan() || largest <= least {
        return None;
    }
    let none = |difference: f64| difference.abs() <= NONE * largest;
    // A jump between two points is a steep chord between two chords of equal slope.
    let chords = [far_left, left, right, far_right];
    let ends = [[u1, u2], [u2, 0.0], [0.0, u3], [u3, u4]];
    for inner in [1, 2] {
        let (before, at, after) = (chords[inner - 1], chords[inner], chords[inner + 1]);
        let step = (at - 0.5 * (before + after)).abs();
        if (before - after).abs() <= JUMP * step && step > least {
            let [from, to] = ends[inner];
            return Some(Shape::Jump { by: (at - 0.5 * (before + after)) * (to - from), between: ends[inner] });
        }
    }
    if m.abs() > KINK * l.abs().max(r.abs()) {
        return Some(Shape::Kink { slopes: [left, right], between: [u2, u3] });
    }
    // A straight line on one side only.
    match (none(l), none(r)) {
        (true, false) if !none(m) => Some(Shape::Kink { slopes: [left, far_right], between: [0.0, u4] }),
        (false, true) if !none(m) => Some(Shape::Kink { slopes: [far_left, right], between: [u1, 0.0] }),
        (true, false) if none(m) => Some(Shape::Kink { slopes: [right, far_right], between: [u3, u4] }),
        (false, true) if none(m) => Some(Shape::Kink { slopes: [far_left, left], between: [u1, u2] }),
        _ => None,
    }
}

/// Third and fourth coefficient of a part of degree four.
pub(in crate::analysis) fn higher(part: &Univariate) -> Option<[f64; 2]> {
    let [_, _, third, fourth] = part.coefficients();
    (part.degree() >= 4).then_some([third, fourth])
}

#[cfg(test)]
mod tests {
    use super::*;

    const NODES: [f64; 4] = [-2.857, -1.7320508, 1.7320508, 2.857];

    fn of(f: impl Fn(f64) -> f64) -> Option<Shape> {
        shape(&NODES.map(|u| (u, f(u) - f(0.0))), 1e-9)
    }

    #[test]
    fn a_kink_at_the_mean_is_no_curvature() {
        assert!(matches!(of(f64::abs), Some(Shape::Kink { slopes: [-1.0, 1.0], .. })));
        // On top of a parabola, too.
        assert!(matches!(of(|u| u.abs() + 0.05 * u * u + 2.0 * u), Some(Shape::Kink { .. })));
    }

    #[test]
    fn a_kink_beside_the_mean_leaves_one_side_straight() {
        for at in [0.3, 1.0, 1.5, 2.0, 2.5] {
            for sign in [1.0, -1.0] {
                let found = of(|u| 0.7 * u + (sign * u - at).max(0.0));
                let Some(Shape::Kink { between: [from, to], .. }) = found else { panic!("{at}: {found:?}") };
                assert!(from <= sign * at && sign * at <= to, "{at} is not in {from} .. {to}");
            }
        }
    }

    #[test]
    fn a_jump_is_no_slope() {
        let found = of(|u| 0.5 * u + if u > 0.4 { 3.0 } else { 0.0 });
        let Some(Shape::Jump { by, between: [0.0, _] }) = found else { panic!("{found:?}") };
        assert!((by - 3.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_smooth_is_neither() {
        let smooth: [fn(f64) -> f64; 7] = [
            |u| 3.0 * u,
            |u| u + 0.3 * u * u,
            |u| (0.3 * u).exp(),
            |u| (0.3 * u).cos(),
            |u| (1.0 + 0.1 * u).sqrt(),
            |u| 1.0 / (1.0 + 0.1 * u),
            |u| (0.5 * u).sin(),
        ];
        for (index, f) in smooth.into_iter().enumerate() {
            assert_eq!(of(f), None, "{index}");
        }
    }
}
