//! Numbers and names for readers: rounded to the digits that carry information, with signs for unknown and for negligible values.

use sensitol_numeric::names::{clean, shortened_to};

/// Printed in place of an unknown value.
pub const UNKNOWN: &str = "-";

/// Greatest length of a name in characters. Longer ones are shortened in the middle.
const NAME: usize = 30;

/// Least share of the variance that is shown on its own.
pub(crate) const NEWS: f64 = 1e-4;

/// Returns the exact power of ten. The last digit of `libm::pow` may differ, which a label would show.
pub(crate) fn power_of_ten(exponent: f64) -> f64 {
    format!("1e{exponent}").parse().unwrap_or_else(|_| libm::pow(10.0, exponent))
}

/// Formats a count with its noun in singular or plural.
pub fn plural(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// Formats a yield in percent, with three significant digits of the reject rate, and one of a yield near 0.
pub(crate) fn share(rejected: f64) -> String {
    let percent = 100.0 * rejected;
    if percent <= 0.0 {
        return "100 %".to_owned();
    }
    let kept = 100.0 * (1.0 - rejected);
    // A smaller yield is a rounding error of its reject rate.
    let of_kept = if kept > 1e-10 { -libm::log10(kept).floor() } else { 0.0 };
    let decimals = (2.0 - libm::log10(percent).floor()).max(of_kept).clamp(2.0, 12.0) as usize;
    let text = format!("{:.decimals$}", 100.0 - percent);
    match text.trim_end_matches('0') {
        "100." => "100 %".to_owned(),
        "0." => "0 %".to_owned(),
        _ => format!("{text} %"),
    }
}

/// Returns the decimals that show `digits` significant digits of `scale`, or None if that needs an exponent.
pub(crate) fn decimals(scale: f64, digits: i32) -> Option<usize> {
    if scale == 0.0 || !scale.is_finite() {
        return Some(0);
    }
    let magnitude = libm::log10(scale.abs()).floor() as i32;
    usize::try_from((digits - 1 - magnitude).max(0)).ok().filter(|&decimals| decimals <= 9)
}

/// Formats `digits` significant digits, with an exponent if the number is very large or very small.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    // The rounded text gives the magnitude, so that 0.9999999 counts as 1.
    let rounded = format!("{value:.*e}", digits - 1);
    let magnitude: i32 = rounded.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    if !(-4..9).contains(&magnitude) {
        return shortened(&rounded);
    }
    let decimals = (digits as i32 - 1 - magnitude).max(0) as usize;
    format!("{value:.decimals$}")
}

/// Formats a number as the study has it, to at most eight digits if it is long.
pub fn plain(value: f64) -> String {
    let text = format!("{value}");
    // A tolerance computed from limits ends in rounding errors that the study does not contain.
    let text = if text.len() > 10 { trimmed(&significant(value, 8)) } else { text };
    let exponent = shortened(&format!("{value:e}"));
    if exponent.len() + 2 < text.len() { exponent } else { text }
}

/// Greatest number of significant digits of a computed value.
const MOST_DIGITS: i32 = 6;
/// Least and most digits of sigma that a value beside it resolves. Three digits tell a mean from a limit to a hundredth of sigma.
const SIGMA_DIGITS: [i32; 2] = [3, 5];

/// Returns the decimals of a value beside its sigma: six significant digits, but three to five of sigma; None if that needs an exponent.
fn decimals_beside(value: f64, sigma: f64) -> Option<usize> {
    let [least, most] = SIGMA_DIGITS.map(|digits| decimals(sigma, digits));
    let most = most?;
    // A value of 0, or one far below sigma, has the decimals of sigma.
    let own = decimals(value, MOST_DIGITS).filter(|_| value != 0.0).unwrap_or(most);
    Some(own.clamp(least.unwrap_or(most), most))
}

/// Returns the decimals of an interval's ends, which are those of the greater one, or None if that needs an exponent.
fn decimals_of_ends(ends: [f64; 2], sigma: f64, error: Option<f64>) -> Option<usize> {
    let greatest = ends[0].abs().max(ends[1].abs());
    let decimals = decimals_beside(greatest, sigma).filter(|_| greatest < 1e9)?;
    Some(of_error(error).map_or(decimals, |of_error| of_error.min(decimals)))
}

/// Formats the ends of an interval as [`carried`] does, both with the same decimals.
pub(crate) fn carried_ends(ends: [f64; 2], sigma: f64, error: Option<f64>) -> [String; 2] {
    match decimals_of_ends(ends, sigma, error) {
        Some(decimals) => ends.map(|end| unsigned_zero(format!("{end:.decimals$}"))),
        None => ends.map(|end| carried(end, sigma, error)),
    }
}

/// Formats a value beside its sigma, with six significant digits at most as long as they show three of sigma.
pub(crate) fn beside(value: f64, sigma: f64) -> String {
    match decimals_beside(value, sigma) {
        Some(decimals) if value.abs() < 1e9 => unsigned_zero(format!("{value:.decimals$}")),
        _ => significant(value, digits_beside(value, sigma)),
    }
}

/// Returns the significant digits of a number beside its sigma, used if it needs an exponent.
fn digits_beside(value: f64, sigma: f64) -> usize {
    let ratio = libm::log10((value / sigma).abs().max(1.0)).floor();
    let [least, most] = SIGMA_DIGITS;
    let digits =
        if ratio.is_finite() { MOST_DIGITS.clamp(ratio as i32 + least, ratio as i32 + most) } else { MOST_DIGITS };
    digits.min(17) as usize
}

/// Formats the ends of a proven interval as [`carried`] does, but rounded outward: no value lies beyond the printed numbers.
///
/// An end within a millionth of the last digit of a printed number is printed as that number. The rounding of a sum thus moves no end by
/// a digit.
pub(crate) fn outward(ends: [f64; 2], sigma: f64, error: Option<f64>) -> [String; 2] {
    /// Tolerance for rounding, as a part of the last digit.
    const ROUNDING: f64 = 1e-6;
    let decimals = decimals_of_ends(ends, sigma, error);
    let shown = |value: f64, sign: f64| {
        let last = match decimals {
            Some(decimals) => power_of_ten(-(decimals as f64)),
            None if value == 0.0 => 0.0,
            None => power_of_ten(libm::log10(value.abs()).floor() - digits_beside(value, sigma) as f64 + 1.0),
        };
        // Adding half a digit before rounding to the nearest rounds outward.
        let moved = value + sign * (0.5 - ROUNDING) * last;
        match decimals {
            Some(decimals) => unsigned_zero(format!("{moved:.decimals$}")),
            None => carried(moved, sigma, error),
        }
    };
    [shown(ends[0], -1.0), shown(ends[1], 1.0)]
}

/// Prints `-0.00` as `0.00`.
pub(crate) fn unsigned_zero(text: String) -> String {
    match text.strip_prefix('-') {
        Some(zero) if zero.chars().all(|c| c == '0' || c == '.') => zero.to_owned(),
        _ => text,
    }
}

/// Formats a share in percent.
pub(crate) fn percent(share: f64) -> String {
    match 100.0 * share {
        nothing if nothing.abs() < 1e-12 => "0".to_owned(),
        small if small.abs() < 0.005 => "<0.01".to_owned(),
        percent => format!("{percent:.2}"),
    }
}

/// Removes zeros at the end of a mantissa.
fn shortened(text: &str) -> String {
    match text.split_once('e') {
        Some((mantissa, exponent)) => format!("{}e{exponent}", trimmed(mantissa)),
        None => text.to_owned(),
    }
}

fn trimmed(text: &str) -> String {
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text.to_owned()
    }
}

/// Formats a share in percent with no more decimals than its error supports. Returns the number of decimals too.
pub(crate) fn percent_within(share: f64, error: Option<f64>) -> (String, usize) {
    match of_error(error.map(|error| 100.0 * error)) {
        Some(decimals) if decimals < 2 => (unsigned_zero(format!("{:.decimals$}", 100.0 * share)), decimals),
        _ => (percent(share), 2),
    }
}

/// Formats a number with `digits` significant digits, or fewer if its error supports only those.
pub(crate) fn within(value: f64, digits: usize, error: Option<f64>) -> String {
    match (decimals(value, digits as i32), of_error(error)) {
        (Some(own), Some(of_error)) if of_error < own => unsigned_zero(format!("{value:.of_error$}")),
        _ => significant(value, digits),
    }
}

/// Returns a name on one line, shortened if it is long.
pub(crate) fn short(name: &str) -> String {
    shortened_to(&clean(name), NAME)
}

/// Formats a number, or returns the sign for unknown.
pub fn known(value: Option<f64>, show: impl FnOnce(f64) -> String) -> String {
    value.map_or(UNKNOWN.to_owned(), show)
}

/// Formats a skewness or kurtosis.
pub(crate) fn shape(value: f64) -> String {
    shape_with(value, None)
}

/// Returns the decimals that show two digits of an error, or None if it is unknown or 0.
fn of_error(error: Option<f64>) -> Option<usize> {
    decimals(error.filter(|error| *error > 0.0 && error.is_finite())?, 2)
}

/// Formats a skewness or kurtosis with no more decimals than its error supports.
pub(crate) fn shape_with(value: f64, error: Option<f64>) -> String {
    let decimals = of_error(error).map_or(4, |of_error| of_error.min(4));
    unsigned_zero(format!("{value:.decimals$}"))
}

/// Formats a capability index such as Cp or Cpk.
pub(crate) fn index(value: f64) -> String {
    unsigned_zero(format!("{value:.3}"))
}

/// Formats a capability index with no more decimals than its error supports.
pub(crate) fn index_with(value: f64, error: Option<f64>) -> String {
    let decimals = of_error(error).map_or(3, |of_error| of_error.min(3));
    unsigned_zero(format!("{value:.decimals$}"))
}

/// Least distinguishable reject rate: no distribution of a dimension is known so far out.
pub(crate) const FEWEST: f64 = 1e-9;

/// Formats a computed yield in percent.
pub(crate) fn yielded(yield_: f64) -> String {
    unrejected(1.0 - yield_)
}

/// Formats the yield that belongs to a reject rate.
pub(crate) fn unrejected(rejected: f64) -> String {
    if rejected > 0.0 && rejected < FEWEST { "> 99.9999999 %".to_owned() } else { share(rejected) }
}

/// Formats a required yield in percent, with the digits that the study has. A computed one has more, and is rounded as any yield.
pub(crate) fn target_yield(yield_: f64) -> String {
    /// Greatest number of letters of a number that a person writes, such as 99.999999.
    const WRITTEN: usize = 9;
    // Rounded, because the product by 100 adds digits.
    let percent = format!("{}", (1e11 * yield_).round() / 1e9);
    if percent.len() <= WRITTEN { format!("{percent} %") } else { share(1.0 - yield_) }
}

/// Formats limits in words.
pub(crate) fn limits(lower: Option<f64>, upper: Option<f64>) -> String {
    match (lower, upper) {
        (None, None) => String::new(),
        (Some(lower), None) => format!("above {}", plain(lower)),
        (None, Some(upper)) => format!("below {}", plain(upper)),
        (Some(lower), Some(upper)) => format!("{} .. {}", plain(lower), plain(upper)),
    }
}

/// Formats a value beside its sigma with no more decimals than its error supports. The last decimal is the error's second digit.
pub(crate) fn carried(value: f64, sigma: f64, error: Option<f64>) -> String {
    match (decimals_beside(value, sigma), of_error(error)) {
        (Some(own), Some(of_error)) if of_error < own && value.abs() < 1e9 => {
            unsigned_zero(format!("{value:.of_error$}"))
        }
        (own, _) if own.is_none() || value.abs() >= 1e9 => {
            // The exponent form has digits down to the second digit of the error.
            let known = error.filter(|error| *error > 0.0 && error.is_finite());
            let carried = known.map(|error| libm::log10(value.abs()).floor() - libm::log10(error).floor() + 2.0);
            let digits = digits_beside(value, sigma);
            significant(value, carried.map_or(digits, |carried| digits.min(carried.max(1.0) as usize)))
        }
        _ => beside(value, sigma),
    }
}

/// Formats a number with a standard error, down to the second digit of the error, with six significant digits at most.
pub(crate) fn estimated(value: f64, error: Option<f64>) -> String {
    match error {
        Some(error) if error > 0.0 && error.is_finite() => {
            let own = if value == 0.0 {
                f64::INFINITY
            } else {
                f64::from(MOST_DIGITS - 1) - libm::log10(value.abs()).floor()
            };
            let decimals = (1.0 - libm::log10(error).floor()).min(own);
            let tiny = decimals > 15.0 && value.abs().max(error) < 1e-4;
            if tiny || value.abs() >= 1e15 {
                // The exponent form has digits down to the second digit of the error.
                let digits = 2.0 + libm::log10((value / error).abs().max(1.0)).floor();
                return significant(value, digits.min(f64::from(MOST_DIGITS)) as usize);
            }
            let decimals = decimals.clamp(0.0, 15.0) as usize;
            unsigned_zero(format!("{value:.decimals$}"))
        }
        Some(_) => plain(value),
        None => significant(value, 4),
    }
}

/// Formats a mean or a quantile with its standard error as [`estimated`] does, with as many digits as [`beside`] shows of it beside sigma.
pub(crate) fn estimated_beside(value: f64, sigma: Option<f64>, error: Option<f64>) -> String {
    let sigma = sigma.filter(|sigma| *sigma > 0.0);
    match (sigma, error.filter(|error| *error > 0.0 && error.is_finite())) {
        (Some(sigma), Some(error)) => carried(value, sigma, Some(error)),
        _ => estimated(value, error),
    }
}

pub(crate) fn uncertainty(error: f64) -> String {
    significant(error, 2)
}

/// Formats the ends of a tolerance band as on drawings.
pub(crate) fn band([lower, upper]: [f64; 2]) -> String {
    if lower == -upper {
        return format!("± {}", plain(upper));
    }
    let signed = |value: f64| if value >= 0.0 { format!("+{}", plain(value)) } else { plain(value) };
    format!("{} / {}", signed(lower), signed(upper))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_digits_unless_sigma_needs_more() {
        assert_eq!(beside(941.73848, 0.87081), "941.738");
        // Six digits would show two of sigma.
        assert_eq!(beside(12556.513, 8.0435), "12556.51");
        assert_eq!(beside(1000.0, 0.0005), "1000.000000");
        // Five digits of sigma are enough, however small the value is.
        assert_eq!(beside(0.000_123_456_789, 8.0435), "0.0001");
        assert_eq!(carried(941.73848, 0.87081, Some(0.02)), "941.738");
        assert_eq!(carried(941.73848, 0.87081, Some(0.2)), "941.74");
        assert_eq!(estimated(0.043_646_769, Some(3e-8)), "0.0436468");
        assert_eq!(carried_ends([-0.123_456, 941.73848], 0.87081, None), ["-0.123", "941.738"]);
    }

    #[test]
    fn a_yield_near_0_is_not_0() {
        // Upper end of the interval of no hit among 100000: 3.84e-5. Its mirror has three digits of the rejects.
        assert_eq!(
            [0.0, 3.84e-5, 0.000_139, 0.05, 0.5].map(yielded),
            ["0 %", "0.004 %", "0.01 %", "5.00 %", "50.00 %"]
        );
        assert_eq!(yielded(1.0 - 3.84e-5), "99.99616 %");
    }

    #[test]
    fn a_target_has_the_digits_of_the_study() {
        assert_eq!([0.9973, 0.999, 0.99999].map(target_yield), ["99.73 %", "99.9 %", "99.999 %"]);
        // One standard deviation fewer than three, computed: with three digits of the rejects.
        assert_eq!(target_yield(0.954_499_736), "95.45 %");
    }

    proptest::proptest! {
        /// No value lies beyond the printed ends, except for a millionth of their last digit.
        #[test]
        fn outward_ends_enclose(low in -1e6..1e6_f64, width in 1e-6..1e4_f64, sigma in 1e-4..1e3_f64) {
            let high = low + width;
            let texts = outward([low, high], sigma, None);
            let decimals = texts[0].split_once('.').map_or(0, |(_, digits)| digits.len());
            // A millionth of the last digit, and rounding of a double at either step.
            let slack = 2e-6 * 10f64.powi(-(decimals as i32)) + 4.0 * f64::EPSILON * low.abs().max(high.abs());
            let [from, to] = texts.clone().map(|text| text.parse::<f64>().unwrap());
            proptest::prop_assert!(from <= low + slack && to >= high - slack, "{texts:?} of {low} .. {high}");
        }
    }
}
