//! The worst case of a characteristic as well as it is known, under the name that it has earned in every writer.
//!
//! Proven ends are rounded outward to the digits that are shown: no assembly lies beyond the numbers that a reader sees. A linear worst case
//! is not a bound, and is called linear.

use crate::document::number::{carried, outward};
use crate::statistics::CharacteristicStatistics;
use sensitol::analysis::CharacteristicAnalysis;

/// Totals that differ by a smaller part are the same but for the order of sums.
const SAME: f64 = 1e-9;

/// How the worst case is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum WorstCaseKind {
    /// No assembly lies beyond, and some reach it.
    Proven,
    /// The ends are those of a search, which proves nothing.
    Found,
    /// By slopes alone.
    Linear,
}

/// The worst case as well as it is known.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct KnownWorstCase {
    pub(super) kind: WorstCaseKind,
    pub(super) ends: [f64; 2],
    /// The ends as they are shown.
    pub(super) texts: [String; 2],
}

/// The worst case of a characteristic, as well as it is known.
pub(crate) trait WorstCaseFigures {
    /// The worst case as well as it is known; None without a slope.
    fn known_worst_case(&self) -> Option<KnownWorstCase>;

    /// The worst case where it is proven: by bounds that values reach, or because nothing varies.
    fn proven_worst_case(&self) -> Option<KnownWorstCase>;

    /// Whether a proven worst case is that of the linear model, in the digits that are shown.
    fn is_shown_as_linear(&self, proven: &KnownWorstCase) -> bool;

    /// Whether a proven worst case is that of the linear model but for rounding.
    fn is_linear(&self, proven: &KnownWorstCase) -> bool;

    fn shown_ends(&self, ends: [f64; 2]) -> [String; 2];
}

impl WorstCaseFigures for CharacteristicAnalysis {
    fn known_worst_case(&self) -> Option<KnownWorstCase> {
        let found = self.extremes.as_ref().map(|found| [found.least.value, found.greatest.value]);
        let of = |kind, ends: [f64; 2]| KnownWorstCase { kind, ends, texts: self.shown_ends(ends) };
        match (self.proven_worst_case(), found) {
            (Some(known), _) => Some(known),
            (None, Some(found)) => Some(of(WorstCaseKind::Found, found)),
            (None, None) => Some(of(WorstCaseKind::Linear, self.worst_case?)),
        }
    }

    fn proven_worst_case(&self) -> Option<KnownWorstCase> {
        let kind = WorstCaseKind::Proven;
        if self.constant {
            let ends = self.worst_case?;
            return Some(KnownWorstCase { kind, ends, texts: self.shown_ends(ends) });
        }
        let proof = self.proof().filter(|proof| proof.proven)?;
        let slack = proof.slack.iter().copied().fold(0.0, f64::max);
        Some(KnownWorstCase { kind, ends: proof.bounds, texts: outward(proof.bounds, self.scale(), Some(slack)) })
    }

    fn is_shown_as_linear(&self, proven: &KnownWorstCase) -> bool {
        self.worst_case.is_some_and(|linear| outward(linear, self.scale(), None) == proven.texts)
    }

    fn is_linear(&self, proven: &KnownWorstCase) -> bool {
        let Some(linear) = self.worst_case else { return false };
        let size = proven.ends.iter().chain(&linear).fold(linear[1] - linear[0], |size, end| size.max(end.abs()));
        proven.ends.iter().zip(linear).all(|(proven, linear)| (proven - linear).abs() <= SAME * size)
    }

    fn shown_ends(&self, ends: [f64; 2]) -> [String; 2] {
        ends.map(|end| carried(end, self.scale(), None))
    }
}
