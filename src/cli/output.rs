//! Where text goes, and how it looks.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use clap::ColorChoice;
use tempfile::TempPath;

use super::advice;
use super::args::OutputArgs;
use super::failure::Failure;
use crate::document::{Detail, Style};
use crate::report::WarningReport;
use crate::warning::Warning;

/// What the user wants to see.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look<'s> {
    pub(super) color: ColorChoice,
    pub(super) quiet: bool,
    pub(super) verbose: bool,
    /// The study that warnings are of, where there are several.
    pub(super) study: Option<&'s str>,
}

impl<'s> Look<'s> {
    /// For what concerns one study of several.
    pub(super) fn of(self, study: &'s str) -> Self {
        Self { study: Some(study), ..self }
    }

    /// Of a report that goes there: a file has no colours, unless they are asked for always, and the usual width.
    pub(super) fn style(self, asked: &OutputArgs) -> Style {
        let detail = if self.verbose { Detail::Full } else { Detail::Short };
        let (color, width) = match asked.output {
            Some(_) => (self.color == ColorChoice::Always, Style::WIDTH),
            None => {
                let color = anstream::AutoStream::choice(&std::io::stdout()) != anstream::ColorChoice::Never;
                (color, terminal_width())
            }
        };
        Style { detail, unicode: self.color != ColorChoice::Never && utf8_locale(), color, width }
    }

    /// Shows a warning and what to do about it.
    pub(super) fn warn(self, warning: &Warning) {
        self.tell(&WarningReport::of(warning));
    }

    /// The same of a report.
    pub(super) fn tell(self, warning: &WarningReport) {
        if self.quiet {
            return;
        }
        let WarningReport { code, message, .. } = warning;
        let of = self.study.map(|study| format!("{study}: ")).unwrap_or_default();
        anstream::eprintln!("\u{1b}[1;33mwarning\u{1b}[0m[{code}]: {of}{message}");
        if let Some(help) = advice::help(&warning.advice) {
            anstream::eprintln!("  \u{1b}[1mhelp\u{1b}[0m: {help}");
        }
    }
}

/// Tells why nothing came of it.
pub(super) fn error(message: &str) {
    anstream::eprintln!("{message}");
}

pub(super) fn set_color(choice: ColorChoice) {
    match choice {
        ColorChoice::Auto => anstream::ColorChoice::Auto,
        ColorChoice::Always => anstream::ColorChoice::Always,
        ColorChoice::Never => anstream::ColorChoice::Never,
    }
    .write_global();
}

/// That of the terminal where stdout is one, but no line is longer than people like to read, and none shorter than a number.
fn terminal_width() -> usize {
    let size = terminal_size::terminal_size_of(std::io::stdout());
    size.map_or(Style::WIDTH, |(width, _)| usize::from(width.0).clamp(40, 120))
}

/// Whether the terminal expects UTF-8, as POSIX tells it; elsewhere it does.
fn utf8_locale() -> bool {
    if !cfg!(unix) {
        return true;
    }
    let set = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
    let locale = set("LC_ALL").or_else(|| set("LC_CTYPE")).or_else(|| set("LANG")).unwrap_or_default();
    let locale = locale.to_lowercase();
    locale.contains("utf-8") || locale.contains("utf8")
}

/// Where a result goes: opened before the work, so that a file that cannot be written costs no evaluation.
pub(super) enum Destination {
    Stdout,
    /// Written under another name and renamed, so that no half result ever bears the name. Made and closed again: however many
    /// results there are to be, none keeps a file open.
    File {
        path: PathBuf,
        file: TempPath,
    },
    /// What is no ordinary file, such as a pipe or a device, is written to as it is.
    Special {
        path: PathBuf,
        file: std::fs::File,
    },
}

impl Destination {
    pub(super) fn open(asked: &OutputArgs) -> Result<Self, Failure> {
        match &asked.output {
            None => Ok(Self::Stdout),
            Some(path) => Self::file(path),
        }
    }

    pub(super) fn file(path: &Path) -> Result<Self, Failure> {
        // The temporary file's own name would only puzzle.
        let unwritable = |error: std::io::Error| {
            let error = error.raw_os_error().map_or(error.kind().into(), std::io::Error::from_raw_os_error);
            Failure::Unwritable { path: path.to_owned(), error }
        };
        if path.is_dir() {
            return Err(unwritable(ErrorKind::IsADirectory.into()));
        }
        // A link leads to the file that is meant, and stays.
        let target = std::fs::canonicalize(path);
        let path = target.as_deref().unwrap_or(path);
        if std::fs::metadata(path).is_ok_and(|there| !there.is_file()) {
            let file = std::fs::OpenOptions::new().write(true).open(path).map_err(unwritable)?;
            return Ok(Self::Special { path: path.to_owned(), file });
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !folder.is_dir() {
            let missing = std::io::Error::new(ErrorKind::NotFound, format!("there is no folder {}", folder.display()));
            return Err(Failure::Unwritable { path: path.to_owned(), error: missing });
        }
        let mut builder = tempfile::Builder::new();
        // A private temporary file becomes an ordinary one: readable as the user's other files are.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.prefix(".sensitol-").tempfile_in(folder).map_err(unwritable)?;
        Ok(Self::File { path: path.to_owned(), file: file.into_temp_path() })
    }

    pub(super) fn write(self, text: &str) -> Result<(), Failure> {
        match self {
            Self::Stdout => {
                let mut stdout = std::io::stdout().lock();
                stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()).map_err(|error| match error.kind() {
                    ErrorKind::BrokenPipe => Failure::ClosedPipe,
                    _ => Failure::Stdout(error),
                })
            }
            Self::Special { path, mut file } => {
                let written = file.write_all(text.as_bytes()).and_then(|()| file.flush());
                match written {
                    Err(error) if error.kind() == ErrorKind::BrokenPipe => Err(Failure::ClosedPipe),
                    written => written.map_err(|error| Failure::Unwritable { path, error }),
                }
            }
            Self::File { path, file } => {
                let written = std::fs::write(&file, text);
                let renamed = written.and_then(|()| file.persist(&path).map_err(|error| error.error));
                renamed.map(drop).map_err(|error| Failure::Unwritable { path, error })
            }
        }
    }
}

/// JSON for people and programs: indented, with a line break at its end.
pub(super) fn json(value: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("reports are plain data");
    text.push('\n');
    text
}
