//! Figures that follow from the estimates of a characteristic, in their order in JSON.

use serde::Serialize;

use sensitol_numeric::capability::Quantiles;
use sensitol_numeric::json_form::Four;
use sensitol_numeric::verdict::Verdicts;

/// Figures that follow from the estimates of a characteristic.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SimulatedConclusion {
    /// Standard errors of the values.
    pub(super) standard_error: StandardErrors,
    /// Distribution of the sample.
    pub(super) distribution: Empirical,
    /// 95 % interval of the yield, with the uncertainty of measured samples; null if there are no limits.
    pub(super) yield_interval: Option<[f64; 2]>,
    /// Yield if all points without a value are rejected, and if none is; null if every point has one.
    pub(super) yield_bounds: Option<[f64; 2]>,
    #[serde(flatten)]
    pub(super) verdicts: Verdicts,
}

/// Standard errors, and the 95 % interval of the yield.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct StandardErrors {
    #[serde(flatten)]
    pub(super) moments: Four<Option<f64>>,
    /// 95 % interval of the yield, by the number of points only.
    #[serde(rename = "yield")]
    pub(super) yield_: Option<[f64; 2]>,
    /// Standard errors of the quantiles.
    pub(super) quantiles: Quantiles<Option<f64>>,
}

/// Distribution that is known by a sample.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct Empirical {
    /// Always `empirical`.
    pub(super) family: &'static str,
    /// Quantiles.
    pub(super) quantiles: Quantiles<Option<f64>>,
}
