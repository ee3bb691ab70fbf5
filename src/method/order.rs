//! Which derivatives a method uses, and where its moments come from.

/// How much of the derivatives a method makes use of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// Slopes only.
    First,
    /// Curvatures and interactions too.
    Second,
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
