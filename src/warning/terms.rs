//! The words that warnings use for more than one case.

use serde::Serialize;

/// How a search for extremes ended.
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

/// The change of a characteristic at a switch of its formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Change {
    /// Its slope changes.
    Kink,
    /// Its value jumps.
    Jump,
    /// It has no value beyond.
    Edge,
}

/// The part of a derivative that is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Loss {
    /// Every derivative: there is no value at the means, from which differences are taken.
    Centre,
    /// Slope and curvature: without them the characteristic has no moments.
    Slope,
    /// The curvature; the slope is one-sided.
    Curvature,
    /// The mixed derivative.
    Mixed,
    /// One side of the mixed derivative.
    OneSidedMixed,
    /// Nothing failed: the run was stopped before the points of these derivatives were evaluated.
    NotEvaluated {
        /// How many derivatives are missing.
        derivatives: usize,
    },
}

/// The result of which an accuracy is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Figure {
    /// Sigma, relative.
    Sigma,
    /// The skewness.
    Skewness,
    /// The kurtosis.
    Kurtosis,
    /// The share within the limits.
    Yield,
}

impl Figure {
    /// Its name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Sigma => "sigma",
            Self::Skewness => "skewness",
            Self::Kurtosis => "kurtosis",
            Self::Yield => "yield",
        }
    }
}

/// The kind of thing that a name of a study stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum NameKind {
    /// A constant.
    Constant,
    /// A formula that other formulas may use.
    Formula,
    /// An unknown of the closure conditions.
    Unknown,
}

impl NameKind {
    /// The word for it, without and with a plural.
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

/// The things that the progress of a run counts.
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
