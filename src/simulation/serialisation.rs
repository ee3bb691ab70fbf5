//! JSON form of a simulation: values by their names, uncertainties in `standard_error`.

use serde::{Serialize, Serializer};

use crate::simulation::json::{ControlShape, Reduction};
use crate::simulation::{SimulatedCharacteristic, Simulation, SurrogateControl};
use crate::warning::serialize::warnings_last;
use sensitol_numeric::capability::Quantiles;
use sensitol_numeric::json_form::Four;
use sensitol_numeric::sampling::Estimate;
use sensitol_numeric::verdict::{Judged, Verdict};

warnings_last!(Simulation);

/// A characteristic with standard errors next to the values, in JSON.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SimulatedShape<'r> {
    #[serde(flatten, serialize_with = "SimulatedCharacteristic::serialize")]
    #[cfg_attr(feature = "schema", schemars(with = "SimulatedCharacteristic"))]
    own: &'r SimulatedCharacteristic,
    /// Standard errors of the values.
    standard_error: StandardErrors,
    /// Distribution of the sample.
    distribution: Empirical,
    /// 95 % interval of the yield, with the uncertainty of measured samples; null if there are no limits.
    yield_interval: Option<[f64; 2]>,
    /// Yield if all points without a value are rejected, and if none is; null if every point has one.
    yield_bounds: Option<[f64; 2]>,
    /// True if the interval of the yield is above the target, false if below, null if it contains the target.
    met: Option<bool>,
    /// Verdict on the target yield; null if there is no target.
    verdict: Option<Verdict>,
    /// Verdicts on all requirements, the target yield included.
    #[cfg_attr(feature = "schema", schemars(with = "Vec<sensitol_numeric::verdict::JudgedShape>"))]
    requirements: Vec<Judged>,
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

impl Serialize for SimulatedCharacteristic {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let error = |estimate: Option<Estimate>| estimate.and_then(|estimate| estimate.standard_error);
        let moments = [self.mean, self.sigma, self.skewness, self.kurtosis].map(error);
        let value = |estimate: Option<Estimate>| estimate.map(|estimate| estimate.value);
        let shape = SimulatedShape {
            own: self,
            standard_error: StandardErrors {
                moments: Four::from(&moments),
                yield_: self.yield_.map(|share| share.interval),
                quantiles: Quantiles(self.quantiles.map(error)),
            },
            distribution: Empirical { family: "empirical", quantiles: Quantiles(self.quantiles.map(value)) },
            yield_interval: self.yield_interval(),
            yield_bounds: self.yield_bounds(),
            met: self.verdict().and_then(Verdict::met),
            verdict: self.verdict(),
            requirements: self.requirements(),
        };
        shape.serialize(serializer)
    }
}

impl Serialize for SurrogateControl {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let reduction = Reduction { mean: self.mean, sigma: self.sigma };
        ControlShape { method: self.method.name(), evaluations: self.evaluations, reduction }.serialize(serializer)
    }
}
