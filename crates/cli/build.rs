//! Embeds the examples of the repository in the command.
//!
//! A build without optimisation reads them from the repository instead, so that a change of an example compiles nothing anew.

use std::fmt::Write;
use std::path::{Path, PathBuf};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let own = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets it"));
    let folder = own.join("../../examples");
    let embeds = std::env::var("PROFILE").is_ok_and(|profile| profile == "release");
    let mut text = String::new();
    let read_at_run_time = (!embeds && folder.is_dir()).then(|| folder.display().to_string());
    writeln!(text, "const FOLDER: Option<&str> = {read_at_run_time:?};").expect("a text grows");
    text += "const EMBEDDED: &[(&str, &[u8])] = &[\n";
    if embeds && folder.is_dir() {
        println!("cargo::rerun-if-changed={}", folder.display());
        let mut files = Vec::new();
        list(&folder, &folder, &mut files);
        files.sort();
        for (name, path) in files {
            writeln!(text, "    ({name:?}, include_bytes!({path:?})),").expect("a text grows");
        }
    }
    text += "];\n";
    std::fs::write(out.join("examples.rs"), text).expect("the output folder is writable");
}

/// Lists the files below a folder by their names with slashes, without those that a run leaves.
fn list(root: &Path, folder: &Path, files: &mut Vec<(String, String)>) {
    let entries = std::fs::read_dir(folder).expect("the folder of examples can be read");
    for entry in entries.flatten() {
        let path = entry.path();
        let own = entry.file_name().to_string_lossy().into_owned();
        if own.starts_with('.') || own == "__pycache__" || own.contains(".journal.sqlite") {
            continue;
        }
        if path.is_dir() {
            list(root, &path, files);
        } else {
            let name = path.strip_prefix(root).expect("a file below the root");
            let name = name.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/");
            files.push((name, path.display().to_string()));
        }
    }
}
