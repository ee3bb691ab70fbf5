//! What a method takes.

use super::{Method, MethodError, Options};
use crate::plan::Plan;
use crate::problem::Problem;

/// Evaluations and stages, if no point fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Cost {
    /// Points that are sent to the model.
    pub evaluations: usize,
    /// Batches in which they are sent.
    pub stages: usize,
}

impl Cost {
    /// Of a plan.
    pub(super) fn of(plan: &dyn Plan) -> Self {
        let (evaluations, stages) = plan.cost();
        Self { evaluations, stages }
    }

    /// The same, if the budget allows it.
    pub(super) fn within(
        self,
        method: &'static str,
        problem: &Problem,
        options: &Options,
    ) -> Result<Self, MethodError> {
        match options.budget.filter(|&budget| self.evaluations > budget) {
            None => Ok(self),
            Some(budget) => Err(MethodError::OverBudget {
                method,
                needed: self.evaluations,
                budget,
                fitting: fitting(problem, budget),
            }),
        }
    }
}

/// The derivative method with the most evaluations that so many allow.
pub(super) fn fitting(problem: &Problem, budget: usize) -> Option<(Method, usize)> {
    [Method::Full, Method::SixN, Method::SecondOrder]
        .into_iter()
        .filter_map(|method| {
            let cost = method.procedure().plan(problem, &Options::from(method)).ok()?.cost().0;
            (cost <= budget).then_some((method, cost))
        })
        .max_by_key(|&(_, cost)| cost)
}
