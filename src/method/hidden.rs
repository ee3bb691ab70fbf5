//! Terms that the polynomial through a dimension's nodes cannot show: those that vanish at all of them.
//!
//! With `w(u)` the product of `u` and `u - u_i` over the nodes, a part may as well be `g(u) + (p + q u) w(u)`. Its size is taken
//! from how fast the known coefficients fall: from one power to the next but one by the same factor.
//!
//! ```text
//! two nodes     ratio = (c2/c1)^2      p = 2 c1 ratio   q = 2 c2 ratio
//! four nodes    ratio = max(|c3/c1|, |c4/c2|)    p = c3 ratio   q = c4 ratio
//! ```
//!
//! That is exact for a reciprocal, and for exponentials, roots and circular functions it is too much by a factor of 2 to 5. Where
//! a dimension acts by its square alone, two nodes tell no ratio: half its curvature beside the value at the means stands in.

use sensitol_numeric::distribution::Rule;
use sensitol_numeric::moments::Term;
use sensitol_numeric::surrogate::{InputShape, Univariate};

/// Factors above this say only that the polynomial is bad, and without a slope they are infinite. `exp(c u)` has the factor `c^2/4` by two
/// nodes and `c^2/6` by four: these are its `c = 0.45` and `c = 1.3`.
const MOST: f64 = 0.05;
const MOST_OF_FOUR: f64 = 0.3;
/// With a rule at the nodes of a long tail: this part of what is curved.
const LONG_TAIL: f64 = 0.2;

/// How fast the powers of a part fall, from one to the next but one.
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

/// The part with what it may hide, at the nodes of the input's rule, and what that adds to its mean and its variance.
pub(super) struct Hidden {
    /// `g` and what is hidden.
    pub(super) values: Vec<f64>,
    pub(super) mean: f64,
    pub(super) variance: f64,
}

/// Of a part through these nodes; None where it is not even a parabola.
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
    // A rule at the nodes themselves sees nothing of what vanishes there.
    let blind = part.degree() >= 4 && rule.nodes.iter().all(|u| *u == 0.0 || nodes.iter().any(|(node, _)| node == u));
    let tail = if blind { LONG_TAIL * known.part(1.0).curved } else { 0.0 };
    // Matched nodes integrate what vanishes at them: the power after that moves the mean.
    let sixth = if part.degree() >= 4 { c4 * ratio } else { 4.0 * c2 * ratio * ratio };
    Some(Hidden {
        mean: (term.mean() - known.mean()).abs() + 6.0 * sixth.abs(),
        variance: (other - variance).abs() + tail,
        values,
    })
}
