//! The studies of a folder: listed, read, saved, watched. Files outside it are never touched.

use std::io::ErrorKind;
use std::io::Write;
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde_json::json;
use sha2::{Digest, Sha256};

use crate::commands::serve::answer::Answer;
use crate::commands::serve::guard::Query;
use crate::failure::Failure;
use crate::interrupt;
use sensitol_study::{Study, StudyText};

/// Greatest depth of searched subfolders.
const DEEPEST: usize = 4;
/// Greatest number of studies that are listed.
const MOST: usize = 1000;
/// Longest wait for a change of a file.
const WAIT: Duration = Duration::from_secs(20);
/// Interval between two looks at the file.
const LOOK: Duration = Duration::from_millis(200);

pub(in crate::commands::serve) struct Folder {
    /// Path of the folder, with links resolved.
    root: PathBuf,
    /// Path as the user gave it.
    asked: PathBuf,
    /// Held while a save compares a file with the page's version and replaces it.
    saving: Mutex<()>,
}

impl Folder {
    pub(in crate::commands::serve) fn open(asked: &Path) -> Result<Self, Failure> {
        let wrong = |reason: String| Failure::NotAFolder { path: asked.to_owned(), reason };
        let root = asked.canonicalize().map_err(|error| wrong(error.to_string()))?;
        if !root.is_dir() {
            return Err(wrong("it is a file: name the folder that it is in".to_owned()));
        }
        Ok(Self { root, asked: asked.to_owned(), saving: Mutex::default() })
    }

    /// Returns the path with links resolved.
    pub(in crate::commands::serve) fn root(&self) -> PathBuf {
        self.root.clone()
    }

    /// Returns the path as the user gave it.
    pub(in crate::commands::serve) fn shown(&self) -> String {
        self.asked.display().to_string()
    }

    /// Returns the last part of the path.
    pub(in crate::commands::serve) fn name(&self) -> String {
        self.root.file_name().map_or_else(|| self.shown(), |name| name.to_string_lossy().into_owned())
    }

    /// Returns the path of the named file, with `/` between folders. Files outside the folder, also by links, and files that are not
    /// studies are refused.
    pub(in crate::commands::serve) fn place(&self, query: &Query) -> Result<PathBuf, Answer> {
        let name = query.get("path").ok_or_else(|| Answer::refused(400, "no study is named"))?;
        let path = Path::new(name);
        let inside = path.components().all(|part| matches!(part, Component::Normal(_))) && !name.contains('\\');
        let ending = path.extension().and_then(|ending| ending.to_str());
        if name.is_empty() || !inside {
            return Err(Answer::refused(403, "only studies of the folder are opened and saved"));
        }
        if !ending.is_some_and(|ending| ["toml", "json"].contains(&ending)) {
            return Err(Answer::refused(403, "a study is a .toml or a .json file"));
        }
        let whole = self.root.join(path);
        let parent = whole.parent().unwrap_or(&self.root).canonicalize();
        let parent = parent.map_err(|_| Answer::refused(404, "there is no such folder"))?;
        let real = whole.canonicalize().unwrap_or_else(|_| parent.join(whole.file_name().unwrap_or_default()));
        if !parent.starts_with(&self.root) || !real.starts_with(&self.root) {
            return Err(Answer::refused(403, "only studies of the folder are opened and saved"));
        }
        // A pipe would be read without end.
        if real.metadata().is_ok_and(|about| !about.is_file()) {
            return Err(Answer::refused(403, "a study is a file"));
        }
        Ok(real)
    }

    /// Lists files that are studies by extension and content, sorted by name.
    pub(in crate::commands::serve) fn list(&self) -> Answer {
        let mut found = Vec::new();
        self.collect(&self.root, 0, &mut found);
        found.sort();
        Answer::json(json!({ "studies": found }).to_string())
    }

    fn collect(&self, folder: &Path, depth: usize, found: &mut Vec<String>) {
        // Entries that cannot be read are not listed.
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let hidden = entry.file_name().to_string_lossy().starts_with('.');
            let Ok(kind) = entry.file_type() else { continue };
            if hidden || found.len() >= MOST {
                continue;
            }
            if kind.is_dir() && depth < DEEPEST {
                self.collect(&path, depth + 1, found);
            } else if kind.is_file() && is_study(&path) {
                let inner = path.strip_prefix(&self.root).unwrap_or(&path);
                let parts: Vec<_> = inner.components().map(|part| part.as_os_str().to_string_lossy()).collect();
                found.push(parts.join("/"));
            }
        }
    }

    /// Returns the text of a study as TOML, with its hash.
    pub(in crate::commands::serve) fn read(&self, query: &Query) -> Answer {
        let path = match self.place(query) {
            Ok(path) => path,
            Err(refusal) => return refusal,
        };
        let Ok(text) = std::fs::read_to_string(&path) else {
            return Answer::refused(404, "there is no such study, or it is not text");
        };
        let known = hash(text.as_bytes());
        let name = query.get("path").unwrap_or_default();
        if path.extension().is_some_and(|ending| ending == "toml") {
            return Answer::json(json!({ "name": name, "text": text, "hash": known }).to_string());
        }
        // A JSON study is shown as TOML, and saved as a new file.
        let folder = path.parent().unwrap_or(&self.root);
        match Study::from_text(StudyText::json(name, &text).in_folder(folder).within(&self.root)) {
            Ok(study) => {
                let name = format!("{}.toml", name.trim_end_matches(".json"));
                Answer::json(json!({ "name": name, "text": study.expanded, "hash": null }).to_string())
            }
            Err(error) => Answer::refused(400, &error.to_string()),
        }
    }

    /// Writes a study as a whole, unless the file has changed since the page read it.
    pub(in crate::commands::serve) fn save(&self, query: &Query, text: &str) -> Answer {
        let path = match self.place(query) {
            Ok(path) if path.extension().is_some_and(|ending| ending == "toml") => path,
            Ok(_) => return Answer::refused(403, "the workbench saves .toml files: name one"),
            Err(refusal) => return refusal,
        };
        let unwritten = |error: std::io::Error| Answer::refused(500, &format!("it cannot be written: {error}"));
        // The file is renamed into place, so that it is never incomplete.
        let folder = path.parent().unwrap_or(&self.root);
        let new = tempfile::NamedTempFile::new_in(folder).and_then(|mut file| {
            file.write_all(text.as_bytes())?;
            file.as_file().sync_all()?;
            Ok(file)
        });
        let new = match new {
            Ok(new) => new,
            Err(error) => return unwritten(error),
        };
        let overwrite = query.get("overwrite") == Some("yes");
        // Two saves of the same version one after the other: the second one finds a file that it does not know.
        let _saving = self.saving.lock().unwrap_or_else(PoisonError::into_inner);
        let there = match std::fs::read(&path) {
            Ok(bytes) => Some(hash(&bytes)),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return unwritten(error),
        };
        if !overwrite && there.as_deref() != query.get("hash").filter(|hash| !hash.is_empty()) {
            return Answer::refused(409, "the file is not the one that was opened: another program has changed it");
        }
        if let Ok(now) = std::fs::metadata(&path)
            && let Err(error) = new.as_file().set_permissions(now.permissions())
        {
            return unwritten(error);
        }
        match new.persist(&path) {
            Ok(_) => Answer::json(json!({ "hash": hash(text.as_bytes()) }).to_string()),
            Err(error) => unwritten(error.error),
        }
    }

    /// Waits until the file differs from the page's version. Returns an empty answer after a while.
    pub(in crate::commands::serve) fn changed(&self, query: &Query) -> Answer {
        let path = match self.place(query) {
            Ok(path) => path,
            Err(refusal) => return refusal,
        };
        let begun = Instant::now();
        while begun.elapsed() < WAIT && !interrupt::stopped() {
            let now = std::fs::read(&path).ok().map(|bytes| hash(&bytes));
            if now.as_deref() != query.get("hash") {
                return Answer::json(json!({ "hash": now }).to_string());
            }
            std::thread::sleep(LOOK);
        }
        Answer::nothing()
    }
}

fn hash(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// True if the file looks like a study, valid or not: it contains characteristics.
fn is_study(path: &Path) -> bool {
    let named = |name: &str| std::fs::read_to_string(path).is_ok_and(|text| text.contains(name));
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("toml") => named("[characteristics") || named("characteristics."),
        Some("json") => named("\"characteristics\"") && named("\"dimensions\"") && !named("\"schema\""),
        _ => false,
    }
}
