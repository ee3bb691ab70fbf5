//! Times of measured rows: numbers, clock times, dates in ISO and German form, and dates of workbooks.

/// Seconds of a day.
const DAY: f64 = 86400.0;
/// Date from which workbooks count days.
const WORKBOOK_ORIGIN: [i64; 3] = [1899, 12, 30];
/// Days of each month of a year that is not a leap year.
const MONTHS: [i64; 12] = [31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];

/// Time of one row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum RowTime {
    /// A number as it is.
    Number(f64),
    /// Seconds of a day without a date.
    Clock(f64),
    /// Seconds with a date.
    Dated(f64),
}

impl RowTime {
    /// Time of a text. Returns None if it is none.
    pub(crate) fn of_text(text: &str) -> Option<Self> {
        if let Ok(number) = text.parse::<f64>() {
            return Some(Self::Number(number)).filter(|_| number.is_finite());
        }
        match text.split_once([' ', 'T']) {
            Some((date, time)) => Some(Self::Dated(DAY * date_of(date)? + clock_of(time.trim())?)),
            None if text.contains(':') => clock_of(text).map(Self::Clock),
            None => Some(Self::Dated(DAY * date_of(text)?)),
        }
    }

    /// Time of a workbook's number of days. Numbers below one are clock times.
    pub(crate) fn of_workbook(days: f64) -> Option<Self> {
        let origin = days_of(WORKBOOK_ORIGIN)?;
        match days {
            days if !days.is_finite() || days < 0.0 => None,
            days if days < 1.0 => Some(Self::Clock(DAY * days)),
            days => Some(Self::Dated(DAY * (days + origin))),
        }
    }

    fn seconds(self) -> f64 {
        match self {
            Self::Number(value) | Self::Clock(value) | Self::Dated(value) => value,
        }
    }

    /// True if two times are of one form.
    pub(crate) fn like(self, other: Self) -> bool {
        std::mem::discriminant(&self) == std::mem::discriminant(&other)
    }
}

/// Rows at which clock times without a date fall.
fn falls(times: &[Option<RowTime>]) -> Vec<usize> {
    let (mut found, mut last) = (Vec::new(), f64::NEG_INFINITY);
    for (row, time) in times.iter().enumerate() {
        if let Some(RowTime::Clock(time)) = time {
            if *time < last {
                found.push(row);
            }
            last = *time;
        }
    }
    found
}

/// Times as numbers, and the number of falls of clock times. Clock times that fall once continue on the next day.
pub(crate) fn in_order(times: &[Option<RowTime>]) -> (Vec<Option<f64>>, usize) {
    let falls = falls(times);
    let next_day = if let [row] = falls[..] { row } else { times.len() };
    let placed = |(row, time): (usize, &Option<RowTime>)| {
        time.map(|time| time.seconds() + if row >= next_day { DAY } else { 0.0 })
    };
    (times.iter().enumerate().map(placed).collect(), falls.len())
}

/// Whole number of digits alone.
fn whole(text: &str) -> Option<i64> {
    let digits = (1..=4).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
    text.parse().ok().filter(|_| digits)
}

/// Days of a date: `2026-11-28`, or `28.11.2026`.
fn date_of(text: &str) -> Option<f64> {
    let numbers = |separator: char| text.split(separator).map(whole).collect::<Option<Vec<i64>>>();
    if let Some([year, month, day]) = numbers('-').as_deref() {
        return days_of([*year, *month, *day]);
    }
    match numbers('.').as_deref() {
        // A year of two digits is one of this century.
        Some([day, month, year]) if *year < 100 => days_of([2000 + year, *month, *day]),
        Some([day, month, year]) => days_of([*year, *month, *day]),
        _ => None,
    }
}

/// Days of the Gregorian calendar. Returns None of a day that does not exist.
fn days_of([year, month, day]: [i64; 3]) -> Option<f64> {
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let place = usize::try_from(month - 1).ok()?;
    let longest = MONTHS.get(place)? + i64::from(leap && month == 2);
    if !(1..=longest).contains(&day) {
        return None;
    }
    // Years begin in March, so that a leap day is the last of its year.
    let (y, m) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    Some((365 * y + y.div_euclid(4) - y.div_euclid(100) + y.div_euclid(400) + (153 * m + 2) / 5 + day) as f64)
}

/// Seconds of a clock time: `06:30`, `06:30:15` or `06:30:15.5`, with or without a Z.
fn clock_of(text: &str) -> Option<f64> {
    let parts: Vec<&str> = text.trim_end_matches('Z').split(':').collect();
    let (hours, minutes, seconds) = match parts[..] {
        [hours, minutes] => (whole(hours)?, whole(minutes)?, 0.0),
        [hours, minutes, seconds] => {
            whole(seconds.split('.').next()?)?;
            (whole(hours)?, whole(minutes)?, seconds.parse::<f64>().ok()?)
        }
        _ => return None,
    };
    let exists = hours < 24 && minutes < 60 && (0.0..60.0).contains(&seconds);
    exists.then_some((3600 * hours + 60 * minutes) as f64 + seconds)
}

#[cfg(test)]
mod tests {
    use super::{RowTime, in_order};

    fn seconds(texts: &[&str]) -> Vec<f64> {
        let times: Vec<_> = texts.iter().map(|text| RowTime::of_text(text)).collect();
        in_order(&times).0.into_iter().map(|time| time.expect("a time")).collect()
    }

    #[test]
    fn a_night_shift_continues_on_the_next_day() {
        assert_eq!(seconds(&["20:00", "23:59:30", "03:52"]), [72000.0, 86370.0, 86400.0 + 13920.0]);
        // Two falls are an order that no night explains.
        assert_eq!(seconds(&["20:00", "03:00", "02:00"]), [72000.0, 10800.0, 7200.0]);
    }

    /// Days between two dates by the calendar: 2024 is a leap year, and 1900 is not.
    #[test]
    fn dates_in_both_forms_are_the_same_days() {
        for (from, to, days) in [
            ("2026-11-28", "29.11.2026", 1.0),
            ("28.02.2024", "2024-03-01", 2.0),
            ("1900-02-28", "01.03.1900", 1.0),
            ("31.12.25", "2026-01-01", 1.0),
        ] {
            let found = seconds(&[from, to]);
            assert_eq!(found[1] - found[0], 86400.0 * days, "{from} {to}");
        }
        assert_eq!(RowTime::of_text("28.11.2026 06:01"), RowTime::of_text("2026-11-28T06:01:00Z"));
        // Workbooks show 45000.25 as 2023-03-15 06:00.
        assert_eq!(RowTime::of_workbook(45000.25), RowTime::of_text("2023-03-15 06:00"));
        assert_eq!(RowTime::of_workbook(0.25), RowTime::of_text("06:00"));
    }

    #[test]
    fn times_that_do_not_exist_are_none() {
        for text in
            ["25:71", "24:00", "06:60", "06:30:61", "2026-02-31", "31.04.2026", "2026-13-01", "28.11", "-1:30", "6 am"]
        {
            let number = text.parse::<f64>().is_ok();
            assert!(number || RowTime::of_text(text).is_none(), "{text}");
        }
    }
}
