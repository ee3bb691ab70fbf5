//! The procedure of a method.

use std::sync::Arc;

use super::{Cost, Method, MethodError, Options, Outcome};
use crate::assembly::Run;
use crate::plan::Plan;
use crate::problem::Problem;

/// The procedure of a method.
pub trait Procedure: Sync {
    /// Its place in the enumeration.
    fn method(&self) -> Method;

    /// Its name in study files and on the command line.
    fn name(&self) -> &'static str {
        self.method().name()
    }

    /// Its description, in one line.
    fn about(&self) -> &'static str;

    /// How many evaluations it takes for N dimensions, as a formula.
    fn count(&self) -> &'static str;

    /// Whether the options mean something to it.
    ///
    /// # Errors
    /// When one does not, or names something that the problem does not have.
    fn check(&self, problem: &Problem, options: &Options) -> Result<(), MethodError> {
        self.plan(problem, options).map(drop)
    }

    /// Its cost, or why it cannot be run.
    ///
    /// # Errors
    /// As [`Procedure::plan`], and when it needs more evaluations than the budget allows.
    fn fits(&self, problem: &Problem, options: &Options) -> Result<Cost, MethodError> {
        let plan = self.plan(problem, options)?;
        Cost::of(&*plan).within(self.name(), problem, options)
    }

    /// The evaluations of a model that sends derivatives with its answers; None where these save none.
    fn with_gradients(&self, problem: &Problem, options: &Options) -> Option<usize> {
        let _ = (problem, options);
        None
    }

    /// The fewest and the most evaluations of a method that chooses as it goes; None for one whose plan says how many.
    fn range(&self, problem: &Problem, options: &Options) -> Option<[usize; 2]> {
        let _ = (problem, options);
        None
    }

    /// The plan that it would follow, whatever the budget.
    ///
    /// # Errors
    /// As [`Procedure::check`], and when there are more points than could ever be evaluated.
    fn plan(&self, problem: &Problem, options: &Options) -> Result<Arc<dyn Plan>, MethodError>;

    /// Evaluates the problem.
    ///
    /// # Errors
    /// As [`Procedure::fits`]; nothing is evaluated then.
    fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError>;
}
