//! Solution of the closure conditions at every point: on the branch of the nominal state, which every search starts from.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use faer::Mat;

use crate::assembly::SwitchKind;
use crate::assembly::formula::FormulaSet;
use crate::assembly::implicit::anchor::{Anchor, OFF, SLACK, STEPS};
use crate::assembly::implicit::batch::BatchSolver;
use crate::assembly::implicit::conditioning::ConditionNumber;
use crate::assembly::implicit::conditions::Conditions;
use crate::assembly::implicit::error::AssemblyFailure;
use crate::assembly::implicit::newton::{Root, Search, Stuck};
use crate::assembly::implicit::subject::PressedJoint;
use crate::assembly::implicit::system::System;

/// Solver of the conditions at any point, once the nominal state is known.
pub(in crate::assembly) struct Assembler {
    pub(super) system: System,
    /// Contacts of the joints that press a part.
    pub(in crate::assembly) pressed: Vec<PressedJoint>,
    /// Dimensions to which the start values belong.
    nominal: Vec<f64>,
    anchor: Mutex<Option<Result<Arc<Anchor>, Box<AssemblyFailure>>>>,
    /// Solver of many points, made when it is first requested. None if the conditions have none.
    batch: OnceLock<Option<BatchSolver>>,
}

/// Greatest distance of a followed root from its prediction, as part of a step.
const FOLLOWED: f64 = 0.5;
/// Distance of a followed root from its prediction, as part of a step, below which the next step is twice as long.
const EASY: f64 = 0.1;
/// Shortest step, as a part of the way.
const SHORTEST: f64 = 1.0 / 65536.0;
/// Greatest number of steps of a followed way.
const PARTS: usize = 1000;
/// Condition number beyond which the unknowns are not determined.
const SINGULAR: f64 = 1e10;
/// Condition number above which a nominal position causes a warning. The assembly then ends at a distance of about the square of the
/// inverse, a ten-thousandth of its size, and tolerances are of this order.
const NEARLY_SINGULAR: f64 = 100.0;

impl Assembler {
    /// Creates the solver of conditions whose formulas are in `set` from `first` on. `given` is the number of variables that are not
    /// unknowns.
    pub(in crate::assembly) fn new(conditions: &Conditions, set: &FormulaSet, first: usize, given: usize) -> Self {
        let system = System::new(conditions, set, first, given);
        Self {
            system,
            pressed: conditions.pressed.clone(),
            nominal: conditions.nominal.clone(),
            anchor: Mutex::new(None),
            batch: OnceLock::new(),
        }
    }

    pub(in crate::assembly) fn len(&self) -> usize {
        self.system.len()
    }

    /// Returns the variables that the conditions depend on, ascending.
    pub(in crate::assembly) fn uses(&self) -> &[usize] {
        &self.system.uses
    }

    pub(in crate::assembly) fn nominal(&self) -> &[f64] {
        &self.nominal
    }

    /// Returns the nominal state, which the first call seeks. `given` returns the nominal variables, or None if they are not available now.
    pub(in crate::assembly) fn anchor(
        &self,
        set: &FormulaSet,
        given: impl FnOnce() -> Option<Vec<f64>>,
    ) -> Option<Result<Arc<Anchor>, Box<AssemblyFailure>>> {
        let mut anchor = self.anchor.lock().unwrap_or_else(PoisonError::into_inner);
        if anchor.is_none() {
            *anchor = Some(self.assemble(set, given()?).map(Arc::new).map_err(Box::new));
        }
        anchor.clone()
    }

    /// Returns the nominal state, if it was sought and found.
    pub(in crate::assembly) fn known_anchor(&self) -> Option<Arc<Anchor>> {
        let anchor = self.anchor.lock().unwrap_or_else(PoisonError::into_inner);
        anchor.as_ref()?.as_ref().ok().map(Arc::clone)
    }

    /// Returns the solver of many points, or None if the conditions have none.
    pub(super) fn batch(&self, set: &FormulaSet, anchor: &Anchor) -> Option<&BatchSolver> {
        self.batch.get_or_init(|| BatchSolver::new(&self.system, set, anchor)).as_ref()
    }

    /// Finds the nominal state from the start values.
    fn assemble(&self, set: &FormulaSet, given: Vec<f64>) -> Result<Anchor, AssemblyFailure> {
        let system = &self.system;
        let start: Vec<f64> = system.unknowns.iter().map(|unknown| unknown.start()).collect();
        let begun = system.values(&given, &start);
        if let Some(failure) = system.explain(set, &given, &start) {
            return Err(failure.into());
        }
        let scales = system.scales(&given, &start);
        let search = Search { system, scales: &scales, given: &given };
        let root = search.from(&start).map_err(|stuck| self.failure(set, &search, stuck, Some(&begun), None))?;
        // The scales of the start values may be far off, so the root has its own.
        let scales = system.scales(&given, &root.u);
        let search = Search { system, scales: &scales, given: &given };
        let stuck = || Stuck { u: root.u.clone(), values: system.values(&given, &root.u), singular: true };
        let singular = || self.failure(set, &search, stuck(), None, None);
        let linear = search.linear(&root.u).ok_or_else(singular)?;
        let condition = ConditionNumber::of(linear.matrix());
        if condition.value >= SINGULAR {
            return Err(singular());
        }
        // Derivatives by the given variables, for the predictions at other points.
        let by = system.derivatives(&given, &root.u, &system.uses);
        let mut slopes = Mat::zeros(system.len(), system.uses.len());
        for k in 0..system.uses.len() {
            let right: Vec<f64> = (0..system.len())
                .map(|i| -by[(i, k)] / scales.equations[i])
                .map(|value| if value.is_finite() { value } else { 0.0 })
                .collect();
            let slope = linear.solve(&right);
            (0..system.len()).for_each(|j| slopes[(j, k)] = slope[j] * scales.unknowns[j]);
        }
        Ok(Anchor {
            sign: linear.sign(),
            u: root.u,
            given,
            scales,
            slopes,
            condition: condition.value,
            weakest: condition.unknown,
            bends: set.switches(&system.formulas).iter().any(|switch| switch.kind == SwitchKind::Branch),
        })
    }

    /// Returns the unknowns at a point by the safeguarded search. `set` explains a formula that has no value there.
    pub(super) fn solve_safeguarded(
        &self,
        set: &FormulaSet,
        anchor: &Anchor,
        given: &[f64],
    ) -> Result<Vec<f64>, AssemblyFailure> {
        let search = Search { system: &self.system, scales: &anchor.scales, given };
        // The direct search from the prediction is enough if it ends near the prediction, on the same branch, in few steps.
        let change = if anchor.bends { search.first_step(&anchor.u) } else { None };
        let change = change.unwrap_or_else(|| self.prediction(anchor, given));
        let predicted = search.moved(&anchor.u, &change, 1.0);
        let direct = search.from(&predicted);
        if let Ok(root) = &direct {
            let way = search.distance(&predicted, &anchor.u);
            let near = search.distance(&root.u, &predicted) <= OFF * way + SLACK;
            if near && root.sign == anchor.sign && root.iterations <= STEPS {
                return Ok(root.u.clone());
            }
        }
        // In all other cases the state is followed from the nominal one, so that it stays on its branch.
        match (self.follow(anchor, given), direct) {
            (Ok(u), _) => Ok(u),
            (Err(followed), Err(stuck)) => Err(self.failure(set, &search, stuck, None, Some(followed))),
            (Err(followed), Ok(root)) => {
                let off = |j: usize| ((root.u[j] - predicted[j]) / anchor.scales.unknowns[j]).abs();
                let worst = (0..root.u.len()).max_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(0);
                Err(AssemblyFailure::OtherBranch {
                    unknown: self.system.unknowns[worst].name().to_owned(),
                    nominal: anchor.u[worst],
                    found: root.u[worst],
                    followed,
                })
            }
        }
    }

    /// Returns the first-order change of the unknowns from the nominal state to a point, in scales.
    fn prediction(&self, anchor: &Anchor, given: &[f64]) -> Vec<f64> {
        let change =
            |(k, &index): (usize, &usize), j: usize| anchor.slopes[(j, k)] * (given[index] - anchor.given[index]);
        (0..self.len())
            .map(|j| {
                let sum: f64 = self.system.uses.iter().enumerate().map(|use_| change(use_, j)).sum();
                sum / anchor.scales.unknowns[j]
            })
            .collect()
    }

    /// Follows the state along the straight way from the nominal dimensions to a point. Returns the part of the way that succeeded if it
    /// fails.
    fn follow(&self, anchor: &Anchor, given: &[f64]) -> Result<Vec<f64>, f64> {
        let system = &self.system;
        let at = |part: f64| -> Vec<f64> {
            let between = |(&from, &to): (&f64, &f64)| if part == 1.0 { to } else { from + part * (to - from) };
            anchor.given.iter().zip(given).map(between).collect()
        };
        let (mut done, mut step, mut u) = (0.0, 0.25f64, anchor.u.clone());
        for _ in 0..PARTS {
            let here = at(done);
            let search = Search { system, scales: &anchor.scales, given: &here };
            let Some(linear) = search.linear(&u) else { return Err(done) };
            let by = system.derivatives(&here, &u, &system.uses);
            let right: Vec<f64> = (0..system.len())
                .map(|i| {
                    let terms = system.uses.iter().enumerate().map(|(k, &index)| {
                        let rate = by[(i, k)] * (given[index] - anchor.given[index]);
                        if rate.is_finite() { rate } else { 0.0 }
                    });
                    -terms.sum::<f64>() / anchor.scales.equations[i]
                })
                .collect();
            // Tries ever shorter steps until the root stays on the branch and near its prediction.
            let rate = linear.solve(&right);
            loop {
                let part = step.min(1.0 - done);
                let next = if part < step || done + part == 1.0 { 1.0 } else { done + part };
                let there = at(next);
                let search = Search { system, scales: &anchor.scales, given: &there };
                let predicted = search.moved(&u, &rate, next - done);
                let way = search.distance(&predicted, &u);
                if let Ok(Root { u: found, sign, .. }) = search.from(&predicted) {
                    let off = search.distance(&found, &predicted);
                    if sign == anchor.sign && off <= FOLLOWED * way + SLACK {
                        if off <= EASY * way + SLACK {
                            step *= 2.0;
                        }
                        (u, done) = (found, next);
                        if done == 1.0 {
                            return Ok(u);
                        }
                        break;
                    }
                }
                step *= 0.5;
                if step < SHORTEST {
                    return Err(done);
                }
            }
        }
        Err(done)
    }

    /// Returns the error of a search that got stuck. `begun` are the equations at the start values of the nominal state.
    fn failure(
        &self,
        set: &FormulaSet,
        search: &Search<'_>,
        stuck: Stuck,
        begun: Option<&[f64]>,
        followed: Option<f64>,
    ) -> AssemblyFailure {
        let system = &self.system;
        if let Some(failure) = system.explain(set, search.given, &stuck.u) {
            return failure.into();
        }
        let at = system.named(&stuck.u);
        let nominal = followed.is_none();
        let bound = system.unknowns.iter().zip(&stuck.u).find(|(unknown, value)| unknown.bounds().contains(value));
        if stuck.singular && bound.is_none() {
            let condition = search.linear(&stuck.u).map(|linear| ConditionNumber::of(linear.matrix()));
            let (unknown, worst) = condition.map_or((0, 0), |condition| (condition.unknown, condition.equation));
            return AssemblyFailure::Singular {
                nominal,
                unknown: system.unknowns[unknown].name().to_owned(),
                worst: system.words(worst),
                residual: stuck.values[worst],
                at,
                followed,
            };
        }
        let worst = search.worst(&stuck.values);
        let state = (search.given, &stuck.u[..]);
        if let Some(joint) = system.open_joint(set, state, &stuck.values, worst) {
            return AssemblyFailure::OpenJoint { nominal, joint: Box::new(joint), followed };
        }
        AssemblyFailure::Open {
            nominal,
            worst: system.equations[worst].clone(),
            residual: stuck.values[worst],
            start: begun.map(|begun| begun[worst]),
            at,
            bound: bound.map(|(unknown, &value)| (unknown.name().to_owned(), value)),
            followed,
        }
    }
}

impl Anchor {
    /// Returns the unknown that is determined least and the condition number, if the nominal position is nearly singular.
    pub(in crate::assembly) fn nearly_singular(&self, assembler: &Assembler) -> Option<(String, f64)> {
        let unknown = || assembler.system.unknowns[self.weakest].name().to_owned();
        (self.condition > NEARLY_SINGULAR).then(|| (unknown(), self.condition))
    }
}
