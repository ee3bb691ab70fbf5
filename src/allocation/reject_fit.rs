//! The data of what some characteristics reject together, about a station; [`rejects`](super::rejects) makes and uses it.

use crate::characteristic::SpecLimits;

/// What some characteristics reject together.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RejectFit {
    /// The characteristics with their limits.
    pub(super) of: Vec<(usize, SpecLimits)>,
    /// What the laws make of the fits: a factor, as its logarithm.
    pub(super) ln: f64,
    /// Whether the laws reject nothing at the station.
    pub(super) nothing: bool,
    /// How that grows with `ln T` of every dimension.
    pub(super) slopes: Vec<f64>,
}
