//! Serialised forms of the results for rare events.

use serde::{Serialize, Serializer};

use crate::rare::{Beyond, RareCharacteristic, RareEvents};
use crate::warning::serialize::warnings_last;
use sensitol_numeric::sampling::Estimate;
use sensitol_numeric::verdict::{Judged, Verdict};

warnings_last!(RareEvents);

/// Characteristic with its verdicts, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct RareShape<'r> {
    #[serde(flatten, serialize_with = "RareCharacteristic::serialize")]
    #[cfg_attr(feature = "schema", schemars(with = "RareCharacteristic"))]
    own: &'r RareCharacteristic,
    /// Rejects below the lower limit; null if there is no lower limit.
    below: Option<BeyondShape<'r>>,
    /// Rejects above the upper limit; null if there is no upper limit.
    above: Option<BeyondShape<'r>>,
    /// True if the interval of the yield lies above the target, false if below, null if around it.
    met: Option<bool>,
    /// Verdict on the target yield; null if there is no target.
    verdict: Option<Verdict>,
    /// Verdicts on all requirements, including the target yield.
    #[cfg_attr(feature = "schema", schemars(with = "Vec<sensitol_numeric::verdict::JudgedShape>"))]
    requirements: Vec<Judged>,
}

/// Rejects beyond one limit, as they are written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct BeyondShape<'r> {
    #[serde(flatten)]
    #[cfg_attr(feature = "schema", schemars(with = "Beyond"))]
    own: &'r Beyond,
    /// Probability if no point without a value lies beyond, and if all do; null if every point has a value.
    bounds: Option<[f64; 2]>,
}

impl Serialize for RareCharacteristic {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let side = |own| BeyondShape { own, bounds: self.bounds(own) };
        let shape = RareShape {
            own: self,
            below: self.below.as_ref().map(side),
            above: self.above.as_ref().map(side),
            met: self.verdict().and_then(Verdict::met),
            verdict: self.verdict(),
            requirements: self.requirements(),
        };
        shape.serialize(serializer)
    }
}

/// Probability as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct ProbabilityShape {
    /// Probability of an assembly beyond the limit; null if no point lies there.
    probability: Option<f64>,
    /// Standard error of the probability.
    standard_error: Option<f64>,
    /// Probability in parts per million.
    ppm: Option<f64>,
}

impl From<&Option<Estimate>> for ProbabilityShape {
    fn from(found: &Option<Estimate>) -> Self {
        let probability = found.map(|found| found.value);
        let standard_error = found.and_then(|found| found.standard_error);
        Self { probability, standard_error, ppm: probability.map(|value| 1e6 * value) }
    }
}
