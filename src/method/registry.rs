//! Registry of all methods.

use crate::method::auto;
use crate::method::derivative::classic;
use crate::method::derivative::full;
use crate::method::derivative::rss;
use crate::method::derivative::second_order;
use crate::method::derivative::six_n;
use crate::method::derivative::worst_case;
use crate::method::integration::bivariate_dimension_reduction;
use crate::method::integration::dimension_reduction;
use crate::method::integration::three_point;
use crate::method::response_surface;
use crate::method::{Cost, Method, MethodError, Options, Procedure, ReducedInputs};
use crate::problem::Problem;

/// Every method, in the order of listings.
pub static ALL: &[&dyn Procedure] = &[
    &auto::AUTO,
    &rss::RSS,
    &worst_case::WORST_CASE,
    &second_order::SECOND_ORDER,
    &six_n::SIX_N,
    &full::FULL,
    &classic::CLASSIC,
    &dimension_reduction::DimensionReduction,
    &bivariate_dimension_reduction::BivariateDimensionReduction,
    &three_point::ThreePoint,
    &response_surface::ResponseSurface,
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
