//! Account of the refinement by which `auto` came to its result.

use crate::method::Accuracies;
use crate::method::check_points::SurrogateCheck;
use crate::plan::Point;

/// Reason why a refinement by `auto` ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum ClimbEnd {
    /// The estimated error of every characteristic is as small as requested.
    Reached,
    /// The budget does not allow the next evaluations.
    Budget,
    /// No further evaluations are expected to help.
    Exhausted,
    /// The run was stopped before any other end.
    Stopped,
}

/// Account of the refinement by which `auto` came to its result. Lists of values have one entry for each characteristic.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct AutoAccount {
    /// Relative error of sigma that was requested.
    pub accuracy: f64,
    /// Requested accuracies of the other results.
    pub accuracies: Accuracies,
    /// Reason why the refinement ended.
    pub rest: ClimbEnd,
    /// Positions of varying dimensions with five points.
    pub refined: Vec<usize>,
    /// Number of pairs that were evaluated one by one.
    pub direct: usize,
    /// Number of probes, which move all dimensions at once. A probe takes one evaluation or two.
    pub probes: usize,
    /// Number of check points that were evaluated.
    pub checks: usize,
    /// Number of pairs whose interactions are given by the formulas of all characteristics.
    pub from_formulas: usize,
    /// True if every pair was examined.
    pub all_pairs: bool,
    /// Comparison of model and surrogate for every characteristic; None if it has no surrogate, or if no check point has a value.
    pub checked: Vec<Option<SurrogateCheck>>,
    /// Scatter of answers next to the means, for every characteristic.
    pub noise: Vec<Option<f64>>,
    /// Difference of model and surrogate at three sigma along the steepest line, in sigmas; infinite without a value, None if not examined.
    pub tails: Vec<Option<f64>>,
    /// Value of `tails` without the part that a parabola explains which the check points have shown.
    pub(crate) beyond: Vec<Option<f64>>,
    /// Share of the variance of interactions that the screening did not find; None if no screening was needed.
    pub unscreened: Vec<Option<f64>>,
    /// Points far out that `tails` compares, by characteristic.
    pub(crate) far: Vec<(usize, [Point; 2])>,
}

impl AutoAccount {
    /// Returns the relative error of sigma if a surface is off by `off` sigmas three sigma out.
    pub(crate) fn far_out(off: f64) -> f64 {
        SurrogateCheck::far_out(off)
    }

    /// Returns the variance that the surrogate of a characteristic lacks by its check points; None if fewer than two have a value.
    pub(crate) fn unexplained(&self, c: usize) -> Option<f64> {
        self.checked[c].as_ref().filter(|check| check.points > 1).map(|check| check.variance)
    }
}
