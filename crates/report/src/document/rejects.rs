//! Yields and rejects, with the digits that their error carries and no more.

use super::number::{FEWEST, power_of_ten, share, significant};

/// Significant digits of parts per million, at most.
const DIGITS: i32 = 4;
/// Errors that an interval of 95 % reaches to either side.
const REACH: f64 = 2.0;

/// The shares of assemblies beyond the limits, and the error of all of it.
///
/// The first digit of the error is the last one printed. Rejects below half of what the interval of two errors allows are not told
/// apart from none: then the interval's end is printed as a bound, the yield rounded down and the rejects rounded up. So are rejects
/// fewer than any law tells. The rejects of one side have the interval of their own, where that is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rejects {
    /// Share below the lower limit.
    below: Option<f64>,
    /// Share above the upper limit.
    above: Option<f64>,
    /// One error of the sum; None where it is unknown.
    error: Option<f64>,
    /// The 95 % interval of either side; None where it is unknown.
    intervals: [Option<[f64; 2]>; 2],
}

impl Rejects {
    /// Shares from 0 to 1.
    pub(crate) fn new(below: Option<f64>, above: Option<f64>, error: Option<f64>) -> Self {
        Self { below, above, error: error.filter(|error| *error > 0.0 && error.is_finite()), intervals: [None; 2] }
    }

    /// With the 95 % intervals of the rejects below and above.
    pub(crate) fn within(self, intervals: [Option<[f64; 2]>; 2]) -> Self {
        Self { intervals, ..self }
    }

    /// Of all limits together.
    pub(crate) fn all(rejected: f64, error: Option<f64>) -> Self {
        Self::new(None, Some(rejected), error)
    }

    fn total(self) -> Option<f64> {
        self.below.or(self.above)?;
        Some((self.below.unwrap_or(0.0) + self.above.unwrap_or(0.0)).clamp(0.0, 1.0))
    }

    /// Where the rejects are not told apart from none: the most that the interval allows.
    fn bound(self, rejected: f64) -> Option<f64> {
        let reach = REACH * self.error.unwrap_or(0.0);
        let few = rejected > 0.0 && rejected < FEWEST;
        (few || rejected < reach).then_some((rejected + reach).clamp(FEWEST, 1.0))
    }

    /// Whether the rejects are told apart from none, so that figures that follow from their number mean something.
    pub(crate) fn are_resolved(self) -> bool {
        self.total().is_some_and(|rejected| self.bound(rejected).is_none())
    }

    /// The yield by itself; None without any limit.
    pub(crate) fn yield_text(self) -> Option<String> {
        let rejected = self.total()?;
        if let Some(most) = self.bound(rejected) {
            return Some(at_least(most));
        }
        let exact = share(rejected);
        let Some(error) = self.error else { return Some(exact) };
        let decimals = decimals(100.0 * error);
        let shorter = format!("{:.decimals$} %", 100.0 * (1.0 - rejected));
        // Rejects have three digits at most, however small their error.
        Some(if shorter.len() < exact.len() { shorter } else { exact })
    }

    /// The yield with its error, or as a bound. An error that the printed digits do not show is left out.
    pub(crate) fn with_error(self) -> Option<String> {
        let text = self.yield_text()?;
        let decimals = text.trim_end_matches(" %").split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let seen = |error: &f64| 1e3 * error >= 10_f64.powi(-(decimals as i32));
        let error = self.error.filter(|_| self.are_resolved()).filter(seen);
        Some(error.map_or(text.clone(), |error| format!("{text} ± {}", significant(100.0 * error, 1))))
    }

    /// The yield with the rejects on either side in brackets.
    pub(crate) fn text(self) -> Option<String> {
        let yield_ = self.yield_text()?;
        let sides = match self.total().and_then(|rejected| self.bound(rejected)) {
            Some(most) if most < 1.0 => format!("< {} ppm", parts(most)),
            Some(_) => return Some(yield_),
            None => self.sides(),
        };
        Some(format!("{yield_} ({sides})"))
    }

    /// The rejects below and above, each where there is a limit.
    pub(crate) fn by_side(self) -> [Option<String>; 2] {
        [0, 1].map(|side| Some(format!("{} ppm", self.side(side)?)))
    }

    /// All rejects, in parts per million; None without any limit.
    pub(crate) fn all_ppm(self) -> Option<String> {
        self.total().map(|rejected| self.ppm(rejected))
    }

    /// The rejects on either side, in parts per million.
    pub(crate) fn sides(self) -> String {
        let side = |(side, name): (usize, &str)| Some(format!("{} ppm {name}", self.side(side)?));
        let sides: Vec<String> = [(0, "below"), (1, "above")].into_iter().filter_map(side).collect();
        sides.join(", ")
    }

    /// The rejects below (0) or above (1) in parts per million: by their own interval, and by the error of all where there is none.
    fn side(self, side: usize) -> Option<String> {
        let share = [self.below, self.above][side]?;
        let Some([low, high]) = self.intervals[side] else { return Some(self.ppm(share)) };
        let few = share > 0.0 && share < FEWEST;
        // As two errors that reach beyond none: the interval is wider than twice the share.
        if few || share < 0.5 * (high - low) {
            return Some(format!("< {}", parts(high.clamp(FEWEST, 1.0))));
        }
        let error = 0.5 * (high - low) / REACH;
        Some(carried(share, Some(error).filter(|error| *error > 0.0)))
    }

    fn ppm(self, share: f64) -> String {
        match self.bound(share) {
            Some(most) => format!("< {}", parts(most)),
            None => carried(share, self.error),
        }
    }
}

/// Parts per million with the digits that an error carries.
fn carried(share: f64, error: Option<f64>) -> String {
    let (ppm, exact) = (1e6 * share, significant(1e6 * share, DIGITS as usize));
    let Some(error) = error else { return exact };
    // As many digits of the share as stand before the error's second one.
    let digits = libm::log10(ppm).floor() - libm::log10(1e6 * error).floor() + 1.0;
    if digits >= f64::from(DIGITS) { exact } else { rounded(ppm, digits.max(1.0) as usize) }
}

/// So many decimals that the first digit of the error is the last one.
fn decimals(error: f64) -> usize {
    (-libm::log10(error).floor()).clamp(0.0, 12.0) as usize
}

/// Digits beyond the significant ones are zeros.
fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.*e}", digits - 1);
    text.parse().map_or(text, |value: f64| significant(value, digits))
}

/// Parts per million, rounded up to two digits.
fn parts(share: f64) -> String {
    significant(upwards(1e6 * share, 2), 2)
}

fn upwards(value: f64, digits: i32) -> f64 {
    let unit = power_of_ten(libm::log10(value).floor() + 1.0 - f64::from(digits));
    // A value that is a multiple but for rounding stays what it is.
    (value / unit - 1e-9).ceil() * unit
}

/// `> 99.997 %`: the yield that is left where so many are rejected at most, rounded down at the first digit of the rejects.
fn at_least(most: f64) -> String {
    let percent = 100.0 * upwards(most, 2);
    let decimals = decimals(percent);
    let unit = 10_f64.powi(-(decimals as i32));
    let least = 100.0 - (percent / unit - 1e-9).ceil() * unit;
    if least <= 0.0 { "unknown".to_owned() } else { format!("> {least:.decimals$} %") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(below: f64, above: f64, error: Option<f64>) -> String {
        let share = |ppm: f64| 1e-6 * ppm;
        Rejects::new(Some(share(below)), Some(share(above)), error.map(share)).text().expect("there are limits")
    }

    #[test]
    fn the_first_digit_of_the_error_is_the_last_one() {
        assert_eq!(text(1234.0, 2345.6, Some(30.0)), "99.642 % (1230 ppm below, 2350 ppm above)");
        assert_eq!(text(123_456.0, 0.0, Some(2000.0)), "87.7 % (123000 ppm below, < 4000 ppm above)");
    }

    #[test]
    fn rejects_that_the_interval_does_not_tell_from_none_are_a_bound() {
        // The design's own example: fewer than 15 ppm are above 99.998 %.
        assert_eq!(text(0.0, 0.1, Some(7.4)), "> 99.998 % (< 15 ppm)");
        assert_eq!(text(0.0, 0.1692, Some(14.9)), "> 99.997 % (< 30 ppm)");
        assert_eq!(text(2e5, 1e5, Some(4e5)), "unknown");
    }

    #[test]
    fn without_an_error_three_digits_of_the_rejects_are_shown() {
        assert_eq!(text(1234.56, 0.0, None), "99.877 % (1235 ppm below, 0 ppm above)");
        assert_eq!(text(0.0, 0.0, Some(0.0)), "100 % (0 ppm below, 0 ppm above)");
    }

    #[test]
    fn rejects_fewer_than_any_law_tells_are_a_bound_for_all_and_for_each_side() {
        assert_eq!(text(9.831e-5, 9.831e-5, None), "> 99.9999999 % (< 0.0010 ppm)");
        assert_eq!(text(1234.56, 1e-7, None), "99.877 % (1235 ppm below, < 0.0010 ppm above)");
        assert_eq!(Rejects::all(1e-12, Some(1e-13)).with_error().unwrap(), "> 99.9999999 %");
    }

    /// None of 100,000 below, 8 % above: the bound of the one side is its own. Where a proof excludes a side, it has none.
    #[test]
    fn a_side_has_the_bound_of_its_own_count() {
        let all = Rejects::new(Some(0.0), Some(0.08), Some(4e-4));
        assert_eq!(all.sides(), "< 800 ppm below, 80000 ppm above");
        let within = |below: [f64; 2]| all.within([Some(below), Some([0.0792, 0.0808])]).sides();
        assert_eq!(within([0.0, 36.9e-6]), "< 37 ppm below, 80000 ppm above");
        assert_eq!(within([0.0, 0.0]), "0 ppm below, 80000 ppm above");
        // Of one point the interval is wider than it is large.
        let one = Rejects::new(Some(1e-5), None, Some(1e-5)).within([Some([0.25e-6, 55.7e-6]), None]);
        assert_eq!(one.sides(), "< 56 ppm below");
    }

    proptest::proptest! {
        /// Whatever is printed lies within an error's first digit of what is known, and a bound on its safe side.
        #[test]
        fn what_is_printed_holds(rejected in 1e-9..0.999_f64, error in 1e-12..0.3_f64) {
            let text = Rejects::all(rejected, Some(error)).yield_text().unwrap();
            if text != "unknown" {
                let number: f64 = text.trim_start_matches("> ").trim_end_matches(" %").parse().unwrap();
                if text.starts_with('>') {
                    let high = (rejected + REACH * error).min(1.0);
                    proptest::prop_assert!(number <= 100.0 * (1.0 - high) + 1e-9, "{text}");
                } else {
                    // Half a unit of the last digit: no more than half the error, or of the third digit of the rejects.
                    let room = 50.0 * error + 0.6 * rejected + 1e-9;
                    proptest::prop_assert!((number - 100.0 * (1.0 - rejected)).abs() <= room, "{text}");
                }
            }
        }
    }
}
