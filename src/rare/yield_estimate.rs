//! Yield of a characteristic from the probabilities beyond each of its limits.

use crate::rare::estimate::ProbabilityEstimate;
use crate::rare::{Beyond, RareCharacteristic};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::requirement::{Requirement, RequirementFigures};
use sensitol_numeric::sampling::Estimate;
use sensitol_numeric::verdict::{self, Judged, JudgedFigure, Verdict};

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
    let value = |beyond: &Beyond| beyond.probability.map(|probability| probability.value);
    let apart = |end: usize| {
        let distances = sides.iter().map(|beyond| beyond.interval[end] - value(beyond).unwrap_or(0.0));
        distances.fold(0.0, libm::hypot)
    };
    let seen: f64 = sides.iter().filter_map(|beyond| value(beyond)).sum();
    let (known, unseen): (Vec<&Beyond>, Vec<&Beyond>) = sides.iter().partition(|beyond| value(beyond).is_some());
    let open: f64 = known.iter().map(|beyond| beyond.interval[1] - value(beyond).unwrap_or(0.0)).sum();
    let negligible = !known.is_empty() && unseen.iter().map(|beyond| beyond.interval[1]).sum::<f64>() <= open;
    let interval = verdict::share([1.0 - seen - apart(1), 1.0 - seen + apart(0)]);
    let value = (unseen.is_empty() || negligible).then(|| (1.0 - seen).clamp(0.0, 1.0));
    Some(Within { value, interval })
}

/// Probability of keeping one limit, minus that of lying beyond the other.
fn keeping(kept: ProbabilityEstimate, other: Option<&Beyond>) -> Within {
    let estimate = |probability: Option<Estimate>| probability.map_or(0.0, |estimate| estimate.value);
    let (keeps, lost) = (estimate(kept.probability), other.map_or(0.0, |beyond| estimate(beyond.probability)));
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
        let unknown: f64 = sides.map(|beyond| beyond.bounds[1] - beyond.bounds[0]).sum();
        JudgedFigure { value: self.yield_, interval: self.yield_interval.map(|[low, high]| [low - unknown, high]) }
    }
}

impl RareCharacteristic {
    /// Probability beyond one of the limits if no point without a value lies there, and if all do. Returns None if
    /// every point has a value.
    pub fn bounds(&self, beyond: &Beyond) -> Option<[f64; 2]> {
        (self.failed > 0).then_some(beyond.bounds)
    }

    /// Verdict on any requirement, the characteristic's own or another. Only a yield can be judged, because nothing is
    /// known of the values between the limits.
    pub(crate) fn judge(&self, requirement: Requirement) -> Judged {
        Judged::by(requirement, self).unless(self.unfinished)
    }

    /// Verdicts on all requirements of the characteristic, including its target yield.
    pub fn requirements(&self) -> Vec<Judged> {
        verdict::judged(&self.characteristic, |requirement| self.judge(requirement))
    }

    /// Verdict on the target yield. Returns None if there is no target.
    pub fn verdict(&self) -> Option<Verdict> {
        verdict::on_target_yield(&self.characteristic, |target| self.judge(target))
    }
}
