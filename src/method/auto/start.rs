//! Plan that `auto` begins with: the points that it evaluates in any case.

use crate::method::auto::next_stage::Climb;
use crate::plan::{DifferencePlan, Geometry, KnownAnswers, Plan, Stage};

/// Points of the parabolas, check points, and points that measure the scatter.
#[derive(Debug)]
pub(super) struct Start {
    plan: DifferencePlan,
    first: Stage,
    evaluations: usize,
    stages: usize,
}

impl Start {
    /// Returns the plan of a refinement that has not begun.
    pub(super) fn of(climb: Climb<'_>, characteristics: usize) -> Self {
        let first = climb.wanted(&KnownAnswers::nothing(characteristics));
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
    fn geometry(&self) -> &Geometry {
        self.plan.geometry()
    }

    fn cost(&self) -> (usize, usize) {
        (self.evaluations, self.stages)
    }

    fn next(&self, known: &KnownAnswers) -> Option<Stage> {
        let points: Vec<_> = self.first.points.iter().filter(|(point, _)| !known.tried(point)).cloned().collect();
        (!points.is_empty()).then_some(Stage { points })
    }
}
