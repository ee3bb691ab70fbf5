//! Half a million interactions as the few that matter, and what all others make together.

use super::{Analysis, CharacteristicAnalysis, Missing};

/// An interaction below this share of the variance is not listed by itself,
const LEAST: f64 = 1e-6;
/// nor one that so many exceed: some megabytes of JSON.
const MOST: usize = 10_000;

impl Analysis {
    /// Without the interactions that hardly matter: what they make together stands in their place.
    pub fn shortened(mut self) -> Self {
        self.characteristics.iter_mut().for_each(CharacteristicAnalysis::shorten);
        self
    }
}

impl CharacteristicAnalysis {
    /// The same of one characteristic.
    pub fn shorten(&mut self) {
        let mut remainder = self.interactions_remainder.unwrap_or_default();
        // Strongest first: a place is a rank.
        self.interactions.retain(|rank, pair| {
            let open = pair.missing == Some(Missing::NotEvaluated);
            let listed = rank < MOST && !open && pair.share.is_none_or(|share| share >= LEAST);
            if !listed {
                remainder.count += 1;
                remainder.share += pair.share.unwrap_or(0.0);
                remainder.not_evaluated += usize::from(open);
            }
            listed
        });
        self.interactions_remainder = (remainder.count > 0).then_some(remainder);
    }
}
