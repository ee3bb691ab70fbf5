//! Counts of one characteristic.

use crate::assembly::EvaluationError;
use crate::simulation::sample_groups::GroupSums;
use crate::simulation::surface_difference::Difference;
use sensitol_numeric::characteristic::KeptLimits;
use sensitol_numeric::sampling::{Fine, LargestPoints, Scale, Summary};

/// Limits and scale with which a portion is counted.
#[derive(Clone, Copy)]
pub(super) struct CountingScale {
    pub(super) limits: KeptLimits,
    /// Characteristic whose limits decide which points count for the conditional yield.
    pub(super) given: Option<usize>,
    /// Scale of the histogram bins, known after the first batch.
    pub(super) scale: Option<Scale>,
}

/// Sums of one replicate of one characteristic.
#[derive(Clone)]
pub(super) struct Replicate {
    pub(super) summary: Summary,
    pub(super) largest: LargestPoints,
    pub(super) outside: [u64; 2],
    /// Empty if there is no surrogate.
    pub(super) difference: Difference,
    pub(super) fine: Option<Fine>,
}

/// Sums of one characteristic in all replicates.
pub(super) struct Count {
    pub(super) replicates: Vec<Replicate>,
    /// Sums by groups of measured rows. Empty if there are no measured inputs.
    pub(super) groups: GroupSums,
    pub(super) failed: u64,
    pub(super) error: Option<EvaluationError>,
}

impl Count {
    /// Merges the summaries of all replicates.
    pub(super) fn summary(&self) -> Summary {
        let mut all = Summary::default();
        self.replicates.iter().for_each(|replicate| all.merge(&replicate.summary));
        all
    }

    /// Merges the largest points of all replicates.
    pub(super) fn largest(&self) -> LargestPoints {
        let mut all = LargestPoints::default();
        self.replicates.iter().for_each(|replicate| all.merge(&replicate.largest));
        all
    }
}
