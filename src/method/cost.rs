//! The cost of a method.

use crate::method::{EvaluationLimit, Method, MethodError, Options};
use crate::plan::Plan;
use crate::problem::Problem;

/// Number of evaluations and stages, if no point fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Cost {
    /// Number of points that are sent to the model.
    pub evaluations: usize,
    /// Number of batches in which the points are sent.
    pub stages: usize,
}

impl Cost {
    /// Returns the evaluations and stages of a plan.
    pub(super) fn of(plan: &dyn Plan) -> Self {
        let (evaluations, stages) = plan.cost();
        Self { evaluations, stages }
    }

    /// Returns the cost itself if it is within the budget, or within the limit that holds without a budget.
    pub(super) fn within(
        self,
        method: &'static str,
        problem: &Problem,
        options: &Options,
    ) -> Result<Self, MethodError> {
        let dimensions = problem.dimensions().iter().filter(|dimension| dimension.sigma() > 0.0).count();
        affordable(method, self.evaluations as u128, problem, options, dimensions).map(|()| self)
    }
}

/// Refuses more evaluations than a plan may have, before any of its points is made. Without a budget the limit is 1,000,000.
pub(super) fn affordable(
    method: &'static str,
    needed: u128,
    problem: &Problem,
    options: &Options,
    dimensions: usize,
) -> Result<(), MethodError> {
    // A point takes several evaluations if a value is chosen from stock for it, or if the assembly moves.
    let needed = needed * problem.evaluations_per_point() as u128;
    let limit = options.budget.map_or(EvaluationLimit::WithoutBudget, |_| EvaluationLimit::Listed);
    let most = options.budget.unwrap_or(usize::MAX).min(limit.most());
    if needed <= most as u128 {
        return Ok(());
    }
    let fitting = fitting(problem, most);
    match (options.budget, usize::try_from(needed)) {
        (Some(budget), Ok(needed)) if budget == most => {
            Err(MethodError::OverBudget { method, needed, budget, fitting })
        }
        _ => Err(MethodError::TooMany { method, dimensions, needed, limit, fitting }),
    }
}

/// Returns the derivative method with the most evaluations within the budget, and their number.
pub(super) fn fitting(problem: &Problem, budget: usize) -> Option<(Method, usize)> {
    [Method::Full, Method::SixN, Method::SecondOrder]
        .into_iter()
        .filter_map(|method| {
            let points = method.procedure().plan(problem, &Options::from(method)).ok()?.cost().0;
            let cost = points.saturating_mul(problem.evaluations_per_point());
            (cost <= budget).then_some((method, cost))
        })
        .max_by_key(|&(_, cost)| cost)
}
