//! A batch of points, and what each is for.

use super::Point;

/// Points that can all be evaluated now, side by side.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stage {
    /// The points, each once, with their purpose.
    pub points: Vec<(Point, Purpose)>,
}

/// The purpose of a point. One that serves several purposes bears the first of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Purpose {
    /// All dimensions at their means: the centre of every difference.
    Centre,
    /// All dimensions at their nominal values.
    Nominal,
    /// One dimension at a node: slopes and curvatures.
    Axis,
    /// Two dimensions at nodes: their mixed derivative.
    Pair,
    /// Every dimension at a node, up or down: all interactions at once.
    Probe,
    /// A point of the dimensions' distribution: the surrogate is compared with the model there.
    Check,
    /// Next to the means: what the model's answers scatter by.
    Noise,
    /// A dimension without tolerance, moved a little to know its sensitivity.
    Sensitivity,
    /// A shorter step in place of one at which the model failed.
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
    /// In words.
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
