//! How what is required, what there was and what there is of it are written.

use serde::{Serialize, Serializer};

use sensitol_numeric::requirement::{Required, Requirement};
use sensitol_numeric::shape::{ends, finite};
use sensitol_numeric::verdict::{Judged, Verdict};

/// The value of a requirement before, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct Before {
    /// The value before.
    before: Option<f64>,
    /// Whether it was kept; null where that is not known.
    met_before: Option<bool>,
    /// The same in a word.
    verdict_before: Verdict,
}

impl From<&Judged> for Before {
    fn from(of: &Judged) -> Self {
        Self { before: of.value.and_then(finite), met_before: of.verdict.met(), verdict_before: of.verdict }
    }
}

/// The value of a requirement after, as it is written; all null where nothing was found.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct After {
    /// The value found.
    after: Option<f64>,
    /// Within which that is known, an end null where there is none; null where it is not known at all.
    interval: Option<[Option<f64>; 2]>,
    /// Whether it is kept; null where that is not known, and where nothing was found.
    met: Option<bool>,
    /// The same in a word; null where nothing was found.
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

/// The verdict of a sample on a requirement, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct Sampled {
    /// The figure of the sample.
    value: Option<f64>,
    /// Within which that is known, three errors on either side; null where it is not known at all.
    interval: Option<[Option<f64>; 2]>,
    /// The verdict on the requirement from that.
    verdict: Verdict,
}

/// Null without a sample.
pub(super) fn sampled<S: Serializer>(of: &Option<Judged>, serializer: S) -> Result<S::Ok, S::Error> {
    let written = |of: &Judged| Sampled {
        value: of.value.and_then(finite),
        interval: of.interval.map(ends),
        verdict: of.verdict,
    };
    of.as_ref().map(written).serialize(serializer)
}

/// A requirement of a characteristic, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct RequiredOf<'r> {
    /// The characteristic.
    characteristic: &'r str,
    #[serde(flatten)]
    required: Required,
}

/// The requirement of a characteristic at a point of the front.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FrontRequirement {
    /// The characteristic; all with limits where a joint yield is required.
    pub characteristic: String,
    /// The requirement.
    pub requirement: Requirement,
    /// How much of it; of rss and worst case the part of the room that they may take.
    pub amount: f64,
}

/// The requirement of every characteristic.
pub(super) fn required<S: Serializer>(all: &[FrontRequirement], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(all.iter().map(|wanted| RequiredOf {
        characteristic: &wanted.characteristic,
        required: Required::of(&wanted.requirement, wanted.amount),
    }))
}
