//! Whether a target is met: the one place that decides it, from the interval of what is known.
//!
//! ```text
//! met             the whole interval keeps the target
//! missed          the whole interval breaks it
//! inconclusive    anything else: the interval holds values on both sides, or is unknown
//! ```
//!
//! An interval is the estimate and two of its errors on either side, cut to what the figure can be. Other evidence against the
//! estimate widens it: another share of the same surface, points without a value. A run that was stopped has no interval.

use serde::{Serialize, Serializer};

use crate::capability;
use crate::characteristic::{Characteristic, SpecLimits};
use crate::power::Power;
use crate::requirement::{Required, Requirement};
use crate::shape::{ends, finite};

/// Errors on either side of an estimate that make its interval: 95 % where errors are standard errors.
pub const ERRORS: f64 = 2.0;
/// The difference that the same sum in another order may make, relative to the room that a target leaves: tolerances that were
/// chosen so that they just keep a target keep it. The search of tolerances keeps its constraints to a part of 10^9 of their
/// room.
const ROUNDING: f64 = 1e-8;

/// The verdict on a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The whole interval keeps the target.
    Met,
    /// The whole interval breaks it.
    Missed,
    /// Neither: what is known does not tell.
    Inconclusive,
}

impl Verdict {
    /// In reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::Missed => "missed",
            Self::Inconclusive => "inconclusive",
        }
    }

    /// Whether the target is met; None where that is not known.
    pub fn met(self) -> Option<bool> {
        match self {
            Self::Met => Some(true),
            Self::Missed => Some(false),
            Self::Inconclusive => None,
        }
    }

    /// Of an interval, inconclusive where there is none.
    ///
    /// ```
    /// use crate::requirement::Requirement;
    /// use crate::verdict::Verdict;
    /// let yield_ = Requirement::Yield(0.99);
    /// assert_eq!(Verdict::of(yield_, Some([0.991, 0.999])), Verdict::Met);
    /// assert_eq!(Verdict::of(yield_, Some([0.98, 0.985])), Verdict::Missed);
    /// assert_eq!(Verdict::of(yield_, Some([0.98, 0.999])), Verdict::Inconclusive);
    /// assert_eq!(Verdict::of(yield_, None), Verdict::Inconclusive);
    /// // At most 0.05, not at least.
    /// assert_eq!(Verdict::of(Requirement::Sigma(0.05), Some([0.03, 0.04])), Verdict::Met);
    /// ```
    pub(crate) fn of(requirement: Requirement, interval: Option<[f64; 2]>) -> Self {
        let Some([low, high]) = interval.filter(|[low, high]| low <= high) else { return Self::Inconclusive };
        let slack = |room: f64| ROUNDING * room.abs();
        let [worst, best, target] = match requirement {
            // Rounding is a part of what is rejected.
            Requirement::Yield(target) => [low + slack(1.0 - target), high, target],
            Requirement::Cpk(target) => [low + slack(target), high, target],
            Requirement::Sigma(target) => [-high + slack(target), -low, -target],
            Requirement::Rss | Requirement::WorstCase => [-high + slack(1.0), -low, -1.0],
        };
        match () {
            () if worst >= target => Self::Met,
            () if best < target => Self::Missed,
            () => Self::Inconclusive,
        }
    }
}

/// A requirement, what there is of it, and what that says.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Judged {
    /// The requirement.
    pub requirement: Requirement,
    /// The value in the requirement's own measure: yield, Cpk, sigma, or the greatest part of a limit's room that rss or worst
    /// case takes. None where it is unknown.
    pub value: Option<f64>,
    /// Within which that is known; None where that is unknown.
    pub interval: Option<[f64; 2]>,
    /// The verdict by the interval.
    pub verdict: Verdict,
}

/// A judged requirement as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct JudgedShape {
    #[serde(flatten)]
    required: Required,
    /// The value found.
    value: Option<f64>,
    /// Within which that is known, an end null where there is none; null where it is not known at all.
    interval: Option<[Option<f64>; 2]>,
    /// Whether it is kept; null where that is not known.
    met: Option<bool>,
    /// The same in a word.
    verdict: Verdict,
}

impl Serialize for Judged {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let required = Required::from(&self.requirement);
        let (value, interval) = (self.value.and_then(finite), self.interval.map(ends));
        JudgedShape { required, value, interval, met: self.verdict.met(), verdict: self.verdict }.serialize(serializer)
    }
}

impl Judged {
    /// By a value and its interval.
    pub fn of(requirement: Requirement, value: Option<f64>, interval: Option<[f64; 2]>) -> Self {
        Self { requirement, value, interval, verdict: Verdict::of(requirement, interval) }
    }

    /// The same of a characteristic times a power of two.
    pub fn times(self, power: Power) -> Self {
        match self.requirement {
            Requirement::Sigma(_) => Self {
                requirement: self.requirement.times(power),
                value: self.value.and_then(|value| power.checked(value)),
                interval: self.interval.map(|interval| interval.map(|end| power.times(end))),
                verdict: self.verdict,
            },
            _ => self,
        }
    }

    /// The same by three errors on either side in place of two: many requirements are asked of a sample, each of them often just kept.
    pub fn widely(self) -> Self {
        let Self { requirement, value, interval, .. } = self;
        let wider = value.zip(interval).map(|(value, ends)| ends.map(|end| value + 1.5 * (end - value)));
        Self::of(requirement, value, wider)
    }

    /// The same of a run that was stopped while points were open: there is no interval, and nothing follows.
    pub fn unless(self, unfinished: bool) -> Self {
        if unfinished { Self::of(self.requirement, self.value, None) } else { self }
    }
}

/// Every requirement of a characteristic, its target yield first, as `judge` sees it.
pub fn judged(characteristic: &Characteristic, judge: impl Fn(Requirement) -> Judged) -> Vec<Judged> {
    characteristic.requirements().into_iter().map(judge).collect()
}

/// The worst of all verdicts: missed before inconclusive before met; None without any.
pub fn worst(all: impl IntoIterator<Item = Verdict>) -> Option<Verdict> {
    let rank = |verdict: &Verdict| match verdict {
        Verdict::Met => 0,
        Verdict::Inconclusive => 1,
        Verdict::Missed => 2,
    };
    all.into_iter().max_by_key(rank)
}

/// An estimate and two errors on either side; None without an error.
pub fn about(value: f64, error: Option<f64>) -> Option<[f64; 2]> {
    let reach = ERRORS * error.filter(|error| error.is_finite())?;
    Some([value - reach, value + reach])
}

/// The interval of a share.
pub fn share([low, high]: [f64; 2]) -> [f64; 2] {
    [low.clamp(0.0, 1.0), high.clamp(0.0, 1.0)]
}

/// An interval that holds another value too: of what contradicts the estimate.
pub fn including([low, high]: [f64; 2], other: f64) -> [f64; 2] {
    [low.min(other), high.max(other)]
}

/// An interval of an estimate to which an independent error belongs that leaves `other` open: the distances of the ends add as
/// squares (Zou and Donner 2008).
pub fn joined(value: f64, [low, high]: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let apart = |from: f64, to: f64| (to - from).max(0.0);
    let below = libm::hypot(apart(low, value), apart(other[0], value));
    let above = libm::hypot(apart(value, high), apart(value, other[1]));
    [value - below, value + above]
}

/// The 95 % intervals of the rejects of either side, widened by the interval that measured samples leave to all rejects; None where that is unknown.
pub fn sides_with_samples(
    sides: [Option<f64>; 2],
    intervals: [Option<[f64; 2]>; 2],
    rejected: Option<[f64; 2]>,
) -> [Option<[f64; 2]>; 2] {
    let all: f64 = sides.iter().flatten().sum();
    [0, 1].map(|side| {
        let ([low, high], value) = (rejected?, sides[side]?);
        // Each side may have all that is open.
        let open = [value - (all - low).max(0.0), value + (high - all).max(0.0)];
        Some(share(joined(value, intervals[side]?, open)))
    })
}

/// The yield when this share of all assemblies has no value, and may be rejected: all of it, or none.
///
/// `lost` is None where assemblies without a value were met and how many there are is unknown.
pub fn losing([low, high]: [f64; 2], lost: Option<f64>) -> [f64; 2] {
    [low * (1.0 - lost.unwrap_or(1.0)), high]
}

/// The interval of a Cpk from the errors of mean and sigma: the mean moves it by `2 e / 3 sigma`, and sigma between
/// `cpk(sigma + 2 e)` and `cpk(sigma - 2 e)`; the two are independent. None where an error is unknown, or there is no Cpk.
///
/// ```
/// use crate::characteristic::SpecLimits;
/// use crate::verdict::of_cpk;
/// let limits = SpecLimits::new(Some(-4.0), Some(4.0))?;
/// // 4/3, and 2 x 0.03/3 by the mean alone.
/// let [low, high] = of_cpk((0.0, Some(0.03)), (1.0, Some(0.0)), limits).unwrap();
/// assert!((low - 3.94 / 3.0).abs() < 1e-12 && (high - 4.06 / 3.0).abs() < 1e-12);
/// assert_eq!(of_cpk((0.0, None), (1.0, Some(0.0)), limits), None);
/// # Ok::<(), crate::characteristic::LimitsError>(())
/// ```
pub fn of_cpk(
    (mean, mean_error): (f64, Option<f64>),
    (sigma, sigma_error): (f64, Option<f64>),
    limits: SpecLimits,
) -> Option<[f64; 2]> {
    let [least, most] = about(sigma, sigma_error)?;
    let reach = ERRORS * mean_error.filter(|error| error.is_finite())? / (3.0 * sigma);
    let value = capability::cpk(mean, sigma, limits)?;
    let wide = value * sigma / most;
    let narrow = if least > 0.0 { value * sigma / least } else { value.signum() * f64::INFINITY };
    let [down, up] = [value - wide.min(narrow), wide.max(narrow) - value].map(|by| libm::hypot(by.max(0.0), reach));
    Some([value - down, value + up])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_target_at_the_end_of_an_interval_is_kept() {
        assert_eq!(Verdict::of(Requirement::Yield(0.9), Some([0.9, 0.95])), Verdict::Met);
        assert_eq!(Verdict::of(Requirement::Yield(0.9), Some([0.85, 0.9])), Verdict::Inconclusive);
        assert_eq!(Verdict::of(Requirement::Rss, Some([1.0, 1.0])), Verdict::Met);
        assert_eq!(Verdict::of(Requirement::WorstCase, Some([1.01, 1.01])), Verdict::Missed);
        assert_eq!(Verdict::of(Requirement::Cpk(1.33), Some([f64::NAN, 2.0])), Verdict::Inconclusive);
    }

    /// All may be rejected where it is unknown how many have no value.
    #[test]
    fn what_has_no_value_only_lowers_a_yield() {
        assert_eq!(losing([0.9, 0.95], None), [0.0, 0.95]);
        assert_eq!(losing([0.8, 0.9], Some(0.5)), [0.4, 0.9]);
    }

    /// Three below by one error and four by another are five; the other side has only one of them.
    #[test]
    fn independent_errors_add_as_squares() {
        assert_eq!(joined(10.0, [7.0, 10.0], [6.0, 12.0]), [5.0, 12.0]);
        // An interval that does not hold the estimate reaches no farther than it.
        assert_eq!(joined(10.0, [9.0, 11.0], [10.5, 10.5]), [9.0, 10.0 + libm::hypot(1.0, 0.5)]);
    }

    /// Two errors of sigma reach 0: no Cpk is too good to be.
    #[test]
    fn a_sigma_that_may_be_nothing_leaves_a_cpk_open() {
        let limits = SpecLimits::new(Some(-4.0), Some(4.0)).unwrap();
        let [low, high] = of_cpk((0.0, Some(0.0)), (1.0, Some(0.6)), limits).unwrap();
        // 4/3 by 2.2.
        assert!((low - 4.0 / 6.6).abs() < 1e-12 && high == f64::INFINITY, "{low} {high}");
    }
}
