//! Which derivatives a method uses, and where its moments come from.

use sensitol_numeric::surrogate::Univariate;

/// How much of the derivatives a method makes use of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Slopes only.
    First,
    /// Curvatures and interactions too.
    Second,
}

impl Order {
    /// Returns as much of a part as is made use of.
    pub(super) fn used(self, part: Univariate) -> Univariate {
        match self {
            Self::First => Univariate::of_coefficients(&[part.slope()]).with_origin(part.origin()),
            Self::Second => part,
        }
    }
}

/// The basis of the moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Basis {
    /// A surrogate of exact derivatives.
    Exact,
    /// A surrogate of differences.
    Differences,
    /// A surrogate fitted by least squares.
    LeastSquares,
    /// Quadrature of the values themselves, without a surrogate.
    Quadrature,
}
