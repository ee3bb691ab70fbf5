//! How an analysis is written: what follows from its fields stands beside them.

use serde::{Serialize, Serializer};

use super::{Analysis, CharacteristicAnalysis};
use crate::extremes::{Coordinate, Extremes};
use crate::warning::warnings_last;
use sensitol_numeric::verdict::{Judged, Verdict};

warnings_last!(Analysis);

/// A characteristic with its verdicts and intervals, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CharacteristicShape<'r> {
    #[serde(flatten, serialize_with = "CharacteristicAnalysis::serialize")]
    #[cfg_attr(feature = "schema", schemars(with = "CharacteristicAnalysis"))]
    own: &'r CharacteristicAnalysis,
    /// Intervals that no assembly leaves.
    worst_case: WorstCase<'r>,
    /// Whether the target yield is kept; null where that is not known.
    met: Option<bool>,
    /// The same in a word; null without a target.
    verdict: Option<Verdict>,
    /// Everything that is required of it, the target yield included.
    #[cfg_attr(feature = "schema", schemars(with = "Vec<sensitol_numeric::verdict::JudgedShape>"))]
    requirements: Vec<Judged>,
    /// Within which the share is known that keeps the limits; null where that is not known.
    yield_interval: Option<[f64; 2]>,
}

impl Serialize for CharacteristicAnalysis {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let shape = CharacteristicShape {
            own: self,
            worst_case: WorstCase::of(self),
            met: self.met(),
            verdict: self.verdict(),
            requirements: self.requirements(),
            yield_interval: self.yield_interval(),
        };
        shape.serialize(serializer)
    }
}

/// Intervals that no assembly leaves, as they are written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct WorstCase<'r> {
    /// Of the linear model.
    linear: Option<[f64; 2]>,
    /// Of the model itself, where they were searched.
    extremes: Option<[f64; 2]>,
    /// Whether it is proven that no assembly lies beyond the extremes.
    proven: Option<bool>,
    /// Where the extremes are: every dimension that matters by name.
    at: Option<ExtremesAt<'r>>,
    /// An interval that no assembly leaves, by interval arithmetic; of formulas only.
    bounds: Option<[f64; 2]>,
    /// Whether values next to both bounds exist.
    bounds_reached: Option<bool>,
    /// Evaluations of the search; a point that serves several characteristics counts for each.
    evaluations: Option<usize>,
}

/// Where the extremes are.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct ExtremesAt<'r> {
    /// The dimensions at the least value.
    #[serde(serialize_with = "coordinates")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, f64>"))]
    lower: &'r [Coordinate],
    /// The dimensions at the greatest value.
    #[serde(serialize_with = "coordinates")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, f64>"))]
    upper: &'r [Coordinate],
}

fn coordinates<S: Serializer>(point: &[Coordinate], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(point.iter().map(|at| (&at.dimension, at.x)))
}

impl<'r> WorstCase<'r> {
    fn of(one: &'r CharacteristicAnalysis) -> Self {
        let found = one.extremes.as_ref();
        let proof = one.proof();
        Self {
            linear: one.worst_case,
            extremes: found.map(|found| [found.least.value, found.greatest.value]),
            proven: found.map(Extremes::proven),
            at: found.map(|found| ExtremesAt { lower: &found.least.at, upper: &found.greatest.at }),
            bounds: proof.map(|proof| proof.bounds),
            bounds_reached: proof.map(|proof| proof.proven),
            evaluations: found.map(|found| found.evaluations),
        }
    }
}
