//! The joint effect of interactions that are not listed one by one.

use serde::Serialize;

/// Interactions that are not listed one by one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Remainder {
    /// How many.
    pub count: usize,
    /// Their shares of the variance, added up; of those whose share is known.
    pub share: f64,
    /// How many of them were not evaluated before the run was stopped.
    pub not_evaluated: usize,
}
