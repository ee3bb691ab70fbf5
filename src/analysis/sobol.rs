//! Sobol' indices as results have them.

use serde::{Serialize, Serializer};

use crate::verification::Share;
use sensitol_numeric::capability::EstimatedShare;

/// The source of Sobol' indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum IndexSource {
    /// The surface, without an evaluation.
    Surface,
    /// The model, by exchanging inputs between two samples.
    Exchange,
    /// A sample of the model that was there already, by the ranks of every input: first order only.
    Ranks,
}

/// Dimensions that vary together, as one factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FactorIndices {
    /// The dimensions.
    pub dimensions: Vec<String>,
    /// The part of the variance that they explain by themselves.
    pub first_order: Option<EstimatedShare>,
    /// The same with everything in which they have a part.
    pub total: Option<EstimatedShare>,
}

/// Where the indices of a characteristic come from, and those of factors that are no single dimension.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SobolIndices {
    /// Their source: `surface`, `exchange` of inputs of the model, or `ranks` of a sample.
    #[cfg_attr(feature = "schema", schemars(with = "String"))]
    pub source: IndexSource,
    /// Dimensions that vary together: these have indices as one factor only.
    pub factors: Vec<FactorIndices>,
    /// 1 less the sum of all first orders: interactions, and what the first orders are off.
    pub interactions: Option<f64>,
}

impl IndexSource {
    /// Its name in reports.
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
