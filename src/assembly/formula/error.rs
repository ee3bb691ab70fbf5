//! The faults of a formula: as it is written, and at one point.

use std::ops::Range;

use super::name::is_plain;
use sensitol_numeric::names::shortened_to;

/// A formula that cannot be read, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{fault}")]
pub struct FormulaError {
    /// Byte range in the formula's text.
    pub span: Range<usize>,
    /// The fault there.
    pub fault: FormulaFault,
}

/// The faults of a formula's text.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FormulaFault {
    /// Nothing stands there.
    #[error("the formula is empty")]
    Empty,
    /// A character that means nothing in a formula.
    #[error("`{found}` means nothing in a formula")]
    UnexpectedCharacter {
        /// The character or operator.
        found: String,
        /// The text to write instead, where that is known.
        instead: Option<&'static str>,
    },
    /// A number that no double holds.
    #[error("`{text}` is not a number that fits a double")]
    BadNumber {
        /// As written.
        text: String,
    },
    /// A backquoted name without its second backquote.
    #[error("the name that starts here has no closing backquote")]
    UnclosedName,
    /// A unit without its second bracket.
    #[error("this `[` is never closed")]
    UnclosedUnit,
    /// A unit that nothing is known of.
    #[error("there is no unit `{text}`")]
    UnknownUnit {
        /// As written.
        text: String,
    },
    /// A parenthesis without its partner.
    #[error("this `(` is never closed")]
    UnclosedParenthesis,
    /// A parenthesis without its partner.
    #[error("this `)` closes nothing")]
    UnopenedParenthesis,
    /// A comma outside the arguments of a function.
    #[error("a comma stands between the arguments of a function only")]
    StrayComma,
    /// An operand is missing.
    #[error("a number, a name or `(` is missing before {before}")]
    MissingOperand {
        /// The text that stands there instead.
        before: String,
    },
    /// Two operands stand side by side.
    #[error("an operator is missing before {before}")]
    MissingOperator {
        /// The text that stands there instead.
        before: String,
    },
    /// `a < b < c`
    #[error("comparisons cannot be chained")]
    ChainedComparison,
    /// A call of something that is not a function.
    #[error("there is no function `{name}`")]
    UnknownFunction {
        /// As written.
        name: String,
        /// The most similar function.
        nearest: Option<String>,
    },
    /// A function name without parentheses.
    #[error("`{name}` is a function and needs its arguments in parentheses")]
    BareFunction {
        /// The function.
        name: String,
    },
    /// A wrong number of arguments.
    #[error("`{name}` takes {expected} argument(s), not {found}")]
    WrongArity {
        /// The function.
        name: String,
        /// How many it takes, in words.
        expected: &'static str,
        /// How many stand there.
        found: usize,
    },
    /// More nested than is read.
    #[error("the formula is nested deeper than {limit} levels")]
    TooDeep {
        /// The deepest that is read.
        limit: usize,
    },
    /// A name that has to stand in backquotes.
    #[error("{name} is one name, and reads as several here")]
    NeedsBackquotes {
        /// The name.
        name: String,
    },
    /// A name that nothing bears.
    #[error("nothing is named `{name}`")]
    UndefinedName {
        /// As written.
        name: String,
        /// The most similar name.
        nearest: Option<String>,
    },
    /// A formula that needs its own value.
    #[error("`{}` needs its own value: {}", .path[0], path_words(.path))]
    Cycle {
        /// The names along the way, the first not repeated at the end.
        path: Vec<String>,
    },
}

fn path_words(path: &[String]) -> String {
    let mut words: Vec<&str> = path.iter().map(String::as_str).collect();
    words.push(&path[0]);
    words.join(" -> ")
}

impl FormulaFault {
    /// The text to write instead, where that can be said.
    pub fn help(&self) -> Option<String> {
        let nearest = |nearest: &Option<String>| nearest.as_ref().map(|name| format!("did you mean `{name}`?"));
        match self {
            Self::Empty => Some("write a formula such as \"a + b - c\"".into()),
            Self::UnexpectedCharacter { instead, .. } => instead.map(str::to_owned),
            Self::UnclosedUnit => Some("add a `]`".into()),
            Self::UnknownUnit { .. } => Some("units are written such as mm, N/mm^2, 1/K, deg, kg.m^2".into()),
            Self::UnclosedParenthesis => Some("add a `)`".into()),
            Self::UnopenedParenthesis => Some("remove it, or add a `(` before it".into()),
            Self::MissingOperator { .. } => Some("multiplication is written with `*`".into()),
            Self::ChainedComparison => Some("write `if(a < b, b < c, 0)`".into()),
            Self::UnknownFunction { nearest: Some(name), .. } => Some(format!("did you mean `{name}`?")),
            Self::UnknownFunction { .. } => {
                Some(format!("functions are {}", super::functions::Callable::names().collect::<Vec<_>>().join(", ")))
            }
            Self::BareFunction { name } => {
                Some(format!("write `{name}(...)`; a dimension of this name has to be renamed"))
            }
            Self::NeedsBackquotes { name } => Some(format!("write it in backquotes: `{name}`")),
            Self::UndefinedName { nearest: Some(name), .. } if !is_plain(name) => {
                Some(format!("did you mean {name}? Write it in backquotes: `{name}`"))
            }
            Self::UndefinedName { nearest: name @ Some(_), .. } => nearest(name),
            Self::UndefinedName { .. } => Some(
                "formulas know dimensions, constants, unknowns, other formulas and the model's outputs; \
                 a name with other characters than letters, digits and _ stands in backquotes"
                    .into(),
            ),
            Self::Cycle { .. } => Some("one of these formulas must do without the others".into()),
            _ => None,
        }
    }
}

/// Characters of a part of a formula that a message shows.
const SHOWN: usize = 80;

/// A formula that has no value at one point.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("`{}` in formula `{name}`: {reason}", shortened_to(&.text[.span.clone()], SHOWN))]
#[non_exhaustive]
pub struct FormulaFailure {
    /// The name of the formula or characteristic.
    pub name: String,
    /// Its text.
    pub text: String,
    /// The part of it that has no value.
    pub span: Range<usize>,
    /// Why.
    pub reason: FailureReason,
}

/// Why a part of a formula has no value.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FailureReason {
    /// The argument of a function lies outside its domain.
    #[error("{rule}, but is {argument}")]
    Domain {
        /// The argument.
        argument: f64,
        /// Where the function has a value.
        rule: &'static str,
    },
    /// A division by 0.
    #[error("division by 0")]
    DivisionByZero,
    /// A power that is not real, or infinite.
    #[error("{base} ^ {exponent} is not a finite real number")]
    Power {
        /// The base.
        base: f64,
        /// The exponent.
        exponent: f64,
    },
    /// A result beyond the largest double, or an operand that was none.
    #[error("the result {value} is not finite")]
    NotFinite {
        /// The result.
        value: f64,
    },
}
