//! Formulas: from text to a batch evaluator over columns. Every error has a position in the text.
//!
//! A [`Formula`] is parsed alone. A [`FormulaSet`] resolves several formulas against each other and against variables and constants, and
//! evaluates them.
//!
//! Syntax: `+ - * / ^`, `< <= > >= == !=`, `if(condition, x, y)`, `min max` of several, `abs sqrt exp ln log10 sin cos tan asin acos atan
//! atan2 sinh cosh tanh hypot floor ceil sign`, `pi` and `deg` (= pi/180). `^` binds to the right and tighter than a sign: `-x^2` is
//! `-(x^2)`. A condition is true if it is not 0. Names with other characters than letters, digits and `_` are written in backquotes.
//!
//! Intermediate results may be infinite (`1/(1/a + 1/b)` at `a = 0` is 0). NaN always leads to NaN. A result that is not finite is an error
//! of the point.
//!
//! The same programs run on every type that implements `Scalar`, not only on columns of numbers. A [`Jet`] gives exact derivatives, an
//! [`Interval`] gives bounds that include rounding, and a magnitude gives the size of the terms that are rounded.

mod batch;
mod cancel;
mod derivative;
mod error;
mod expansion;
mod functions;
mod graph;
mod hessian;
pub mod interval;
pub mod jet;
mod lexer;
mod magnitude;
mod margins;
mod name;
pub(crate) mod parser;
mod periodic;
mod program;
mod quantity;
mod scalar;
pub mod set;
mod slopes;
pub(crate) mod stages;
mod switches;
mod units;

pub use error::{FailureReason, FormulaError, FormulaFailure, FormulaFault};
pub(crate) use functions::{Binary, Unary};
pub(crate) use interval::Interval;
pub(crate) use jet::Jet;
pub use name::is_plain;
pub use parser::Formula;
pub use parser::is_reserved;
pub(crate) use scalar::Scalar;
pub use set::{FormulaSet, Meaning, Routine};
pub use units::{Role, UnitFinding};
