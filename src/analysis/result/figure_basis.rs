//! Bases of the certainty of figures.

use serde::Serialize;

/// Basis of the certainty of a figure, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FigureBasis {
    /// Proof: rounding is the only error.
    Proof,
    /// Points of the model that sample the whole distribution, or measured values in a proven surface.
    Points,
    /// The surface: its figures hold if the model follows it between the check points.
    Surface,
}

impl FigureBasis {
    /// Name of the basis in JSON and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Proof => "proof",
            Self::Points => "points",
            Self::Surface => "surface",
        }
    }
}

/// The bases of the figures of a characteristic. None for a figure that is unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FigureBases {
    /// Basis of mean, sigma, skewness and kurtosis.
    pub moments: Option<FigureBasis>,
    /// Basis of the yield and of the reject rates.
    #[serde(rename = "yield")]
    pub yield_: Option<FigureBasis>,
    /// Basis of the quantiles.
    pub quantiles: Option<FigureBasis>,
}
