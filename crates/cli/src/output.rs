//! Where text goes, and how it looks.

use std::borrow::Cow;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::ColorChoice;
use tempfile::TempPath;

use super::advice;
use super::args::OutputArgs;
use super::failure::Failure;
use sensitol::warning::Warning;
use sensitol_numeric::names::{clean, is_hidden};
use sensitol_report::WarningReport;
use sensitol_report::document::{Detail, Style};

/// Warnings of one code that are shown each, and names of the others that are shown.
const EACH: usize = 3;
const NAMED: usize = 5;

/// The user's choice of output.
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

    /// Shows warnings as [`tell_all`](Self::tell_all) does.
    pub(super) fn warn_all(self, warnings: &[Warning]) {
        self.tell_all(&warnings.iter().map(WarningReport::of).collect::<Vec<_>>());
    }

    /// Shows the warnings of a report: of many of one code the first few, then how many more there are and what they concern.
    pub(super) fn tell_all(self, warnings: &[WarningReport]) {
        let mut more: Vec<(&str, Vec<&str>)> = Vec::new();
        for (index, warning) in warnings.iter().enumerate() {
            let alike = |one: &&WarningReport| one.code == warning.code;
            let before = warnings[..index].iter().filter(alike).count();
            if self.verbose || before < EACH || warnings.iter().filter(alike).count() <= EACH + 1 {
                self.tell(warning);
                continue;
            }
            let name = warning.characteristic.as_deref().or(warning.dimension.as_deref()).unwrap_or("the study");
            match more.iter_mut().find(|(code, _)| *code == warning.code) {
                Some((_, names)) => names.push(name),
                None => more.push((warning.code, vec![name])),
            }
        }
        for (code, names) in more {
            let shown: Vec<String> = names.iter().take(NAMED).map(|name| format!("`{name}`")).collect();
            let rest = if names.len() > NAMED { ", ..." } else { "" };
            let message = format!("{} more of this kind: {}{rest}", names.len(), shown.join(", "));
            self.line(code, &message, Some("use --verbose to see each".to_owned()));
        }
    }

    /// The same of a report.
    fn tell(self, warning: &WarningReport) {
        self.line(warning.code, &warning.message, advice::help(&warning.advice));
    }

    fn line(self, code: &str, message: &str, help: Option<String>) {
        if self.quiet {
            return;
        }
        let of = self.study.map(|study| format!("{study}: ")).unwrap_or_default();
        let mut text = format!("\u{1b}[1;33mwarning\u{1b}[0m[{code}]: {}{}\n", clean(&of), clean(message));
        if let Some(help) = help {
            text += &format!("  \u{1b}[1mhelp\u{1b}[0m: {}\n", clean(&help));
        }
        to_stderr(&text);
    }
}

/// Tells why nothing came of it.
pub(super) fn error(message: &str) {
    to_stderr(&format!("{}\n", shown(message)));
}

/// Asks, and leaves the cursor behind the question.
pub(super) fn prompt(question: &str) {
    to_stderr(&shown(question));
}

/// The message of the parser of the command line: it repeats what was typed.
pub(super) fn usage(message: &str) {
    to_stderr(&shown(message));
}

/// A line that a model wrote.
pub(super) fn model_line(line: &str) {
    to_stderr(&format!("model: {}\n", clean(line)));
}

/// A stderr that is full or closed changes no result and no exit code.
fn to_stderr(text: &str) {
    let mut stderr = anstream::stderr().lock();
    let _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
}

/// Own text with lines and colours of its own, in which names and texts of others stand: of what is hidden it keeps line breaks
/// and the sequences that set colours.
fn shown(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let colour = rest.strip_prefix("\u{1b}[").and_then(|after| {
            let end = after.find(|c: char| !c.is_ascii_digit() && c != ';')?;
            after[end..].starts_with('m').then_some(2 + end + 1)
        });
        let taken = colour.unwrap_or(c.len_utf8());
        match c {
            _ if colour.is_some() => shown.push_str(&rest[..taken]),
            '\n' => shown.push(c),
            '\t' => shown.push(' '),
            c if is_hidden(c) => shown.push('\u{fffd}'),
            c => shown.push(c),
        }
        rest = &rest[taken..];
    }
    shown
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
    /// Written under another name and renamed, so that no half result ever bears the name.
    File {
        path: PathBuf,
    },
    /// A pipe, a device or another special file is written to as it is.
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
        let unwritable = |error: std::io::Error| Failure::Unwritable { path: path.to_owned(), error: bare(error) };
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
        if std::fs::metadata(path).is_ok_and(|there| there.permissions().readonly()) {
            let protected = std::io::Error::new(ErrorKind::PermissionDenied, "the file is there and read-only");
            return Err(Failure::Unwritable { path: path.to_owned(), error: protected });
        }
        remove_leftovers(folder);
        // Tried now, so that a folder that cannot be written to costs no evaluation; nothing stays.
        temporary(path).map_err(unwritable)?;
        Ok(Self::File { path: path.to_owned() })
    }

    /// Writes these bytes as they are.
    pub(super) fn write_bytes(self, bytes: &[u8]) -> Result<(), Failure> {
        match self {
            Self::Stdout => {
                let mut stdout = std::io::stdout().lock();
                stdout.write_all(bytes).and_then(|()| stdout.flush()).map_err(|error| match error.kind() {
                    ErrorKind::BrokenPipe => Failure::ClosedPipe,
                    _ => Failure::Stdout(error),
                })
            }
            Self::Special { path, mut file } => {
                let written = file.write_all(bytes).and_then(|()| file.flush());
                match written {
                    Err(error) if error.kind() == ErrorKind::BrokenPipe => Err(Failure::ClosedPipe),
                    written => written.map_err(|error| Failure::Unwritable { path, error }),
                }
            }
            Self::File { path } => {
                let written = temporary(&path).and_then(|file| {
                    std::fs::write(&file, bytes)?;
                    file.persist(&path).map_err(|error| error.error)
                });
                written.map_err(|error| Failure::Unwritable { path, error: bare(error) })
            }
        }
    }

    pub(super) fn write(self, text: &str) -> Result<(), Failure> {
        // A file or a pipe gets every byte; a terminal would obey some of them.
        let terminal = matches!(self, Self::Stdout) && std::io::stdout().is_terminal();
        let text = if terminal { Cow::from(shown(text)) } else { Cow::from(text) };
        self.write_bytes(text.as_bytes())
    }
}

/// A file next to that of this path, with the mode of the one that it will replace; a new one is readable as the user's other
/// files are.
fn temporary(path: &Path) -> std::io::Result<TempPath> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let file = builder.prefix(TEMPORARY).tempfile_in(folder)?.into_temp_path();
    if let Ok(there) = std::fs::metadata(path) {
        std::fs::set_permissions(&file, there.permissions())?;
    }
    Ok(file)
}

/// How a temporary file's name begins.
const TEMPORARY: &str = ".sensitol-";
/// A temporary file is there for as long as writing it takes: one that is older belongs to a run that was killed.
const LEFT_OVER: Duration = Duration::from_secs(3600);

/// Removes what killed runs have left in a folder, as far as that is possible.
fn remove_leftovers(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let old = || entry.metadata().ok()?.modified().ok()?.elapsed().ok().filter(|age| *age > LEFT_OVER);
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && entry.file_name().to_string_lossy().starts_with(TEMPORARY) && old().is_some() {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Without the temporary file's own name, which would only puzzle.
fn bare(error: std::io::Error) -> std::io::Error {
    error.raw_os_error().map_or(error.kind().into(), std::io::Error::from_raw_os_error)
}

/// JSON for people and programs: indented, with a line break at its end.
pub(super) fn json(value: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("reports are plain data");
    text.push('\n');
    text
}
