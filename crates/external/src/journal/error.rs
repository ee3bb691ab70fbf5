//! Errors of journals.

use std::path::PathBuf;

use super::content::VERSION;

/// A fault of a journal.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("journal {}: {fault}", path.display())]
#[non_exhaustive]
pub struct JournalError {
    /// Path of the file.
    pub path: PathBuf,
    /// The fault.
    pub fault: JournalFault,
}

/// The faults of a journal.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum JournalFault {
    /// The file does not exist.
    #[error("there is no such file")]
    Missing,
    /// The file is not a journal.
    #[error("this is no journal of sensitol; name another file, or none")]
    NotAJournal,
    /// The file was written by a later version.
    #[error("version {found} of the journal was written by a later sensitol; this one reads version {VERSION}")]
    Later {
        /// Version of the file.
        found: i32,
    },
    /// A file that the model depends on cannot be read.
    #[error("the model's file {} cannot be read: {reason}", file.display())]
    ModelFile {
        /// Path of that file.
        file: PathBuf,
        /// Message of the operating system.
        reason: String,
    },
    /// Reading or writing failed. Stored answers stay as they are.
    #[error("{reason}; what it holds already is not touched")]
    Failed {
        /// Message of SQLite.
        reason: String,
    },
}
