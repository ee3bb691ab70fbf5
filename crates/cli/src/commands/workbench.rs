//! `sensitol workbench`: a page that edits and analyses studies in a browser.
//!
//! `web/build` makes the page, which contains the engine as WebAssembly. This command finds the page and inserts a study. The program
//! itself is built without WebAssembly.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::args::{OutputArgs, WorkbenchArgs};
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Destination, Look};
use crate::own_file::Content;
use sensitol_study::{FileRole, Study};

const PAGE: &str = "workbench.html";
/// Environment variable with the path of the page.
const VARIABLE: &str = "SENSITOL_WORKBENCH";
/// Placeholder in the page for the study.
const EMPTY: &str = "<script type=\"application/json\" id=\"study-data\">null</script>";
/// Mark of the engine's version in a page.
const GENERATOR: &str =
    concat!("<meta name=\"generator\" content=\"sensitol ", env!("CARGO_PKG_VERSION"), " workbench\">");

/// Data that the page opens.
#[derive(Serialize)]
struct Given {
    name: String,
    text: String,
    files: BTreeMap<String, String>,
}

pub(crate) fn run(asked: &WorkbenchArgs, look: Look) -> Result<Exit, Failure> {
    let output = OutputArgs { json: false, output: Some(asked.output.clone()), force: asked.force };
    let mut files = Files::default().forced(asked.force);
    let given = asked.study.as_deref().map(|path| -> Result<Given, Failure> {
        let study = Study::read(path)?;
        files.study(path, &study, None);
        look.warn_all(&study.warnings);
        given(path, &study)
    });
    let given = given.transpose()?;
    let page = page(asked.page.as_deref())?;
    if let Some(page) = &asked.page {
        files.reads(page, "the page without a study");
    }
    let destination: Destination = files.output_of(&output, &Content::Report)?;
    let data = serde_json::to_string(&given).expect("texts are plain data");
    // Escaped, so that no text of a study ends the element around it.
    let data = data.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026");
    destination.write(&page.replacen(EMPTY, &EMPTY.replace("null", &data), 1))?;
    Ok(Exit::Done)
}

/// Returns the study for the page: its TOML text, and its files of measured values.
fn given(path: &Path, study: &Study) -> Result<Given, Failure> {
    let cannot = |reason: &str| Failure::NotInPage { path: path.to_owned(), reason: reason.to_owned() };
    if study.problem.function().signature().costly {
        return Err(cannot("its model is an external program, and a page runs none: `sensitol analyze` does"));
    }
    let mut files = BTreeMap::new();
    for file in study.files.iter().filter(|file| file.role == FileRole::Measured) {
        let text = std::fs::read_to_string(&file.path)
            .map_err(|error| cannot(&format!("{} cannot be read: {error}", file.shown())))?;
        files.insert(file.written.clone(), text);
    }
    let toml = path.extension().is_some_and(|ending| ending == "toml");
    let text = if toml { study.text().to_owned() } else { study.expanded.clone() };
    let stem = path.file_stem().map_or_else(|| "study".into(), |stem| stem.to_string_lossy());
    Ok(Given { name: format!("{stem}.toml"), text, files })
}

/// Reads the page without a study, and checks that it fits to this program.
pub(crate) fn page(named: Option<&Path>) -> Result<String, Failure> {
    let (path, sought) = match named {
        Some(path) => (Some(path.to_owned()), Vec::new()),
        None => {
            let places = places();
            (places.iter().find(|path| path.is_file()).cloned(), places)
        }
    };
    let Some(path) = path else { return Err(Failure::NoPage { sought }) };
    let wrong = |reason: String| Failure::WrongPage { path: path.clone(), reason };
    let text = std::fs::read_to_string(&path).map_err(|error| wrong(format!("it cannot be read: {error}")))?;
    if !text.contains(EMPTY) {
        return Err(wrong("it is not a workbench without a study, as web/build writes it".to_owned()));
    }
    if !text.contains(GENERATOR) {
        let version = env!("CARGO_PKG_VERSION");
        return Err(wrong(format!("its engine is not that of this program, version {version}: run web/build again")));
    }
    Ok(text)
}

/// Returns the possible paths of the page: of the environment, beside the program, in a package's shared files, and in the output of
/// `web/build`.
fn places() -> Vec<PathBuf> {
    let named = std::env::var_os(VARIABLE).map(PathBuf::from);
    let program = std::env::current_exe().and_then(std::fs::canonicalize).ok();
    let folder = program.as_deref().and_then(Path::parent);
    let around = folder.into_iter().flat_map(|folder| {
        let up = folder.parent().unwrap_or(folder);
        [folder.join(PAGE), up.join("share/sensitol").join(PAGE), up.join("web").join(PAGE)]
    });
    named.into_iter().chain(around).collect()
}
