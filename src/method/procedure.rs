//! Interface that every method implements.

use std::sync::Arc;

use crate::assembly::Run;
use crate::method::{Cost, Method, MethodError, Options, Outcome};
use crate::plan::Plan;
use crate::problem::Problem;

/// Interface of a method: its options, cost, plan and evaluation.
pub trait Procedure: Sync {
    /// Returns the enumeration variant of this method.
    fn method(&self) -> Method;

    /// Returns the name in study files and on the command line.
    fn name(&self) -> &'static str {
        self.method().name()
    }

    /// Returns a description of one line.
    fn about(&self) -> &'static str;

    /// Returns a formula for the number of evaluations for N dimensions.
    fn count(&self) -> &'static str;

    /// Checks that the method accepts the options.
    ///
    /// # Errors
    /// Fails if the method does not have an option, or if an option names something that is not in the problem.
    fn check(&self, problem: &Problem, options: &Options) -> Result<(), MethodError> {
        self.plan(problem, options).map(drop)
    }

    /// Returns the cost, or the reason why the method cannot be run.
    ///
    /// # Errors
    /// Fails like [`Procedure::plan`], and if the method needs more evaluations than the budget allows.
    fn fits(&self, problem: &Problem, options: &Options) -> Result<Cost, MethodError> {
        let plan = self.plan(problem, options)?;
        Cost::of(&*plan).within(self.name(), problem, options)
    }

    /// Returns the number of evaluations of a model that sends derivatives with its answers; None if derivatives save none.
    fn with_gradients(&self, problem: &Problem, options: &Options) -> Option<usize> {
        let _ = (problem, options);
        None
    }

    /// Returns the fewest and the most evaluations of a method that chooses points as it goes; None if its plan fixes the number.
    fn range(&self, problem: &Problem, options: &Options) -> Option<[usize; 2]> {
        let _ = (problem, options);
        None
    }

    /// Returns the plan of the method for these options. The budget is ignored.
    ///
    /// # Errors
    /// Fails like [`Procedure::check`], and if there are more points than could ever be evaluated.
    fn plan(&self, problem: &Problem, options: &Options) -> Result<Arc<dyn Plan>, MethodError>;

    /// Evaluates the problem.
    ///
    /// # Errors
    /// Fails like [`Procedure::fits`]. Nothing is evaluated then.
    fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError>;
}
