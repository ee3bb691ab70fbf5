//! Results of a sample of the model whose surrogate was not trusted.

use serde::Serialize;

use crate::simulation::Histogram;
use crate::verification::Share;
use sensitol_numeric::capability::EstimatedQuantile;
use sensitol_numeric::json_form::{Four, through};
use sensitol_numeric::power::{Losable, Rescale, Rescaling};

/// Points of the model in place of a surrogate that was not trusted.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SampledModel {
    /// Number of points with a value.
    pub samples: u64,
    /// Number of further points at which the model has no value.
    pub failed: u64,
    /// Error of the first of them.
    pub error: Option<String>,
    /// Share of the variance that the surrogate left unexplained at the check points. None if no surrogate is a control variate, because the
    /// characteristic follows a choice from stock.
    pub left: Option<f64>,
    /// Standard errors of mean, sigma, skewness and kurtosis. None if unknown.
    #[serde(flatten, serialize_with = "through::<Four<Option<f64>>, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Four<Option<f64>>"))]
    pub standard_errors: [Option<f64>; 4],
    /// Share of the sample within the limits. None if there are no limits.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// 95 % interval of the yield.
    pub yield_interval: Option<[f64; 2]>,
    /// Shares of the sample below the lower and above the upper limit. None if that limit does not exist.
    pub beyond: [Option<f64>; 2],
    /// 95 % intervals of `beyond`.
    #[serde(skip)]
    pub(crate) intervals: [Option<[f64; 2]>; 2],
    /// Quantiles of the sample at the reported probabilities. None at one that it does not resolve.
    #[serde(skip)]
    pub(crate) quantiles: [Option<EstimatedQuantile>; 7],
    /// Histogram of the sample, with some tens of intervals.
    pub histogram: Option<Histogram>,
    /// First-order indices of the dimensions, by the ranks of the sample. Empty if the model is cheap enough to be evaluated again.
    #[serde(skip)]
    pub(crate) ranks: Vec<(usize, Share)>,
}

impl Rescale for SampledModel {
    fn rescale(&mut self, by: &mut Rescaling) {
        let [mean, sigma, ..] = &mut self.standard_errors;
        mean.rescale(by);
        sigma.rescale(by);
        self.quantiles.rescale(by);
        self.histogram.rescale(by);
    }
}

impl Losable for SampledModel {}
