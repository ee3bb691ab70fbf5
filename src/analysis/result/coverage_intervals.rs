//! Intervals that hold a given share of assemblies, as reported.

use serde::Serialize;

use crate::analysis::result::yield_source::YieldSource;
use sensitol_numeric::power::rescale;

/// Two intervals that hold a share `p` of all assemblies.
///
/// Source: JCGM 101:2008, 5.3.2 to 5.3.4 and 7.7.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CoverageIntervals {
    /// Share of assemblies that each interval holds.
    pub probability: f64,
    /// Interval with equal shares of assemblies below and above it.
    pub equal_tails: [f64; 2],
    /// Errors of the ends of `equal_tails`; null if unknown.
    pub equal_tails_errors: [Option<f64>; 2],
    /// Shortest interval.
    pub shortest: [f64; 2],
    /// Errors of the ends of `shortest`, as quantiles; null if unknown.
    pub shortest_errors: [Option<f64>; 2],
    /// Source of the intervals: that of the quantiles.
    pub source: YieldSource,
}

rescale!(CoverageIntervals { equal_tails, equal_tails_errors, shortest, shortest_errors } without { probability, source });
