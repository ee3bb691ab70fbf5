//! Data of the rejects of some characteristics together, about a linearization point. The module
//! [`rejects`](super::rejects) makes and uses it.

use sensitol_numeric::characteristic::SpecLimits;

/// Joint rejects of some characteristics.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RejectFit {
    /// Characteristics with their limits.
    pub(super) of: Vec<(usize, SpecLimits)>,
    /// Correction of the fits by the surface distributions: the logarithm of a factor.
    pub(super) ln: f64,
    /// True if the surface distributions reject nothing at the linearization point.
    pub(super) nothing: bool,
    /// Derivatives of the correction by `ln T` of every dimension.
    pub(super) slopes: Vec<f64>,
}
