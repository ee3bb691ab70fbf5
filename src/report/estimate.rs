//! Points of the model that results rest on, as reports say it.

use serde::Serialize;

use crate::analysis::SampledModel;
use crate::simulation::Histogram;

/// Points of the model that the moments rest on.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ModelSamplingReport {
    /// How many.
    pub samples: u64,
    /// Standard error of the mean.
    pub mean: Option<f64>,
    /// Standard error of sigma.
    pub sigma: Option<f64>,
    /// Standard error of the skewness.
    pub skewness: Option<f64>,
    /// Standard error of the kurtosis.
    pub kurtosis: Option<f64>,
    /// The share of the sample within the limits.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// Its 95 % interval.
    pub yield_interval: Option<[f64; 2]>,
    /// The sample in intervals.
    pub histogram: Option<Histogram>,
}

impl ModelSamplingReport {
    pub(super) fn of(sampled: &SampledModel) -> Self {
        let [mean, sigma, skewness, kurtosis] = sampled.standard_errors;
        let (yield_, yield_interval) = sampled.yield_.unzip();
        let histogram = sampled.histogram.clone();
        Self { samples: sampled.samples, mean, sigma, skewness, kurtosis, yield_, yield_interval, histogram }
    }
}
