//! The source of a derivative of a surface.

use serde::Serialize;

/// The source of a derivative of a surface, the most reliable first. A proof accepts [`Exact`](Self::Exact) and
/// [`Evaluated`](Self::Evaluated) only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum DerivativeOrigin {
    /// Differentiated from a formula.
    Exact,
    /// Computed from values of the model at points of its own.
    Evaluated,
    /// Estimated by a fit that many derivatives share, or assumed to be 0: it has no evaluation of its own.
    Screened,
}

impl DerivativeOrigin {
    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Evaluated => "evaluated",
            Self::Screened => "screened",
        }
    }

    /// Whether it was differentiated or evaluated, so that a proof may rest on it.
    pub fn is_known(self) -> bool {
        self != Self::Screened
    }

    /// The origin of a sum of two derivatives: the less reliable one.
    pub(crate) fn and(self, other: Self) -> Self {
        self.max(other)
    }
}
