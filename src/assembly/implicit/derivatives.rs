//! Exact first and second derivatives of the unknowns, by the implicit function theorem.

use crate::assembly::formula::{FormulaSet, Jet};
use crate::assembly::implicit::anchor::Anchor;
use crate::assembly::implicit::assembler::Assembler;
use crate::assembly::implicit::linear::Linear;
use crate::assembly::implicit::newton::Search;
use crate::assembly::implicit::system::Kind;

/// Unknowns at a point, with the factorised Jacobian for their derivatives.
pub(in crate::assembly) struct Tangent<'a> {
    assembler: &'a Assembler,
    anchor: &'a Anchor,
    given: &'a [f64],
    u: Vec<f64>,
    linear: Linear,
}

/// Output whose derivatives depend on the unknowns.
#[derive(Debug, Clone, Copy)]
pub(in crate::assembly) enum ImplicitOutput {
    /// Formula of this index in the set.
    Formula(usize),
    /// Unknown of this index.
    Unknown(usize),
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

    /// Returns the mixed derivatives of every output by these pairs of given variables. An output is a formula of the set or an unknown.
    /// Returns None if a derivative may not exist, and for loops.
    ///
    /// Second derivatives of an output `y` by its multipliers `lambda = J^-T y_u`. They are those of `y - lambda g` along the moves of the
    /// given variables and the unknowns (Lagrange). One pass a variable gives the products with all others.
    ///
    /// # Cost
    /// One solution for every variable and output, and about 12 products for every operation, variable and output.
    pub(in crate::assembly) fn mixed(
        &self,
        set: &FormulaSet,
        outputs: &[ImplicitOutput],
        pairs: &[(usize, usize)],
    ) -> Option<Vec<Vec<f64>>> {
        let system = &self.assembler.system;
        if !system.conditions.iter().all(|kind| matches!(kind, Kind::Equation)) {
            return None;
        }
        let formula = |output: &ImplicitOutput| match output {
            ImplicitOutput::Formula(formula) => Some(*formula),
            ImplicitOutput::Unknown(_) => None,
        };
        let formulas: Vec<usize> = outputs.iter().filter_map(formula).chain(system.formulas.iter().copied()).collect();
        let at: Vec<f64> = self.given.iter().chain(&self.u).copied().collect();
        let tape = set.tape(&formulas, &at)?;
        let (place_of, directions) = self.directions(pairs)?;
        let along: Vec<&[f64]> = directions.iter().map(Vec::as_slice).collect();
        let mut found = Vec::with_capacity(outputs.len());
        let mut next = 0;
        for output in outputs {
            let mut weights = vec![0.0; formulas.len()];
            let by_unknowns = match output {
                ImplicitOutput::Formula(_) => {
                    weights[next] = 1.0;
                    next += 1;
                    tape.gradient(&weights)?.split_off(self.given.len())
                }
                ImplicitOutput::Unknown(unknown) => {
                    (0..self.u.len()).map(|j| f64::from(u8::from(j == *unknown))).collect()
                }
            };
            let first = formulas.len() - system.formulas.len();
            let multipliers = self.multipliers(&by_unknowns)?;
            weights[first..].iter_mut().zip(multipliers).for_each(|(weight, multiplier)| *weight = -multiplier);
            let curvatures = tape.curvatures(&weights, &along)?;
            let of_pair = |&(j, k): &(usize, usize)| -> f64 {
                let (curvature, direction) = (&curvatures[place_of[j]], &directions[place_of[k]]);
                curvature.iter().zip(direction).map(|(a, b)| a * b).sum()
            };
            found.push(pairs.iter().map(of_pair).collect());
        }
        Some(found)
    }

    /// Returns the moves of all given variables and unknowns with each variable of the pairs, and the place of each variable among them.
    fn directions(&self, pairs: &[(usize, usize)]) -> Option<(Vec<usize>, Vec<Vec<f64>>)> {
        let (given, system) = (self.given.len(), &self.assembler.system);
        let mut variables: Vec<usize> = pairs.iter().flat_map(|&(j, k)| [j, k]).collect();
        variables.sort_unstable();
        variables.dedup();
        let mut place_of = vec![0; given];
        variables.iter().enumerate().for_each(|(place, &variable)| place_of[variable] = place);
        let by = system.derivatives(self.given, &self.u, &variables);
        let mut directions = Vec::with_capacity(variables.len());
        for (place, &variable) in variables.iter().enumerate() {
            let column: Vec<Option<f64>> =
                (0..system.len()).map(|i| Some(by[(i, place)]).filter(|slope| slope.is_finite())).collect();
            let mut direction = vec![0.0; given];
            direction[variable] = 1.0;
            match column.iter().all(|slope| *slope == Some(0.0)) {
                true => direction.resize(given + self.u.len(), 0.0),
                false => direction.extend(self.solved(&column)),
            }
            directions.push(direction);
        }
        directions.iter().flatten().all(|part| part.is_finite()).then_some((place_of, directions))
    }

    /// Returns `J^-T` of derivatives by the unknowns.
    fn multipliers(&self, by_unknowns: &[f64]) -> Option<Vec<f64>> {
        let scales = &self.anchor.scales;
        let right: Vec<f64> = by_unknowns.iter().zip(&scales.unknowns).map(|(slope, scale)| slope * scale).collect();
        let scaled = self.linear.solve_transposed(&right)?;
        Some(scaled.iter().zip(&scales.equations).map(|(multiplier, size)| multiplier / size).collect())
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
