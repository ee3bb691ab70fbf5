//! Error terms that vanish at every node of a dimension, so that the polynomial through the nodes cannot show them.
//!
//! Let `w(u)` be the product of `u` and `u - u_i` over the nodes. The values at the nodes do not distinguish the part `g(u)` from `g(u) +
//! (p + q u) w(u)`. The size of `p` and `q` is estimated from the known coefficients, which are assumed to decrease by the same factor from
//! each power to the next but one.
//!
//! ```text
//! two nodes     ratio = (c2/c1)^2      p = 2 c1 ratio   q = 2 c2 ratio
//! four nodes    ratio = max(|c3/c1|, |c4/c2|)    p = c3 ratio   q = c4 ratio
//! ```
//!
//! The estimate is exact for a reciprocal. For exponentials, roots and circular functions it is too large by a factor of 2 to 5. If a
//! dimension acts by its square alone, two nodes give no ratio. Half its curvature divided by the value at the means is used instead.

use sensitol_numeric::distribution::Rule;
use sensitol_numeric::moments::Term;
use sensitol_numeric::surrogate::{InputShape, Univariate};

/// Greatest ratio with two nodes. A greater one only shows that the polynomial is bad; without a slope it is infinite. `exp(c u)` has the
/// ratio `c^2/4`, and this is its value for `c = 0.45`.
const MOST: f64 = 0.05;
/// Greatest ratio with four nodes. `exp(c u)` has the ratio `c^2/6`, and this is its value for `c = 1.3`.
const MOST_OF_FOUR: f64 = 0.3;
/// Share of the curved variance that is added if all nodes of the rule are nodes of the polynomial, as for a long tail.
const LONG_TAIL: f64 = 0.2;

/// Returns the factor by which the coefficients of a part decrease, from each power to the next but one.
pub(super) fn ratio(part: &Univariate, centre: f64) -> f64 {
    let [c1, c2, c3, c4] = part.coefficients().map(f64::abs);
    let by = |a: f64, b: f64| if a == 0.0 { 0.0 } else { a / b };
    if part.degree() >= 4 {
        return by(c3, c1).max(by(c4, c2)).min(MOST_OF_FOUR);
    }
    match by(c2, c1).powi(2) {
        ratio if ratio <= MOST => ratio,
        _ => (0.5 * by(c2, centre.abs())).min(MOST),
    }
}

/// Univariate part with the terms that it may hide, and their effect on mean and variance.
pub(super) struct Hidden {
    /// Values of `g` plus the hidden terms, at the nodes of the input's rule.
    pub(super) values: Vec<f64>,
    pub(super) mean: f64,
    pub(super) variance: f64,
}

/// Estimates the terms that a part through these nodes may hide. Returns None if it is not even a parabola.
pub(super) fn hidden(part: &Univariate, nodes: &[(f64, f64)], centre: f64, shape: &InputShape) -> Option<Hidden> {
    if part.degree() < 2 {
        return None;
    }
    let ratio = ratio(part, centre);
    let [c1, c2, c3, c4] = part.coefficients();
    let [p, q] = if part.degree() >= 4 { [c3 * ratio, c4 * ratio] } else { [2.0 * c1 * ratio, 2.0 * c2 * ratio] };
    let rule: &Rule = &shape.rule;
    let value = |&u: &f64| {
        let product: f64 = nodes.iter().map(|(node, _)| u - node).product();
        part.value(u) + (p + q * u) * u * product
    };
    let values: Vec<f64> = rule.nodes.iter().map(value).collect();
    let known = part.term(shape);
    let term = Term::Tabulated { values: values.clone(), rule, moments: &shape.moments };
    let (variance, other) = (known.variance(1.0), term.variance(1.0));
    // A rule with the same nodes does not show terms that vanish there.
    let blind = part.degree() >= 4 && rule.nodes.iter().all(|u| *u == 0.0 || nodes.iter().any(|(node, _)| node == u));
    let tail = if blind { LONG_TAIL * known.part(1.0).curved } else { 0.0 };
    // Matched nodes integrate the terms that vanish at them. The power after these moves the mean.
    let sixth = if part.degree() >= 4 { c4 * ratio } else { 4.0 * c2 * ratio * ratio };
    Some(Hidden {
        mean: (term.mean() - known.mean()).abs() + 6.0 * sixth.abs(),
        variance: (other - variance).abs() + tail,
        values,
    })
}
