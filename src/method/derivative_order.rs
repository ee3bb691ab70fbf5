//! Order of the derivatives that a method uses, and basis of its moments.

use crate::method::DerivativeSource;
use sensitol_numeric::surrogate::Univariate;

/// Highest order of the derivatives that a method uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// First derivatives (slopes) only.
    First,
    /// Second derivatives (curvatures and interactions) too.
    Second,
}

impl Order {
    /// Returns the terms of a univariate part that this order uses.
    pub(super) fn used(self, part: Univariate) -> Univariate {
        match self {
            Self::First => Univariate::of_coefficients(&[part.slope()]).with_origin(part.origin()),
            Self::Second => part,
        }
    }
}

/// Basis of the moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Basis {
    /// Surrogate of exact derivatives.
    Exact,
    /// Surrogate of difference quotients.
    Differences,
    /// Surrogate fitted by least squares.
    LeastSquares,
    /// Quadrature of the values themselves, without a surrogate.
    Quadrature,
}

impl Basis {
    /// Source of the derivatives from which the moments follow. Returns None if they follow from none.
    pub(crate) fn derivatives(self) -> Option<DerivativeSource> {
        match self {
            Self::Exact => Some(DerivativeSource::Exact),
            Self::Differences => Some(DerivativeSource::Difference),
            Self::LeastSquares | Self::Quadrature => None,
        }
    }
}
