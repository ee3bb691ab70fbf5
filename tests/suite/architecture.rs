//! The house keeps its shape: layers import downward only, and nothing prints outside the command line.

use std::path::{Path, PathBuf};

use super::support::repository;

/// From the roof to the ground; what stands on one line does not import its neighbours.
const LAYERS: &[&[&str]] = &[
    &["main"],
    &["cli", "internals"],
    &["task"],
    &["error"],
    &["study", "report"],
    &["document"],
    &["compare", "rare", "sweep", "allocation"],
    &["analysis", "probe"],
    &["simulation"],
    &["extremes"],
    &["method"],
    &["evaluation"],
    &["verification"],
    &["problem"],
    &["plan"],
    &["law"],
    &["surrogate", "verdict"],
    &["capability"],
    &["moments"],
    &["sampling"],
    &["models", "journal", "magnitude"],
    &["assembly"],
    &["warning"],
    &["correlation"],
    &["dimension", "characteristic"],
    &["distribution", "fits", "requirement", "inspection"],
    &["pearson", "method_kind"],
    &["names", "elementary", "summary", "time", "unit", "table", "labels"],
    &["shape", "parallel", "short_sort", "power"],
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

/// The table of the house in CONTRIBUTING.md: every module once, from the roof to the ground.
#[test]
fn the_table_of_the_house_is_the_list_of_layers() {
    let text = std::fs::read_to_string(repository("CONTRIBUTING.md")).unwrap();
    let house = text.split("## The house").nth(1).unwrap().split("\n## ").next().unwrap();
    let cells = house.lines().filter_map(|line| line.strip_prefix("| `")?.split('|').next());
    let shown: Vec<&str> = cells.flat_map(|cell| cell.split(',')).map(|name| name.trim().trim_matches('`')).collect();
    let mut expected: Vec<&str> = LAYERS.concat();
    assert!(shown.is_sorted_by_key(|module| layer(module)), "the table is not in the order of the layers: {shown:?}");
    let mut sorted = shown.clone();
    sorted.sort_unstable();
    expected.sort_unstable();
    assert_eq!(sorted, expected, "modules of the table and of the list");
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

/// A solver that is exchanged is exchanged in one file: the minimisers have one, and the root of one unknown has another.
#[test]
fn one_file_knows_each_solver() {
    let knows = files().into_iter().filter(|(_, _, code)| code.contains("argmin::")).map(|(file, ..)| file);
    assert_eq!(knows.collect::<Vec<_>>(), ["allocation/minimise.rs", "allocation/root.rs"]);
}

#[test]
fn main_is_small_and_no_file_is_much_over_600_lines() {
    for (file, _, _) in files() {
        let lines = std::fs::read_to_string(repository("src").join(&file)).unwrap().lines().count();
        let most = match file.as_str() {
            "main.rs" => 40,
            // One list of all warnings.
            "warning/mod.rs" => 740,
            _ => 640,
        };
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

/// The string literals of Rust code, raw and ordinary, without comments.
fn literals(code: &str) -> Vec<String> {
    let letters: Vec<char> = code.chars().collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < letters.len() {
        match letters[at] {
            '/' if letters.get(at + 1) == Some(&'/') => {
                while at < letters.len() && letters[at] != '\n' {
                    at += 1;
                }
            }
            // A quotation mark as a character.
            '\'' if letters.get(at + 1) == Some(&'"') => at += 3,
            '\'' if letters.get(at + 1) == Some(&'\\') => at += 4,
            '"' => {
                let hashes = letters[..at].iter().rev().take_while(|&&c| c == '#').count();
                let raw = letters[..at - hashes].last() == Some(&'r');
                let mut text = String::new();
                at += 1;
                while at < letters.len() {
                    let ends = letters[at] == '"' && (1..=hashes).all(|more| letters.get(at + more) == Some(&'#'));
                    if ends {
                        break;
                    }
                    if letters[at] == '\\' && !raw {
                        at += 1;
                    }
                    text.push(letters[at]);
                    at += 1;
                }
                at += 1;
                found.push(text);
            }
            _ => at += 1,
        }
    }
    found
}

/// Whether a text names an option of the command line, as `--method`.
fn names_an_option(text: &str) -> bool {
    let begins = |(at, _): (usize, &str)| {
        let (before, after) = (&text[..at], text[at + 2..].chars().next());
        let inside = before.ends_with(|c: char| c.is_alphanumeric() || c == '-') || before.ends_with("var(");
        !inside && after.is_some_and(|c| c.is_ascii_lowercase())
    };
    text.match_indices("--").any(begins)
}

/// Other front ends have no options: what to do is an `Advice`, which each shows in its own words.
#[test]
fn the_library_names_no_option_of_the_command_line() {
    let tests = |code: &str| code.split("#[cfg(test)]").next().unwrap_or_default().to_owned();
    for (file, module, code) in files() {
        for text in literals(&tests(&code)) {
            assert!(module == "cli" || !names_an_option(&text), "{file} names an option of the command line: {text}");
        }
    }
}

#[test]
fn the_check_of_options_sees_every_form() {
    let code =
        "let a = \"use --method full\"; // \"--no\"\nlet b = r#\"(\"--step\")\"#; let c = ['\"', '\\n']; f(\"x -- y\")";
    assert_eq!(literals(code), ["use --method full", "(\"--step\")", "x -- y"]);
    assert!(names_an_option("all (--method full)") && names_an_option("--step"));
    // Properties of style sheets, dashes, and comments of the markup.
    assert!(!names_an_option("var(--ink)") && !names_an_option("a -- b") && !names_an_option("<!-- x -->"));
}
