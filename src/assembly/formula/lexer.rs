//! Text to tokens.

use std::ops::Range;

use winnow::LocatingSlice;
use winnow::ascii::{digit1, multispace0};
use winnow::combinator::{alt, delimited, opt};
use winnow::error::ContextError;
use winnow::prelude::*;
use winnow::stream::Location;
use winnow::token::{literal, one_of, take_till, take_while};

use super::error::{FormulaError, FormulaFault};

/// One token.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    Number(f64),
    /// The flag says that it stood in backquotes, where it is never a function or constant.
    Name(String, bool),
    Operator(&'static str),
    Open,
    Close,
    Comma,
}

type Input<'a> = LocatingSlice<&'a str>;
type Scan<T> = Result<T, ContextError>;

/// Longest first, so that `<=` is not read as `<`.
const OPERATORS: [&str; 11] = ["<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "^"];

/// What people write by habit, and what formulas write instead.
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

/// All tokens with their byte ranges.
pub(super) fn tokens(text: &str) -> Result<Vec<(Token, Range<usize>)>, FormulaError> {
    let mut input = LocatingSlice::new(text);
    let mut tokens = Vec::new();
    loop {
        let _: Scan<&str> = multispace0.parse_next(&mut input);
        let (start, rest) = (input.current_token_start(), *input.as_ref());
        if rest.is_empty() {
            return Ok(tokens);
        }
        let habit = HABITS
            .iter()
            .find(|(sign, _)| rest.starts_with(sign) && !rest.starts_with("==") && !rest.starts_with("!="))
            .filter(|(sign, _)| *sign != "." || matches!(tokens.last(), Some((Token::Name(..), _))));
        if let Some(&(sign, instead)) = habit {
            return Err(FormulaError {
                span: start..start + sign.len(),
                fault: FormulaFault::UnexpectedCharacter { found: sign.to_owned(), instead: Some(instead) },
            });
        }
        match token.parse_next(&mut input) {
            Ok(Ok(token)) => tokens.push((token, start..input.current_token_start())),
            Ok(Err(text)) => {
                let span = start..input.current_token_start();
                return Err(FormulaError { span, fault: FormulaFault::BadNumber { text } });
            }
            Err(_) if rest.starts_with('`') => {
                return Err(FormulaError { span: start..start + 1, fault: FormulaFault::UnclosedName });
            }
            Err(_) => {
                let found = rest.chars().next().expect("not empty").to_string();
                let span = start..start + found.len();
                return Err(FormulaError { span, fault: FormulaFault::UnexpectedCharacter { found, instead: None } });
            }
        }
    }
}

/// One token, or a number that no double holds.
fn token(input: &mut Input<'_>) -> Scan<Result<Token, String>> {
    alt((
        number,
        plain_name.map(|name: &str| Ok(Token::Name(name.to_owned(), false))),
        quoted_name.map(|name: &str| Ok(Token::Name(name.to_owned(), true))),
        operator.map(|sign| Ok(Token::Operator(sign))),
        '('.value(Ok(Token::Open)),
        ')'.value(Ok(Token::Close)),
        ','.value(Ok(Token::Comma)),
    ))
    .parse_next(input)
}

fn number(input: &mut Input<'_>) -> Scan<Result<Token, String>> {
    let mantissa = alt(((digit1, opt(('.', opt(digit1)))).void(), ('.', digit1).void()));
    let exponent = opt((one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1));
    let text: &str = (mantissa, exponent).take().parse_next(input)?;
    Ok(match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Token::Number(value)),
        _ => Err(text.to_owned()),
    })
}

fn plain_name<'a>(input: &mut Input<'a>) -> Scan<&'a str> {
    let first = one_of(|c: char| c.is_alphabetic() || c == '_');
    let rest = take_while(0.., |c: char| c.is_alphanumeric() || c == '_');
    (first, rest).take().parse_next(input)
}

fn quoted_name<'a>(input: &mut Input<'a>) -> Scan<&'a str> {
    delimited('`', take_till(1.., '`'), '`').parse_next(input)
}

fn operator(input: &mut Input<'_>) -> Scan<&'static str> {
    for sign in OPERATORS {
        let found: Scan<&str> = literal(sign).parse_next(input);
        if found.is_ok() {
            return Ok(sign);
        }
    }
    Err(ContextError::new())
}
