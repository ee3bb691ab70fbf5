//! Parts of an analysis that take another form in JSON.

use serde::Serialize;

use crate::method::{Basis, DerivativeSource};

/// Basis of the moments, in JSON.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(in crate::analysis) struct BasisShape {
    /// Source of the derivatives from which the moments follow: `exact` or `difference`; null if they follow from none.
    derivatives: Option<&'static str>,
    /// Basis of the moments.
    basis: Basis,
}

impl From<&Basis> for BasisShape {
    fn from(&basis: &Basis) -> Self {
        let derivatives = match basis {
            Basis::Exact => Some(DerivativeSource::Exact.name()),
            Basis::Differences => Some(DerivativeSource::Difference.name()),
            Basis::LeastSquares | Basis::Quadrature => None,
        };
        Self { derivatives, basis }
    }
}
