//! Distribution of a characteristic by its four moments.

use serde::Serialize;

use crate::capability::Quantiles;
use crate::json_form::{ends, through};
use crate::moments::Moments;
use crate::pearson::{Pearson, PearsonError};
use crate::power::{Rescale, Rescaling};

/// Distribution with the four moments of a characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "family", rename_all = "lowercase")]
pub enum Law {
    /// Single value of every assembly: sigma is 0.
    Point {
        /// Value of every assembly.
        at: f64,
    },
    /// Member of the Pearson system with the four moments.
    Pearson(
        #[serde(serialize_with = "through::<PearsonShape, _, _>")]
        #[cfg_attr(feature = "schema", schemars(with = "PearsonShape"))]
        Box<Pearson>,
    ),
}

/// Member of the Pearson system as serialised in results.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(inline))]
struct PearsonShape {
    /// Type in the Pearson system: `normal`, or `I` to `VII`.
    #[serde(rename = "type")]
    kind: &'static str,
    /// Lower and upper end of the support, null if infinite.
    support: [Option<f64>; 2],
    /// Quantiles of the distribution.
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
    /// Fits a distribution to moments. It is the normal one if skewness and excess are rounding errors, as sums of normal dimensions leave
    /// them.
    ///
    /// # Errors
    /// If no distribution has these moments.
    pub fn fit(moments: &Moments) -> Result<Self, PearsonError> {
        let (Some(skewness), Some(excess)) = (moments.skewness(), moments.excess()) else {
            return match moments.mean() {
                mean if mean.is_finite() && moments.sigma() == 0.0 => Ok(Self::Point { at: mean }),
                _ => Err(PearsonError::NotFinite),
            };
        };
        // Rounding errors of a linear stack in both. At 8 sigma such a value changes a probability by 1e-10 of itself.
        const ROUNDING: f64 = 1e-12;
        let nothing = skewness.abs() < ROUNDING && excess.abs() < ROUNDING;
        let [skewness, excess] = if nothing { [0.0; 2] } else { [skewness, excess] };
        Ok(Self::Pearson(Box::new(Pearson::with_excess(moments.mean(), moments.sigma(), skewness, excess)?)))
    }

    /// Normal distribution with the mean and sigma of these moments, shown for comparison with the fit.
    ///
    /// # Errors
    /// If mean or sigma is not finite.
    pub fn normal(moments: &Moments) -> Result<Self, PearsonError> {
        let varies = moments.skewness().is_some() || moments.sigma() > 0.0;
        Self::fit(&if varies { Moments::new(moments.mean(), moments.sigma(), 0.0, 0.0) } else { *moments })
    }

    /// Probability strictly below `x`.
    pub fn below(&self, x: f64) -> f64 {
        match self {
            Self::Point { at } => f64::from(*at < x),
            Self::Pearson(law) => law.cdf(x),
        }
    }

    /// Probability strictly above `x`.
    pub fn above(&self, x: f64) -> f64 {
        match self {
            Self::Point { at } => f64::from(*at > x),
            Self::Pearson(law) => law.sf(x),
        }
    }

    /// Value below which the probability is `p`.
    pub fn quantile(&self, p: f64) -> f64 {
        match self {
            Self::Point { at } => *at,
            Self::Pearson(law) => law.quantile(p),
        }
    }

    /// Value above which the probability is `p`.
    pub fn upper_quantile(&self, p: f64) -> f64 {
        match self {
            Self::Point { at } => *at,
            Self::Pearson(law) => law.upper_quantile(p),
        }
    }
}
