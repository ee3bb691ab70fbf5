//! Parts of an analysis that take another form in JSON.

use serde::Serialize;

use crate::method::{Basis, DerivativeSource};

/// The basis of the moments, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct BasisShape {
    /// Where the derivatives that the moments rest on come from: `exact` or `difference`; null where they rest on none.
    derivatives: Option<&'static str>,
    /// The basis of the moments.
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
