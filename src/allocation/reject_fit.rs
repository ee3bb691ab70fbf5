//! The data of what some characteristics reject together, about a station; [`rejects`](super::rejects) makes and uses it.

use sensitol_numeric::characteristic::SpecLimits;

/// The joint rejects of some characteristics.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RejectFit {
    /// The characteristics with their limits.
    pub(super) of: Vec<(usize, SpecLimits)>,
    /// The correction of the fits by the laws: a factor, as its logarithm.
    pub(super) ln: f64,
    /// Whether the laws reject nothing at the station.
    pub(super) nothing: bool,
    /// How that grows with `ln T` of every dimension.
    pub(super) slopes: Vec<f64>,
}
