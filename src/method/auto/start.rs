//! What `auto` evaluates in any case: the plan that it begins with.

use super::climb::Climb;
use crate::plan::{Axis, DifferencePlan, Known, Plan, Point, Stage};
use crate::surrogate::Inputs;

/// Parabolas, and the points that check and listen.
#[derive(Debug)]
pub(super) struct Start {
    plan: DifferencePlan,
    first: Stage,
    evaluations: usize,
    stages: usize,
}

impl Start {
    /// Of a climb that has not begun.
    pub(super) fn of(climb: Climb<'_>, characteristics: usize) -> Self {
        let first = climb.wanted(&Known::nothing(characteristics));
        let later = climb.looks_out(characteristics);
        Self {
            first: first.clone(),
            evaluations: first.points.len() + later,
            stages: 1 + usize::from(later > 0),
            plan: climb.plan,
        }
    }
}

impl Plan for Start {
    fn varying(&self) -> &[usize] {
        self.plan.varying()
    }

    fn moved(&self) -> Vec<usize> {
        self.plan.moved()
    }

    fn inputs(&self) -> &Inputs {
        self.plan.inputs()
    }

    fn axis(&self, dimension: usize) -> &Axis {
        self.plan.axis(dimension)
    }

    fn nominal(&self) -> &Point {
        self.plan.nominal()
    }

    fn centre(&self) -> Vec<f64> {
        self.plan.centre()
    }

    fn depends(&self, characteristic: usize, dimension: usize) -> bool {
        self.plan.depends(characteristic, dimension)
    }

    fn possible_pairs(&self) -> usize {
        self.plan.possible_pairs()
    }

    fn cost(&self) -> (usize, usize) {
        (self.evaluations, self.stages)
    }

    fn next(&self, known: &Known) -> Option<Stage> {
        let points: Vec<_> = self.first.points.iter().filter(|(point, _)| !known.tried(point)).cloned().collect();
        (!points.is_empty()).then_some(Stage { points })
    }
}
