//! The files that belong to a study beside its own: measured data, and what a program is and depends on.

use std::path::{Path, PathBuf};

use super::file::ModelEntry;
use super::spanned::Spanned;

/// A file that a study names.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct NamedFile {
    /// Its role in the study.
    pub role: FileRole,
    /// As it is written there.
    pub written: String,
    /// Where it is.
    pub path: PathBuf,
}

/// The role of a file in a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileRole {
    /// Measured values of a dimension.
    Measured,
    /// The program of the model, or a file that it depends on.
    Model,
}

impl NamedFile {
    /// Its name in a sentence.
    pub fn shown(&self) -> String {
        format!("`{}`", self.written)
    }

    /// Whether another folder makes it another file.
    pub fn is_relative(&self) -> bool {
        Path::new(&self.written).is_relative()
    }
}

/// The words of a command that are files of the study's folder, and the files that the model depends on.
pub(super) fn of_model(entry: &ModelEntry, folder: &Path) -> Vec<NamedFile> {
    let words = entry.command.iter().flat_map(|command| command.get_ref());
    let files = entry.files.iter().flatten().map(Spanned::get_ref);
    let named =
        |written: &String| NamedFile { role: FileRole::Model, written: written.clone(), path: folder.join(written) };
    words.chain(files).map(named).filter(|named| named.path.exists()).collect()
}
