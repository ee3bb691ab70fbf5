//! Risks of an inspection, as serialised in results.

use serde::Serialize;

use crate::power::rescale;

/// Estimated share: of the variance, or of all parts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EstimatedShare {
    /// Estimated share. An estimate from a sample may be below 0 by its error.
    pub value: f64,
    /// Error of the share: the true value lies within three of these. None if it is unknown.
    pub error: Option<f64>,
}

/// Risks of an inspection with a gauge that has an error. Shares are of all parts unless stated otherwise.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct InspectionRisks {
    /// Standard deviation of the gauge.
    pub gauge: f64,
    /// Amount by which the limits are tightened. None if no guard reaches the requested rate.
    pub guard: Option<f64>,
    /// Tightened limits.
    pub acceptance: [Option<f64>; 2],
    /// Share of parts that are bad and accepted: the consumer's risk.
    pub false_accept: Option<EstimatedShare>,
    /// Share of parts that are good and rejected: the producer's risk.
    pub false_reject: Option<EstimatedShare>,
    /// Share of parts that are accepted.
    pub accepted: Option<EstimatedShare>,
    /// Share of bad parts among the accepted ones.
    pub bad_among_accepted: Option<EstimatedShare>,
}

rescale!(InspectionRisks { gauge, guard, acceptance } without { false_accept, false_reject, accepted, bad_among_accepted });
