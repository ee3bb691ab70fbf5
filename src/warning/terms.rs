//! Terms that several warnings share.

use serde::Serialize;

/// End of a search for extremes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Ended {
    /// No move along a coordinate improves either extreme.
    Converged,
    /// The budget was spent.
    Budget,
    /// The run was stopped.
    Stopped,
}

/// Change of a characteristic at a switch of its formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Change {
    /// The slope changes.
    Kink,
    /// The value jumps.
    Jump,
    /// There is no value beyond.
    Edge,
}

/// Share of the assemblies in which a pressed part rests on a set of contacts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContactShare {
    /// Contacts that carry the force.
    pub contacts: Vec<String>,
    /// Share of the assemblies.
    pub share: f64,
    /// Standard error of the share.
    pub error: f64,
}

/// Part of a derivative that is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Loss {
    /// Every derivative: there is no value at the means, from which differences are taken.
    Centre,
    /// Slope and curvature: without them the characteristic has no moments.
    Slope,
    /// Curvature only: the slope is one-sided.
    Curvature,
    /// Mixed derivative of two dimensions.
    Mixed,
    /// One side of a mixed derivative.
    OneSidedMixed,
    /// Nothing failed: the run was stopped before the points of these derivatives were evaluated.
    NotEvaluated {
        /// Number of missing derivatives.
        derivatives: usize,
    },
}

/// Figure with a requested accuracy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Figure {
    /// Standard deviation, with a relative error.
    Sigma,
    /// Third standardised moment.
    Skewness,
    /// Fourth standardised moment.
    Kurtosis,
    /// Share within the limits.
    Yield,
}

impl Figure {
    /// Name of the figure in messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Sigma => "sigma",
            Self::Skewness => "skewness",
            Self::Kurtosis => "kurtosis",
            Self::Yield => "yield",
        }
    }
}

/// Kind of thing that a name of a study denotes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum NameKind {
    /// Constant of the study.
    Constant,
    /// Formula that other formulas may use.
    Formula,
    /// Unknown of the closure conditions.
    Unknown,
}

impl NameKind {
    /// Noun for the kind, in singular for a count of 1.
    pub(super) fn noun(self, count: usize) -> &'static str {
        match (self, count) {
            (Self::Constant, 1) => "constant",
            (Self::Constant, _) => "constants",
            (Self::Formula, 1) => "formula",
            (Self::Formula, _) => "formulas",
            (Self::Unknown, 1) => "unknown",
            (Self::Unknown, _) => "unknowns",
        }
    }
}

/// Unit of the progress of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Counted {
    /// Evaluations of the model.
    Evaluations,
    /// Points of a sample.
    Points,
    /// Values of a swept parameter.
    Values,
    /// Methods of a comparison.
    Methods,
}

impl Counted {
    pub(super) fn noun(self, count: u64) -> &'static str {
        match (self, count) {
            (Self::Evaluations, 1) => "evaluation",
            (Self::Evaluations, _) => "evaluations",
            (Self::Points, 1) => "point",
            (Self::Points, _) => "points",
            (Self::Values, 1) => "value",
            (Self::Values, _) => "values",
            (Self::Methods, 1) => "method",
            (Self::Methods, _) => "methods",
        }
    }
}
