//! Files of a command: no file that it reads is overwritten, and none is written twice.

use std::path::{Path, PathBuf};

use crate::args::shared_args::OutputArgs;
use crate::csv::CsvFolder;
use crate::failure::Failure;
use crate::output::Destination;
use crate::own_file::{Content, is_free};
use crate::values::ending;
use sensitol_study::{FileRole, JournalPlace, Study};

/// Paths that are read, and paths that will be written, with links resolved.
#[derive(Debug, Default)]
pub(super) struct Files {
    read: Vec<(PathBuf, &'static str)>,
    written: Vec<PathBuf>,
    /// True if files of other programs are written over.
    force: bool,
}

impl Files {
    /// Files of a command that reads this study, with the given journal or the one beside the study.
    pub(super) fn of(path: &Path, study: &Study, journal: Option<&Path>) -> Self {
        let mut files = Self::default();
        files.study(path, study, journal);
        files
    }

    /// Writes over files of other programs if `--force` is given.
    pub(super) fn forced(self, force: bool) -> Self {
        Self { force, ..self }
    }

    /// Protects a study and the files that it reads.
    pub(super) fn study(&mut self, path: &Path, study: &Study, journal: Option<&Path>) {
        self.reads(path, "the study itself");
        for file in &study.files {
            let what = match file.role {
                FileRole::Measured => "measured data of the study",
                FileRole::Model => "a file of the study's model",
            };
            self.reads(&file.path, what);
        }
        let journal = JournalPlace::asked(journal).path(&path.display().to_string());
        journal.iter().for_each(|journal| self.reads(journal, "the study's journal"));
    }

    /// Protects a file from being overwritten.
    pub(super) fn reads(&mut self, path: &Path, what: &'static str) {
        self.read.push((resolved(path), what));
    }

    /// Opens the file of `--output` of a command that writes pages too, or returns stdout.
    pub(super) fn output(&mut self, asked: &OutputArgs) -> Result<Destination, Failure> {
        refuse_other_kinds(asked, &["html", "pdf"])?;
        self.output_of(asked, &Content::Report)
    }

    /// Opens the file of `--output` of a command that writes pages and workbooks too, or returns stdout.
    pub(super) fn output_beside_workbook(&mut self, asked: &OutputArgs) -> Result<Destination, Failure> {
        refuse_other_kinds(asked, &["html", "pdf", "xlsx"])?;
        self.output_of(asked, &Content::Report)
    }

    /// Opens the file of `--output` of a command that writes nothing but text and JSON, or returns stdout.
    pub(super) fn output_text(&mut self, asked: &OutputArgs) -> Result<Destination, Failure> {
        refuse_other_kinds(asked, &[])?;
        self.output_of(asked, &Content::Report)
    }

    /// Opens the file of `--output` for this content, or returns stdout.
    pub(super) fn output_of(&mut self, asked: &OutputArgs, content: &Content<'_>) -> Result<Destination, Failure> {
        asked.output.as_deref().map_or(Ok(Destination::Stdout), |path| self.open(path, content))
    }

    /// Opens the file of another option for a report, if it is given.
    pub(super) fn file(&mut self, path: Option<&Path>) -> Result<Option<Destination>, Failure> {
        self.file_of(path, &Content::Report)
    }

    /// Opens the file of another option, if it is given.
    pub(super) fn file_of(
        &mut self,
        path: Option<&Path>,
        content: &Content<'_>,
    ) -> Result<Option<Destination>, Failure> {
        path.map(|path| self.open(path, content)).transpose()
    }

    /// Opens the folder of `--csv`, if it is given, for files of these names.
    pub(super) fn folder(&mut self, folder: Option<&Path>, names: &[String]) -> Result<Option<CsvFolder>, Failure> {
        let Some(folder) = folder else { return Ok(None) };
        names.iter().try_for_each(|name| self.claim(&folder.join(name), &Content::Report))?;
        CsvFolder::open(folder, names).map(Some)
    }

    fn open(&mut self, path: &Path, content: &Content<'_>) -> Result<Destination, Failure> {
        self.claim(path, content)?;
        Destination::file(path)
    }

    fn claim(&mut self, path: &Path, content: &Content<'_>) -> Result<(), Failure> {
        // A terminal or /dev/null can take several reports.
        if std::fs::metadata(path).is_ok_and(|there| !there.is_file()) {
            return Ok(());
        }
        let target = resolved(path);
        if let Some((_, what)) = self.read.iter().find(|(read, _)| *read == target) {
            return Err(Failure::WouldBeLost { path: path.to_owned(), what });
        }
        if self.written.contains(&target) {
            return Err(Failure::AskedTwice { path: path.to_owned() });
        }
        // A file that cannot be read is nobody's to write over.
        if !self.force && path.exists() && !is_free(path, content).unwrap_or(false) {
            return Err(Failure::Foreign { path: path.to_owned() });
        }
        self.written.push(target);
        Ok(())
    }
}

/// Resolves links. If the file does not exist yet, those of its folder are resolved.
fn resolved(path: &Path) -> PathBuf {
    let within = || {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(std::fs::canonicalize(folder).ok()?.join(path.file_name()?))
    };
    std::fs::canonicalize(path).ok().or_else(within).unwrap_or_else(|| path.to_owned())
}

/// Refuses a file of `--output` with the ending of another kind. The command has an option for each of `written`.
fn refuse_other_kinds(asked: &OutputArgs, written: &[&str]) -> Result<(), Failure> {
    let Some(path) = &asked.output else { return Ok(()) };
    let ending = ending(path);
    let kind = if ending == "htm" { "html" } else { ending.as_str() };
    let right = match kind {
        "json" if !asked.json => format!("--json -o {}", path.display()),
        kind if written.contains(&kind) => format!("--{kind} {}", path.display()),
        "html" | "pdf" | "xlsx" => format!("-o {}", path.with_extension("txt").display()),
        _ => return Ok(()),
    };
    Err(Failure::OtherKind { path: path.clone(), right })
}
