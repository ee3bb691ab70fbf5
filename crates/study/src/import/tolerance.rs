//! A tolerance in one cell: `0.1`, `±0,1`, `+0.1/-0.05`, `0/-0,02`, `0,02 %`, `H7`.

use crate::table::clean;

/// A tolerance as written. Its numbers are text, since their style follows from the whole table.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Written {
    /// Half-width of the band: a number without sign, or behind `±`.
    Half(String),
    /// One deviation with its sign; the other one is 0.
    OneSided(String),
    /// Upper and lower deviation, the lower one without its sign.
    Unsigned([String; 2]),
    /// Two deviations, in any order.
    Two([String; 2]),
    /// Half-width of the band in percent of the nominal.
    Percent(String),
    /// Tolerance class of ISO 286.
    Class(String),
    /// Two deviations of which one has a plus and the other no sign.
    MissingSign,
}

/// Tolerance in a cell. Returns None if it has none of these forms.
pub(super) fn written(cell: &str) -> Option<Written> {
    let text: String = clean(cell).chars().filter(|c| !c.is_whitespace()).collect();
    let half = ["±", "+/-", "+-"].iter().find_map(|sign| text.strip_prefix(sign));
    let body = half.unwrap_or(&text);
    if let Some(percent) = body.strip_suffix('%') {
        return is_number(percent).then(|| Written::Percent(percent.to_owned()));
    }
    if half.is_some() {
        return is_number(body).then(|| Written::Half(body.to_owned()));
    }
    let at_sign = |at: usize| (!body[..at].ends_with(['e', 'E'])).then(|| body.split_at(at));
    let second = body.char_indices().skip(1).filter(|(_, c)| ['+', '-'].contains(c)).find_map(|(at, _)| at_sign(at));
    if let Some((first, second)) = body.split_once(['/', ';', '|']).or(second) {
        return (is_number(first) && is_number(second)).then(|| pair(first, second));
    }
    if is_number(body) {
        let one = body.to_owned();
        return Some(if body.starts_with(['+', '-']) { Written::OneSided(one) } else { Written::Half(one) });
    }
    let letters = body.chars().take_while(char::is_ascii_alphabetic).count();
    let grade = &body[letters..];
    let class = (1..=2).contains(&letters) && !grade.is_empty() && grade.bytes().all(|byte| byte.is_ascii_digit());
    class.then(|| Written::Class(body.to_owned()))
}

/// True if the text is made of the characters of a number.
pub(super) fn is_number(text: &str) -> bool {
    let begins = |c: char| c.is_ascii_digit() || ['+', '-', '.', ','].contains(&c);
    text.starts_with(begins)
        && text.chars().any(|c| c.is_ascii_digit())
        && text.chars().all(|c| begins(c) || ['e', 'E'].contains(&c))
}

/// Two deviations. Without a sign the first one is the upper one; beside a negative one it is positive.
fn pair(first: &str, second: &str) -> Written {
    let is_zero = |text: &str| !text.contains(|c: char| ('1'..='9').contains(&c));
    let signed = |text: &str, sign: char| text.starts_with(sign);
    let bare = |text: &str| !text.starts_with(['+', '-']);
    let both = [first.to_owned(), second.to_owned()];
    match (first, second) {
        (a, b) if bare(a) && bare(b) => Written::Unsigned(both),
        (a, b) if signed(a, '-') || signed(b, '-') => Written::Two(both),
        (a, b) if bare(a) && !is_zero(a) || bare(b) && !is_zero(b) => Written::MissingSign,
        _ => Written::Two(both),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_form_of_a_tolerance_is_told_apart() {
        let two = |a: &str, b: &str| Some(Written::Two([a.to_owned(), b.to_owned()]));
        let half = |a: &str| Some(Written::Half(a.to_owned()));
        let one = |a: &str| Some(Written::OneSided(a.to_owned()));
        assert_eq!(written("0,1"), half("0,1"));
        assert_eq!(written("\u{2212}0,12"), one("-0,12"));
        assert_eq!(written("+0,14"), one("+0,14"));
        assert_eq!(written("0,1/0,2"), Some(Written::Unsigned(["0,1".to_owned(), "0,2".to_owned()])));
        assert_eq!(written("+0,1/0,2"), Some(Written::MissingSign));
        assert_eq!(written("0,1/-0,2"), two("0,1", "-0,2"));
        assert_eq!(written("-0,2/0,1"), two("-0,2", "0,1"));
        assert_eq!(written("+0,2/0"), two("+0,2", "0"));
        assert_eq!(written("+0,2/+0,1"), two("+0,2", "+0,1"));
        assert_eq!(written("+0,1\n-0,05"), two("+0,1", "-0,05"));
        assert_eq!(written("1e-3"), half("1e-3"));
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
