//! Half a million interactions as the few that matter, and what all others make together.

use serde::Serialize;

use super::{AllocationReport, CharacteristicReport, Report};
use crate::analysis::Missing;

/// An interaction below this share of the variance is not listed by itself,
const LEAST: f64 = 1e-6;
/// nor one that so many exceed: some megabytes of JSON.
const MOST: usize = 10_000;

/// Interactions that are not listed one by one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct RemainderReport {
    /// How many.
    pub count: usize,
    /// Their shares of the variance, added up; of those whose share is known.
    pub share: f64,
    /// How many of them were not evaluated before the run was stopped.
    pub not_evaluated: usize,
}

impl Report {
    /// Without the interactions that hardly matter: what they make together stands in their place.
    pub fn shortened(mut self) -> Self {
        self.characteristics.iter_mut().for_each(shorten);
        self
    }
}

impl AllocationReport {
    /// The same of every characteristic, before and after.
    pub fn shortened(mut self) -> Self {
        self.characteristics.iter_mut().for_each(|one| {
            shorten(&mut one.before);
            one.after.iter_mut().for_each(shorten);
        });
        self
    }
}

fn shorten(one: &mut CharacteristicReport) {
    let all = std::mem::take(&mut one.interactions);
    let mut remainder = RemainderReport::default();
    // Strongest first: a place is a rank.
    for (rank, pair) in all.into_iter().enumerate() {
        let open = pair.missing == Some(Missing::NotEvaluated);
        if rank < MOST && !open && pair.share.is_none_or(|share| share >= LEAST) {
            one.interactions.push(pair);
            continue;
        }
        remainder.count += 1;
        remainder.share += pair.share.unwrap_or(0.0);
        remainder.not_evaluated += usize::from(open);
    }
    one.interactions_remainder = (remainder.count > 0).then_some(remainder);
}
