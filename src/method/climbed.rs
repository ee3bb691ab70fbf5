//! How `auto` came to its result.

use super::Accuracies;
use super::check::SurrogateCheck;
use crate::plan::Point;

/// How a climb ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum ClimbEnd {
    /// Every characteristic is known as well as it was wanted, by the estimate.
    Reached,
    /// The budget does not allow what would be next.
    Budget,
    /// Nothing that could be bought is expected to help.
    Exhausted,
    /// It was stopped before any of that.
    Stopped,
}

/// How `auto` came to its result.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Climbed {
    /// The relative error of sigma that was wanted.
    pub accuracy: f64,
    /// The accuracies to reach of other results.
    pub accuracies: Accuracies,
    /// Why it ended.
    pub rest: ClimbEnd,
    /// Positions of varying dimensions with five points.
    pub refined: Vec<usize>,
    /// Pairs bought for themselves.
    pub direct: usize,
    /// Probes that moved all dimensions, of one evaluation each or two.
    pub probes: usize,
    /// Points that checked.
    pub checks: usize,
    /// Pairs whose interactions the formulas of all characteristics give.
    pub from_formulas: usize,
    /// Whether every pair was examined.
    pub all_pairs: bool,
    /// For every characteristic what the check says; None where it has no surrogate, or nothing was checked.
    pub checked: Vec<Option<SurrogateCheck>>,
    /// The scatter of answers next to the means.
    pub noise: Vec<Option<f64>>,
    /// How many sigmas model and surrogate differ by three sigma out along the steepest line, infinite where the model has no
    /// value there; None where the tails were not examined.
    pub tails: Vec<Option<f64>>,
    /// The same without what a parabola explains that the points that check have seen.
    pub(crate) beyond: Vec<Option<f64>>,
    /// The share of the variance that interactions have which the screening did not find, where it was needed.
    pub unscreened: Vec<Option<f64>>,
    /// The points that were looked at there, by characteristic.
    pub(crate) far: Vec<(usize, [Point; 2])>,
}

impl Climbed {
    /// The relative error of sigma where a surface is off by so many sigmas three sigma out.
    pub(crate) fn far_out(off: f64) -> f64 {
        SurrogateCheck::far_out(off)
    }

    /// The variance that the surrogate of a characteristic does not have, by the check; None where nothing was checked.
    pub(crate) fn unexplained(&self, c: usize) -> Option<f64> {
        self.checked[c].as_ref().filter(|check| check.points > 1).map(|check| check.variance)
    }
}
