//! The points that `auto` evaluates beside the axes.

use crate::plan::Point;

/// Every dimension up or down, and all turned round.
#[derive(Debug, Clone)]
pub(super) struct Probe {
    pub(super) signs: Vec<f64>,
    pub(super) points: [Point; 2],
}

/// Points evaluated beside the axes.
#[derive(Debug, Clone, Default)]
pub(super) struct ChosenPoints {
    /// Points of the distribution, in mirrored pairs.
    pub(super) checks: Vec<[Point; 2]>,
    /// Two points next to the means, opposite to each other.
    pub(super) noise: Option<[Point; 2]>,
    /// For every characteristic that is looked at so, points far out along its steepest line.
    pub(super) tails: Vec<(usize, [Point; 2])>,
    /// Pairs with two evaluations of their own.
    pub(super) direct: Vec<(usize, usize)>,
    /// Probes that judge, and probes that are fitted.
    pub(super) judging: Vec<Probe>,
    pub(super) fitted: Vec<Probe>,
}
