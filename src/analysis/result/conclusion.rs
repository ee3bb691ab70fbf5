//! Figures that follow from the results of a characteristic, in their order in JSON.

use serde::{Serialize, Serializer};

use crate::analysis::result::figure_basis::FigureBases;
use crate::extremes::Coordinate;
use crate::verification::Verified;
use sensitol_numeric::verdict::Verdicts;

/// Verdicts, intervals and bases that follow from the figures of a characteristic.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CharacteristicConclusion<'r> {
    /// Intervals that no assembly leaves.
    pub(super) worst_case: WorstCase<'r>,
    #[serde(flatten)]
    pub(super) verdicts: Verdicts,
    /// Bases of the figures: `proof`, `points` of the model, or the `surface`.
    pub(super) basis: FigureBases,
    /// Plain points of the model that would decide the target yield; null unless the verdict comes from an unrefuted surface.
    pub(super) points_to_decide: Option<u64>,
    /// Interval of the yield; null if unknown.
    pub(super) yield_interval: Option<[f64; 2]>,
    /// Sigma divided by the magnitude of the mean; null if unknown, and if the mean may be 0.
    pub(super) coefficient_of_variation: Option<Verified>,
}

/// Intervals that no assembly leaves, in JSON.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct WorstCase<'r> {
    /// Worst case of the linear model, an interval.
    pub(super) linear: Option<[f64; 2]>,
    /// Interval of the model itself, if it was searched.
    pub(super) extremes: Option<[f64; 2]>,
    /// True if it is proven that no assembly lies beyond the extremes.
    pub(super) proven: Option<bool>,
    /// Points at which the extremes are: every dimension that matters by name.
    pub(super) at: Option<ExtremesAt<'r>>,
    /// Interval that no assembly leaves, by interval arithmetic. Only for formulas.
    pub(super) bounds: Option<[f64; 2]>,
    /// True if values next to both bounds exist.
    pub(super) bounds_reached: Option<bool>,
    /// Evaluations of the search; a point that serves several characteristics counts for each.
    pub(super) evaluations: Option<usize>,
}

/// Places of the extremes.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct ExtremesAt<'r> {
    /// Values of the dimensions at the least value.
    #[serde(serialize_with = "coordinates")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, f64>"))]
    pub(super) lower: &'r [Coordinate],
    /// Values of the dimensions at the greatest value.
    #[serde(serialize_with = "coordinates")]
    #[cfg_attr(feature = "schema", schemars(with = "std::collections::BTreeMap<String, f64>"))]
    pub(super) upper: &'r [Coordinate],
}

fn coordinates<S: Serializer>(point: &[Coordinate], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(point.iter().map(|at| (&at.dimension, at.x)))
}
