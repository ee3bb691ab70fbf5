//! How rare events are written.

use serde::{Serialize, Serializer};

use super::{Beyond, RareCharacteristic, RareEvents};
use crate::warning::warnings_last;
use sensitol_numeric::sampling::Estimate;
use sensitol_numeric::verdict::{Judged, Verdict};

warnings_last!(RareEvents);

/// A characteristic with its verdicts, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct RareShape<'r> {
    #[serde(flatten, serialize_with = "RareCharacteristic::serialize")]
    #[cfg_attr(feature = "schema", schemars(with = "RareCharacteristic"))]
    own: &'r RareCharacteristic,
    /// Rejects below the lower limit; null without one.
    below: Option<BeyondShape<'r>>,
    /// Rejects above the upper limit; null without one.
    above: Option<BeyondShape<'r>>,
    /// Whether the interval of the yield lies above the target (true), below (false), or around it (null).
    met: Option<bool>,
    /// The same in a word; null without a target.
    verdict: Option<Verdict>,
    /// Everything that is required of it, the target yield included.
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
    /// If no point without a value lies beyond, and if all do; null where every point has a value.
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

/// A probability as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct ProbabilityShape {
    /// The probability of an assembly beyond it; null where none was seen.
    probability: Option<f64>,
    /// Its standard error.
    standard_error: Option<f64>,
    /// The probability in millionths.
    ppm: Option<f64>,
}

impl From<&Option<Estimate>> for ProbabilityShape {
    fn from(found: &Option<Estimate>) -> Self {
        let probability = found.map(|found| found.value);
        let standard_error = found.and_then(|found| found.standard_error);
        Self { probability, standard_error, ppm: probability.map(|value| 1e6 * value) }
    }
}
