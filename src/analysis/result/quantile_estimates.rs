//! Quantiles of a characteristic, as reported.

use serde::Serialize;

use crate::analysis::result::yield_source::YieldSource;
use sensitol_numeric::capability::{EstimatedQuantile, Quantiles, percentile_errors, percentiles};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::power::rescale;

/// Indices of the outer two quantiles and the median.
const OUTER: [usize; 3] = [0, 3, 6];

/// Quantiles with their errors, all from one source.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct QuantileEstimates {
    /// Source of the quantiles: that of the yield, unless that is a proof about the limits only.
    pub source: YieldSource,
    /// Quantiles by their probabilities; null at a probability that the source does not resolve.
    pub values: Quantiles<Option<EstimatedQuantile>>,
    /// Error of `cp_percentile`. None if it is unknown.
    pub cp_percentile_error: Option<f64>,
    /// Error of `cpk_percentile`. None if it is unknown.
    pub cpk_percentile_error: Option<f64>,
}

rescale!(QuantileEstimates { values } without { source, cp_percentile_error, cpk_percentile_error });

impl QuantileEstimates {
    /// Quantiles of one source, with the errors of the indices for these limits.
    pub(in crate::analysis) fn new(
        source: YieldSource,
        values: Quantiles<Option<EstimatedQuantile>>,
        limits: SpecLimits,
    ) -> Self {
        let own = Self { source, values, cp_percentile_error: None, cpk_percentile_error: None };
        let [cp_percentile_error, cpk_percentile_error] =
            own.outer().map_or([None; 2], |outer| percentile_errors(outer, limits));
        Self { cp_percentile_error, cpk_percentile_error, ..own }
    }

    /// The quantiles 0.00135, 0.5 and 0.99865. Returns None if one of them is not resolved.
    pub fn outer(&self) -> Option<[EstimatedQuantile; 3]> {
        let [low, middle, high] = OUTER.map(|index| self.values.0[index]);
        Some([low?, middle?, high?])
    }

    /// Cp and Cpk by the quantiles. None without limits, and if a quantile is not resolved.
    pub(in crate::analysis) fn indices(&self, limits: SpecLimits) -> [Option<f64>; 2] {
        self.outer().map_or([None; 2], |outer| percentiles(outer.map(|quantile| quantile.value), limits))
    }
}
