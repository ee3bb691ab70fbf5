//! Text of a study file, and places in it.

use std::ops::Range;
use std::sync::Arc;

use crate::error::{Fault, StudyFault, fault};
use crate::external_settings::Externals;
use crate::folder::Place;
use sensitol::assembly::formula::FormulaError;

/// Name and text of a study file, with the settings for its files and programs.
#[derive(Clone)]
pub(super) struct Source {
    pub(super) name: String,
    pub(super) text: Arc<str>,
    /// Place of the files that the study names.
    pub(super) place: Place,
    pub(super) externals: Externals,
}

impl Source {
    /// Range in the file of a range of a decoded string, whose literal with its quotes is at `literal`.
    ///
    /// Every escape is one character of the string. A line break right after a triple quote is no character.
    pub(super) fn within_string(&self, literal: Range<usize>, decoded: Range<usize>) -> Range<usize> {
        let raw = &self.text[literal.clone()];
        let quote = ["\"\"\"", "'''", "\"", "'"].into_iter().find(|quote| raw.starts_with(quote)).unwrap_or("");
        let body = &raw[quote.len()..raw.len() - quote.len()];
        let trimmed =
            if quote.len() == 3 { body.trim_start_matches('\r').strip_prefix('\n').unwrap_or(body) } else { body };
        let start = literal.start + quote.len() + (body.len() - trimmed.len());
        let place = |target: usize| start + raw_offset(trimmed, target, quote.starts_with('"'));
        place(decoded.start)..place(decoded.end)
    }
}

/// Number of bytes in a literal's body before the decoded byte `target`.
fn raw_offset(body: &str, target: usize, escapes: bool) -> usize {
    let (mut raw, mut decoded) = (0, 0);
    while decoded < target && raw < body.len() {
        let rest = &body[raw..];
        let character = rest.chars().next().expect("not at the end");
        if !(escapes && character == '\\') {
            raw += character.len_utf8();
            decoded += character.len_utf8();
            continue;
        }
        let digits = match rest[1..].chars().next() {
            Some('x') => 2,
            Some('u') => 4,
            Some('U') => 8,
            Some(c) if c.is_whitespace() => {
                // A TOML line continuation removes all white space that follows.
                raw += 1 + rest[1..].len() - rest[1..].trim_start().len();
                continue;
            }
            _ => 0,
        };
        let code = rest.get(2..2 + digits).and_then(|digits| u32::from_str_radix(digits, 16).ok());
        decoded += code.and_then(char::from_u32).map_or(1, char::len_utf8);
        raw += (2 + digits).min(rest.len());
    }
    raw
}

/// Fault within a formula, at its place in the file.
pub(super) fn in_formula(source: &Source, text: Range<usize>, key: String, error: FormulaError) -> Fault {
    let span = source.within_string(text, error.span);
    fault(span, key, StudyFault::Formula(error.fault))
}
