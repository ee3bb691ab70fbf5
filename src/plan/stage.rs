//! Stage: points that are evaluated together, with their purposes.

use super::Point;

/// Points that can all be evaluated now, in parallel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stage {
    /// Points, each once, with their purposes.
    pub points: Vec<(Point, Purpose)>,
}

/// Purpose of a point. A point with several purposes has the first of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Purpose {
    /// All dimensions at their means: the centre of every difference.
    Centre,
    /// All dimensions at their nominal values.
    Nominal,
    /// One dimension at a node, for slopes and curvatures.
    Axis,
    /// Two dimensions at nodes, for their mixed derivative.
    Pair,
    /// Every dimension at a node, up or down, for all interactions at once.
    Probe,
    /// Point of the dimensions' distribution, at which the surrogate is compared with the model.
    Check,
    /// Point close to the means, for the scatter of the model's answers.
    Noise,
    /// Dimension without tolerance, moved a little for its sensitivity.
    Sensitivity,
    /// Shorter step in place of one at which the model failed.
    Repair,
    /// One input at a node of its quadrature rule, along its own axis or along an eigenvector.
    Cut,
    /// Two inputs at nodes of their quadrature rules.
    Plane,
    /// All inputs at nodes of their quadrature rules.
    Grid,
    /// All dimensions off their means: a corner of a factorial design.
    Corner,
}

impl Purpose {
    /// Description for readers.
    pub fn words(self) -> &'static str {
        match self {
            Self::Centre => "all dimensions at their means",
            Self::Nominal => "all dimensions at their nominal values",
            Self::Axis => "one dimension at a node: slopes and curvatures",
            Self::Pair => "two dimensions at nodes: mixed derivatives",
            Self::Probe => "every dimension at a node: all interactions at once",
            Self::Check => "points of the dimensions' distribution: model against surrogate",
            Self::Noise => "next to the means: what answers scatter by",
            Self::Sensitivity => "a dimension without tolerance, moved a little: its sensitivity",
            Self::Repair => "a shorter step where the model failed",
            Self::Cut => "one input at a node of its quadrature rule",
            Self::Plane => "two inputs at nodes of their quadrature rules",
            Self::Grid => "all inputs at nodes of their quadrature rules",
            Self::Corner => "all dimensions off their means: a corner of the factorial design",
        }
    }
}
