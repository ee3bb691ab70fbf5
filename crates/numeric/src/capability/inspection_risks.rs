//! The risks of an inspection, as results have them.

use serde::Serialize;

use crate::power::rescale;

/// A share that is estimated: of the variance, or of all parts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EstimatedShare {
    /// Its value; an estimate from a sample may be below 0 by its error.
    pub value: f64,
    /// Three of these reach the truth; None where nothing is known of it.
    pub error: Option<f64>,
}

/// The risks of an inspection with a gauge that errs. Shares are of all parts unless something else is said.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct InspectionRisks {
    /// The standard deviation of the gauge.
    pub gauge: f64,
    /// By how much the limits are tightened; None where no guard reaches the rate that is wanted.
    pub guard: Option<f64>,
    /// The tightened limits.
    pub acceptance: [Option<f64>; 2],
    /// Bad and accepted: the consumer's risk.
    pub false_accept: Option<EstimatedShare>,
    /// Good and rejected: the producer's risk.
    pub false_reject: Option<EstimatedShare>,
    /// Accepted.
    pub accepted: Option<EstimatedShare>,
    /// Of the accepted parts, those that are bad.
    pub bad_among_accepted: Option<EstimatedShare>,
}

rescale!(InspectionRisks { gauge, guard, acceptance } without { false_accept, false_reject, accepted, bad_among_accepted });
