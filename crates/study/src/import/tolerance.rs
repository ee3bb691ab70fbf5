//! A tolerance in one cell: `0.1`, `±0,1`, `+0.1/-0.05`, `0/-0,02`, `0,02 %`, `H7`.

use crate::table::clean;

/// A tolerance as written. Its numbers are text, since their style follows from the whole table.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Written {
    /// Half-width of the band.
    Half(String),
    /// Two deviations, in any order.
    Two([String; 2]),
    /// Half-width of the band in percent of the nominal.
    Percent(String),
    /// Tolerance class of ISO 286.
    Class(String),
}

/// Tolerance in a cell. Returns None if it has none of these forms.
pub(super) fn written(cell: &str) -> Option<Written> {
    let text: String = clean(cell).chars().filter(|c| !c.is_whitespace()).collect();
    let half = ["±", "+/-", "+-"].iter().find_map(|sign| text.strip_prefix(sign));
    let body = half.unwrap_or(&text);
    let begins = |c: char| c.is_ascii_digit() || ['+', '-', '.', ','].contains(&c);
    let number = |text: &str| text.starts_with(begins) && text.chars().all(|c| begins(c) || ['e', 'E'].contains(&c));
    if let Some(percent) = body.strip_suffix('%') {
        return number(percent).then(|| Written::Percent(percent.to_owned()));
    }
    if half.is_some() {
        return number(body).then(|| Written::Half(body.to_owned()));
    }
    if let Some((first, second)) = body.split_once(['/', ';', '|']) {
        return (number(first) && number(second)).then(|| Written::Two([first.to_owned(), second.to_owned()]));
    }
    if number(body) {
        return Some(Written::Half(body.to_owned()));
    }
    let letters = body.chars().take_while(char::is_ascii_alphabetic).count();
    let grade = &body[letters..];
    let class = (1..=2).contains(&letters) && !grade.is_empty() && grade.bytes().all(|byte| byte.is_ascii_digit());
    class.then(|| Written::Class(body.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_of_a_tolerance_is_told_apart() {
        let two = |a: &str, b: &str| Some(Written::Two([a.to_owned(), b.to_owned()]));
        let half = |a: &str| Some(Written::Half(a.to_owned()));
        assert_eq!(written("0,1"), half("0,1"));
        assert_eq!(written("± 0,05"), half("0,05"));
        assert_eq!(written("+/-0.1"), half("0.1"));
        assert_eq!(written("+0.1/-0.05"), two("+0.1", "-0.05"));
        assert_eq!(written("0/\u{2212}0,02"), two("0", "-0,02"));
        assert_eq!(written("0,02 %"), Some(Written::Percent("0,02".to_owned())));
        assert_eq!(written("H7"), Some(Written::Class("H7".to_owned())));
        assert_eq!(written("js12"), Some(Written::Class("js12".to_owned())));
        for none in ["", "H", "7H", "tbd", "H7x", "±"] {
            assert_eq!(written(none), None, "{none}");
        }
    }
}
