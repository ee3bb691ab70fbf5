//! Errors of one output at one point.

use crate::assembly::formula::FormulaFailure;
use crate::assembly::implicit;
use crate::assembly::process_error;
use sensitol_numeric::names::{clipped, nearest};

/// Reason why an assembly function has no value for one output at one point.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// The function answered with NaN or an infinity.
    #[error("the model returned {value}")]
    NotFinite {
        /// NaN or infinity that the function returned.
        value: f64,
    },
    /// A formula has no value at the point.
    #[error(transparent)]
    Formula(#[from] Box<FormulaFailure>),
    /// The assembly does not close at the point, or only on another branch than the nominal state.
    #[error(transparent)]
    Assembly(#[from] Box<implicit::AssemblyFailure>),
    /// An external program failed.
    #[error(transparent)]
    Process(#[from] Box<process_error::ProcessError>),
    /// A table of answers has none for this point.
    #[error("no answer is given for this point")]
    NotGiven,
    /// A table of answers has no column for an output.
    #[error(transparent)]
    NoColumn(#[from] NoColumn),
    /// An answer could not be stored in the journal, or a stored one could not be read.
    #[error("{}", clipped(message))]
    NotKept {
        /// Fault of the journal.
        message: String,
    },
    /// The model refused the point with a reason of its own.
    #[error("{}", clipped(message))]
    Refused {
        /// Reason in the model's own words.
        message: String,
    },
}

/// A dimension or output for which a table has no column.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the points that were evaluated elsewhere have no column `{}`{}", clipped(name), self.instead())]
#[non_exhaustive]
pub struct NoColumn {
    /// Name of the dimension or output.
    pub name: String,
    /// Column with the most similar name, if one is similar.
    pub nearest: Option<String>,
}

impl NoColumn {
    /// Returns the error for a table with these columns.
    pub(super) fn among<'c>(name: &str, columns: impl Iterator<Item = &'c str>) -> Self {
        let nearest = nearest(name, columns).map(str::to_owned);
        Self { name: name.to_owned(), nearest }
    }

    fn instead(&self) -> String {
        self.nearest.as_ref().map(|nearest| format!("; there is `{nearest}`")).unwrap_or_default()
    }
}
