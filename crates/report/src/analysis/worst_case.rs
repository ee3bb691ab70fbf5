//! Best known worst case of a characteristic, under the same name in every writer.
//!
//! Proven ends are rounded outward to the printed digits: no assembly lies beyond the numbers on the page.
//! A linear worst case is not a bound, and is called linear.

use crate::document::number::{carried, outward};
use crate::figures::FittedFigures;
use sensitol::analysis::CharacteristicAnalysis;

/// Greatest relative difference of totals that the order of sums may cause.
const SAME: f64 = 1e-9;

/// Origin of the worst case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WorstCaseKind {
    /// Proven bounds that some assemblies reach.
    Proven,
    /// Ends found by a search, which proves nothing.
    Found,
    /// Ends by slopes alone.
    Linear,
}

/// Best known worst case.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct KnownWorstCase {
    pub(crate) kind: WorstCaseKind,
    pub(crate) ends: [f64; 2],
    /// Ends as they are printed.
    pub(crate) texts: [String; 2],
}

/// Worst-case figures of a characteristic.
pub(crate) trait KnownWorstCaseFigures {
    /// Returns the best known worst case, or None if no slope is known.
    fn known_worst_case(&self) -> Option<KnownWorstCase>;

    /// Returns the worst case if it is proven: by bounds that are reached, or because nothing varies.
    fn proven_worst_case(&self) -> Option<KnownWorstCase>;

    /// True if a proven worst case has the same printed ends as the linear one.
    fn is_shown_as_linear(&self, proven: &KnownWorstCase) -> bool;

    /// True if a proven worst case equals the linear one except for rounding.
    fn is_linear(&self, proven: &KnownWorstCase) -> bool;

    fn shown_ends(&self, ends: [f64; 2]) -> [String; 2];
}

impl KnownWorstCaseFigures for CharacteristicAnalysis {
    fn known_worst_case(&self) -> Option<KnownWorstCase> {
        let found = self.range.extremes.as_ref().map(|found| [found.least.value, found.greatest.value]);
        let of = |kind, ends: [f64; 2]| KnownWorstCase { kind, ends, texts: self.shown_ends(ends) };
        match (self.proven_worst_case(), found) {
            (Some(known), _) => Some(known),
            (None, Some(found)) => Some(of(WorstCaseKind::Found, found)),
            (None, None) => Some(of(WorstCaseKind::Linear, self.range.worst_case?)),
        }
    }

    fn proven_worst_case(&self) -> Option<KnownWorstCase> {
        let kind = WorstCaseKind::Proven;
        if self.constant {
            let ends = self.range.worst_case?;
            return Some(KnownWorstCase { kind, ends, texts: self.shown_ends(ends) });
        }
        let proof = self.proof().filter(|proof| proof.proven)?;
        let slack = proof.slack.iter().copied().fold(0.0, f64::max);
        Some(KnownWorstCase { kind, ends: proof.bounds, texts: outward(proof.bounds, self.scale(), Some(slack)) })
    }

    fn is_shown_as_linear(&self, proven: &KnownWorstCase) -> bool {
        self.range.worst_case.is_some_and(|linear| outward(linear, self.scale(), None) == proven.texts)
    }

    fn is_linear(&self, proven: &KnownWorstCase) -> bool {
        let Some(linear) = self.range.worst_case else { return false };
        let size = proven.ends.iter().chain(&linear).fold(linear[1] - linear[0], |size, end| size.max(end.abs()));
        proven.ends.iter().zip(linear).all(|(proven, linear)| (proven - linear).abs() <= SAME * size)
    }

    fn shown_ends(&self, ends: [f64; 2]) -> [String; 2] {
        ends.map(|end| carried(end, self.scale(), None))
    }
}
