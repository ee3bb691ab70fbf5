//! Figures that follow from the results of a characteristic, and the order of both in JSON.

use serde::{Serialize, Serializer};

use crate::analysis::{Analysis, CharacteristicAnalysis, FigureBases};
use crate::extremes::{Coordinate, Extremes};
use crate::verification::Verified;
use crate::warning::serialize::warnings_last;
use sensitol_numeric::serialize_with_conclusion;
use sensitol_numeric::verdict::Verdicts;

warnings_last!(Analysis);
serialize_with_conclusion!(CharacteristicAnalysis);

/// Verdicts, intervals and bases that follow from the figures of a characteristic.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CharacteristicConclusion<'r> {
    /// Intervals that no assembly leaves.
    worst_case: WorstCase<'r>,
    #[serde(flatten)]
    verdicts: Verdicts,
    /// Bases of the figures: `proof`, `points` of the model, or the `surface`.
    basis: FigureBases,
    /// Plain points of the model that would decide the target yield; null unless the verdict comes from an unrefuted surface.
    points_to_decide: Option<u64>,
    /// Interval of the yield; null if unknown.
    yield_interval: Option<[f64; 2]>,
    /// Sigma divided by the magnitude of the mean; null if unknown, and if the mean may be 0.
    coefficient_of_variation: Option<Verified>,
}

impl CharacteristicAnalysis {
    /// Verdicts, intervals and bases that follow from the figures.
    pub fn conclusion(&self) -> CharacteristicConclusion<'_> {
        CharacteristicConclusion {
            worst_case: WorstCase::of(self),
            verdicts: self.verdicts(),
            basis: self.bases(),
            points_to_decide: self.points_to_decide(),
            yield_interval: self.yield_interval(),
            coefficient_of_variation: self.coefficient_of_variation(),
        }
    }
}

/// Intervals that no assembly leaves, in JSON.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct WorstCase<'r> {
    /// Worst case of the linear model, an interval.
    linear: Option<[f64; 2]>,
    /// Interval of the model itself, if it was searched.
    extremes: Option<[f64; 2]>,
    /// True if it is proven that no assembly lies beyond the extremes.
    proven: Option<bool>,
    /// Points at which the extremes are: every dimension that matters by name.
    at: Option<ExtremesAt<'r>>,
    /// Interval that no assembly leaves, by interval arithmetic. Only for formulas.
    bounds: Option<[f64; 2]>,
    /// True if values next to both bounds exist.
    bounds_reached: Option<bool>,
    /// Evaluations of the search; a point that serves several characteristics counts for each.
    evaluations: Option<usize>,
}

/// Places of the extremes.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct ExtremesAt<'r> {
    /// Values of the dimensions at the least value.
    #[serde(serialize_with = "coordinates")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, f64>"))]
    lower: &'r [Coordinate],
    /// Values of the dimensions at the greatest value.
    #[serde(serialize_with = "coordinates")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, f64>"))]
    upper: &'r [Coordinate],
}

fn coordinates<S: Serializer>(point: &[Coordinate], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(point.iter().map(|at| (&at.dimension, at.x)))
}

impl<'r> WorstCase<'r> {
    fn of(one: &'r CharacteristicAnalysis) -> Self {
        let found = one.range.extremes.as_ref();
        let proof = one.proof();
        Self {
            linear: one.range.worst_case,
            extremes: found.map(|found| [found.least.value, found.greatest.value]),
            proven: found.map(Extremes::proven),
            at: found.map(|found| ExtremesAt { lower: &found.least.at, upper: &found.greatest.at }),
            bounds: proof.map(|proof| proof.bounds),
            bounds_reached: proof.map(|proof| proof.proven),
            evaluations: found.map(|found| found.evaluations),
        }
    }
}
