//! Requirements of a characteristic: their names, their sense, their unit, and the figure that judges each kind.
//!
//! A new kind is a variant of [`Requirement`], its arms in this file, and a method of [`RequirementFigures`].

use serde::Serialize;

use crate::power::Power;

/// Requirement of a characteristic, used to allocate tolerances and to judge results.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(into = "Required")]
pub enum Requirement {
    /// Least share within the limits. Allocation computes it by four moments and the Pearson fit.
    Yield(f64),
    /// Least value of `min(U - mean, mean - L) / 3 sigma`.
    Cpk(f64),
    /// Greatest sigma, in the unit of the characteristic.
    Sigma(f64),
    /// RSS within the limits: the middle of the linear model plus and minus the root of the sum of squares.
    Rss,
    /// Worst case within the limits: proven by interval arithmetic if the formula allows it, else computed from the surface.
    WorstCase,
}

/// Side of the required amount on which a figure must lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sense {
    /// The figure must be at least the amount.
    AtLeast,
    /// The figure must be at most the amount.
    AtMost,
}

/// Figures of a characteristic, one for each kind of requirement.
///
/// The default of the type means an unknown figure. [`Requirement::figure`] selects the one that judges a requirement.
///
/// ```
/// use sensitol_numeric::requirement::{Requirement, RequirementFigures};
/// struct Moments {
///     sigma: f64,
/// }
/// impl RequirementFigures for Moments {
///     type Figure = Option<f64>;
///     fn sigma(&self) -> Option<f64> {
///         Some(self.sigma)
///     }
/// }
/// assert_eq!(Requirement::Sigma(0.1).figure(&Moments { sigma: 0.2 }), Some(0.2));
/// assert_eq!(Requirement::Rss.figure(&Moments { sigma: 0.2 }), None);
/// ```
pub trait RequirementFigures {
    /// Type of a figure.
    type Figure: Default;

    /// Share within the limits.
    fn yield_(&self) -> Self::Figure {
        Self::Figure::default()
    }

    /// Process capability Cpk.
    fn cpk(&self) -> Self::Figure {
        Self::Figure::default()
    }

    /// Standard deviation.
    fn sigma(&self) -> Self::Figure {
        Self::Figure::default()
    }

    /// Fraction of the limits that the RSS uses.
    fn rss(&self) -> Self::Figure {
        Self::Figure::default()
    }

    /// Fraction of the limits that the worst case uses.
    fn worst_case(&self) -> Self::Figure {
        Self::Figure::default()
    }
}

/// Error of an impossible requirement.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RequirementError {
    /// The required yield is not a share, or is 1, which only a worst case can guarantee.
    #[error("a required yield must lie between 0 and 1, both excluded, not {value}")]
    ImpossibleYield {
        /// Required yield as given.
        value: f64,
    },
    /// The number must be above 0.
    #[error("the required {what} must be above 0, but is {value}")]
    NotPositive {
        /// Figure that is required: `Cpk` or `sigma`.
        what: &'static str,
        /// Number as given, 0 or less.
        value: f64,
    },
    /// The requirement needs limits, and there are none.
    #[error("to require {what} of a characteristic, it needs limits")]
    NoLimits {
        /// Requirement, with an article.
        what: &'static str,
    },
}

/// Requirement as serialised in results.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Required {
    /// Name of the requirement: `yield`, `cpk`, `sigma`, `rss` or `worst-case`.
    requirement: &'static str,
    /// Required amount. For `rss` and `worst-case`, the fraction of the limits used, at most 1.
    required: f64,
}

impl From<Requirement> for Required {
    fn from(of: Requirement) -> Self {
        Self::of(&of, of.amount())
    }
}

impl Required {
    /// Requirement with another amount.
    pub fn of(requirement: &Requirement, amount: f64) -> Self {
        Self { requirement: requirement.key(), required: amount }
    }
}

impl Requirement {
    /// Figure that judges the requirement.
    pub fn figure<F: RequirementFigures + ?Sized>(&self, figures: &F) -> F::Figure {
        match self {
            Self::Yield(_) => figures.yield_(),
            Self::Cpk(_) => figures.cpk(),
            Self::Sigma(_) => figures.sigma(),
            Self::Rss => figures.rss(),
            Self::WorstCase => figures.worst_case(),
        }
    }

    /// Side of the amount on which the figure must lie.
    pub fn sense(&self) -> Sense {
        match self {
            Self::Yield(_) | Self::Cpk(_) => Sense::AtLeast,
            Self::Sigma(_) | Self::Rss | Self::WorstCase => Sense::AtMost,
        }
    }

    /// Scale of rounding errors of the figure near the amount: the rejects of a yield, else the amount.
    pub fn rounding_scale(&self) -> f64 {
        self.target_yield().map_or_else(|| self.amount().abs(), |target| (1.0 - target).abs())
    }

    /// Required yield. Returns None for other requirements.
    pub fn target_yield(&self) -> Option<f64> {
        if let Self::Yield(target) = *self { Some(target) } else { None }
    }

    /// Name of the requirement in JSON and CSV.
    pub fn key(&self) -> &'static str {
        match self {
            Self::Cpk(_) => "cpk",
            other => other.name(),
        }
    }

    /// Requirement of a characteristic that is multiplied by a power of two.
    pub fn times(self, power: Power) -> Self {
        match self {
            Self::Sigma(value) => Self::Sigma(power.times(value).clamp(f64::MIN_POSITIVE, f64::MAX)),
            other => other,
        }
    }

    /// Required amount. For rss and worst case, the fraction of the limits used, 1.
    pub fn amount(&self) -> f64 {
        self.value().unwrap_or(1.0)
    }

    /// Name of the requirement in messages.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Yield(_) => "yield",
            Self::Cpk(_) => "Cpk",
            Self::Sigma(_) => "sigma",
            Self::Rss => "rss",
            Self::WorstCase => "worst-case",
        }
    }

    /// Required amount. Returns None for rss and worst case, which the limits define.
    pub fn value(&self) -> Option<f64> {
        match *self {
            Self::Yield(value) | Self::Cpk(value) | Self::Sigma(value) => Some(value),
            Self::Rss | Self::WorstCase => None,
        }
    }

    /// Requirement of the same kind with another amount. Rss and worst case have none, and stay.
    ///
    /// ```
    /// use sensitol_numeric::requirement::Requirement;
    /// assert_eq!(Requirement::Cpk(1.0).with_amount(1.33), Requirement::Cpk(1.33));
    /// ```
    #[must_use]
    pub fn with_amount(self, amount: f64) -> Self {
        match self {
            Self::Yield(_) => Self::Yield(amount),
            Self::Cpk(_) => Self::Cpk(amount),
            Self::Sigma(_) => Self::Sigma(amount),
            Self::Rss | Self::WorstCase => self,
        }
    }

    /// True if the amount has the unit of the characteristic, false if it has no unit.
    pub fn has_unit(&self) -> bool {
        matches!(self, Self::Sigma(_))
    }

    /// Checks the requirement for a characteristic with or without limits.
    ///
    /// # Errors
    /// If the number is impossible, or the requirement needs limits that are missing.
    pub fn checked(self, limits_exist: bool) -> Result<Self, RequirementError> {
        match self {
            Self::Yield(value) if !(value > 0.0 && value < 1.0) => {
                return Err(RequirementError::ImpossibleYield { value });
            }
            Self::Cpk(value) | Self::Sigma(value) if !(value.is_finite() && value > 0.0) => {
                return Err(RequirementError::NotPositive { what: self.name(), value });
            }
            _ => {}
        }
        if !matches!(self, Self::Sigma(_)) && !limits_exist {
            let what = match self {
                Self::Yield(_) => "a yield",
                Self::Cpk(_) => "a Cpk",
                Self::Rss => "an rss",
                _ => "a worst case",
            };
            return Err(RequirementError::NoLimits { what });
        }
        Ok(self)
    }
}
