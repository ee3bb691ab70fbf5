//! The conditions as functions that can be evaluated and differentiated.

use faer::Mat;

use super::conditions::{Condition, Conditions, Unknown};
use crate::assembly::formula::{Binary, FormulaFailure, FormulaSet, Jet, Routine, Scalar, Unary};

/// `m` conditions on `m` unknowns. Their formulas' variables are what is given, then the unknowns.
pub(super) struct System {
    pub(super) unknowns: Vec<Unknown>,
    /// The name of every equation.
    pub(super) equations: Vec<String>,
    conditions: Vec<Kind>,
    routine: Routine,
    /// The formulas of the routine, in the set.
    formulas: Vec<usize>,
    /// How many variables are given; the unknowns' indices follow.
    given: usize,
    /// Those of them that the conditions depend on.
    pub(super) uses: Vec<usize>,
}

/// The equations that the values of the routine make: an equation of one, a loop of twice as many as it has links.
enum Kind {
    Equation,
    Loop { links: usize },
}

/// How large the terms of every equation are, and how far every unknown has to move to matter.
#[derive(Debug, Clone)]
pub(super) struct Scales {
    pub(super) equations: Vec<f64>,
    pub(super) unknowns: Vec<f64>,
}

/// A step for a derivative where the exact one does not exist, relative to the unknown's scale.
const STEP: f64 = 1e-7;

impl System {
    /// Of conditions whose formulas stand in `set` from `first` on, with the unknowns as variables after the `given` ones.
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
            conditions: kinds.collect(),
            routine: set.routine(&formulas),
            formulas,
            given,
            uses,
        }
    }

    /// Number of unknowns.
    pub(super) fn len(&self) -> usize {
        self.unknowns.len()
    }

    /// Every equation's value.
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

    /// The equations' values at a state.
    pub(super) fn values(&self, given: &[f64], u: &[f64]) -> Vec<f64> {
        self.residuals(&|index: usize| self.variable(given, u, index), &mut Vec::new())
    }

    fn variable(&self, given: &[f64], u: &[f64], index: usize) -> f64 {
        index.checked_sub(self.given).map_or_else(|| given[index], |unknown| u[unknown])
    }

    /// The derivatives of the equations by each of these variables at a state; NaN where there is none.
    pub(super) fn derivatives(&self, given: &[f64], u: &[f64], by: &[usize]) -> Mat<f64> {
        let mut derivatives = Mat::zeros(self.len(), by.len());
        let mut room = Vec::new();
        // A jet has two directions.
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

    /// The derivatives by the unknowns; at a kink a difference stands for what does not exist.
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

    /// How far an unknown may move before its curvature counts as much as its slope.
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

    /// The sizes of the terms at a state: of a loop the sum of its lengths, of an equation what its variables make of it
    /// to first order; and how far an unknown moves until it makes as much, or until a straight line says nothing of it.
    pub(super) fn scales(&self, given: &[f64], u: &[f64]) -> Scales {
        let all: Vec<usize> = self.uses.iter().copied().chain(self.given..self.given + self.len()).collect();
        let derivatives = self.derivatives(given, u, &all);
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
            if *size == 0.0 {
                // Everything is 0 here: what a unit of the unknowns makes.
                *size = (0..self.len()).map(|j| slope(i, j)).fold(0.0, f64::max);
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

    /// Why an equation has no value at a state.
    pub(super) fn explain(&self, set: &FormulaSet, given: &[f64], u: &[f64]) -> Option<FormulaFailure> {
        self.formulas.iter().find_map(|&formula| set.explain(formula, |index| self.variable(given, u, index)))
    }

    /// The state with its names.
    pub(super) fn named(&self, u: &[f64]) -> Vec<(String, f64)> {
        self.unknowns.iter().zip(u).map(|(unknown, &value)| (unknown.name().to_owned(), value)).collect()
    }
}
