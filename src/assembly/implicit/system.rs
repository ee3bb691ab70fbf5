//! Conditions as functions that can be evaluated and differentiated.

use faer::Mat;

use crate::assembly::formula::{Binary, FormulaFailure, FormulaSet, Jet, Routine, Scalar, Unary};
use crate::assembly::implicit::conditions::{Condition, Conditions, Unknown};
use crate::assembly::implicit::subject::{EquationSubject, OpenJoint};

/// System of `m` conditions on `m` unknowns. The variables of the formulas are the given ones, followed by the unknowns.
pub(super) struct System {
    pub(super) unknowns: Vec<Unknown>,
    pub(super) equations: Vec<String>,
    /// Joint of rigid parts that each equation belongs to.
    pub(super) subjects: Vec<Option<EquationSubject>>,
    pub(super) conditions: Vec<Kind>,
    routine: Routine,
    /// Indices in the set of the formulas of the routine.
    pub(super) formulas: Vec<usize>,
    /// Number of given variables. The indices of the unknowns follow.
    pub(super) given: usize,
    /// Given variables that the conditions depend on, ascending.
    pub(super) uses: Vec<usize>,
}

/// Number of values of the routine in a condition: one for an equation, twice the number of links for a loop.
pub(super) enum Kind {
    Equation,
    Loop { links: usize },
}

/// Size of the terms of every equation, and a significant move of every unknown.
#[derive(Debug, Clone)]
pub(super) struct Scales {
    pub(super) equations: Vec<f64>,
    pub(super) unknowns: Vec<f64>,
}

/// Terms of an equation that count as 0, as part of the effect of one unit of the unknowns. Rounding leaves 1e-16 where an angle is 0.
const ROUNDING: f64 = 1e-14;
/// Step of a difference that replaces a missing derivative, relative to the unknown's scale.
const STEP: f64 = 1e-7;

impl System {
    /// Creates the system of conditions whose formulas are in `set` from `first` on, with the unknowns as variables after the `given` ones.
    pub(super) fn new(conditions: &Conditions, set: &FormulaSet, first: usize, given: usize) -> Self {
        let kinds = conditions.conditions.iter().map(|condition| match condition {
            Condition::Equation { .. } => Kind::Equation,
            Condition::Loop { links, .. } => Kind::Loop { links: links.len() },
        });
        let formulas: Vec<usize> = (first..set.len()).collect();
        let mut uses: Vec<usize> =
            formulas.iter().flat_map(|&formula| set.variables(formula).iter().copied()).collect();
        uses.retain(|&variable| variable < given);
        uses.sort_unstable();
        uses.dedup();
        Self {
            unknowns: conditions.unknowns.clone(),
            equations: conditions.conditions.iter().flat_map(Condition::equations).collect(),
            subjects: conditions.subjects(),
            conditions: kinds.collect(),
            routine: set.routine(&formulas),
            formulas,
            given,
            uses,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.unknowns.len()
    }

    /// Returns the value of every equation. `room` keeps memory from one call to the next.
    pub(super) fn residuals<S: Scalar>(&self, variable: &impl Fn(usize) -> S, room: &mut Vec<S>) -> Vec<S> {
        let values = self.routine.run(variable, room);
        let mut values = values.chunks(1);
        let mut next = move || values.next().expect("a value for every formula")[0].clone();
        let mut residuals = Vec::with_capacity(self.len());
        for kind in &self.conditions {
            match kind {
                Kind::Equation => residuals.push(next()),
                Kind::Loop { links } => {
                    let mut sums = [Unary::Cos, Unary::Sin].map(|_| S::constant(0.0));
                    for _ in 0..*links {
                        let (length, angle) = (next(), next());
                        for (sum, function) in sums.iter_mut().zip([Unary::Cos, Unary::Sin]) {
                            let part = S::binary(Binary::Multiply, &length, &S::unary(function, &angle));
                            *sum = S::binary(Binary::Add, sum, &part);
                        }
                    }
                    residuals.extend(sums);
                }
            }
        }
        residuals
    }

    /// Returns the values of the equations at a state.
    pub(super) fn values(&self, given: &[f64], u: &[f64]) -> Vec<f64> {
        self.residuals(&|index: usize| self.variable(given, u, index), &mut Vec::new())
    }

    fn variable(&self, given: &[f64], u: &[f64], index: usize) -> f64 {
        index.checked_sub(self.given).map_or_else(|| given[index], |unknown| u[unknown])
    }

    /// Returns the derivatives of the equations by each of these variables at a state, NaN if one does not exist.
    pub(super) fn derivatives(&self, given: &[f64], u: &[f64], by: &[usize]) -> Mat<f64> {
        let mut derivatives = Mat::zeros(self.len(), by.len());
        let mut room = Vec::new();
        // A jet has two directions, so that one run gives two columns.
        for (pair, directions) in by.chunks(2).enumerate() {
            let seed = |index: usize| {
                let along = [0, 1].map(|d| f64::from(u8::from(directions.get(d) == Some(&index))));
                Jet::variable(self.variable(given, u, index), along)
            };
            for (row, jet) in self.residuals(&seed, &mut room).iter().enumerate() {
                for d in 0..directions.len() {
                    derivatives[(row, 2 * pair + d)] = jet.first(d).unwrap_or(f64::NAN);
                }
            }
        }
        derivatives
    }

    /// Returns the derivatives by the unknowns. At a kink a difference replaces the missing derivative.
    pub(super) fn jacobian(&self, given: &[f64], u: &[f64], scales: &Scales) -> Mat<f64> {
        let unknowns: Vec<usize> = (self.given..self.given + self.len()).collect();
        let mut jacobian = self.derivatives(given, u, &unknowns);
        for j in 0..self.len() {
            if (0..self.len()).all(|i| jacobian[(i, j)].is_finite()) {
                continue;
            }
            let step = STEP * scales.unknowns[j];
            let moved = |sign: f64| {
                let mut moved = u.to_vec();
                moved[j] += sign * step;
                self.values(given, &moved)
            };
            let (up, down) = (moved(1.0), moved(-1.0));
            for i in (0..self.len()).filter(|&i| !jacobian[(i, j)].is_finite()).collect::<Vec<_>>() {
                jacobian[(i, j)] = (up[i] - down[i]) / (2.0 * step);
            }
        }
        jacobian
    }

    /// Returns the derivatives by each of these variables at a state, with differences in place of those that do not exist. A kink at the
    /// nominal state leaves the scales as they are beside it.
    fn slopes(&self, given: &[f64], u: &[f64], by: &[usize]) -> Mat<f64> {
        let mut slopes = self.derivatives(given, u, by);
        for (column, &index) in by.iter().enumerate() {
            if (0..self.len()).all(|row| slopes[(row, column)].is_finite()) {
                continue;
            }
            // No scale is found yet: a variable moves by a part of its value, and of 1 if it is small.
            let step = STEP * self.variable(given, u, index).abs().max(1.0);
            let moved = |by: f64| {
                let (mut given, mut u) = (given.to_vec(), u.to_vec());
                match index.checked_sub(self.given) {
                    None => given[index] += by,
                    Some(unknown) => u[unknown] += by,
                }
                self.values(&given, &u)
            };
            let (up, down) = (moved(step), moved(-step));
            for row in 0..self.len() {
                if !slopes[(row, column)].is_finite() {
                    slopes[(row, column)] = (up[row] - down[row]) / (2.0 * step);
                }
            }
        }
        slopes
    }

    /// Returns the distance that an unknown may move before its curvature counts as much as its slope.
    fn bend(&self, given: &[f64], u: &[f64], unknown: usize, equations: &[f64]) -> f64 {
        let along = |index: usize| [f64::from(u8::from(index == self.given + unknown)); 2];
        let seed = |index: usize| Jet::variable(self.variable(given, u, index), along(index));
        let jets = self.residuals(&seed, &mut Vec::new());
        let largest = |of: fn(&Jet) -> Option<f64>| {
            let parts = jets.iter().zip(equations).filter_map(|(jet, size)| Some((of(jet)? / size).abs()));
            parts.fold(0.0, f64::max)
        };
        let reach = largest(|jet| jet.first(0)) / largest(Jet::second);
        if reach > 0.0 { reach } else { f64::INFINITY }
    }

    /// Returns the scales at a state. The scale of a loop is the sum of its lengths, that of an equation its first-order change by all
    /// variables. The scale of an unknown is the move that changes an equation by its scale, or from which the curvature dominates.
    pub(super) fn scales(&self, given: &[f64], u: &[f64]) -> Scales {
        let all: Vec<usize> = self.uses.iter().copied().chain(self.given..self.given + self.len()).collect();
        let derivatives = self.slopes(given, u, &all);
        let finite = |value: f64| if value.is_finite() { value.abs() } else { 0.0 };
        let mut equations: Vec<f64> = (0..self.len())
            .map(|i| {
                let term = |(k, &index): (usize, &usize)| finite(derivatives[(i, k)] * self.variable(given, u, index));
                all.iter().enumerate().map(term).sum()
            })
            .collect();
        let lengths = self.routine.run(&|index: usize| self.variable(given, u, index), &mut Vec::new());
        let (mut row, mut value) = (0, 0);
        for kind in &self.conditions {
            match kind {
                Kind::Equation => (row, value) = (row + 1, value + 1),
                Kind::Loop { links } => {
                    let size: f64 = (0..*links).map(|link| finite(lengths[value + 2 * link])).sum();
                    equations[row..row + 2].fill(size);
                    (row, value) = (row + 2, value + 2 * links);
                }
            }
        }
        let slope = |i: usize, j: usize| finite(derivatives[(i, self.uses.len() + j)]);
        for (i, size) in equations.iter_mut().enumerate() {
            // All terms are 0 here, but for rounding: the effect of one unit of the unknowns is the scale.
            let unit = (0..self.len()).map(|j| slope(i, j)).fold(0.0, f64::max);
            if *size <= ROUNDING * unit {
                *size = unit;
            }
            if *size == 0.0 {
                *size = 1.0;
            }
        }
        let unknowns = (0..self.len())
            .map(|j| {
                let reach = (0..self.len()).filter(|&i| slope(i, j) > 0.0).map(|i| equations[i] / slope(i, j));
                let reach: f64 = reach.fold(f64::INFINITY, f64::min);
                let [lower, upper] = self.unknowns[j].bounds();
                let reach = reach.min(self.bend(given, u, j, &equations)).min(upper - lower);
                if reach.is_finite() { reach } else { u[j].abs().max(1.0) }
            })
            .collect();
        Scales { equations, unknowns }
    }

    /// Returns the failure of the first equation that has no value at a state.
    pub(super) fn explain(&self, set: &FormulaSet, given: &[f64], u: &[f64]) -> Option<FormulaFailure> {
        self.formulas.iter().find_map(|&formula| set.explain(formula, |index| self.variable(given, u, index)))
    }

    /// Returns an equation in words: the joint that it belongs to, or its name.
    pub(super) fn words(&self, equation: usize) -> String {
        self.subjects[equation].as_ref().map_or_else(|| self.equations[equation].clone(), ToString::to_string)
    }

    /// Returns the joint of rigid parts that is open most at a state, with the amount, if `worst` belongs to a joint. Scales differ between
    /// the equations of joints, so amounts are compared as lengths: a direction by the size of the state.
    pub(super) fn open_joint(
        &self,
        set: &FormulaSet,
        (given, u): (&[f64], &[f64]),
        values: &[f64],
        worst: usize,
    ) -> Option<OpenJoint> {
        self.subjects[worst].as_ref()?;
        let size = u.iter().fold(1.0, |size: f64, value| size.max(value.abs()));
        let amount = |equation: usize| match &self.subjects[equation] {
            None => 0.0,
            Some(subject) => values[equation].abs() * if subject.is_direction() { size } else { 1.0 },
        };
        let equation = (0..values.len()).max_by(|&a, &b| amount(a).total_cmp(&amount(b)))?;
        let subject = self.subjects[equation].clone()?;
        let lengths = match subject {
            EquationSubject::Rod { .. } => {
                set.difference(self.formula_of(equation)?, |index| self.variable(given, u, index))
            }
            EquationSubject::Joint { .. } => None,
        };
        Some(OpenJoint { subject, residual: values[equation], lengths })
    }

    /// Returns the first formula of an equation. A loop has two equations, and two formulas for every link.
    fn formula_of(&self, equation: usize) -> Option<usize> {
        let (mut first, mut formula) = (0, 0);
        for kind in &self.conditions {
            if first == equation {
                break;
            }
            let [equations, formulas] = match kind {
                Kind::Equation => [1, 1],
                Kind::Loop { links } => [2, 2 * links],
            };
            (first, formula) = (first + equations, formula + formulas);
        }
        self.formulas.get(formula).copied()
    }

    /// Returns a state with the names of the unknowns.
    pub(super) fn named(&self, u: &[f64]) -> Vec<(String, f64)> {
        self.unknowns.iter().zip(u).map(|(unknown, &value)| (unknown.name().to_owned(), value)).collect()
    }
}
