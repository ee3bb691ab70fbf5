//! Numbers for people: rounded to what they are worth, aligned by their decimal point.

/// In place of what is unknown.
pub(crate) const UNKNOWN: &str = "-";

/// A count with what is counted.
pub(crate) fn plural(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// A yield in percent, with three digits of what is rejected.
pub(crate) fn share(rejected: f64) -> String {
    let percent = 100.0 * rejected;
    if percent <= 0.0 {
        return "100 %".to_owned();
    }
    let decimals = (2.0 - percent.log10().floor()).clamp(2.0, 12.0) as usize;
    let text = format!("{:.decimals$}", 100.0 - percent);
    match text.trim_end_matches('0') {
        "100." => "100 %".to_owned(),
        "0." => "0 %".to_owned(),
        _ => format!("{text} %"),
    }
}

/// As many decimals as show `digits` significant digits of `scale`; None where that takes an exponent.
pub(crate) fn decimals(scale: f64, digits: i32) -> Option<usize> {
    if scale == 0.0 || !scale.is_finite() {
        return Some(0);
    }
    let magnitude = scale.abs().log10().floor() as i32;
    usize::try_from((digits - 1 - magnitude).max(0)).ok().filter(|&decimals| decimals <= 9)
}

/// `digits` significant digits, with an exponent where the number is very large or very small.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    // Rounded first, so that 0.9999999 counts as 1.
    let rounded = format!("{value:.*e}", digits - 1);
    let magnitude: i32 = rounded.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    if !(-4..9).contains(&magnitude) {
        return shortened(&rounded);
    }
    let decimals = (digits as i32 - 1 - magnitude).max(0) as usize;
    format!("{value:.decimals$}")
}

/// The number as it was written in the study, within reason.
pub(crate) fn plain(value: f64) -> String {
    let text = format!("{value}");
    // A tolerance computed from limits has a tail of rounding errors that nobody wrote.
    let text = if text.len() > 10 { trimmed(&significant(value, 8)) } else { text };
    let exponent = shortened(&format!("{value:e}"));
    if exponent.len() + 2 < text.len() { exponent } else { text }
}

/// A mean beside its sigma: as many digits as sigma has five of.
pub(crate) fn beside(value: f64, sigma: f64) -> String {
    match decimals(sigma, 5) {
        Some(decimals) if value.abs() < 1e9 => unsigned_zero(format!("{value:.decimals$}")),
        _ => {
            let ratio = (value / sigma).abs().max(1.0).log10().floor();
            let digits = if ratio.is_finite() { (ratio as usize + 5).min(17) } else { 6 };
            significant(value, digits)
        }
    }
}

/// `-0.00` says no more than `0.00`.
pub(crate) fn unsigned_zero(text: String) -> String {
    match text.strip_prefix('-') {
        Some(zero) if zero.chars().all(|c| c == '0' || c == '.') => zero.to_owned(),
        _ => text,
    }
}

/// A share in percent.
pub(crate) fn percent(share: f64) -> String {
    match 100.0 * share {
        nothing if nothing.abs() < 1e-12 => "0".to_owned(),
        small if small.abs() < 0.005 => "<0.01".to_owned(),
        percent => format!("{percent:.2}"),
    }
}

/// Without the zeros at the end of a mantissa.
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
