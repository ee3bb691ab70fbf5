//! Expansion of formulas into polynomials, term by term.

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::graph::{GraphNode, NodeId};
use crate::assembly::formula::set::FormulaSet;
use crate::assembly::polynomial::{Coefficient, DEGREE, Polynomial};

impl FormulaSet {
    /// Returns a formula as a polynomial in its variables, whose polynomials `variable` gives. Returns None if it is not a polynomial
    /// ([`degree`](Self::degree)), beyond the fourth degree, or if it has too many terms.
    ///
    /// Cost: one pass over the operations, and the products of terms.
    pub(crate) fn polynomial(
        &self,
        formula: usize,
        variable: &dyn Fn(usize) -> Option<Polynomial>,
    ) -> Option<Polynomial> {
        let root = self.roots[formula];
        let nodes = &self.graph.nodes()[..=root as usize];
        let needed = self.graph.needed([root]);
        // The last operation that uses a node takes its terms without a copy, so that sums grow in place.
        let mut uses = vec![0u32; nodes.len()];
        let operands = nodes.iter().enumerate().filter(|(id, _)| needed[*id]).flat_map(|(_, node)| node.operands());
        operands.for_each(|operand| uses[operand as usize] += 1);
        let mut known: Vec<Option<Polynomial>> = vec![None; nodes.len()];
        for (id, &node) in nodes.iter().enumerate().filter(|(id, _)| needed[*id]) {
            let mut take = |operand: NodeId| {
                let place = operand as usize;
                uses[place] -= 1;
                if uses[place] == 0 { known[place].take() } else { known[place].clone() }
            };
            let expanded = match node {
                GraphNode::Constant(bits) => Some(Polynomial::constant(f64::from_bits(bits))),
                GraphNode::Variable(index) => variable(index),
                GraphNode::Unary(function, a) => take(a).and_then(|a| unary(function, a)),
                GraphNode::Binary(function, a, b) => {
                    let (a, b) = (take(a), take(b));
                    a.zip(b).and_then(|(a, b)| binary(function, a, b))
                }
                GraphNode::If(condition, then, otherwise) => {
                    let (condition, then, otherwise) = (take(condition), take(then), take(otherwise));
                    match condition.and_then(|of| of.as_constant()) {
                        Some(Coefficient { value: 0.0, error: 0.0 }) => otherwise,
                        Some(of) if of.value.abs() > of.error => then,
                        _ => None,
                    }
                }
            };
            known[id] = expanded;
        }
        let found = known[root as usize].take()?;
        let finite = found.terms().all(|(_, of)| of.value.is_finite() && of.error.is_finite());
        finite.then_some(found)
    }
}

fn unary(function: Unary, a: Polynomial) -> Option<Polynomial> {
    match a.as_constant() {
        Some(of) => Some(applied(of, &|value| function.apply(value))),
        None if function == Unary::Negate => Polynomial::default().plus(a, -1.0),
        None => None,
    }
}

fn binary(function: Binary, a: Polynomial, b: Polynomial) -> Option<Polynomial> {
    match (function, a.as_constant(), b.as_constant()) {
        (Binary::Add, ..) => a.plus(b, 1.0),
        (Binary::Subtract, ..) => a.plus(b, -1.0),
        (Binary::Multiply, ..) => a.times(&b),
        (Binary::Divide, _, Some(divisor)) => Some(a.over(divisor)),
        (Binary::Power, None, Some(exponent)) => power(&a, exponent.value),
        (_, Some(of), Some(with)) => {
            let by_first = applied(of, &|value| function.apply(value, with.value)).as_constant()?;
            let by_second = applied(with, &|value| function.apply(of.value, value)).as_constant()?;
            let error = by_first.error + by_second.error;
            Some(Polynomial::of_coefficient(Coefficient { error, ..by_first }))
        }
        _ => None,
    }
}

/// Returns a whole power up to the highest degree.
fn power(base: &Polynomial, exponent: f64) -> Option<Polynomial> {
    let whole = (0..=DEGREE).find(|&whole| whole as f64 == exponent)?;
    (0..whole).try_fold(Polynomial::constant(1.0), |product, _| product.times(base))
}

/// Returns a function of a number. The error combines that of the number and one rounding.
fn applied(of: Coefficient, function: &dyn Fn(f64) -> f64) -> Polynomial {
    let value = function(of.value);
    let off = [of.value - of.error, of.value + of.error].map(|at| (function(at) - value).abs());
    let error = off[0].max(off[1]) + f64::EPSILON * value.abs();
    Polynomial::of_coefficient(Coefficient { value, error })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::formula::{Formula, Meaning};

    /// Returns the terms of a formula in `x ~ 2 + 3 u0` and `y ~ -1 + 0.5 u1`, with `k` = 4 fixed.
    fn terms(text: &str) -> Option<Vec<(Vec<u32>, f64)>> {
        let formula = Formula::parse(text).unwrap();
        let names = [("x", Meaning::Variable(0)), ("y", Meaning::Variable(1)), ("k", Meaning::Variable(2))];
        let set = FormulaSet::new(vec![("result".to_owned(), formula)], names).unwrap();
        let inputs = [(2.0, 3.0), (-1.0, 0.5), (4.0, 0.0)];
        let variable = |index: usize| Some(Polynomial::input(index, inputs[index].0, inputs[index].1));
        let found = set.polynomial(0, &variable)?;
        let terms = found.terms().filter(|(_, of)| of.value != 0.0);
        Some(terms.map(|(inputs, of)| (inputs.to_vec(), of.value)).collect())
    }

    /// Expected terms were computed by hand: `x y = -2 + u0 - 3 u0 + ...` with the means 2 and -1.
    #[test]
    fn expansions_by_hand() {
        let product = vec![(vec![0, 1], 1.5), (vec![0], -3.0), (vec![1], 1.0), (vec![], -2.0)];
        assert_eq!(terms("x*y"), Some(product));
        assert_eq!(terms("(x - 2)^4/sqrt(k)"), Some(vec![(vec![0; 4], 40.5)]));
        assert_eq!(terms("-(x - 2)*(y + 1)^2"), Some(vec![(vec![0, 1, 1], -0.75)]));
        assert_eq!(terms("if(k > 3, x, exp(x)) - 2"), Some(vec![(vec![0], 3.0)]));
        assert_eq!(terms("if(k > 5, x, y) + 1"), Some(vec![(vec![1], 0.5)]));
        assert_eq!(terms("max(k, 3) + hypot(k, 3)"), Some(vec![(vec![], 9.0)]));
    }

    #[test]
    fn anything_else_is_none() {
        for text in
            ["x/y", "sqrt(x)", "abs(x)", "x^5", "x^-1", "x^0.5", "2^x", "x < y", "x^3*y^2", "k/(k - 4)", "if(x, x, y)"]
        {
            assert_eq!(terms(text), None, "{text}");
        }
    }
}
