//! What the size of measured samples leaves open, as reports show it.

use serde::Serialize;

use crate::analysis::SamplingInterval;

/// Intervals that cover the true results, as far as the size of measured samples decides.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct SamplingReport {
    /// Of the mean.
    pub mean: Option<[f64; 2]>,
    /// Of sigma.
    pub sigma: Option<[f64; 2]>,
    /// Of the skewness.
    pub skewness: Option<[f64; 2]>,
    /// Of the kurtosis.
    pub kurtosis: Option<[f64; 2]>,
    /// Of the share within the limits.
    #[serde(rename = "yield")]
    pub yield_: Option<[f64; 2]>,
    /// Of Cpk.
    pub cpk: Option<[f64; 2]>,
    /// The probability with which each covers the truth.
    pub level: f64,
    /// How many resamples they come from.
    pub resamples: usize,
    /// What they rest on, in words, to be printed.
    #[serde(skip)]
    pub basis: String,
    /// Of the share outside the limits, with digits that the yield has lost.
    #[serde(skip)]
    pub rejected: Option<[f64; 2]>,
    /// The measured dimensions with the number of their values, which were drawn anew (BCa bootstrap) with the surrogate kept.
    #[serde(serialize_with = "by_name")]
    #[cfg_attr(feature = "cli", schemars(with = "std::collections::BTreeMap<String, usize>"))]
    pub samples: Vec<(String, usize)>,
}

fn by_name<S: serde::Serializer>(samples: &[(String, usize)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(samples.iter().map(|(name, count)| (name, count)))
}

impl SamplingReport {
    pub(super) fn of(interval: &SamplingInterval) -> Self {
        Self {
            mean: interval.mean,
            sigma: interval.sigma,
            skewness: interval.skewness,
            kurtosis: interval.kurtosis,
            yield_: interval.yield_(),
            cpk: interval.cpk,
            level: interval.level,
            resamples: interval.resamples,
            basis: interval.basis(),
            rejected: interval.rejected,
            samples: interval.samples.clone(),
        }
    }
}
