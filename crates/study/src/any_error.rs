//! One type for all errors between a study and its results, for programs that pass them on.

use sensitol::warning::Advice;

use crate::{RewriteError, StudyError};

/// An error of a study, or of its evaluation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AnyError {
    /// The study file is not valid.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The study cannot be rewritten.
    #[error(transparent)]
    Rewrite(#[from] RewriteError),
    /// The engine returns an error.
    #[error(transparent)]
    Engine(sensitol::Error),
}

impl<E: Into<sensitol::Error>> From<E> for AnyError {
    fn from(error: E) -> Self {
        Self::Engine(error.into())
    }
}

impl AnyError {
    /// Text to write instead. Returns None if no general advice exists.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Study(error) => error.help(),
            Self::Engine(error) => error.help(),
            _ => None,
        }
    }

    /// Actions to take, besides changing the study. The most promising is first.
    pub fn advice(&self) -> Vec<Advice> {
        match self {
            Self::Study(error) => error.fault.advice(),
            Self::Engine(error) => error.advice(),
            _ => Vec::new(),
        }
    }
}
