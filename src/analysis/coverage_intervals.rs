//! Intervals that hold a share of assemblies, as they are reported.

use serde::Serialize;

use super::yield_source::YieldSource;
use sensitol_numeric::power::rescale;

/// Two intervals that hold a share `p` of all assemblies.
///
/// Source: JCGM 101:2008, 5.3.2 to 5.3.4 and 7.7.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CoverageIntervals {
    /// The share of assemblies that each holds.
    pub probability: f64,
    /// With as many assemblies below as above.
    pub equal_tails: [f64; 2],
    /// The shortest of all.
    pub shortest: [f64; 2],
    /// Where they come from: a surface that is trusted, else points of the model, else the Pearson fit.
    pub source: YieldSource,
}

rescale!(CoverageIntervals { equal_tails, shortest } without { probability, source });
