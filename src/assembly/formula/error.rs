//! Errors of a formula: in its text, and at one point.

use crate::assembly::formula::functions;
use std::ops::Range;

use crate::assembly::formula::name::is_plain;
use sensitol_numeric::names::shortened_to;

/// Fault in the text of a formula, with its position.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{fault}")]
#[non_exhaustive]
pub struct FormulaError {
    /// Byte range in the formula's text.
    pub span: Range<usize>,
    /// Fault in this range.
    pub fault: FormulaFault,
}

/// Faults of a formula's text.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FormulaFault {
    /// The text is empty.
    #[error("the formula is empty")]
    Empty,
    /// A character that means nothing in a formula.
    #[error("`{found}` means nothing in a formula")]
    UnexpectedCharacter {
        /// Character or operator that was found.
        found: String,
        /// Text to write instead, if there is one.
        instead: Option<&'static str>,
    },
    /// A number that no double can hold.
    #[error("`{text}` is not a number that fits a double")]
    BadNumber {
        /// Number as it was written.
        text: String,
    },
    /// A backquoted name without its second backquote.
    #[error("the name that starts here has no closing backquote")]
    UnclosedName,
    /// A unit without its second bracket.
    #[error("this `[` is never closed")]
    UnclosedUnit,
    /// A unit that does not exist.
    #[error("there is no unit `{text}`")]
    UnknownUnit {
        /// Unit as it was written.
        text: String,
    },
    /// An opening parenthesis without its closing one.
    #[error("this `(` is never closed")]
    UnclosedParenthesis,
    /// A closing parenthesis without its opening one.
    #[error("this `)` closes nothing")]
    UnopenedParenthesis,
    /// A comma outside the arguments of a function.
    #[error("a comma stands between the arguments of a function only")]
    StrayComma,
    /// An operand is missing.
    #[error("a number, a name or `(` is missing before {before}")]
    MissingOperand {
        /// Text in the place of the operand.
        before: String,
    },
    /// Two operands without an operator between them.
    #[error("an operator is missing before {before}")]
    MissingOperator {
        /// Text in the place of the operator.
        before: String,
    },
    /// A chain of comparisons such as `a < b < c`.
    #[error("comparisons cannot be chained")]
    ChainedComparison,
    /// A call of a name that is not a function.
    #[error("there is no function `{name}`")]
    UnknownFunction {
        /// Name as it was written.
        name: String,
        /// Function with the most similar name, if one is similar.
        nearest: Option<String>,
    },
    /// A function name without parentheses.
    #[error("`{name}` is a function and needs its arguments in parentheses")]
    BareFunction {
        /// Name of the function.
        name: String,
    },
    /// A wrong number of arguments.
    #[error("`{name}` takes {expected} argument(s), not {found}")]
    WrongArity {
        /// Name of the function.
        name: String,
        /// Number of arguments that it takes, in words.
        expected: &'static str,
        /// Number of arguments that were found.
        found: usize,
    },
    /// A formula with too many nested levels.
    #[error("the formula is nested deeper than {limit} levels")]
    TooDeep {
        /// Greatest number of nested levels that is read.
        limit: usize,
    },
    /// A name that must be in backquotes.
    #[error("{name} is one name, and reads as several here")]
    NeedsBackquotes {
        /// Name without backquotes.
        name: String,
    },
    /// A name that is not defined.
    #[error("nothing is named `{name}`")]
    UndefinedName {
        /// Name as it was written.
        name: String,
        /// Defined name that is most similar, if one is similar.
        nearest: Option<String>,
    },
    /// A formula that needs its own value.
    #[error("`{}` needs its own value: {}", .path[0], path_words(.path))]
    Cycle {
        /// Names in the cycle, without the first one again at the end.
        path: Vec<String>,
    },
}

fn path_words(path: &[String]) -> String {
    let mut words: Vec<&str> = path.iter().map(String::as_str).collect();
    words.push(&path[0]);
    words.join(" -> ")
}

impl FormulaFault {
    /// Returns the text to write instead, if there is one.
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
                Some(format!("functions are {}", functions::Callable::names().collect::<Vec<_>>().join(", ")))
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

/// Greatest number of characters of a formula's part in a message.
const SHOWN: usize = 80;

/// Failure of a formula that has no value at one point.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("`{}` in formula `{name}`: {reason}", shortened_to(&.text[.span.clone()], SHOWN))]
#[non_exhaustive]
pub struct FormulaFailure {
    /// Name of the formula or characteristic.
    pub name: String,
    /// Text of the formula.
    pub text: String,
    /// Range of the part that has no value.
    pub span: Range<usize>,
    /// Reason why this part has no value.
    pub reason: FailureReason,
}

/// Reason why a part of a formula has no value.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FailureReason {
    /// The argument of a function lies outside its domain.
    #[error("{rule}, but is {argument}")]
    Domain {
        /// Value of the argument.
        argument: f64,
        /// Rule for arguments at which the function has a value.
        rule: &'static str,
    },
    /// A division by 0.
    #[error("division by 0")]
    DivisionByZero,
    /// A power that is infinite or not real.
    #[error("{base} ^ {exponent} is not a finite real number")]
    Power {
        /// Value of the base.
        base: f64,
        /// Value of the exponent.
        exponent: f64,
    },
    /// A result beyond the largest double, or an operand that is not finite.
    #[error("the result {value} is not finite")]
    NotFinite {
        /// Result, which is infinite or NaN.
        value: f64,
    },
}
