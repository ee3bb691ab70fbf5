//! Figures that follow from a sample: uncertainties in `standard_error`, the distribution and the verdicts.

use serde::Serialize;

use crate::simulation::{SimulatedCharacteristic, Simulation};
use crate::warning::serialize::warnings_last;
use sensitol_numeric::capability::Quantiles;
use sensitol_numeric::json_form::Four;
use sensitol_numeric::sampling::Estimate;
use sensitol_numeric::serialize_with_conclusion;
use sensitol_numeric::verdict::Verdicts;

warnings_last!(Simulation);
serialize_with_conclusion!(SimulatedCharacteristic);

/// Figures that follow from the estimates of a characteristic.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SimulatedConclusion {
    /// Standard errors of the values.
    standard_error: StandardErrors,
    /// Distribution of the sample.
    distribution: Empirical,
    /// 95 % interval of the yield, with the uncertainty of measured samples; null if there are no limits.
    yield_interval: Option<[f64; 2]>,
    /// Yield if all points without a value are rejected, and if none is; null if every point has one.
    yield_bounds: Option<[f64; 2]>,
    #[serde(flatten)]
    verdicts: Verdicts,
}

/// Standard errors, and the 95 % interval of the yield.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct StandardErrors {
    #[serde(flatten)]
    moments: Four<Option<f64>>,
    /// 95 % interval of the yield, by the number of points only.
    #[serde(rename = "yield")]
    yield_: Option<[f64; 2]>,
    /// Standard errors of the quantiles.
    quantiles: Quantiles<Option<f64>>,
}

/// Distribution that is known by a sample.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct Empirical {
    /// Always `empirical`.
    family: &'static str,
    /// Quantiles.
    quantiles: Quantiles<Option<f64>>,
}

impl SimulatedCharacteristic {
    /// Figures that follow from the estimates.
    pub fn conclusion(&self) -> SimulatedConclusion {
        let error = |estimate: Option<Estimate>| estimate.and_then(|estimate| estimate.standard_error);
        let moments = [self.mean, self.sigma, self.skewness, self.kurtosis].map(error);
        let value = |estimate: Option<Estimate>| estimate.map(|estimate| estimate.value);
        SimulatedConclusion {
            standard_error: StandardErrors {
                moments: Four::from(&moments),
                yield_: self.yield_.map(|share| share.interval),
                quantiles: Quantiles(self.quantiles.map(error)),
            },
            distribution: Empirical { family: "empirical", quantiles: Quantiles(self.quantiles.map(value)) },
            yield_interval: self.yield_interval(),
            yield_bounds: self.yield_bounds(),
            verdicts: self.verdicts(),
        }
    }
}
