//! Serialised forms of requirements and their values before and after.

use serde::{Serialize, Serializer};

use sensitol_numeric::json_form::{ends, finite};
use sensitol_numeric::requirement::{Required, Requirement};
use sensitol_numeric::verdict::{Judged, Verdict};

/// Value of a requirement before, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(in crate::allocation) struct Before {
    /// Value before.
    before: Option<f64>,
    /// True if the requirement was kept before; null if that is not known.
    met_before: Option<bool>,
    /// Verdict on the requirement before.
    verdict_before: Verdict,
}

impl From<&Judged> for Before {
    fn from(of: &Judged) -> Self {
        Self { before: of.value.and_then(finite), met_before: of.verdict.met(), verdict_before: of.verdict }
    }
}

/// Value of a requirement after, as it is written; all null if no tolerances were found.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(in crate::allocation) struct After {
    /// Value at the tolerances found.
    after: Option<f64>,
    /// Interval of the value, with null for an unbounded end; null if the value is not known.
    interval: Option<[Option<f64>; 2]>,
    /// True if the requirement is kept; null if that is not known, and if no tolerances were found.
    met: Option<bool>,
    /// Verdict on the requirement; null if no tolerances were found.
    verdict: Option<Verdict>,
}

impl From<&Option<Judged>> for After {
    fn from(of: &Option<Judged>) -> Self {
        Self {
            after: of.and_then(|of| of.value).and_then(finite),
            interval: of.and_then(|of| of.interval).map(ends),
            met: of.and_then(|of| of.verdict.met()),
            verdict: of.map(|of| of.verdict),
        }
    }
}

/// Verdict of a sample on a requirement, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(in crate::allocation) struct Sampled {
    /// Value from the sample.
    value: Option<f64>,
    /// Interval of the value, three errors on either side; null if the value is not known.
    interval: Option<[Option<f64>; 2]>,
    /// Verdict on the requirement from the interval.
    verdict: Verdict,
}

/// Writes the verdict of a sample, or null if there is none.
pub(in crate::allocation) fn sampled<S: Serializer>(of: &Option<Judged>, serializer: S) -> Result<S::Ok, S::Error> {
    let written = |of: &Judged| Sampled {
        value: of.value.and_then(finite),
        interval: of.interval.map(ends),
        verdict: of.verdict,
    };
    of.as_ref().map(written).serialize(serializer)
}

/// Requirement of a characteristic, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(in crate::allocation) struct RequiredOf<'r> {
    /// Name of the characteristic.
    characteristic: &'r str,
    #[serde(flatten)]
    required: Required,
}

/// Requirement of a characteristic at a point of the front.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FrontRequirement {
    /// Name of the characteristic, or of all with limits for a joint yield.
    pub characteristic: String,
    /// Requirement.
    pub requirement: Requirement,
    /// Required amount. For rss and worst case it is the part of the slack that may be used.
    pub amount: f64,
}

/// Writes the requirement of every characteristic.
pub(in crate::allocation) fn required<S: Serializer>(
    all: &[FrontRequirement],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(all.iter().map(|wanted| RequiredOf {
        characteristic: &wanted.characteristic,
        required: Required::of(&wanted.requirement, wanted.amount),
    }))
}
