//! Magnitudes of the terms of a formula, which rounding errors are proportional to.
//!
//! ```text
//! terms(x) = |x|          terms(f(a, b)) = |df/da| terms(a) + |df/db| terms(b), |f(a, b)| at the least
//! ```
//!
//! Errors of `n` operations are at most `n epsilon` times the magnitude, to first order. For example, `100.01 - 100` has the magnitude
//! 200.01 and the value 0.01. Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms (2002), section 3.3, running error
//! analysis.

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::jet::Jet;
use crate::assembly::formula::scalar::{Scalar, Verdict};
use crate::assembly::formula::set::FormulaSet;

/// Value with the sum of the magnitudes of its terms.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Magnitude {
    value: f64,
    terms: f64,
}

impl Magnitude {
    fn of(value: f64) -> Self {
        Self { value, terms: value.abs() }
    }

    /// Returns the magnitude of an operand in the result. A derivative that does not exist, at a kink or a jump, counts as 1.
    fn through(&self, jet: &Jet, direction: usize) -> f64 {
        jet.first(direction).map_or(1.0, f64::abs) * self.terms
    }
}

impl Scalar for Magnitude {
    fn constant(value: f64) -> Self {
        Self::of(value)
    }

    fn unary(function: Unary, a: &Self) -> Self {
        let jet = Jet::unary(function, &Jet::variable(a.value, [1.0, 0.0]));
        Self { value: jet.value(), terms: a.through(&jet, 0).max(jet.value().abs()) }
    }

    fn binary(function: Binary, a: &Self, b: &Self) -> Self {
        let jet = Jet::binary(function, &Jet::variable(a.value, [1.0, 0.0]), &Jet::variable(b.value, [0.0, 1.0]));
        let terms = a.through(&jet, 0) + b.through(&jet, 1);
        Self { value: jet.value(), terms: terms.max(jet.value().abs()) }
    }

    fn verdict(&self) -> Verdict {
        self.value.verdict()
    }

    fn join(condition: &Self, then: Self, otherwise: Self) -> Self {
        if condition.value != 0.0 { then } else { otherwise }
    }
}

impl FormulaSet {
    /// Returns the sums of the magnitudes of the terms of some formulas at one point. They are NaN or infinite if a formula has no value.
    ///
    /// Cost: about twenty evaluations.
    pub(crate) fn magnitudes(&self, formulas: &[usize], variable: impl Fn(usize) -> f64) -> Vec<f64> {
        let of = |index: usize| Magnitude::of(variable(index));
        let found = self.evaluate_scalar(formulas, of).into_iter();
        found.map(|one| if one.value.is_finite() { one.terms } else { f64::NAN }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::formula::Formula;
    use crate::assembly::formula::set::Meaning;

    fn terms(formula: &str, x: [f64; 2]) -> f64 {
        let formulas = vec![("y".to_owned(), Formula::parse(formula).unwrap())];
        let set = FormulaSet::new(formulas, [("a", Meaning::Variable(0)), ("b", Meaning::Variable(1))]).unwrap();
        set.magnitudes(&[0], |index| x[index])[0]
    }

    #[test]
    fn terms_of_sums_and_differences_add_up() {
        assert_eq!(terms("a - b", [100.0, 99.0]), 199.0);
        assert_eq!(terms("a + 3*b - 2", [1.0, -2.0]), 1.0 + 6.0 + 6.0 + 2.0);
        assert_eq!(terms("(a + 1000) - 1000", [0.5, 0.0]), 2000.5);
    }

    /// A product has the terms of both factors. A root has half of those of its argument, but at least its own size.
    #[test]
    fn terms_go_through_functions_by_their_slopes() {
        assert_eq!(terms("a*b", [3.0, 4.0]), 24.0);
        assert_eq!(terms("sqrt(a - b)", [10_001.0, 10_000.0]), 20_001.0 / 2.0);
        assert_eq!(terms("sqrt(a)", [4.0, 0.0]), 2.0);
        assert_eq!(terms("abs(a)", [0.0, 1.0]), 0.0);
        assert_eq!(terms("if(a > b, a - b, b - a)", [7.0, 4.0]), 11.0);
        assert!(terms("sqrt(a)", [-1.0, 0.0]).is_nan());
    }
}
