//! The sources that a yield may come from.

use serde::Serialize;

/// The sources of a yield, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum YieldSource {
    /// Proof.
    Proof,
    /// Points of the model itself.
    Samples,
    /// The law of the fitted surface.
    SurfaceLaw,
    /// The Pearson distribution with the four moments.
    Pearson,
}

impl YieldSource {
    /// Name of the source in JSON and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Proof => "proof",
            Self::Samples => "samples",
            Self::SurfaceLaw => "surface-law",
            Self::Pearson => "pearson",
        }
    }

    /// Name of the source in a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Self::Proof => "proof",
            Self::Samples => "points of the model",
            Self::SurfaceLaw => "the surface law",
            Self::Pearson => "the Pearson fit",
        }
    }
}
