//! Habitual typing mistakes, and the text that a study needs instead.

use std::fmt;
use std::ops::Range;

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
            let words = text.split_whitespace().map(str::to_owned).collect();
            return Some(Self::CommandLine { words });
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
    fn commas_in_numbers_only() {
        assert_eq!(decimal_comma("a = 10,05", 6), Some("10,05".into()));
        assert_eq!(decimal_comma("a = [1, 2]", 6), None);
        assert_eq!(decimal_comma("a = 10,0, b = 3", 8), Some("10,0".into()));
        assert_eq!(decimal_comma("\u{e4}1,2", 0), None);
        assert_eq!(percent(99.73), 0.9973);
    }
}
