//! Derivatives of probabilities by skewness and excess.
//!
//! With a dot for a derivative by one of the two, `p. = p (u - E u)`, and Pearson's equation gives the derivative of `u`:
//!
//! ```text
//! u' = -(c1. + 3 c2. z)/C + (c1 + d z)(c1. z + c2. z^2)/C^2
//! d/d. P(> z) = (u(z) - E u) M(z) + integral beyond z of u' M,    M: the mass beyond
//! ```
//!
//! The probability below is treated in the same way. With `u = 0` at the anchor, `E u` is the sum of the integrals over both sides, by
//! parts. `u'` is a formula and `M` is
//! tabulated, so that Gauss-Legendre on the panels of the tables has rounding errors only.

use crate::pearson::equation::LEGENDRE;
use crate::pearson::side::Side;

/// Relative size below which the contribution of a piece is neglected.
const NOTHING: f64 = 1e-17;
/// Greatest number of pieces beyond the tables. A density that needs more ends too abruptly for these derivatives.
const BEYOND: usize = 120;

/// Derivatives by skewness and by excess.
pub(super) type Slopes = [f64; 2];

/// Piece of a side, with integrals over it outwards.
struct Span {
    /// Distances of the ends of the piece from the anchor.
    from: f64,
    to: f64,
    /// Integral of `u'` over the piece.
    own: Slopes,
    /// Integral of `u' M` over the piece.
    weighted: Slopes,
}

/// Side of a Pearson distribution in pieces, from the anchor outwards.
pub(super) struct Walk<'s> {
    side: &'s Side,
    /// Derivatives `c1.` and `c2.`, by skewness and by excess.
    growth: [[f64; 2]; 2],
    spans: Vec<Span>,
}

impl<'s> Walk<'s> {
    /// Returns None if the integral beyond the tables does not converge.
    pub(super) fn along(side: &'s Side, growth: [[f64; 2]; 2]) -> Option<Self> {
        let mut walk = Self { side, growth, spans: Vec::new() };
        for (index, [from, to]) in side.panels().enumerate() {
            walk.spans.push(walk.span(from, to, Some(index)));
        }
        let mut from = walk.spans.last().map_or(0.0, |span| span.to);
        let mut open = !side.ends_with_tables();
        for _ in 0..BEYOND {
            // Close to an end of the support, distances to it have lost their digits.
            if !open || side.is_at_its_end(from) {
                break;
            }
            let to = from + side.reach(from);
            let span = walk.span(from, to, None);
            let all = walk.all();
            let nothing = |index: usize| span.weighted[index].abs() <= NOTHING * all[index].abs();
            open = to > from && !(nothing(0) && nothing(1));
            walk.spans.push(span);
            from = to;
        }
        (!open).then_some(walk)
    }

    /// Integral of `u' M` over the whole side.
    pub(super) fn all(&self) -> Slopes {
        sum(self.spans.iter().map(|span| span.weighted))
    }

    /// Derivatives of the mass beyond a distance from the anchor.
    pub(super) fn beyond(&self, distance: f64, mean: Slopes) -> Slopes {
        let index = self.spans.partition_point(|span| span.to <= distance);
        let Some(at) = self.spans.get(index) else { return [0.0; 2] };
        let tabled = (index < self.side.panels().len()).then_some(index);
        let rest = self.span(distance.max(at.from), at.to, tabled);
        let before = sum(self.spans[..index].iter().map(|span| span.own));
        let after = sum(self.spans[index + 1..].iter().map(|span| span.weighted));
        let mass = self.side.mass_beyond(distance);
        std::array::from_fn(|i| (before[i] + at.own[i] - rest.own[i] - mean[i]) * mass + rest.weighted[i] + after[i])
    }

    /// Integrals from one distance to another. `panel` is the panel of the tables that holds both, if any: its mass is tabulated.
    fn span(&self, from: f64, to: f64, panel: Option<usize>) -> Span {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let (mut own, mut weighted) = ([0.0; 2], [0.0; 2]);
        for (x, weight) in LEGENDRE.iter().flat_map(|&(x, weight)| [(x, weight), (-x, weight)]) {
            let distance = middle + half * x;
            let rate = self.side.rate(distance, self.growth);
            let mass = match panel {
                Some(index) => self.side.mass_in_panel(index, distance),
                None => self.side.mass_beyond(distance),
            };
            for index in 0..2 {
                own[index] += half * weight * rate[index];
                weighted[index] += half * weight * rate[index] * mass;
            }
        }
        Span { from, to, own, weighted }
    }
}

fn sum(all: impl Iterator<Item = Slopes>) -> Slopes {
    all.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]])
}

#[cfg(test)]
mod tests {
    use crate::pearson::Pearson;

    /// Reference: differences of the probabilities, which other tests compare with 25 digits. Extrapolated from two steps, they have an
    /// error of `h^4` times a fifth derivative near 1e3, and of `1e-13/h` by rounding.
    #[test]
    fn slopes_are_the_differences_of_probabilities() {
        let step = 1e-3;
        // Types I to VII, both signs of the skewness, and places close to the lines between types.
        let places = [
            [0.0, 0.0],
            [0.0, -0.6],
            [0.0, 1.5],
            [0.3, -0.2],
            [0.5, 0.375],
            [-0.5, 0.37],
            [0.02, 0.001],
            [-0.4, 0.5],
            [0.6, 0.55],
            [1.0, 2.0],
            [0.7, 2.5],
        ];
        for [skewness, excess] in places {
            let law = |by: [f64; 2]| Pearson::with_excess(0.0, 1.0, skewness + by[0], excess + by[1]).unwrap();
            for [lower, upper] in [[Some(-2.8), Some(3.1)], [Some(-0.4), None], [None, Some(-0.2)], [None, Some(4.5)]] {
                let found = law([0.0; 2]).outside_by_shape(lower, upper).unwrap();
                let outside = |by: [f64; 2]| {
                    let law = law(by);
                    lower.map_or(0.0, |x| law.cdf(x)) + upper.map_or(0.0, |x| law.sf(x))
                };
                for (index, found) in found.into_iter().enumerate() {
                    let difference = |h: f64| {
                        let by = |h: f64| if index == 0 { [h, 0.0] } else { [0.0, h] };
                        (outside(by(h)) - outside(by(-h))) / (2.0 * h)
                    };
                    let expected = (4.0 * difference(0.5 * step) - difference(step)) / 3.0;
                    let off = (found - expected).abs();
                    assert!(off <= 2e-9, "{skewness}, {excess}, {lower:?}, {upper:?}: {found} and {expected}");
                }
            }
        }
    }

    /// A density that is infinite at the end of its support has no such derivative there.
    #[test]
    fn a_law_of_two_horns_has_none() {
        let law = Pearson::with_excess(0.0, 1.0, 0.0, -1.8).unwrap();
        assert_eq!(law.outside_by_shape(Some(-0.9), None), None);
    }
}
