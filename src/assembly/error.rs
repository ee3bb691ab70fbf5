//! Why one output has no value at one point.

use super::formula::FormulaFailure;
use sensitol_numeric::names::nearest;

/// Why an assembly function gave no value for one output at one point.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// The function answered with NaN or an infinity.
    #[error("the model returned {value}")]
    NotFinite {
        /// The value that it returned.
        value: f64,
    },
    /// A formula has no value there.
    #[error(transparent)]
    Formula(#[from] Box<FormulaFailure>),
    /// The assembly does not close there, or not on the branch of the nominal state.
    #[error(transparent)]
    Assembly(#[from] Box<super::implicit::AssemblyFailure>),
    /// An external program failed.
    #[error(transparent)]
    Process(#[from] Box<super::process_error::ProcessError>),
    /// The table of answers that were evaluated elsewhere has none for this point.
    #[error("no answer is given for this point")]
    NotGiven,
    /// The table of answers that were evaluated elsewhere has none at all for an output.
    #[error(transparent)]
    NoColumn(#[from] NoColumn),
    /// The answer could not be kept, or what is kept could not be read.
    #[error("{message}")]
    NotKept {
        /// The fault of the journal.
        message: String,
    },
    /// The model said why itself.
    #[error("{message}")]
    Refused {
        /// The model's own words.
        message: String,
    },
}

/// A dimension or output for which a table has no column.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the points that were evaluated elsewhere have no column `{name}`{}", self.instead())]
#[non_exhaustive]
pub struct NoColumn {
    /// The name of what is wanted.
    pub name: String,
    /// The most similar column.
    pub nearest: Option<String>,
}

impl NoColumn {
    /// Of a table with these columns.
    pub(super) fn among<'c>(name: &str, columns: impl Iterator<Item = &'c str>) -> Self {
        let nearest = nearest(name, columns).map(str::to_owned);
        Self { name: name.to_owned(), nearest }
    }

    fn instead(&self) -> String {
        self.nearest.as_ref().map(|nearest| format!("; there is `{nearest}`")).unwrap_or_default()
    }
}
