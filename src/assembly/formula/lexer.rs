//! Text to tokens.

use std::ops::Range;

use crate::assembly::formula::error::{FormulaError, FormulaFault};
use crate::assembly::formula::name::plain_length;

/// Token of a formula.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    Number(f64),
    /// Name, and true if it was in backquotes. A quoted name is never a function or constant.
    Name(String, bool),
    Operator(&'static str),
    Open,
    Close,
    Comma,
    /// Text in brackets after a number.
    Unit(String),
}

/// Operators, longest first, so that `<=` is not read as `<`.
const OPERATORS: [&str; 11] = ["<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "^"];

/// Advice on the `=` before a formula.
const SPREADSHEET: &str = "leave out the `=` that begins a formula of a spreadsheet";

/// Spellings from other languages, with advice on the spelling in formulas.
const HABITS: [(&str, &str); 12] = [
    ("**", "powers are written with `^`"),
    ("&&", "write `if(a, b, 0)` for a and b"),
    ("||", "write `if(a, 1, b)` for a or b"),
    ("=", "equality is written with `==`"),
    ("!", "write `if(a, 0, 1)` for not a"),
    ("\u{2212}", "minus is the sign `-` of the keyboard"),
    ("\u{2013}", "minus is the sign `-` of the keyboard"),
    ("\u{d7}", "multiplication is written with `*`"),
    ("\u{b7}", "multiplication is written with `*`"),
    ("\u{22c5}", "multiplication is written with `*`"),
    ("\u{f7}", "division is written with `/`"),
    (".", "functions have no prefix: write `sin(x)`, not `math.sin(x)`"),
];

/// Returns all tokens with their byte ranges.
pub(super) fn tokens(text: &str) -> Result<Vec<(Token, Range<usize>)>, FormulaError> {
    let mut tokens = Vec::new();
    let mut start = 0;
    loop {
        let rest = text[start..].trim_start_matches([' ', '\t', '\r', '\n']);
        start = text.len() - rest.len();
        if rest.is_empty() {
            return Ok(tokens);
        }
        let fault = |length: usize, fault| Err(FormulaError { span: start..start + length, fault });
        if let (Some(unit), Some((Token::Number(_), _))) = (rest.strip_prefix('['), tokens.last()) {
            let Some(length) = unit.find(']') else { return fault(1, FormulaFault::UnclosedUnit) };
            tokens.push((Token::Unit(unit[..length].to_owned()), start..start + length + 2));
            start += length + 2;
            continue;
        }
        let habit = HABITS
            .iter()
            .find(|(sign, _)| rest.starts_with(sign) && !rest.starts_with("==") && !rest.starts_with("!="))
            .filter(|(sign, _)| *sign != "." || matches!(tokens.last(), Some((Token::Name(..), _))));
        if let Some(&(sign, instead)) = habit {
            let instead = if sign == "=" && tokens.is_empty() { SPREADSHEET } else { instead };
            let found = FormulaFault::UnexpectedCharacter { found: sign.to_owned(), instead: Some(instead) };
            return fault(sign.len(), found);
        }
        let Some((length, token)) = token(rest) else {
            if rest.starts_with('`') {
                return fault(1, FormulaFault::UnclosedName);
            }
            let found: String = rest.chars().take(1).collect();
            return fault(found.len(), FormulaFault::UnexpectedCharacter { found, instead: None });
        };
        match token {
            Ok(token) => tokens.push((token, start..start + length)),
            Err(text) => return fault(length, FormulaFault::BadNumber { text }),
        }
        start += length;
    }
}

/// Returns the first token of a text and its length in bytes, or None if there is none. A number that no double can hold is an error.
fn token(rest: &str) -> Option<(usize, Result<Token, String>)> {
    if let Some(length) = number(rest) {
        let text = &rest[..length];
        let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
        return Some((length, value.map(Token::Number).ok_or_else(|| text.to_owned())));
    }
    if let Some(length) = plain_length(rest) {
        return Some((length, Ok(Token::Name(rest[..length].to_owned(), false))));
    }
    if let Some(quoted) = rest.strip_prefix('`') {
        let length = quoted.find('`').filter(|&length| length > 0)?;
        return Some((length + 2, Ok(Token::Name(quoted[..length].to_owned(), true))));
    }
    if let Some(sign) = OPERATORS.into_iter().find(|sign| rest.starts_with(sign)) {
        return Some((sign.len(), Ok(Token::Operator(sign))));
    }
    let token = match rest.chars().next()? {
        '(' => Token::Open,
        ')' => Token::Close,
        ',' => Token::Comma,
        _ => return None,
    };
    Some((1, Ok(token)))
}

/// Returns the length of the number that a text begins with, such as `2`, `2.`, `.5` or `1.5e-3`. The `e` of `2e` is not part of it.
fn number(text: &str) -> Option<usize> {
    let digits = |text: &str| text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let whole = digits(text);
    let mut length = whole;
    if let Some(fraction) = text[whole..].strip_prefix('.') {
        length += 1 + digits(fraction);
    }
    if length == 0 || text[..length] == *"." {
        return None;
    }
    if let Some(exponent) = text[length..].strip_prefix(['e', 'E']) {
        let unsigned = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
        let digits = digits(unsigned);
        if digits > 0 {
            length += 1 + (exponent.len() - unsigned.len()) + digits;
        }
    }
    Some(length)
}
