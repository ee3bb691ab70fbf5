//! Habitual typing mistakes, and the text that a study needs instead.

use std::fmt;
use std::ops::Range;

/// Beginning of the text on the meaning of a tolerance.
const TOLERANCE: &str = "a half band";

/// Probable mistake behind a fault.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum TypingHabit {
    /// A decimal comma.
    DecimalComma {
        /// The number as written.
        found: String,
    },
    /// Typographic quotes.
    CurlyQuotes,
    /// A typographic minus sign or dash.
    TypesetMinus,
    /// A missing comma between two entries of a table or a list.
    MissingComma,
    /// A number in quotes.
    QuotedNumber {
        /// The number without the quotes.
        number: String,
    },
    /// Two deviations in quotes.
    TwoDeviations {
        /// The list of the deviations.
        list: String,
    },
    /// A tolerance class of ISO 286 in place of a tolerance.
    FitClass {
        /// The class.
        class: String,
    },
    /// Numbers of a list in one text.
    QuotedNumbers {
        /// The list of the numbers.
        list: String,
    },
    /// A command line in one text.
    CommandLine {
        /// Words of the command line.
        words: Vec<String>,
    },
}

impl fmt::Display for TypingHabit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DecimalComma { found } => {
                write!(f, "numbers have a decimal point: write {}", found.replace(',', "."))
            }
            Self::CurlyQuotes => f.write_str("texts stand in straight quotes: \""),
            Self::TypesetMinus => f.write_str("minus is the sign - of the keyboard"),
            Self::MissingComma => f.write_str("write a comma between the entries"),
            Self::QuotedNumber { number } => write!(f, "write {number}, without quotes"),
            Self::QuotedNumbers { list } => write!(f, "write its numbers as a list: {list}"),
            Self::TwoDeviations { list } => write!(f, "write {list}, without quotes"),
            Self::FitClass { class } => write!(f, "write fit = \"{class}\" in place of the tolerance"),
            Self::CommandLine { words } => {
                write!(f, "write its words as a list: {words:?}")
            }
        }
    }
}

impl TypingHabit {
    /// Probable mistake in a text that the parser refused at this place with this message. Returns None if none is likely.
    pub(super) fn of_syntax(text: &str, at: &Range<usize>, message: &str) -> Option<Self> {
        let start = text.get(..at.start)?.rfind('\n').map_or(0, |newline| newline + 1);
        let line = text[start..].lines().next().unwrap_or_default();
        let here = at.start - start;
        if let Some(found) = decimal_comma(line, here) {
            return Some(Self::DecimalComma { found });
        }
        let rest = line.get(here..).unwrap_or_default();
        match rest.chars().next() {
            Some('\u{201c}' | '\u{201d}' | '\u{201e}' | '\u{2018}' | '\u{2019}') => Some(Self::CurlyQuotes),
            Some('\u{2212}' | '\u{2013}') => Some(Self::TypesetMinus),
            _ => message.contains("expected `,`").then_some(Self::MissingComma),
        }
    }

    /// Probable mistake in a value of the wrong kind. Returns None if none is likely.
    pub(super) fn of_value(expected: &str, found: &str) -> Option<Self> {
        let text = found.strip_prefix("the text \"")?.strip_suffix('"')?;
        if expected.starts_with("a list such as") {
            let numbers: Vec<&str> =
                text.split([' ', ',', ';', '[', ']']).filter(|number| !number.is_empty()).collect();
            if !numbers.is_empty() && numbers.iter().all(|number| number.parse::<f64>().is_ok()) {
                return Some(Self::QuotedNumbers { list: format!("[{}]", numbers.join(", ")) });
            }
            let words = text.split_whitespace().map(str::to_owned).collect();
            return Some(Self::CommandLine { words });
        }
        if expected.starts_with(TOLERANCE) {
            return Self::of_tolerance(text);
        }
        if !expected.starts_with("a number") {
            return None;
        }
        match text.trim().parse::<f64>() {
            Ok(_) => Some(Self::QuotedNumber { number: text.trim().to_owned() }),
            Err(_) => decimal_comma(text, 0).filter(|found| found == text).map(|found| Self::DecimalComma { found }),
        }
    }
}

impl TypingHabit {
    /// Probable mistake in a text in place of a tolerance: `±0.1`, `+0.1/-0.05`, `H7`. Returns None if none is likely.
    fn of_tolerance(text: &str) -> Option<Self> {
        let bare: String = text.chars().filter(|c| !c.is_whitespace()).collect();
        let bare = bare.replace('\u{2212}', "-").replace(',', ".");
        let number = |text: &str| text.parse::<f64>().is_ok_and(f64::is_finite);
        let half = ["±", "+/-", "+-"].iter().find_map(|sign| bare.strip_prefix(sign)).unwrap_or(&bare);
        if number(half) && !half.starts_with(['+', '-']) {
            return Some(Self::QuotedNumber { number: half.to_owned() });
        }
        let plain = |text: &str| text.trim_start_matches('+').to_owned();
        if number(half) {
            let list = if half.starts_with('-') { format!("[{half}, 0]") } else { format!("[0, {}]", plain(half)) };
            return Some(Self::TwoDeviations { list });
        }
        if let Some((upper, lower)) = half.split_once('/').filter(|(upper, lower)| number(upper) && number(lower)) {
            let list = format!("[{}, {}]", plain(lower), plain(upper));
            let signed = lower.starts_with(['+', '-']) || lower.parse() == Ok(0.0);
            return signed.then_some(Self::TwoDeviations { list });
        }
        let letters = half.chars().take_while(char::is_ascii_alphabetic).count();
        let grade = &half[letters..];
        let class = (1..=2).contains(&letters) && !grade.is_empty() && grade.bytes().all(|byte| byte.is_ascii_digit());
        class.then(|| Self::FitClass { class: half.to_owned() })
    }
}

/// Number with a comma in it that holds this place of the line or ends there.
fn decimal_comma(line: &str, here: usize) -> Option<String> {
    let digit = |c: char| c.is_ascii_digit();
    for (comma, _) in line.match_indices(',') {
        let before = line[..comma]
            .rfind(|c: char| !digit(c))
            .map_or(0, |at| at + line[at..].chars().next().map_or(1, char::len_utf8));
        let after = line[comma + 1..].find(|c: char| !digit(c)).map_or(line.len(), |at| comma + 1 + at);
        if before < comma && after > comma + 1 && (before..=after).contains(&here) {
            return Some(line[before..after].to_owned());
        }
    }
    None
}

/// Share that equals a percentage, without the rounding of a division.
pub(super) fn percent(value: f64) -> f64 {
    format!("{value}e-2").parse().unwrap_or(value / 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_in_quotes_are_written_without() {
        let of = |text: &str| {
            let found = format!("the text \"{text}\"");
            TypingHabit::of_value("a half band such as 0.3", &found).map(|habit| habit.to_string())
        };
        for (text, words) in [
            ("±0.01", "write 0.01, without quotes"),
            ("0.01", "write 0.01, without quotes"),
            ("+/- 0,01", "write 0.01, without quotes"),
            ("-0.02", "write [-0.02, 0], without quotes"),
            ("+0.1/-0.05", "write [-0.05, 0.1], without quotes"),
            ("H7", "write fit = \"H7\" in place of the tolerance"),
        ] {
            assert_eq!(of(text).as_deref(), Some(words), "{text}");
        }
        assert_eq!(of("tight"), None);
        // Without signs the second deviation may lie on either side.
        assert_eq!(of("0.1/0.2"), None);
    }

    #[test]
    fn commas_in_numbers_only() {
        assert_eq!(decimal_comma("a = 10,05", 6), Some("10,05".into()));
        assert_eq!(decimal_comma("a = [1, 2]", 6), None);
        assert_eq!(decimal_comma("a = 10,0, b = 3", 8), Some("10,0".into()));
        assert_eq!(decimal_comma("\u{e4}1,2", 0), None);
        assert_eq!(percent(99.73), 0.9973);
    }
}
