//! `sensitol examples`: the studies of the documentation, to begin from.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use schemars::JsonSchema;
use serde::Serialize;

use crate::failure::{Exit, Failure};
use crate::new_study::shell;
use crate::output::{Destination, TEMPORARY, json};
use sensitol_numeric::names::{first_of, nearest};

include!(concat!(env!("OUT_DIR"), "/examples.rs"));

/// Greatest number of known names that an error lists.
const NAMED: usize = 8;

#[derive(Debug, Args)]
pub(crate) struct ExamplesArgs {
    #[command(subcommand)]
    command: Option<ExamplesCommand>,
}

#[derive(Debug, Subcommand)]
enum ExamplesCommand {
    /// Lists the examples with their titles, as `sensitol examples` does
    #[command(after_help = "Examples:\n  sensitol examples list")]
    List,
    /// Copies an example into a new folder
    #[command(after_help = "Examples:\n  sensitol examples copy engine-balance")]
    Copy {
        /// The example
        #[arg(value_name = "NAME")]
        name: String,
        /// The new folder [default: NAME, in the current folder]
        #[arg(value_name = "FOLDER")]
        folder: Option<PathBuf>,
    },
}

/// Files of an example: names with slashes, and contents.
type ExampleFiles = Vec<(String, Cow<'static, [u8]>)>;

/// The list of `examples --json`: one example.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ExampleReport {
    /// The name, for `sensitol examples copy`.
    name: String,
    /// The heading of its README.
    title: Option<String>,
    /// Files of the example, by their paths from its folder.
    files: Vec<String>,
}

pub(crate) fn run(asked: &ExamplesArgs, as_json: bool) -> Result<Exit, Failure> {
    let all = examples()?;
    match &asked.command {
        None | Some(ExamplesCommand::List) => {
            let reports: Vec<ExampleReport> = all.iter().map(|(name, files)| ExampleReport::of(name, files)).collect();
            let text = if as_json { json(&reports) } else { listed(&reports) };
            Destination::Stdout.write(&text)?;
        }
        Some(ExamplesCommand::Copy { name, folder }) => {
            let Some(files) = all.get(name) else {
                let known: Vec<String> = all.keys().cloned().collect();
                return Err(Failure::UnknownExample {
                    name: name.clone(),
                    nearest: nearest(name, all.keys().map(String::as_str)).map(str::to_owned),
                    known: first_of(&known, NAMED),
                });
            };
            let folder = folder.clone().unwrap_or_else(|| PathBuf::from(name));
            copy(files, &folder)?;
            Destination::Stdout.write(&told(files, &folder))?;
        }
    }
    Ok(Exit::Done)
}

impl ExampleReport {
    fn of(name: &str, files: &ExampleFiles) -> Self {
        let title = files.iter().find(|(file, _)| file == "README.md").and_then(|(_, bytes)| {
            let text = std::str::from_utf8(bytes).ok()?;
            text.lines().find_map(|line| line.strip_prefix("# ")).map(str::to_owned)
        });
        Self { name: name.to_owned(), title, files: files.iter().map(|(file, _)| file.clone()).collect() }
    }
}

/// Formats a line for each example.
fn listed(reports: &[ExampleReport]) -> String {
    let widest = reports.iter().map(|one| one.name.len()).max().unwrap_or(0);
    let line = |one: &ExampleReport| format!("{:widest$}  {}\n", one.name, one.title.as_deref().unwrap_or_default());
    reports.iter().map(line).collect()
}

/// Returns all examples: embedded, or of the repository in a build without optimisation.
fn examples() -> Result<BTreeMap<String, ExampleFiles>, Failure> {
    let mut all: BTreeMap<String, ExampleFiles> = BTreeMap::new();
    let mut add = |path: &str, bytes: Cow<'static, [u8]>| {
        if let Some((name, file)) = path.split_once('/') {
            all.entry(name.to_owned()).or_default().push((file.to_owned(), bytes));
        }
    };
    for (path, bytes) in EMBEDDED {
        add(path, Cow::Borrowed(bytes));
    }
    if let Some(folder) = FOLDER.map(Path::new) {
        let unread = |error: std::io::Error| Failure::NotAFolder { path: folder.into(), reason: error.to_string() };
        let mut files = Vec::new();
        list(folder, "", &mut files).map_err(unread)?;
        files.sort();
        for name in files {
            let bytes = std::fs::read(folder.join(&name)).map_err(unread)?;
            add(&name, Cow::Owned(bytes));
        }
    }
    if all.is_empty() { Err(Failure::NoExamples) } else { Ok(all) }
}

/// Lists the files below a folder by their names with slashes, without those that a run leaves.
fn list(folder: &Path, prefix: &str, files: &mut Vec<String>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let own = entry.file_name().to_string_lossy().into_owned();
        if own.starts_with('.') || own == "__pycache__" || own.contains(".journal.sqlite") {
            continue;
        }
        if entry.path().is_dir() {
            list(&entry.path(), &format!("{prefix}{own}/"), files)?;
        } else {
            files.push(format!("{prefix}{own}"));
        }
    }
    Ok(())
}

/// Writes all files into a new folder, or none of them.
fn copy(files: &ExampleFiles, folder: &Path) -> Result<(), Failure> {
    if folder.symlink_metadata().is_ok() {
        return Err(Failure::Exists { path: folder.to_owned() });
    }
    let unwritable = |error: std::io::Error| Failure::Unwritable { path: folder.to_owned(), error };
    let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let staged = tempfile::Builder::new().prefix(TEMPORARY).tempdir_in(parent).map_err(unwritable)?;
    let new = staged.path().join("example");
    for (name, bytes) in files {
        let path = new.join(name);
        std::fs::create_dir_all(path.parent().unwrap_or(&new)).map_err(unwritable)?;
        std::fs::write(&path, bytes).map_err(unwritable)?;
    }
    std::fs::rename(&new, folder).map_err(unwritable)
}

/// Formats the list of written files, missing programs, and the command to try next.
fn told(files: &ExampleFiles, folder: &Path) -> String {
    let mut text = format!("written: {}, {} files\n", folder.display(), files.len());
    let mut outside = Vec::new();
    for (name, bytes) in files.iter().filter(|(name, _)| name.ends_with(".toml")) {
        let words = std::str::from_utf8(bytes).unwrap_or_default().split('"');
        let missing = words.filter(|word| word.starts_with("../")).map(|word| format!("{name} needs {word}"));
        outside.extend(missing);
    }
    for line in outside {
        text += &format!("not part of it: {line}, which a clone of the repository has\n");
    }
    if files.iter().any(|(name, _)| name == "study.toml") {
        text += &format!("next: sensitol analyze {}\n", shell(&folder.join("study.toml")));
    }
    text
}
