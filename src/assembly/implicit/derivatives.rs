//! Exact first and second derivatives of the unknowns, by the implicit function theorem.

use crate::assembly::formula::{FormulaSet, Jet};
use crate::assembly::implicit::anchor::Anchor;
use crate::assembly::implicit::assembler::Assembler;
use crate::assembly::implicit::linear::Linear;
use crate::assembly::implicit::newton::Search;

/// Unknowns at a point, with the factorised Jacobian for their derivatives.
pub(in crate::assembly) struct Tangent<'a> {
    assembler: &'a Assembler,
    anchor: &'a Anchor,
    given: &'a [f64],
    u: Vec<f64>,
    linear: Linear,
}

impl Assembler {
    /// Returns the unknowns at a point, to be differentiated. Returns None if they are not determined there or have a kink.
    pub(in crate::assembly) fn tangent<'a>(
        &'a self,
        set: &FormulaSet,
        anchor: &'a Anchor,
        given: &'a [f64],
    ) -> Option<Tangent<'a>> {
        let u = self.solve(set, anchor, given).ok()?;
        let unknowns: Vec<usize> = (given.len()..given.len() + self.len()).collect();
        let exact = self.system.derivatives(given, &u, &unknowns);
        if !(0..self.len()).all(|i| (0..self.len()).all(|j| exact[(i, j)].is_finite())) {
            return None;
        }
        let linear = Search { system: &self.system, scales: &anchor.scales, given }.linear(&u)?;
        Some(Tangent { assembler: self, anchor, given, u, linear })
    }
}

impl Tangent<'_> {
    /// Returns every unknown along two directions. `along` gives the part of every given variable.
    pub(in crate::assembly) fn jets(&self, along: &dyn Fn(usize) -> [f64; 2]) -> Vec<Jet> {
        let first = |direction: usize, jets: &[Jet]| {
            self.solved(&jets.iter().map(|jet| jet.first(direction)).collect::<Vec<_>>())
        };
        let still: Vec<Jet> = self.u.iter().map(|&u| Jet::variable(u, [0.0; 2])).collect();
        if self.assembler.uses().iter().all(|&index| along(index) == [0.0; 2]) {
            return still;
        }
        // With unknowns at rest, the residuals give the right side of the first derivatives.
        let residuals = self.residuals(along, &still);
        let first = [0, 1].map(|direction| first(direction, &residuals));
        let moving = |j: usize| Jet::variable(self.u[j], [first[0][j], first[1][j]]);
        let moving: Vec<Jet> = (0..self.u.len()).map(moving).collect();
        // With unknowns moving at these rates, the residuals give the right side of the second derivatives.
        let residuals = self.residuals(along, &moving);
        let second = self.solved(&residuals.iter().map(Jet::second).collect::<Vec<_>>());
        (0..self.u.len()).map(|j| Jet::known(self.u[j], [first[0][j], first[1][j]], second[j])).collect()
    }

    fn residuals(&self, along: &dyn Fn(usize) -> [f64; 2], unknowns: &[Jet]) -> Vec<Jet> {
        let variable = |index: usize| match index.checked_sub(self.given.len()) {
            None => Jet::variable(self.given[index], along(index)),
            Some(unknown) => unknowns[unknown],
        };
        self.assembler.system.residuals(&variable, &mut Vec::new())
    }

    /// Returns `-J^-1` of a column, NaN if any part of the column does not exist.
    fn solved(&self, column: &[Option<f64>]) -> Vec<f64> {
        let scales = &self.anchor.scales;
        let right: Option<Vec<f64>> =
            column.iter().zip(&scales.equations).map(|(value, size)| Some(-(*value)? / size)).collect();
        match right {
            None => vec![f64::NAN; column.len()],
            Some(right) => {
                let step = self.linear.solve(&right);
                step.iter().zip(&scales.unknowns).map(|(step, scale)| step * scale).collect()
            }
        }
    }
}
