//! Every error between a study and its results in one type, for programs that pass them on.

use sensitol::warning::Advice;

use crate::{RewriteError, StudyError};

/// An error of a study, or of its evaluation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A study file is wrong.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A study cannot be written with changes.
    #[error(transparent)]
    Rewrite(#[from] RewriteError),
    /// The engine reports an error.
    #[error(transparent)]
    Engine(sensitol::Error),
}

impl<E: Into<sensitol::Error>> From<E> for Error {
    fn from(error: E) -> Self {
        Self::Engine(error.into())
    }
}

impl Error {
    /// The text to write instead, where that can be said.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Study(error) => error.help(),
            Self::Engine(error) => error.help(),
            _ => None,
        }
    }

    /// The actions to take, beside changing what is written; the most promising first.
    pub fn advice(&self) -> Vec<Advice> {
        match self {
            Self::Study(error) => error.fault.advice(),
            Self::Engine(error) => error.advice(),
            _ => Vec::new(),
        }
    }
}
