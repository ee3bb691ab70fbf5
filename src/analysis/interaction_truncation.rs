//! Lists the strongest interactions and sums the rest.

use crate::analysis::{Analysis, CharacteristicAnalysis, Missing};

/// Smallest share of the variance of an interaction that is listed.
const LEAST: f64 = 1e-6;
/// Greatest number of listed interactions: some megabytes of JSON.
const MOST: usize = 10_000;

impl Analysis {
    /// Keeps the interactions that matter. The sum of the others replaces them.
    pub fn shortened(mut self) -> Self {
        self.characteristics.iter_mut().for_each(CharacteristicAnalysis::shorten);
        self
    }
}

impl CharacteristicAnalysis {
    /// Keeps the interactions that matter. The sum of the others is [`interactions_remainder`](crate::analysis::ContributionFigures::interactions_remainder).
    pub fn shorten(&mut self) {
        let mut remainder = self.contributions.interactions_remainder.unwrap_or_default();
        // The strongest are first: the index is the rank.
        self.contributions.interactions.retain(|rank, pair| {
            let open = pair.missing == Some(Missing::NotEvaluated);
            let listed = rank < MOST && !open && pair.share.is_none_or(|share| share >= LEAST);
            if !listed {
                remainder.count += 1;
                remainder.share += pair.share.unwrap_or(0.0);
                remainder.not_evaluated += usize::from(open);
            }
            listed
        });
        self.contributions.interactions_remainder = (remainder.count > 0).then_some(remainder);
    }
}
