//! How far results may be off, as reports say it.

use serde::Serialize;

use super::simulation::HistogramReport;
use crate::analysis::SampledModel;
use crate::method::{ErrorEstimate, ErrorSource};

/// Estimated errors, each in the unit of its result. What nothing is known of is null.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ErrorEstimateReport {
    /// Of the mean.
    pub mean: Option<f64>,
    /// Of sigma.
    pub sigma: Option<f64>,
    /// Of the skewness.
    pub skewness: Option<f64>,
    /// Of the kurtosis.
    pub kurtosis: Option<f64>,
    /// Of the share within the limits.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// What they rest on.
    pub sources: Vec<ErrorSource>,
}

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
    pub histogram: Option<HistogramReport>,
}

impl ErrorEstimateReport {
    /// What the estimates rest on, in words.
    pub fn basis(&self) -> String {
        self.sources.iter().map(|source| source.words()).collect::<Vec<_>>().join("; ")
    }

    pub(super) fn of(estimate: &ErrorEstimate) -> Self {
        let ErrorEstimate { mean, sigma, skewness, kurtosis, yield_, .. } = *estimate;
        Self { mean, sigma, skewness, kurtosis, yield_, sources: estimate.sources.clone() }
    }
}

impl ModelSamplingReport {
    pub(super) fn of(sampled: &SampledModel) -> Self {
        let [mean, sigma, skewness, kurtosis] = sampled.standard_errors;
        let (yield_, yield_interval) = sampled.yield_.unzip();
        let histogram = sampled.histogram.as_ref().map(HistogramReport::of);
        Self { samples: sampled.samples, mean, sigma, skewness, kurtosis, yield_, yield_interval, histogram }
    }
}
