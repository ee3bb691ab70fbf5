//! Origin of a derivative of a surface.

use serde::Serialize;

/// Origin of a derivative of a surface, the most reliable first. A proof accepts [`Exact`](Self::Exact) and [`Evaluated`](Self::Evaluated)
/// only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum DerivativeOrigin {
    /// Differentiated from a formula.
    Exact,
    /// Computed from values of the model at points for this derivative.
    Evaluated,
    /// Estimated by a fit that many derivatives share, or assumed to be 0: no evaluation belongs to it alone.
    Screened,
}

impl DerivativeOrigin {
    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Evaluated => "evaluated",
            Self::Screened => "screened",
        }
    }

    /// True if the derivative was differentiated or evaluated, so that a proof may rest on it.
    pub fn is_known(self) -> bool {
        self != Self::Screened
    }

    /// Origin of a sum of two derivatives: the less reliable one.
    pub(crate) fn and(self, other: Self) -> Self {
        self.max(other)
    }
}
