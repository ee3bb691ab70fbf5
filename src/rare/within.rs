//! The share within the limits, from what lies beyond each of them.

use super::{Beyond, RareCharacteristic};
use crate::characteristic::SpecLimits;
use crate::requirement::Requirement;
use crate::verdict::{self, Judged, Verdict};

/// The share within the limits.
#[derive(Clone, Copy)]
pub(super) struct Within {
    /// None where beyond some limit no point was seen.
    pub(super) value: Option<f64>,
    /// 95 % interval.
    pub(super) interval: [f64; 2],
}

/// Of both sides; None where there is no limit, or one of them could not be looked at.
///
/// Two independent errors are joined as Zou and Donner (2008) do.
pub(super) fn within(limits: SpecLimits, sides: [&Option<Beyond>; 2]) -> Option<Within> {
    let sides: Vec<&Beyond> = sides.into_iter().flatten().collect();
    if sides.is_empty() || sides.len() != [limits.lower(), limits.upper()].iter().flatten().count() {
        return None;
    }
    let value = |beyond: &Beyond| beyond.probability.map(|probability| probability.value);
    let apart = |end: usize| {
        let distances = sides.iter().map(|beyond| beyond.interval[end] - value(beyond).unwrap_or(0.0));
        distances.fold(0.0, f64::hypot)
    };
    let seen: f64 = sides.iter().filter_map(|beyond| value(beyond)).sum();
    let rejected: Option<f64> = sides.iter().map(|beyond| value(beyond)).sum();
    let interval = verdict::share([1.0 - seen - apart(1), 1.0 - seen + apart(0)]);
    Some(Within { value: rejected.map(|rejected| 1.0 - rejected), interval })
}

impl RareCharacteristic {
    /// How a requirement is kept, whether or not it is the characteristic's own: a yield by its interval, where points without a
    /// value may all be rejected ones. Of what lies between the limits nothing is known, so that no other is judged.
    pub fn judge(&self, requirement: Requirement) -> Judged {
        let sides = [&self.below, &self.above].into_iter().flatten();
        let unknown: f64 = sides.map(|beyond| beyond.bounds[1] - beyond.bounds[0]).sum();
        let (value, interval) = match requirement {
            Requirement::Yield(_) => (self.yield_, self.yield_interval.map(|[low, high]| [low - unknown, high])),
            _ => (None, None),
        };
        Judged::of(requirement, value, interval).unless(self.unfinished)
    }

    /// How everything is kept that is required of it: its target yield, and what else there is.
    pub fn requirements(&self) -> Vec<Judged> {
        verdict::judged(&self.characteristic, |requirement| self.judge(requirement))
    }

    /// What is to be said of its target yield; None without one.
    pub fn verdict(&self) -> Option<Verdict> {
        self.characteristic.target_yield().map(|target| self.judge(Requirement::Yield(target)).verdict)
    }
}
