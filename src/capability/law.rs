//! The distribution of a characteristic, as far as four moments tell.

use crate::moments::Moments;
use crate::pearson::{Pearson, PearsonError};

/// A distribution with the four moments of a characteristic.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// Every assembly has this value: sigma is 0.
    Point {
        /// The value.
        at: f64,
    },
    /// The member of the Pearson system.
    Pearson(Box<Pearson>),
}

impl Law {
    /// The law of these moments.
    ///
    /// # Errors
    /// When no distribution has them.
    pub fn fit(moments: &Moments) -> Result<Self, PearsonError> {
        let (Some(skewness), Some(excess)) = (moments.skewness(), moments.excess()) else {
            return match moments.mean() {
                mean if mean.is_finite() => Ok(Self::Point { at: mean }),
                _ => Err(PearsonError::NotFinite),
            };
        };
        Ok(Self::Pearson(Box::new(Pearson::with_excess(moments.mean(), moments.sigma(), skewness, excess)?)))
    }

    /// The normal law with their mean and sigma, beside which the fit is shown.
    ///
    /// # Errors
    /// When mean or sigma is not finite.
    pub fn normal(moments: &Moments) -> Result<Self, PearsonError> {
        Self::fit(&match moments.skewness() {
            Some(_) => Moments::new(moments.mean(), moments.sigma(), 0.0, 0.0),
            None => *moments,
        })
    }

    /// Probability below `x`, which itself does not count.
    pub fn below(&self, x: f64) -> f64 {
        match self {
            Self::Point { at } => f64::from(*at < x),
            Self::Pearson(law) => law.cdf(x),
        }
    }

    /// Probability above `x`, which itself does not count.
    pub fn above(&self, x: f64) -> f64 {
        match self {
            Self::Point { at } => f64::from(*at > x),
            Self::Pearson(law) => law.sf(x),
        }
    }

    /// Below which the probability is `p`.
    pub fn quantile(&self, p: f64) -> f64 {
        match self {
            Self::Point { at } => *at,
            Self::Pearson(law) => law.quantile(p),
        }
    }

    /// Above which the probability is `p`.
    pub fn upper_quantile(&self, p: f64) -> f64 {
        match self {
            Self::Point { at } => *at,
            Self::Pearson(law) => law.upper_quantile(p),
        }
    }
}
