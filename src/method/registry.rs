//! Registry of all methods.

use crate::method::{Cost, Method, MethodError, Options, Procedure, ReducedInputs};
use crate::problem::Problem;

/// Every method, in the order of listings.
pub static ALL: &[&dyn Procedure] = &[
    &crate::method::auto::AUTO,
    &crate::method::derivative::rss::RSS,
    &crate::method::derivative::worst_case::WORST_CASE,
    &crate::method::derivative::second_order::SECOND_ORDER,
    &crate::method::derivative::six_n::SIX_N,
    &crate::method::derivative::full::FULL,
    &crate::method::derivative::classic::CLASSIC,
    &crate::method::integration::dimension_reduction::DimensionReduction,
    &crate::method::integration::bivariate_dimension_reduction::BivariateDimensionReduction,
    &crate::method::integration::three_point::ThreePoint,
    &crate::method::response_surface::ResponseSurface,
];

/// Returns the procedure of a method.
pub fn procedure(method: Method) -> &'static dyn Procedure {
    *ALL.iter().find(|procedure| procedure.method() == method).expect("every method is registered")
}

impl Method {
    /// Returns the procedure of this method.
    pub fn procedure(self) -> &'static dyn Procedure {
        procedure(self)
    }
}

impl Options {
    /// Returns the cost of an analysis of the problem, or the reason why it cannot be run. Nothing is evaluated.
    ///
    /// # Errors
    /// Fails if the options do not fit the problem, or if the method needs more evaluations than the budget allows.
    pub fn cost(&self, problem: &Problem) -> Result<Cost, MethodError> {
        let narrow = ReducedInputs::of(problem, self);
        self.method.procedure().fits(narrow.as_ref().map_or(problem, |narrow| &narrow.problem), self)
    }
}
