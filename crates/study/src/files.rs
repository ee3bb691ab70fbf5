//! Files that belong to a study: measured values, and files of the program.

use std::path::{Path, PathBuf};

use crate::entries::file::ModelEntry;
use crate::entries::spanned::Spanned;

/// A file that a study names.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct NamedFile {
    /// Role of the file in the study.
    pub role: FileRole,
    /// Name of the file in the study.
    pub written: String,
    /// Path of the file.
    pub path: PathBuf,
}

/// Role of a file in a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileRole {
    /// Values of a dimension.
    Measured,
    /// The program of the model, or a file that it depends on.
    Model,
}

impl NamedFile {
    /// Name of the file for use in a sentence.
    pub fn shown(&self) -> String {
        format!("`{}`", self.written)
    }

    /// True if the path depends on the folder of the study.
    pub fn is_relative(&self) -> bool {
        Path::new(&self.written).is_relative()
    }
}

/// Files of the study's folder that a command contains, and the files that the model depends on.
pub(super) fn of_model(entry: &ModelEntry, folder: &Path) -> Vec<NamedFile> {
    let words = entry.command.iter().flat_map(|command| command.get_ref());
    let files = entry.files.iter().flatten().map(Spanned::get_ref);
    let named =
        |written: &String| NamedFile { role: FileRole::Model, written: written.clone(), path: folder.join(written) };
    words.chain(files).map(named).filter(|named| named.path.exists()).collect()
}
