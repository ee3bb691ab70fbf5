//! The counts of one characteristic.

use super::difference::Difference;
use super::groups::GroupSums;
use crate::assembly::EvaluationError;
use sensitol_numeric::characteristic::KeptLimits;
use sensitol_numeric::sampling::{Fine, LargestPoints, Scale, Summary};

/// The limits and the scale by which a portion is counted.
#[derive(Clone, Copy)]
pub(super) struct Lens {
    pub(super) limits: KeptLimits,
    /// Known after the first batch.
    pub(super) scale: Option<Scale>,
}

/// One replicate of one characteristic.
#[derive(Clone)]
pub(super) struct Replicate {
    pub(super) summary: Summary,
    pub(super) largest: LargestPoints,
    pub(super) outside: [u64; 2],
    /// Nothing where no surrogate stands beside the model.
    pub(super) difference: Difference,
    pub(super) fine: Option<Fine>,
}

/// All of one characteristic.
pub(super) struct Count {
    pub(super) replicates: Vec<Replicate>,
    /// By groups of measured rows; nothing without measured inputs.
    pub(super) groups: GroupSums,
    pub(super) failed: u64,
    pub(super) error: Option<EvaluationError>,
}

impl Count {
    /// Of all replicates together.
    pub(super) fn summary(&self) -> Summary {
        let mut all = Summary::default();
        self.replicates.iter().for_each(|replicate| all.merge(&replicate.summary));
        all
    }

    /// The largest points of all replicates.
    pub(super) fn largest(&self) -> LargestPoints {
        let mut all = LargestPoints::default();
        self.replicates.iter().for_each(|replicate| all.merge(&replicate.largest));
        all
    }
}
