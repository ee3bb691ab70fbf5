//! Place of the files that a study names: its folder, or memory.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::external_settings::Externals;

/// Formats of study files. Both have the same keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// A `.toml` file.
    Toml,
    /// A `.json` file.
    Json,
}

/// Text of a study, with the files that it names. Nothing needs to be on a disk.
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
/// # Ok::<(), sensitol_study::StudyError>(())
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
    pub(super) root: Option<PathBuf>,
}

impl StudyText {
    /// Study text in this format. Errors show `name` in place of a file.
    pub(crate) fn new(format: Format, name: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            format,
            name: name.into(),
            text: text.into(),
            files: BTreeMap::new(),
            externals: Externals::default(),
            parameter: None,
            folder: PathBuf::from("."),
            root: None,
        }
    }

    /// Study text in TOML. Errors show `name` in place of a file.
    pub fn toml(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self::new(Format::Toml, name, text)
    }

    /// Study text in JSON. Errors show `name` in place of a file.
    pub fn json(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self::new(Format::Json, name, text)
    }

    /// Adds a file under the name that the study has for it. With at least one such file, none is read from the disk.
    #[must_use]
    pub fn with_file(mut self, name: impl Into<String>, content: impl AsRef<[u8]>) -> Self {
        self.files.insert(name.into(), Arc::from(content.as_ref()));
        self
    }

    /// Sets the folder from which relative paths start. The default is the current folder.
    #[must_use]
    pub fn in_folder(self, folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), ..self }
    }

    /// Refuses files that the study names outside this folder, also by links. Words of a command are not such files.
    ///
    /// ```
    /// use sensitol_study::{Study, StudyText};
    /// let text = r#"
    ///     [dimensions]
    ///     pin = { nominal = 8.0, measured = "../Cargo.toml" }
    ///     bore = { nominal = 8.1, tolerance = 0.03 }
    ///     [characteristics]
    ///     clearance = { formula = "bore - pin" }
    /// "#;
    /// let error = Study::from_text(StudyText::toml("fit.toml", text).in_folder("src").within("src")).unwrap_err();
    /// assert!(error.to_string().contains("the file is outside the folder of studies"));
    /// ```
    #[must_use]
    pub fn within(self, root: impl Into<PathBuf>) -> Self {
        Self { root: Some(root.into()), ..self }
    }

    /// Sets the treatment of external programs.
    #[must_use]
    pub fn with_externals(self, externals: Externals) -> Self {
        Self { externals, ..self }
    }

    /// Selects the parameter of a [sweep](sensitol::sweep), like [`read_sweeping`](crate::Study::read_sweeping).
    #[must_use]
    pub fn sweeping(self, parameter: impl Into<String>) -> Self {
        Self { parameter: Some(parameter.into()), ..self }
    }
}

/// Place of the files of a study.
#[derive(Debug, Clone)]
pub(super) struct Place {
    folder: PathBuf,
    /// Files by the names in the study; None if they are read from the folder.
    memory: Option<Arc<BTreeMap<String, Arc<[u8]>>>>,
    /// Folder that every file is in; None if files may be anywhere.
    root: Option<PathBuf>,
}

impl Place {
    pub(super) fn folder(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), memory: None, root: None }
    }

    /// Files in memory, or of this folder if there are none in memory.
    pub(super) fn memory(files: BTreeMap<String, Arc<[u8]>>, folder: PathBuf) -> Self {
        Self { folder, memory: (!files.is_empty()).then(|| Arc::new(files)), root: None }
    }

    /// Refuses files outside the root, if there is one.
    pub(super) fn within(self, root: Option<PathBuf>) -> Self {
        Self { root, ..self }
    }

    /// Returns the path of a file of the disk. Links are resolved before the path is compared with the root.
    pub(super) fn path_of(&self, file: &str) -> Result<PathBuf, UnreadableFile> {
        let path = self.folder.join(file);
        let Some(root) = &self.root else { return Ok(path) };
        let real = |path: &Path| path.canonicalize().map_err(UnreadableFile::Failed);
        if real(&path)?.starts_with(real(root)?) { Ok(path) } else { Err(UnreadableFile::Outside { path }) }
    }

    /// Folder from which relative paths start.
    pub(super) fn path(&self) -> &Path {
        &self.folder
    }

    pub(super) fn read(&self, file: &str) -> Result<Arc<[u8]>, UnreadableFile> {
        match &self.memory {
            Some(files) => {
                let other = || UnreadableFile::NotGiven { known: files.keys().cloned().collect() };
                files.get(file).cloned().ok_or_else(other)
            }
            None => std::fs::read(self.path_of(file)?).map(Arc::from).map_err(UnreadableFile::Failed),
        }
    }
}

/// Reasons why a file cannot be read.
pub(super) enum UnreadableFile {
    /// The file is not among those in memory.
    NotGiven {
        /// Names of the files in memory.
        known: Vec<String>,
    },
    /// The operating system reports an error.
    Failed(std::io::Error),
    /// The file is outside the folder that files are read from.
    Outside {
        /// Path of the file.
        path: PathBuf,
    },
}
