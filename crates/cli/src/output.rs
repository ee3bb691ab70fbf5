//! Destinations of text, its colours, and its safety for a terminal.

use std::borrow::Cow;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::ColorChoice;
use tempfile::TempPath;

use crate::advice;
use crate::args::shared_args::OutputArgs;
use crate::failure::Failure;
use sensitol::warning::Warning;
use sensitol_numeric::names::{clean, clipped, is_hidden};
use sensitol_report::WarningReport;
use sensitol_report::document::{Detail, Style};

/// Greatest number of warnings with the same code that are printed in full.
const EACH: usize = 3;
/// Greatest number of names that the line for the other warnings lists.
const NAMED: usize = 5;

/// Options that set the look of all output.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look<'s> {
    pub(super) color: ColorChoice,
    pub(super) quiet: bool,
    pub(super) verbose: bool,
    /// Name of the study that warnings concern, if there are several.
    pub(super) study: Option<&'s str>,
}

impl<'s> Look<'s> {
    /// Adds the name of the study that messages concern.
    pub(super) fn of(self, study: &'s str) -> Self {
        Self { study: Some(study), ..self }
    }

    /// Returns the style of a report. A file has the default width, and colours only if they are always on.
    pub(super) fn style(self, asked: &OutputArgs) -> Style {
        let style = self.terminal_style();
        match asked.output {
            Some(_) => Style { color: self.color == ColorChoice::Always, width: Style::WIDTH, ..style },
            None => style,
        }
    }

    /// Returns the style of text on stdout.
    pub(super) fn terminal_style(self) -> Style {
        let detail = if self.verbose { Detail::Full } else { Detail::Short };
        let color = anstream::AutoStream::choice(&std::io::stdout()) != anstream::ColorChoice::Never;
        Style { detail, unicode: self.color != ColorChoice::Never && utf8_locale(), color, width: terminal_width() }
    }

    /// Prints a warning and the advice on it.
    pub(super) fn warn(self, warning: &Warning) {
        self.tell(&WarningReport::of(warning));
    }

    /// Prints warnings as [`tell_all`](Self::tell_all) does.
    pub(super) fn warn_all(self, warnings: &[Warning]) {
        self.tell_all(&warnings.iter().map(WarningReport::of).collect::<Vec<_>>());
    }

    /// Prints the warnings of a report that need attention. Of many with the same code it prints the first few, then the number and names
    /// of the others.
    pub(super) fn tell_all(self, warnings: &[WarningReport]) {
        let asking: Vec<&WarningReport> = warnings.iter().filter(|one| one.asks()).collect();
        let mut more: Vec<(&str, Vec<&str>)> = Vec::new();
        for (index, warning) in asking.iter().enumerate() {
            let alike = |one: &&&WarningReport| one.code == warning.code;
            let before = asking[..index].iter().filter(alike).count();
            if self.verbose || before < EACH || asking.iter().filter(alike).count() <= EACH + 1 {
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

    /// Prints a warning of a report and the advice on it.
    fn tell(self, warning: &WarningReport) {
        self.line(warning.code, &warning.message, advice::help(&warning.advice));
    }

    fn line(self, code: &str, message: &str, help: Option<String>) {
        if self.quiet {
            return;
        }
        let of = self.study.map(|study| format!("{study}: ")).unwrap_or_default();
        let mut text = format!("\u{1b}[1;33mwarning\u{1b}[0m[{code}]: {}{}\n", clean(&of), clean(&clipped(message)));
        if let Some(help) = help {
            text += &format!("  \u{1b}[1mhelp\u{1b}[0m: {}\n", clean(&help));
        }
        to_stderr(&text);
    }
}

impl Look<'_> {
    /// Prints the content of a table, and notes on it.
    pub(super) fn note(self, summary: &str, notes: &[String]) {
        if self.quiet {
            return;
        }
        let of = self.study.map(|study| format!("{study}: ")).unwrap_or_default();
        let mut text = format!("\u{1b}[1mread\u{1b}[0m: {}{}\n", clean(&of), clean(summary));
        notes.iter().for_each(|note| text += &format!("  {}\n", clean(&clipped(note))));
        to_stderr(&text);
    }
}

/// Prints an error.
pub(super) fn error(message: &str) {
    to_stderr(&format!("{}\n", shown(message)));
}

/// Prints a line of information.
pub(super) fn told(message: &str) {
    to_stderr(&format!("{}\n", clean(message)));
}

/// Prints a question and leaves the cursor behind it.
pub(super) fn prompt(question: &str) {
    to_stderr(&shown(question));
}

/// Prints a message of the argument parser, which may repeat the user's input.
pub(super) fn usage(message: &str) {
    to_stderr(&shown(message));
}

/// Prints a line that a model wrote to stderr.
pub(super) fn model_line(line: &str) {
    to_stderr(&format!("model: {}\n", clean(&clipped(line))));
}

/// Writes to stderr. Errors are ignored: a full or closed stderr must not change results or the exit code.
fn to_stderr(text: &str) {
    let mut stderr = anstream::stderr().lock();
    let _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
}

/// Makes text with line breaks and colours safe for a terminal: of the control characters, only line breaks and colour sequences stay.
/// The text may contain names from studies and programs.
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

/// Least width of a report, in columns: numbers need so many.
const NARROWEST: usize = 40;
/// Greatest width on a terminal, in columns, for readability.
const WIDEST: usize = 120;
/// Greatest width that COLUMNS sets for a pipe, in columns.
const WIDEST_PIPE: usize = 1000;

/// Returns the width of the terminal. Without one it is the variable COLUMNS, or the default.
fn terminal_width() -> usize {
    if let Some((width, _)) = terminal_size::terminal_size_of(std::io::stdout()) {
        return usize::from(width.0).clamp(NARROWEST, WIDEST);
    }
    let columns = std::env::var("COLUMNS").ok().and_then(|columns| columns.trim().parse::<usize>().ok());
    columns.filter(|columns| *columns > 0).map_or(Style::WIDTH, |columns| columns.clamp(NARROWEST, WIDEST_PIPE))
}

/// True if the locale is UTF-8. Always true on systems other than Unix.
fn utf8_locale() -> bool {
    if !cfg!(unix) {
        return true;
    }
    let set = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
    let locale = set("LC_ALL").or_else(|| set("LC_CTYPE")).or_else(|| set("LANG")).unwrap_or_default();
    let locale = locale.to_lowercase();
    locale.contains("utf-8") || locale.contains("utf8")
}

/// Destination of a result. It is opened before the work, so that a file that cannot be written costs no evaluation.
pub(super) enum Destination {
    Stdout,
    /// Written under a temporary name and renamed, so that no incomplete result has the final name.
    File {
        path: PathBuf,
    },
    /// Pipe, device or other special file, written to directly.
    Special {
        path: PathBuf,
        file: std::fs::File,
    },
}

impl Destination {
    pub(super) fn file(path: &Path) -> Result<Self, Failure> {
        let unwritable = |error: std::io::Error| Failure::Unwritable { path: path.to_owned(), error: bare(error) };
        if path.is_dir() {
            return Err(unwritable(ErrorKind::IsADirectory.into()));
        }
        // A link is followed, and stays a link.
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
        // A trial file shows at once if the folder is not writable. It is removed immediately.
        temporary(path).map_err(unwritable)?;
        Ok(Self::File { path: path.to_owned() })
    }

    /// Writes several files, or none of them: each is whole under a temporary name before the first gets its own.
    pub(super) fn write_all<'t>(all: impl IntoIterator<Item = (Self, &'t str)>) -> Result<(), Failure> {
        let unwritable = |path: PathBuf, error| Failure::Unwritable { path, error: bare(error) };
        let mut staged = Vec::new();
        for (destination, text) in all {
            match destination {
                Self::File { path } => match stage(&path, text.as_bytes()) {
                    Ok(file) => staged.push((path, file)),
                    Err(error) => return Err(unwritable(path, error)),
                },
                // What went into a device or a pipe cannot be taken back.
                direct => direct.write(text)?,
            }
        }
        staged
            .into_iter()
            .try_for_each(|(path, file)| file.persist(&path).map_err(|error| unwritable(path, error.error)))
    }

    /// Writes bytes unchanged.
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
                let written = stage(&path, bytes).and_then(|file| file.persist(&path).map_err(|error| error.error));
                written.map_err(|error| Failure::Unwritable { path, error: bare(error) })
            }
        }
    }

    pub(super) fn write(self, text: &str) -> Result<(), Failure> {
        // Files and pipes get the text unchanged. A terminal would execute control sequences in it.
        let terminal = matches!(self, Self::Stdout) && std::io::stdout().is_terminal();
        let text = if terminal { Cow::from(shown(text)) } else { Cow::from(text) };
        self.write_bytes(text.as_bytes())
    }
}

/// Writes bytes to a temporary file beside this path. It goes if it is not renamed.
fn stage(path: &Path, bytes: &[u8]) -> std::io::Result<TempPath> {
    let file = temporary(path)?;
    std::fs::write(&file, bytes)?;
    Ok(file)
}

/// Creates a temporary file beside this path, with the mode of the file that it will replace. A new file gets the user's default mode.
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

/// Prefix of the names of temporary files.
pub(super) const TEMPORARY: &str = ".sensitol-";
/// Age above which a temporary file counts as left over from a killed run. A file exists only while it is written.
const LEFT_OVER: Duration = Duration::from_secs(3600);

/// Removes old temporary files from a folder. Errors are ignored.
fn remove_leftovers(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let old = || entry.metadata().ok()?.modified().ok()?.elapsed().ok().filter(|age| *age > LEFT_OVER);
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && entry.file_name().to_string_lossy().starts_with(TEMPORARY) && old().is_some() {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Removes the temporary file's name from an error, because it would only confuse.
fn bare(error: std::io::Error) -> std::io::Error {
    error.raw_os_error().map_or(error.kind().into(), std::io::Error::from_raw_os_error)
}

/// Formats a value as indented JSON with a final line break.
pub(super) fn json(value: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("reports are plain data");
    text.push('\n');
    text
}
