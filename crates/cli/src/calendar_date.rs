//! Date of a report in the calendar, UTC.

use std::ffi::OsStr;
use std::time::{SystemTime, UNIX_EPOCH};

use crate::failure::Failure;

/// Seconds of a day.
const DAY: u64 = 86_400;
/// Variable with the time of a reproducible build, in seconds (reproducible-builds.org).
const VARIABLE: &str = "SOURCE_DATE_EPOCH";

/// Returns the date of today, or of the variable SOURCE_DATE_EPOCH if it is set. Returns None if the clock is wrong.
pub(crate) fn today() -> Result<Option<String>, Failure> {
    let set = std::env::var_os(VARIABLE).filter(|text| !text.is_empty());
    let seconds = match set {
        Some(text) => Some(seconds(&text)?),
        None => SystemTime::now().duration_since(UNIX_EPOCH).ok().map(|since| since.as_secs()),
    };
    Ok(seconds.map(|seconds| date(seconds / DAY)))
}

/// Returns the seconds since 1970 that the variable holds.
fn seconds(text: &OsStr) -> Result<u64, Failure> {
    let whole = text.to_str().and_then(|text| text.trim().parse().ok());
    whole.ok_or_else(|| Failure::WrongDate { variable: VARIABLE, text: text.to_string_lossy().into_owned() })
}

/// Returns the date of a day since 1970-01-01 in the Gregorian calendar.
///
/// # Source
/// H. Hinnant, "chrono-compatible low-level date algorithms", `civil_from_days`: years begin in March, so that leap days end them.
fn date(days: u64) -> String {
    // Days since 0000-03-01, of which 400 years have 146097.
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = year + 400 * era + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Days of `date -u -d DATE +%s` divided by 86400 (GNU coreutils).
    #[test]
    fn dates_are_those_of_the_calendar() {
        let days = [0, 59, 11_016, 11_017, 20_785, 47_540];
        let dates = days.map(date);
        assert_eq!(dates, ["1970-01-01", "1970-03-01", "2000-02-29", "2000-03-01", "2026-11-28", "2100-02-28"]);
    }

    #[test]
    fn a_time_that_is_no_whole_number_of_seconds_is_an_error() {
        for text in ["abc", "-5", "1700000000.5", "1e9", " ", "0x10"] {
            let said = seconds(OsStr::new(text)).unwrap_err().to_string();
            assert!(said.contains("SOURCE_DATE_EPOCH") && said.contains(&format!("`{text}`")), "{said}");
        }
        // `date -u -d @1795867200 +%F` (GNU coreutils).
        assert_eq!(date(seconds(OsStr::new("1795867200\n")).unwrap() / DAY), "2026-11-28");
    }
}
