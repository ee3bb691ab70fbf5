//! Verdicts on targets, decided in this module only, from the interval of a figure.
//!
//! ```text
//! met             the whole interval keeps the target
//! missed          the whole interval breaks it
//! inconclusive    anything else: the interval holds values on both sides, or is unknown
//! ```
//!
//! An interval is the estimate and two of its errors on either side, cut to the possible values of the figure. Evidence against the
//! estimate widens it: another estimate from the same surface, or points without a value. A run that was stopped has no interval.

use serde::Serialize;

use crate::capability;
use crate::characteristic::{Characteristic, SpecLimits};
use crate::power::Power;
use crate::requirement::{Requirement, RequirementFigures, Sense};
use crate::sampling::SamplingInterval;

/// Errors on either side of an estimate that make its interval: 95 % if they are standard errors.
pub const ERRORS: f64 = 2.0;
/// Rounding allowed for a target, relative to its slack, since the same sum in another order may differ. Tolerances that were chosen to
/// just keep a target do keep it: the search of tolerances keeps its constraints to a part of 10^9 of their slack.
const ROUNDING: f64 = 1e-8;

/// Verdict on a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The whole interval keeps the target.
    Met,
    /// The whole interval breaks it.
    Missed,
    /// The interval holds values on both sides of the target, or is unknown.
    Inconclusive,
}

impl Verdict {
    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Met => "met",
            Self::Missed => "missed",
            Self::Inconclusive => "inconclusive",
        }
    }

    /// True if the target is met. Returns None if the verdict is inconclusive.
    pub fn met(self) -> Option<bool> {
        match self {
            Self::Met => Some(true),
            Self::Missed => Some(false),
            Self::Inconclusive => None,
        }
    }

    /// Verdict from an interval, inconclusive without one.
    ///
    /// ```
    /// use sensitol_numeric::requirement::Requirement;
    /// use sensitol_numeric::verdict::Verdict;
    /// let yield_ = Requirement::Yield(0.99);
    /// assert_eq!(Verdict::of(yield_, Some([0.991, 0.999])), Verdict::Met);
    /// assert_eq!(Verdict::of(yield_, Some([0.98, 0.985])), Verdict::Missed);
    /// assert_eq!(Verdict::of(yield_, Some([0.98, 0.999])), Verdict::Inconclusive);
    /// assert_eq!(Verdict::of(yield_, None), Verdict::Inconclusive);
    /// // At most 0.05, not at least.
    /// assert_eq!(Verdict::of(Requirement::Sigma(0.05), Some([0.03, 0.04])), Verdict::Met);
    /// ```
    pub fn of(requirement: Requirement, interval: Option<[f64; 2]>) -> Self {
        let Some([low, high]) = interval.filter(|[low, high]| low <= high) else { return Self::Inconclusive };
        let rounding = ROUNDING * requirement.rounding_scale();
        let [worst, best, target] = match requirement.sense() {
            Sense::AtLeast => [low + rounding, high, requirement.amount()],
            Sense::AtMost => [-high + rounding, -low, -requirement.amount()],
        };
        match () {
            () if worst >= target => Self::Met,
            () if best < target => Self::Missed,
            () => Self::Inconclusive,
        }
    }
}

/// Value of a figure and its interval. Both are None by default: an unknown figure.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JudgedFigure {
    /// Value in the measure of the requirement.
    pub value: Option<f64>,
    /// Interval of the value.
    pub interval: Option<[f64; 2]>,
}

impl JudgedFigure {
    /// Cpk `value` with the interval by the errors of mean and sigma, joined with that of measured samples.
    pub fn cpk(
        value: Option<f64>,
        mean: (f64, Option<f64>),
        sigma: (f64, Option<f64>),
        limits: SpecLimits,
        measured: Option<&SamplingInterval>,
    ) -> Self {
        Self { value, interval: of_cpk(mean, sigma, limits) }.measured(measured, |of| of.cpk)
    }

    /// Sigma with the interval by its error, joined with that of measured samples, and cut at 0.
    pub fn sigma(value: f64, error: Option<f64>, measured: Option<&SamplingInterval>) -> Self {
        let found = Self { value: Some(value), interval: about(value, error) }.measured(measured, |of| of.sigma);
        Self { interval: found.interval.map(|[low, high]| [low.max(0.0), high]), ..found }
    }

    /// Joins the interval with that of measured samples, if there are any. There is none if their uncertainty is unknown.
    fn measured(self, samples: Option<&SamplingInterval>, of: fn(&SamplingInterval) -> Option<[f64; 2]>) -> Self {
        let Some(samples) = samples else { return self };
        let joined = || Some(joined(self.value?, self.interval?, of(samples)?));
        Self { interval: joined(), ..self }
    }
}

/// Requirement with the value found, its interval and the verdict.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Judged {
    /// Requirement that is judged.
    #[serde(flatten)]
    pub requirement: Requirement,
    /// Value in the requirement's own measure: yield, Cpk or sigma. For rss and worst case, the fraction of the limits used. None if it is
    /// unknown.
    #[cfg_attr(feature = "schema", schemars(description = "Value found, null if it is unknown."))]
    pub value: Option<f64>,
    /// Interval of the value, an end null if it is unbounded. None as a whole if it is unknown.
    #[cfg_attr(feature = "schema", schemars(with = "Option<[Option<f64>; 2]>"))]
    pub interval: Option<[f64; 2]>,
    /// True if the requirement is met. None if that is unknown.
    pub met: Option<bool>,
    /// Verdict from the interval.
    pub verdict: Verdict,
}

/// Verdicts on the requirements of a characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Verdicts {
    /// True if the target yield is met. None if there is no target, and if it is unknown.
    pub met: Option<bool>,
    /// Verdict on the target yield. None if there is no target.
    pub verdict: Option<Verdict>,
    /// Verdicts on all requirements, the target yield included.
    pub requirements: Vec<Judged>,
}

impl Verdicts {
    /// Verdicts by `judge`, the target yield first.
    pub fn by(characteristic: &Characteristic, judge: impl Fn(Requirement) -> Judged) -> Self {
        let verdict = characteristic.target().map(|target| judge(target).verdict);
        let requirements = characteristic.requirements().into_iter().map(judge).collect();
        Self { met: verdict.and_then(Verdict::met), verdict, requirements }
    }
}

impl Judged {
    /// Judges a requirement by a value and its interval.
    pub fn of(requirement: Requirement, value: Option<f64>, interval: Option<[f64; 2]>) -> Self {
        let verdict = Verdict::of(requirement, interval);
        Self { requirement, value, interval, met: verdict.met(), verdict }
    }

    /// Judges a requirement by the figure of its kind.
    pub fn by(requirement: Requirement, figures: &impl RequirementFigures<Figure = JudgedFigure>) -> Self {
        let JudgedFigure { value, interval } = requirement.figure(figures);
        Self::of(requirement, value, interval)
    }

    /// Judges a target yield by a yield and its interval.
    pub fn of_yield(target: f64, value: Option<f64>, interval: Option<[f64; 2]>) -> Self {
        Self::of(Requirement::Yield(target), value, interval)
    }

    /// Judged requirement of a characteristic multiplied by a power of two.
    pub fn times(self, power: Power) -> Self {
        if !self.requirement.has_unit() {
            return self;
        }
        Self {
            requirement: self.requirement.times(power),
            value: self.value.and_then(|value| power.checked(value)),
            interval: self.interval.map(|interval| interval.map(|end| power.times(end))),
            ..self
        }
    }

    /// Judges by three errors on either side in place of two, for many requirements judged by one sample: each of them is often just kept.
    pub fn widely(self) -> Self {
        let Self { requirement, value, interval, .. } = self;
        let wider = value.zip(interval).map(|(value, ends)| ends.map(|end| value + 1.5 * (end - value)));
        Self::of(requirement, value, wider)
    }

    /// Removes the interval if the run was stopped with points not evaluated. The verdict is then inconclusive.
    pub fn unless(self, unfinished: bool) -> Self {
        if unfinished { Self::of(self.requirement, self.value, None) } else { self }
    }
}

/// Worst of all verdicts: missed before inconclusive before met. Returns None if there are no verdicts.
pub fn worst(all: impl IntoIterator<Item = Verdict>) -> Option<Verdict> {
    let rank = |verdict: &Verdict| match verdict {
        Verdict::Met => 0,
        Verdict::Inconclusive => 1,
        Verdict::Missed => 2,
    };
    all.into_iter().max_by_key(rank)
}

/// Interval of an estimate and two errors on either side. Returns None if the error is unknown.
pub fn about(value: f64, error: Option<f64>) -> Option<[f64; 2]> {
    let reach = ERRORS * error.filter(|error| error.is_finite())?;
    Some([value - reach, value + reach])
}

/// Interval of a share: `[low, high]` clamped to 0 and 1.
pub fn share([low, high]: [f64; 2]) -> [f64; 2] {
    [low.clamp(0.0, 1.0), high.clamp(0.0, 1.0)]
}

/// Interval extended to hold another value, which contradicts the estimate.
pub fn including([low, high]: [f64; 2], other: f64) -> [f64; 2] {
    [low.min(other), high.max(other)]
}

/// Interval of an estimate with an independent second error, whose interval is `other`. The distances of the ends add as squares (Zou and
/// Donner 2008).
pub fn joined(value: f64, [low, high]: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let apart = |from: f64, to: f64| (to - from).max(0.0);
    let below = libm::hypot(apart(low, value), apart(other[0], value));
    let above = libm::hypot(apart(value, high), apart(value, other[1]));
    [value - below, value + above]
}

/// 95 % intervals of the rejects of either side, widened by `rejected`, the interval of all rejects that measured samples leave. Returns
/// None for a side whose interval is unknown.
pub fn sides_with_samples(
    sides: [Option<f64>; 2],
    intervals: [Option<[f64; 2]>; 2],
    rejected: Option<[f64; 2]>,
) -> [Option<[f64; 2]>; 2] {
    let all: f64 = sides.iter().flatten().sum();
    [0, 1].map(|side| {
        let ([low, high], value) = (rejected?, sides[side]?);
        // Either side may hold all of the uncertain share.
        let open = [value - (all - low).max(0.0), value + (high - all).max(0.0)];
        Some(share(joined(value, intervals[side]?, open)))
    })
}

/// Interval of the yield if the share `lost` of all assemblies has no value: all of it may be rejected, or none.
///
/// `lost` is None if there are assemblies without a value in an unknown number.
pub fn losing([low, high]: [f64; 2], lost: Option<f64>) -> [f64; 2] {
    [low * (1.0 - lost.unwrap_or(1.0)), high]
}

/// Interval of a Cpk from the errors of mean and sigma. The mean moves it by `2 e / 3 sigma`. Sigma moves it between `cpk(sigma + 2 e)` and
/// `cpk(sigma - 2 e)`. The two are independent. Returns None if an error is unknown, or there is no Cpk.
///
/// ```
/// use sensitol_numeric::characteristic::SpecLimits;
/// use sensitol_numeric::verdict::of_cpk;
/// let limits = SpecLimits::new(Some(-4.0), Some(4.0))?;
/// // 4/3, and 2 x 0.03/3 by the mean alone.
/// let [low, high] = of_cpk((0.0, Some(0.03)), (1.0, Some(0.0)), limits).unwrap();
/// assert!((low - 3.94 / 3.0).abs() < 1e-12 && (high - 4.06 / 3.0).abs() < 1e-12);
/// assert_eq!(of_cpk((0.0, None), (1.0, Some(0.0)), limits), None);
/// # Ok::<(), sensitol_numeric::characteristic::LimitsError>(())
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

    /// All assemblies may be rejects if the number without a value is unknown.
    #[test]
    fn what_has_no_value_only_lowers_a_yield() {
        assert_eq!(losing([0.9, 0.95], None), [0.0, 0.95]);
        assert_eq!(losing([0.8, 0.9], Some(0.5)), [0.4, 0.9]);
    }

    /// Three below by one error and four by another are five. The other side has only one of them.
    #[test]
    fn independent_errors_add_as_squares() {
        assert_eq!(joined(10.0, [7.0, 10.0], [6.0, 12.0]), [5.0, 12.0]);
        // An interval that does not hold the estimate reaches no farther than the estimate.
        assert_eq!(joined(10.0, [9.0, 11.0], [10.5, 10.5]), [9.0, 10.0 + libm::hypot(1.0, 0.5)]);
    }

    /// If two errors of sigma reach 0, the Cpk has no upper bound.
    #[test]
    fn a_sigma_that_may_be_nothing_leaves_a_cpk_open() {
        let limits = SpecLimits::new(Some(-4.0), Some(4.0)).unwrap();
        let [low, high] = of_cpk((0.0, Some(0.0)), (1.0, Some(0.6)), limits).unwrap();
        // A Cpk of 4/3, divided by 2.2.
        assert!((low - 4.0 / 6.6).abs() < 1e-12 && high == f64::INFINITY, "{low} {high}");
    }
}
