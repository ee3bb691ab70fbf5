//! The requirement of a characteristic.

use serde::{Serialize, Serializer};

use crate::power::Power;

/// A requirement of a characteristic: when tolerances are chosen, and when a result is judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Requirement {
    /// The share within the limits is at least this; where tolerances are chosen, by four moments and the Pearson fit.
    Yield(f64),
    /// `min(U - mean, mean - L) / 3 sigma` is at least this.
    Cpk(f64),
    /// Sigma is at most this.
    Sigma(f64),
    /// The middle of the linear model plus and minus the root of the sum of squares lies within the limits.
    Rss,
    /// The worst case lies within the limits: proven by interval arithmetic where the formula allows that, of the surface elsewhere.
    WorstCase,
}

/// Why a requirement cannot be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RequirementError {
    /// A yield that is not a share, or one that only a worst case can promise.
    #[error("a required yield must lie between 0 and 1, both excluded, not {value}")]
    ImpossibleYield {
        /// As given.
        value: f64,
    },
    /// A number that must be above 0.
    #[error("the required {what} must be above 0, but is {value}")]
    NotPositive {
        /// `Cpk` or `sigma`.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// Limits are needed to say what is required.
    #[error("to require {what} of a characteristic, it needs limits")]
    NoLimits {
        /// The requirement.
        what: &'static str,
    },
}

/// A requirement as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Required {
    /// `yield`, `cpk`, `sigma`, `rss` or `worst-case`.
    requirement: &'static str,
    /// How much of it; of `rss` and `worst-case` at most all of the room that the limits leave, 1.
    required: f64,
}

impl From<&Requirement> for Required {
    fn from(of: &Requirement) -> Self {
        Self::of(of, of.amount())
    }
}

impl Required {
    /// So much of it.
    pub fn of(requirement: &Requirement, amount: f64) -> Self {
        Self { requirement: requirement.key(), required: amount }
    }
}

impl Serialize for Requirement {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Required::from(self).serialize(serializer)
    }
}

impl Requirement {
    /// The requirement's name in JSON and CSV.
    pub fn key(&self) -> &'static str {
        match self {
            Self::Cpk(_) => "cpk",
            other => other.name(),
        }
    }

    /// The same of a characteristic times a power of two.
    pub fn times(self, power: Power) -> Self {
        match self {
            Self::Sigma(value) => Self::Sigma(power.times(value).clamp(f64::MIN_POSITIVE, f64::MAX)),
            other => other,
        }
    }

    /// How much is required; of limits, all of the room that they leave.
    pub fn amount(&self) -> f64 {
        self.value().unwrap_or(1.0)
    }

    /// The requirement, in a word.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Yield(_) => "yield",
            Self::Cpk(_) => "Cpk",
            Self::Sigma(_) => "sigma",
            Self::Rss => "rss",
            Self::WorstCase => "worst-case",
        }
    }

    /// How much of it; None where the limits say that.
    pub fn value(&self) -> Option<f64> {
        match *self {
            Self::Yield(value) | Self::Cpk(value) | Self::Sigma(value) => Some(value),
            Self::Rss | Self::WorstCase => None,
        }
    }

    /// Of a characteristic that has limits, or has none.
    ///
    /// # Errors
    /// When the number is impossible, or limits are missing that it speaks of.
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
