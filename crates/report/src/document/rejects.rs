//! Yields and reject rates, printed with the digits that their error supports.

use crate::document::number::{FEWEST, power_of_ten, share, significant};

/// Greatest number of significant digits of parts per million.
const DIGITS: i32 = 4;
/// Text of a yield whose interval reaches 0.
pub(crate) const UNKNOWN_YIELD: &str = "unknown";
/// Half-width of a 95 % interval, in errors.
const REACH: f64 = 2.0;

/// Reject rates beyond the limits, with one error for their sum.
///
/// The last printed digit is the first digit of the error. A reject rate below two errors is not distinguishable from zero. It is printed
/// as a bound, the end of its interval: the yield is rounded down and the rejects are rounded up. The same holds for rates below
/// `FEWEST`, which no distribution resolves. The rejects of one side use an interval of their own if it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rejects {
    /// Reject rate below the lower limit.
    below: Option<f64>,
    /// Reject rate above the upper limit.
    above: Option<f64>,
    /// Standard error of the sum. None if it is unknown.
    error: Option<f64>,
    /// 95 % interval of each side. None if it is unknown.
    intervals: [Option<[f64; 2]>; 2],
}

impl Rejects {
    /// Takes reject rates from 0 to 1.
    pub(crate) fn new(below: Option<f64>, above: Option<f64>, error: Option<f64>) -> Self {
        Self { below, above, error: error.filter(|error| *error > 0.0 && error.is_finite()), intervals: [None; 2] }
    }

    /// Adds the 95 % intervals of the rejects below and above.
    pub(crate) fn within(self, intervals: [Option<[f64; 2]>; 2]) -> Self {
        Self { intervals, ..self }
    }

    /// Takes the reject rate of all limits together.
    pub(crate) fn all(rejected: f64, error: Option<f64>) -> Self {
        Self::new(None, Some(rejected), error)
    }

    fn total(self) -> Option<f64> {
        self.below.or(self.above)?;
        Some((self.below.unwrap_or(0.0) + self.above.unwrap_or(0.0)).clamp(0.0, 1.0))
    }

    /// Returns the greatest reject rate that the interval allows, or None if the rejects are distinguishable from zero.
    fn bound(self, rejected: f64) -> Option<f64> {
        let reach = REACH * self.error.unwrap_or(0.0);
        let few = rejected > 0.0 && rejected < FEWEST;
        (few || rejected < reach).then_some((rejected + reach).clamp(FEWEST, 1.0))
    }

    /// True if the rejects are distinguishable from zero, so that figures derived from their number are meaningful.
    pub(crate) fn are_resolved(self) -> bool {
        self.total().is_some_and(|rejected| self.bound(rejected).is_none())
    }

    /// Formats the yield alone. Returns None if there is no limit.
    pub(crate) fn yield_text(self) -> Option<String> {
        let rejected = self.total()?;
        if let Some(most) = self.bound(rejected) {
            return Some(at_least(most));
        }
        let exact = share(rejected);
        let Some(error) = self.error else { return Some(exact) };
        let decimals = decimals(100.0 * error);
        let shorter = format!("{:.decimals$} %", 100.0 * (1.0 - rejected));
        // Rejects have at most three digits, however small their error is.
        Some(if shorter.len() < exact.len() { shorter } else { exact })
    }

    /// Formats the yield with its error, or as a bound. The error is left out if the printed digits do not show it.
    pub(crate) fn with_error(self) -> Option<String> {
        let text = self.yield_text()?;
        let decimals = text.trim_end_matches(" %").split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let seen = |error: &f64| 1e3 * error >= 10_f64.powi(-(decimals as i32));
        let error = self.error.filter(|_| self.are_resolved()).filter(seen);
        Some(error.map_or(text.clone(), |error| format!("{text} ± {}", significant(100.0 * error, 1))))
    }

    /// Formats the yield with the rejects on either side in brackets.
    pub(crate) fn text(self) -> Option<String> {
        let yield_ = self.yield_text()?;
        let sides = match self.total().and_then(|rejected| self.bound(rejected)) {
            Some(most) if most < 1.0 => format!("< {} ppm", parts(most)),
            Some(_) => return Some(yield_),
            None => self.sides(),
        };
        Some(format!("{yield_} ({sides})"))
    }

    /// Formats the rejects below and above, each None if there is no such limit.
    pub(crate) fn by_side(self) -> [Option<String>; 2] {
        [0, 1].map(|side| Some(format!("{} ppm", self.side(side)?)))
    }

    /// Formats all rejects in parts per million. Returns None if there is no limit.
    pub(crate) fn all_ppm(self) -> Option<String> {
        self.total().map(|rejected| self.ppm(rejected))
    }

    /// Formats the rejects on either side in parts per million.
    pub(crate) fn sides(self) -> String {
        let side = |(side, name): (usize, &str)| Some(format!("{} ppm {name}", self.side(side)?));
        let sides: Vec<String> = [(0, "below"), (1, "above")].into_iter().filter_map(side).collect();
        sides.join(", ")
    }

    /// Formats the rejects below (0) or above (1) in parts per million, by their own interval, or by the error of the sum.
    fn side(self, side: usize) -> Option<String> {
        let share = [self.below, self.above][side]?;
        let Some([low, high]) = self.intervals[side] else { return Some(self.ppm(share)) };
        let few = share > 0.0 && share < FEWEST;
        // The interval is wider than twice the share: two errors reach below zero.
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

/// Formats parts per million with the digits that an error supports.
fn carried(share: f64, error: Option<f64>) -> String {
    let (ppm, exact) = (1e6 * share, significant(1e6 * share, DIGITS as usize));
    let Some(error) = error else { return exact };
    // The last printed digit of the share is the first digit of the error.
    let digits = libm::log10(ppm).floor() - libm::log10(1e6 * error).floor() + 1.0;
    if digits >= f64::from(DIGITS) { exact } else { rounded(ppm, digits.max(1.0) as usize) }
}

/// Returns the decimals whose last digit is the first digit of the error.
fn decimals(error: f64) -> usize {
    (-libm::log10(error).floor()).clamp(0.0, 12.0) as usize
}

/// Rounds to so many significant digits. Further digits before the decimal point become zeros.
fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.*e}", digits - 1);
    text.parse().map_or(text, |value: f64| significant(value, digits))
}

/// Formats parts per million, rounded up to two digits.
fn parts(share: f64) -> String {
    significant(upwards(1e6 * share, 2), 2)
}

fn upwards(value: f64, digits: i32) -> f64 {
    let unit = power_of_ten(libm::log10(value).floor() + 1.0 - f64::from(digits));
    // A multiple of the unit, except for rounding errors, stays unchanged.
    (value / unit - 1e-9).ceil() * unit
}

/// Formats the least yield for a greatest reject rate, rounded down, as `> 99.997 %`.
fn at_least(most: f64) -> String {
    let percent = 100.0 * upwards(most, 2);
    let decimals = decimals(percent);
    let unit = 10_f64.powi(-(decimals as i32));
    let least = 100.0 - (percent / unit - 1e-9).ceil() * unit;
    if least <= 0.0 { UNKNOWN_YIELD.to_owned() } else { format!("> {least:.decimals$} %") }
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
        // Example from the design: fewer than 15 ppm mean more than 99.998 %.
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

    /// None of 100,000 points below, 8 % above. Each side has its own bound. A side that a proof excludes has no bound.
    #[test]
    fn a_side_has_the_bound_of_its_own_count() {
        let all = Rejects::new(Some(0.0), Some(0.08), Some(4e-4));
        assert_eq!(all.sides(), "< 800 ppm below, 80000 ppm above");
        let within = |below: [f64; 2]| all.within([Some(below), Some([0.0792, 0.0808])]).sides();
        assert_eq!(within([0.0, 36.9e-6]), "< 37 ppm below, 80000 ppm above");
        assert_eq!(within([0.0, 0.0]), "0 ppm below, 80000 ppm above");
        // One point: the interval is wider than the share.
        let one = Rejects::new(Some(1e-5), None, Some(1e-5)).within([Some([0.25e-6, 55.7e-6]), None]);
        assert_eq!(one.sides(), "< 56 ppm below");
    }

    proptest::proptest! {
        /// The printed value lies within the first digit of the error, and a bound lies on its safe side.
        #[test]
        fn what_is_printed_holds(rejected in 1e-9..0.999_f64, error in 1e-12..0.3_f64) {
            let text = Rejects::all(rejected, Some(error)).yield_text().unwrap();
            if text != "unknown" {
                let number: f64 = text.trim_start_matches("> ").trim_end_matches(" %").parse().unwrap();
                if text.starts_with('>') {
                    let high = (rejected + REACH * error).min(1.0);
                    proptest::prop_assert!(number <= 100.0 * (1.0 - high) + 1e-9, "{text}");
                } else {
                    // Tolerance: half a unit of the last digit, at most half the error or of the third digit of the rejects.
                    let room = 50.0 * error + 0.6 * rejected + 1e-9;
                    proptest::prop_assert!((number - 100.0 * (1.0 - rejected)).abs() <= room, "{text}");
                }
            }
        }
    }
}
