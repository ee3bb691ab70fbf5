//! How a simulation is written: values by their names, what is uncertain of them below `standard_error`.

use serde::{Serialize, Serializer};

use super::shape::{ControlShape, Reduction};
use super::{SimulatedCharacteristic, Simulation, SurrogateControl};
use crate::warning::warnings_last;
use sensitol_numeric::capability::Quantiles;
use sensitol_numeric::sampling::Estimate;
use sensitol_numeric::shape::Four;
use sensitol_numeric::verdict::{Judged, Verdict};

warnings_last!(Simulation);

/// A characteristic with the standard errors beside the values, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SimulatedShape<'r> {
    #[serde(flatten, serialize_with = "SimulatedCharacteristic::serialize")]
    #[cfg_attr(feature = "schema", schemars(with = "SimulatedCharacteristic"))]
    own: &'r SimulatedCharacteristic,
    /// How uncertain the sample leaves all this.
    standard_error: StandardErrors,
    /// The sample's own distribution.
    distribution: Empirical,
    /// 95 % interval of the yield, with what measured samples leave open; null without limits.
    yield_interval: Option<[f64; 2]>,
    /// If all points without a value are rejected, and if none is; null where every point has one.
    yield_bounds: Option<[f64; 2]>,
    /// Whether the interval of the yield lies above the target (true), below (false), or around it (null).
    met: Option<bool>,
    /// The same in a word; null without a target.
    verdict: Option<Verdict>,
    /// Everything that is required of it, the target yield included.
    #[cfg_attr(feature = "schema", schemars(with = "Vec<sensitol_numeric::verdict::JudgedShape>"))]
    requirements: Vec<Judged>,
}

/// Standard errors, and the 95 % interval of the yield.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct StandardErrors {
    #[serde(flatten)]
    moments: Four<Option<f64>>,
    /// 95 % interval, as far as the number of points decides.
    #[serde(rename = "yield")]
    yield_: Option<[f64; 2]>,
    /// Of the quantiles.
    quantiles: Quantiles<Option<f64>>,
}

/// A distribution that is known by a sample.
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
