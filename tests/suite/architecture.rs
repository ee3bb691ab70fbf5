//! The house keeps its shape: layers import downward only, and nothing prints outside the command line.

use std::path::{Path, PathBuf};

use super::support::repository;

/// From the roof to the ground; what stands on one line does not import its neighbours.
const LAYERS: &[&[&str]] = &[
    &["main"],
    &["cli"],
    &["error"],
    &["study", "report"],
    &["compare", "rare", "sweep", "allocation"],
    &["analysis", "probe"],
    &["simulation"],
    &["extremes"],
    &["method"],
    &["evaluation"],
    &["verification"],
    &["problem"],
    &["plan"],
    &["surrogate", "verdict"],
    &["capability"],
    &["moments"],
    &["sampling"],
    &["models", "journal"],
    &["assembly"],
    &["warning"],
    &["correlation"],
    &["dimension", "characteristic"],
    &["distribution", "fits", "requirement"],
    &["pearson"],
    &["names", "elementary", "summary"],
];

fn layer(module: &str) -> usize {
    LAYERS
        .iter()
        .position(|layer| layer.contains(&module))
        .unwrap_or_else(|| panic!("module `{module}` stands in no layer: add it to LAYERS"))
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Every source file with the top module that it belongs to, and its code without comments.
fn files() -> Vec<(String, String, String)> {
    let root = repository("src");
    let mut paths = Vec::new();
    sources(&root, &mut paths);
    paths.sort();
    let file = |path: PathBuf| {
        let inner = path.strip_prefix(&root).unwrap().to_path_buf();
        let module =
            inner.components().next().unwrap().as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
        (inner.display().to_string(), module, code)
    };
    paths.into_iter().map(file).collect()
}

/// The top modules that `code` names by a path from the crate's root.
fn imports(code: &str) -> Vec<String> {
    let after = code.split("crate::").skip(1);
    let name = |rest: &str| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    after
        .flat_map(|rest| match rest.strip_prefix('{') {
            None => vec![name(rest)],
            // `use crate::{a::B, c}`: every name that starts an item of the list.
            Some(list) => {
                let mut depth = 0;
                let mut names = vec![name(list.trim_start())];
                for (at, c) in list.char_indices() {
                    match c {
                        '{' => depth += 1,
                        '}' if depth == 0 => break,
                        '}' => depth -= 1,
                        ',' if depth == 0 => names.push(name(list[at + 1..].trim_start())),
                        _ => {}
                    }
                }
                names
            }
        })
        .filter(|name| !name.is_empty())
        .collect()
}

#[test]
fn layers_import_downward_only() {
    let mut wrong = Vec::new();
    for (file, module, code) in files() {
        if module == "lib" {
            continue;
        }
        for import in imports(&code) {
            if import != module && layer(&import) <= layer(&module) {
                wrong.push(format!("{file} imports {import}"));
            }
        }
    }
    assert!(wrong.is_empty(), "imports that do not lead downward: {wrong:#?}");
}

#[test]
fn the_check_of_imports_sees_every_form() {
    assert_eq!(imports("use crate::plan::Known;"), ["plan"]);
    assert_eq!(imports("use crate::{plan::{At, Point}, cli};"), ["plan", "cli"]);
    assert_eq!(imports("let x = crate::cli::run();"), ["cli"]);
}

#[test]
fn nothing_prints_outside_the_command_line() {
    for (file, module, code) in files() {
        for print in ["print!", "println!", "eprint!", "eprintln!", "dbg!", "io::stdout", "io::stderr"] {
            assert!(module == "cli" || !code.contains(print), "{file} contains {print}");
        }
    }
}

/// A solver that is exchanged is exchanged in one file.
#[test]
fn one_file_knows_the_minimiser() {
    let knows = files().into_iter().filter(|(_, _, code)| code.contains("argmin::")).map(|(file, ..)| file);
    assert_eq!(knows.collect::<Vec<_>>(), ["allocation/minimise.rs"]);
}

#[test]
fn main_is_small_and_no_file_is_much_over_600_lines() {
    for (file, _, _) in files() {
        let lines = std::fs::read_to_string(repository("src").join(&file)).unwrap().lines().count();
        let most = if file == "main.rs" { 40 } else { 640 };
        assert!(lines <= most, "{file} has {lines} lines: split it by idea");
    }
}

#[test]
fn a_library_user_compiles_no_command_line() {
    let manifest = std::fs::read_to_string(repository("Cargo.toml")).unwrap();
    for library in ["clap", "anstream", "annotate-snippets", "tempfile"] {
        let dependencies = manifest.split("[dependencies]").nth(1).unwrap().split("\n[").next().unwrap();
        let line = dependencies.lines().find(|line| line.starts_with(&format!("{library} "))).unwrap();
        assert!(line.contains("optional = true"), "{library} is not optional");
    }
}
