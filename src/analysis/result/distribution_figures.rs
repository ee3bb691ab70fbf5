//! Yield and quantiles of a characteristic, with the source that they share.

use serde::Serialize;

use crate::analysis::result::coverage_intervals::CoverageIntervals;
use crate::analysis::result::quantile_estimates::QuantileEstimates;
use crate::analysis::result::yield_source::YieldSource;
use crate::estimate::{ConditionalYield, DistributionFreeYield};
use sensitol_numeric::capability::{Capability, CapabilityShape, InspectionRisks};
use sensitol_numeric::json_form::{RejectIntervals, through};
use sensitol_numeric::power::rescale;

/// Figures of the distribution of a characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DistributionFigures {
    /// Source of the yield. None if there is no yield.
    pub yield_source: Option<YieldSource>,
    /// Capability from the best available source ([`yield_source`](Self::yield_source)). Indices by quantiles come from
    /// [`quantiles`](Self::quantiles).
    #[serde(flatten, serialize_with = "through::<CapabilityShape, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "CapabilityShape"))]
    pub capability: Option<Capability>,
    /// 95 % intervals of the shares below and above the limits, each side separately: 0 to 0 if a proof excludes a side. None if
    /// that limit does not exist, and if it is unknown.
    #[serde(flatten, serialize_with = "through::<RejectIntervals, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "RejectIntervals"))]
    pub reject_intervals: [Option<[f64; 2]>; 2],
    /// Quantiles with their errors. None if nothing is known of the distribution.
    pub quantiles: Option<QuantileEstimates>,
    /// Intervals that hold the requested share of assemblies. None if none was requested.
    pub coverage: Option<CoverageIntervals>,
    /// Yield of the assemblies that keep the limits of the characteristic that this one is given. None if it is given none, or if it is
    /// unknown.
    #[serde(rename = "conditional_yield")]
    pub conditional: Option<ConditionalYield>,
    /// Yield over all distributions of dimensions of which only the band is promised. None if there is none.
    pub distribution_free_yield: Option<DistributionFreeYield>,
    /// Risks of the inspection. None if there is no gauge.
    pub inspection: Option<InspectionRisks>,
}

impl DistributionFigures {
    /// Figures by a first capability. Its source is chosen later.
    pub(in crate::analysis) fn by(capability: Option<Capability>) -> Self {
        Self {
            yield_source: None,
            capability,
            reject_intervals: [None; 2],
            quantiles: None,
            coverage: None,
            conditional: None,
            distribution_free_yield: None,
            inspection: None,
        }
    }
}

rescale!(DistributionFigures { quantiles, coverage, inspection } without { yield_source, capability, reject_intervals, conditional, distribution_free_yield });
