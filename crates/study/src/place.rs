//! Where the files are that a study names: in its folder, or in memory beside its text.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::externals::Externals;

/// The two formats of one schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// A `.toml` file.
    Toml,
    /// A `.json` file.
    Json,
}

/// The text of a study, with the files that it names: nothing of it has to be on a disk.
///
/// ```
/// use sensitol_study::{Study, StudyText};
/// let text = r#"
///     [dimensions]
///     pin = { nominal = 8.0, measured = "pin.csv" }
///     bore = { nominal = 8.1, tolerance = 0.03 }
///     [characteristics]
///     clearance = { formula = "bore - pin", lower = 0.0 }
/// "#;
/// let pins = "pin\n7.99\n8.01\n8.02\n7.98\n8.00\n8.01\n7.99\n8.00\n";
/// let study = Study::from_text(StudyText::toml("fit.toml", text).with_file("pin.csv", pins))?;
/// assert_eq!(study.problem.dimensions().len(), 2);
/// # Ok::<(), sensitol::Error>(())
/// ```
#[derive(Clone)]
pub struct StudyText {
    pub(super) format: Format,
    pub(super) name: String,
    pub(super) text: String,
    pub(super) files: BTreeMap<String, Arc<[u8]>>,
    pub(super) externals: Externals,
    pub(super) parameter: Option<String>,
    pub(super) folder: PathBuf,
}

impl StudyText {
    /// A text of this format; `name` stands for the file in errors.
    pub(crate) fn new(format: Format, name: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            format,
            name: name.into(),
            text: text.into(),
            files: BTreeMap::new(),
            externals: Externals::default(),
            parameter: None,
            folder: PathBuf::from("."),
        }
    }

    /// TOML.
    pub fn toml(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self::new(Format::Toml, name, text)
    }

    /// JSON.
    pub fn json(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self::new(Format::Json, name, text)
    }

    /// With a file of measured values, named as the study names it. Once one is given, no other is looked for on a disk.
    #[must_use]
    pub fn with_file(mut self, name: impl Into<String>, content: impl AsRef<[u8]>) -> Self {
        self.files.insert(name.into(), Arc::from(content.as_ref()));
        self
    }

    /// In this folder, from which relative paths start; otherwise that is the current folder.
    #[must_use]
    pub fn in_folder(self, folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), ..self }
    }

    /// With external programs treated like this.
    #[must_use]
    pub fn with_externals(self, externals: Externals) -> Self {
        Self { externals, ..self }
    }

    /// For a [sweep](sensitol::sweep) over the parameter of this name, as [`read_sweeping`](super::Study::read_sweeping).
    #[must_use]
    pub fn sweeping(self, parameter: impl Into<String>) -> Self {
        Self { parameter: Some(parameter.into()), ..self }
    }
}

/// Where a study's files are.
#[derive(Debug, Clone)]
pub(super) struct Place {
    folder: PathBuf,
    /// By the names that the study has for them; None where they are files of the folder.
    memory: Option<Arc<BTreeMap<String, Arc<[u8]>>>>,
}

impl Place {
    /// Files of a folder.
    pub(super) fn folder(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), memory: None }
    }

    /// Files in memory, or of this folder where there are none.
    pub(super) fn memory(files: BTreeMap<String, Arc<[u8]>>, folder: PathBuf) -> Self {
        Self { folder, memory: (!files.is_empty()).then(|| Arc::new(files)) }
    }

    /// The folder that relative paths start from.
    pub(super) fn path(&self) -> &Path {
        &self.folder
    }

    /// The bytes of a file.
    pub(super) fn read(&self, file: &str) -> Result<Arc<[u8]>, Unread> {
        match &self.memory {
            Some(files) => {
                let other = || Unread::NotGiven { known: files.keys().cloned().collect() };
                files.get(file).cloned().ok_or_else(other)
            }
            None => std::fs::read(self.folder.join(file)).map(Arc::from).map_err(Unread::Failed),
        }
    }
}

/// Why a file has no bytes.
pub(super) enum Unread {
    /// It is none of those in memory.
    NotGiven {
        /// Their names.
        known: Vec<String>,
    },
    /// The operating system does not read it.
    Failed(std::io::Error),
}
