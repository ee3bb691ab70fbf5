//! Sum of the interactions that are not listed one by one.

use serde::Serialize;

/// Interactions that are not listed one by one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Remainder {
    /// Number of interactions.
    pub count: usize,
    /// Sum of their shares of the variance, as far as they are known.
    pub share: f64,
    /// Number of interactions that were not evaluated before the run was stopped.
    pub not_evaluated: usize,
}
