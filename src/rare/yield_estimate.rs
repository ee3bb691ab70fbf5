//! Yield of a characteristic from the probabilities beyond each of its limits.

use crate::rare::estimate::ProbabilityEstimate;
use crate::rare::{Beyond, RareCharacteristic};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::requirement::{Requirement, RequirementFigures};
use sensitol_numeric::verdict::{self, Judged, JudgedFigure, Verdict, Verdicts};

/// Yield of a characteristic.
#[derive(Clone, Copy)]
pub(super) struct Within {
    /// Yield. None if no point lies beyond some limit, and the probability there may matter.
    pub(super) value: Option<f64>,
    /// 95 % interval.
    pub(super) interval: [f64; 2],
}

/// Yield from both sides. Returns None if there is no limit, or no result for one of them.
///
/// A side with no point beyond adds to the interval only. If it adds less than the uncertainty of the other side, the
/// value is that of the other side. Two independent errors are joined by the method of Zou and Donner (2008). If the
/// means lie beyond a limit, `kept` is the probability of keeping that limit. The yield is then `kept` minus the
/// probability beyond the other limit.
pub(super) fn within(
    limits: SpecLimits,
    sides: [&Option<Beyond>; 2],
    kept: Option<(usize, ProbabilityEstimate)>,
) -> Option<Within> {
    if let Some((side, kept)) = kept {
        let other = match (sides[1 - side], [limits.lower(), limits.upper()][1 - side]) {
            (None, Some(_)) => return None,
            (beyond, _) => beyond.as_ref(),
        };
        return Some(keeping(kept, other));
    }
    let sides: Vec<&Beyond> = sides.into_iter().flatten().collect();
    if sides.is_empty() || sides.len() != [limits.lower(), limits.upper()].iter().flatten().count() {
        return None;
    }
    let apart = |end: usize| {
        let distances = sides.iter().map(|beyond| beyond.interval[end] - beyond.probability.unwrap_or(0.0));
        distances.fold(0.0, libm::hypot)
    };
    let seen: f64 = sides.iter().filter_map(|beyond| beyond.probability).sum();
    let (known, unseen): (Vec<&Beyond>, Vec<&Beyond>) = sides.iter().partition(|beyond| beyond.probability.is_some());
    let open: f64 = known.iter().map(|beyond| beyond.interval[1] - beyond.probability.unwrap_or(0.0)).sum();
    let negligible = !known.is_empty() && unseen.iter().map(|beyond| beyond.interval[1]).sum::<f64>() <= open;
    let interval = verdict::share([1.0 - seen - apart(1), 1.0 - seen + apart(0)]);
    let value = (unseen.is_empty() || negligible).then(|| (1.0 - seen).clamp(0.0, 1.0));
    Some(Within { value, interval })
}

/// Probability of keeping one limit, minus that of lying beyond the other.
fn keeping(kept: ProbabilityEstimate, other: Option<&Beyond>) -> Within {
    let keeps = kept.probability.map_or(0.0, |estimate| estimate.value);
    let lost = other.and_then(|beyond| beyond.probability).unwrap_or(0.0);
    let apart = |end: usize| {
        let of_other = other.map_or(0.0, |beyond| beyond.interval[1 - end] - lost);
        libm::hypot(kept.interval[end] - keeps, of_other)
    };
    let known = kept.probability.is_some()
        && other.is_none_or(|beyond| beyond.probability.is_some() || beyond.interval[1] < keeps);
    let value = known.then(|| (keeps - lost).clamp(0.0, 1.0));
    Within { value, interval: verdict::share([keeps - lost - apart(0), keeps - lost + apart(1)]) }
}

impl RequirementFigures for RareCharacteristic {
    type Figure = JudgedFigure;

    /// Yield with its interval, in which points without a value may all be rejects.
    fn yield_(&self) -> JudgedFigure {
        let sides = [&self.below, &self.above].into_iter().flatten();
        let unknown: f64 = sides.filter_map(|beyond| beyond.bounds).map(|[least, most]| most - least).sum();
        JudgedFigure { value: self.yield_, interval: self.yield_interval.map(|[low, high]| [low - unknown, high]) }
    }
}

impl RareCharacteristic {
    /// Verdict on any requirement, the characteristic's own or another. Only a yield can be judged, because nothing is
    /// known of the values between the limits.
    pub(crate) fn judge(&self, requirement: Requirement) -> Judged {
        Judged::by(requirement, self).unless(self.unfinished)
    }

    /// Verdicts that follow from the figures.
    pub fn conclusion(&self) -> Verdicts {
        Verdicts::by(&self.characteristic, |requirement| self.judge(requirement))
    }

    /// Verdicts on all requirements of the characteristic, including its target yield.
    pub fn requirements(&self) -> Vec<Judged> {
        self.conclusion().requirements
    }

    /// Verdict on the target yield. Returns None if there is no target.
    pub fn verdict(&self) -> Option<Verdict> {
        self.conclusion().verdict
    }
}
