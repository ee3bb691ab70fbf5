//! All methods.

use super::{Cost, Method, MethodError, Narrow, Options, Procedure};
use crate::problem::Problem;

/// Every method, in the order in which they are listed.
pub static ALL: &[&dyn Procedure] = &[
    &super::auto::AUTO,
    &super::rss::RSS,
    &super::worst_case::WORST_CASE,
    &super::second_order::SECOND_ORDER,
    &super::six_n::SIX_N,
    &super::full::FULL,
    &super::classic::CLASSIC,
    &super::dimension_reduction::DimensionReduction,
    &super::bivariate_dimension_reduction::BivariateDimensionReduction,
    &super::three_point::ThreePoint,
    &super::response_surface::ResponseSurface,
];

/// The procedure of a method.
pub fn procedure(method: Method) -> &'static dyn Procedure {
    *ALL.iter().find(|procedure| procedure.method() == method).expect("every method is registered")
}

impl Method {
    /// Its procedure.
    pub fn procedure(self) -> &'static dyn Procedure {
        procedure(self)
    }
}

impl Options {
    /// The cost of an analysis of the problem, or why it cannot be run; nothing is evaluated.
    ///
    /// # Errors
    /// When the options do not fit the problem, and when the method needs more evaluations than the budget allows.
    pub fn cost(&self, problem: &Problem) -> Result<Cost, MethodError> {
        let narrow = Narrow::of(problem, self);
        self.method.procedure().fits(narrow.as_ref().map_or(problem, |narrow| &narrow.problem), self)
    }
}
