//! Results of points of the model in tails at whose limits check points refute the surface.

use serde::Serialize;

/// Yield by importance samples of the model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SampledTail {
    /// Number of points of the model, those that found places included.
    pub points: u64,
    /// Number of those at which the model has no value.
    pub failed: u64,
    /// Yield by these points.
    #[serde(rename = "yield")]
    pub yield_: f64,
    /// 95 % interval of the yield, unseen rejects included.
    #[serde(rename = "yield_interval")]
    pub interval: [f64; 2],
    /// Shares below the lower and above the upper limit. None if that limit does not exist.
    pub beyond: [Option<f64>; 2],
    /// 95 % intervals of `beyond`.
    #[serde(skip)]
    pub(crate) intervals: [Option<[f64; 2]>; 2],
}
