//! Parts of the sentences of warnings.

use crate::warning::Advice;

/// Names that a sentence lists before it counts the rest.
const SHOWN: usize = 5;

/// Message of a warning, and advice.
pub(super) struct Text {
    pub(super) message: String,
    pub(super) advice: Vec<Advice>,
}

/// A message without advice.
pub(super) fn say(message: impl Into<String>) -> Text {
    Text { message: message.into(), advice: Vec::new() }
}

impl Text {
    /// Appends advice.
    pub(super) fn advise(mut self, advice: Advice) -> Self {
        self.advice.push(advice);
        self
    }
}

/// Names in backquotes: the first few of many, and the number of the others.
pub(super) fn names(all: &[String]) -> String {
    let shown = if all.len() == SHOWN + 1 { SHOWN + 1 } else { SHOWN };
    let quoted: Vec<String> = all.iter().take(shown).map(|name| format!("`{name}`")).collect();
    match (all.len().saturating_sub(shown), &quoted[..]) {
        (0, [most @ .., last]) if !most.is_empty() => format!("{} and {last}", most.join(", ")),
        (0, _) => quoted.join(", "),
        (more, _) => format!("{} and {more} more", quoted.join(", ")),
    }
}

/// Sentence that names further dimensions with the same warning, with a leading blank. Empty without any.
pub(super) fn likewise(others: &[String]) -> String {
    match others {
        [] => String::new(),
        [one] => format!(" The same is true of `{one}`."),
        many => format!(" The same is true of {} others: {}.", many.len(), names(many)),
    }
}

/// Values with their lines, and the number of further ones.
pub(super) fn values_and_lines(first: &[(f64, u64)], count: usize) -> String {
    let named: Vec<String> = first.iter().map(|(value, line)| format!("{value} (line {line})")).collect();
    format!("{}{}", named.join(", "), more(first.len(), count))
}

/// Line numbers, and the number of further ones.
pub(super) fn lines<N: ToString>(first: &[N], count: usize) -> String {
    let named: Vec<String> = first.iter().map(N::to_string).collect();
    let word = if count == 1 { "line" } else { "lines" };
    format!("{word} {}{}", named.join(", "), more(first.len(), count))
}

fn more(shown: usize, count: usize) -> String {
    match count.saturating_sub(shown) {
        0 => String::new(),
        more => format!(" and {more} more"),
    }
}

pub(super) fn places([from, to]: [f64; 2]) -> String {
    format!("between {from:+.2} and {to:+.2} sigma")
}

/// Number with this many significant digits.
pub(super) fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = libm::log10(value.abs()).floor() as i32;
    match digits - 1 - exponent {
        places @ 0..=9 => format!("{value:.*}", places as usize),
        places if places < 0 && exponent < 9 => format!("{value:.0}"),
        _ => format!("{value:.*e}", (digits - 1) as usize),
    }
}

/// Number with all its digits, and with an exponent if it is very large or very small.
pub(super) fn number(value: f64) -> String {
    let ordinary = value == 0.0 || (1e-6..1e9).contains(&value.abs());
    if ordinary || !value.is_finite() { value.to_string() } else { format!("{value:e}") }
}

/// Share as percent, or as parts per million if it is below 0.1 %.
pub(super) fn part(share: f64) -> String {
    if share < 1e-3 {
        format!("{} ppm", significant(1e6 * share, 2))
    } else {
        format!("{} %", significant(100.0 * share, 2))
    }
}

#[cfg(test)]
mod tests {
    use super::{names, number};

    #[test]
    fn large_and_small_numbers_have_an_exponent() {
        let written = [4.5, -0.002, 0.0, 6e200, -1.5e-200].map(number);
        assert_eq!(written, ["4.5", "-0.002", "0", "6e200", "-1.5e-200"]);
    }

    #[test]
    fn long_lists_are_counted() {
        let all: Vec<String> = ('a'..='i').map(String::from).collect();
        assert_eq!(names(&all[..1]), "`a`");
        assert_eq!(names(&all[..2]), "`a` and `b`");
        assert_eq!(names(&all[..6]), "`a`, `b`, `c`, `d`, `e` and `f`");
        assert_eq!(names(&all), "`a`, `b`, `c`, `d`, `e` and 4 more");
    }
}
