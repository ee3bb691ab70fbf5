//! Data of the rejects of some characteristics together, about a linearization point. The module
//! [`rejects`](crate::allocation::surface::reject_rate) makes and uses it.

use sensitol_numeric::characteristic::SpecLimits;

/// Joint rejects of some characteristics.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::allocation) struct RejectFit {
    /// Characteristics with their limits.
    pub(in crate::allocation) of: Vec<(usize, SpecLimits)>,
    /// Correction of the fits by the surface distributions: the logarithm of a factor.
    pub(in crate::allocation) ln: f64,
    /// True if the surface distributions reject nothing at the linearization point.
    pub(in crate::allocation) nothing: bool,
    /// Derivatives of the correction by `ln T` of every dimension.
    pub(in crate::allocation) slopes: Vec<f64>,
}
