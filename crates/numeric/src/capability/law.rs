//! The distribution of a characteristic, as far as four moments tell.

use serde::Serialize;

use super::Quantiles;
use crate::moments::Moments;
use crate::pearson::{Pearson, PearsonError};
use crate::power::{Rescale, Rescaling};
use crate::shape::{ends, through};

/// A distribution with the four moments of a characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "family", rename_all = "lowercase")]
pub enum Law {
    /// Every assembly has this value: sigma is 0.
    Point {
        /// The value.
        at: f64,
    },
    /// The member of the Pearson system.
    Pearson(
        #[serde(serialize_with = "through::<PearsonShape, _, _>")]
        #[cfg_attr(feature = "schema", schemars(with = "PearsonShape"))]
        Box<Pearson>,
    ),
}

/// A member of the Pearson system as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(inline))]
struct PearsonShape {
    /// Its type.
    #[serde(rename = "type")]
    kind: &'static str,
    /// Lower and upper end, where there are any.
    support: [Option<f64>; 2],
    /// Quantiles.
    quantiles: Quantiles,
}

impl From<&Box<Pearson>> for PearsonShape {
    fn from(law: &Box<Pearson>) -> Self {
        Self { kind: law.kind().name(), support: ends(law.support()), quantiles: Quantiles::of(law) }
    }
}

impl Rescale for Law {
    fn rescale(&mut self, by: &mut Rescaling) {
        match self {
            Self::Point { at } => at.rescale(by),
            Self::Pearson(law) => law.rescale(by),
        }
    }
}

impl Law {
    /// The law of these moments: the normal one where skewness and excess are roundings, which sums of normal dimensions leave.
    ///
    /// # Errors
    /// When no distribution has them.
    pub fn fit(moments: &Moments) -> Result<Self, PearsonError> {
        let (Some(skewness), Some(excess)) = (moments.skewness(), moments.excess()) else {
            return match moments.mean() {
                mean if mean.is_finite() && moments.sigma() == 0.0 => Ok(Self::Point { at: mean }),
                _ => Err(PearsonError::NotFinite),
            };
        };
        // Differences of a linear stack leave this much of both; at 8 sigma a probability moves by 1e-10 of itself.
        const ROUNDING: f64 = 1e-12;
        let nothing = skewness.abs() < ROUNDING && excess.abs() < ROUNDING;
        let [skewness, excess] = if nothing { [0.0; 2] } else { [skewness, excess] };
        Ok(Self::Pearson(Box::new(Pearson::with_excess(moments.mean(), moments.sigma(), skewness, excess)?)))
    }

    /// The normal law with their mean and sigma, beside which the fit is shown.
    ///
    /// # Errors
    /// When mean or sigma is not finite.
    pub fn normal(moments: &Moments) -> Result<Self, PearsonError> {
        let varies = moments.skewness().is_some() || moments.sigma() > 0.0;
        Self::fit(&if varies { Moments::new(moments.mean(), moments.sigma(), 0.0, 0.0) } else { *moments })
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
