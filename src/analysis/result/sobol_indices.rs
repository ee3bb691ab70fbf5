//! Sobol' indices in results.

use serde::{Serialize, Serializer};

use crate::verification::Share;
use sensitol_numeric::capability::EstimatedShare;

/// Source of Sobol' indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum IndexSource {
    /// The surface, without an evaluation.
    Surface,
    /// The model, by exchanging inputs between two samples.
    Exchange,
    /// An existing sample of the model, by the ranks of every input: first order only.
    Ranks,
}

/// Dimensions that vary together, as one factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FactorIndices {
    /// Names of the dimensions.
    pub dimensions: Vec<String>,
    /// Part of the variance that the factor explains alone.
    pub first_order: Option<EstimatedShare>,
    /// Part of the variance with all interactions of the factor.
    pub total: Option<EstimatedShare>,
}

/// Source of the indices of a characteristic, and the indices of factors with several dimensions.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SobolIndices {
    /// Source: `surface`, `exchange` of inputs of the model, or `ranks` of a sample.
    #[cfg_attr(feature = "schema", schemars(with = "String"))]
    pub source: IndexSource,
    /// Dimensions that vary together and have indices as one factor only.
    pub factors: Vec<FactorIndices>,
    /// One minus the sum of all first orders: interactions, and the errors of the first orders.
    pub interactions: Option<f64>,
}

impl IndexSource {
    /// Returns the name of the source in reports.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Surface => "surface",
            Self::Exchange => "exchange",
            Self::Ranks => "ranks",
        }
    }
}

impl Serialize for IndexSource {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl From<Share> for EstimatedShare {
    fn from(share: Share) -> Self {
        Self { value: share.value, error: Some(share.error) }
    }
}
