//! Yield over all distributions of dimensions of which only the band is promised.

use serde::Serialize;

/// Least and greatest yield, whatever the distribution of some dimensions within their bands.
///
/// Figures beside it, such as sigma and the quantiles, are those of uniform distributions in their place.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DistributionFreeYield {
    /// Names of the dimensions that may have any distribution.
    pub dimensions: Vec<String>,
    /// Least and greatest yield. None if they are unknown: bounds need a linear formula, or a cheap model with one such dimension.
    pub interval: Option<[f64; 2]>,
    /// True if the interval is proven, as for linear formulas. False if it comes from points of the model, or is unknown.
    pub proven: bool,
    /// Values and shares of a distribution with the least yield. None if several dimensions may have any distribution.
    pub worst: Option<Vec<[f64; 2]>>,
}

impl DistributionFreeYield {
    /// Interval that no distribution leaves. Its lower end is 0 without a proof, because counted bounds need not hold between the values at
    /// which they are counted. None if nothing is known.
    pub fn certain_interval(&self) -> Option<[f64; 2]> {
        self.interval.map(|[least, greatest]| [if self.proven { least } else { 0.0 }, greatest])
    }
}
