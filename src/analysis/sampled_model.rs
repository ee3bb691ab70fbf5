//! The results of a sample of the model where its surrogate was not trusted.

use serde::Serialize;

use crate::simulation::Histogram;
use crate::verification::Share;
use sensitol_numeric::power::{Rescale, Rescaling, Unknown};
use sensitol_numeric::shape::{Four, through};

/// Points of the model in place of a surrogate that was not trusted.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SampledModel {
    /// Points.
    pub samples: u64,
    /// Points at which the model has no value, beside these.
    pub failed: u64,
    /// Why not, of the first.
    pub error: Option<String>,
    /// The share of the variance that the surrogate left unexplained at the check.
    pub left: f64,
    /// Standard errors of mean, sigma, skewness and kurtosis, as far as they are known.
    #[serde(flatten, serialize_with = "through::<Four<Option<f64>>, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Four<Option<f64>>"))]
    pub standard_errors: [Option<f64>; 4],
    /// The share of the sample within the limits with its 95 % interval.
    #[serde(flatten, serialize_with = "through::<YieldShape, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "YieldShape"))]
    pub yield_: Option<(f64, [f64; 2])>,
    /// Its shares below the lower and above the upper limit; None without that limit.
    pub beyond: [Option<f64>; 2],
    /// The 95 % intervals of these shares.
    #[serde(skip)]
    pub(crate) intervals: [Option<[f64; 2]>; 2],
    /// The sample, counted in some tens of intervals.
    pub histogram: Option<Histogram>,
    /// First-order indices of the dimensions, by the ranks of the sample; empty where the model is cheap enough to be asked anew.
    #[serde(skip)]
    pub(crate) ranks: Vec<(usize, Share)>,
}

impl Rescale for SampledModel {
    fn rescale(&mut self, by: &mut Rescaling) {
        let [mean, sigma, ..] = &mut self.standard_errors;
        mean.rescale(by);
        sigma.rescale(by);
        self.histogram.rescale(by);
    }
}

impl Unknown for SampledModel {}

/// A share and its interval, as they are written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct YieldShape {
    /// The share of the sample within the limits.
    #[serde(rename = "yield")]
    yield_: Option<f64>,
    /// Its 95 % interval.
    yield_interval: Option<[f64; 2]>,
}

impl From<&Option<(f64, [f64; 2])>> for YieldShape {
    fn from(found: &Option<(f64, [f64; 2])>) -> Self {
        let (yield_, yield_interval) = found.unzip();
        Self { yield_, yield_interval }
    }
}
