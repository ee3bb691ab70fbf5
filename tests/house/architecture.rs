//! Layers import downward only, nothing prints outside the command line, files and folders keep their size.

use std::collections::BTreeMap;

use super::sources::{SourceFile, modules, sources};

/// The packages from the roof to the ground, as their manifests hold them: a package depends on those below it only.
const PACKAGES: &[(&str, &[&str])] = &[
    ("cli", &["report", "study", "external", "models", "engine", "numeric"]),
    ("report", &["study", "models", "engine", "numeric"]),
    ("study", &["external", "models", "spatial", "step", "engine", "numeric"]),
    ("external", &["engine", "numeric"]),
    ("models", &["engine", "numeric"]),
    ("engine", &["numeric"]),
    ("spatial", &["numeric"]),
    ("step", &[]),
    ("numeric", &[]),
];

/// The modules of the engine and of the mathematics below it, from the roof to the ground. Modules of one line do not import each other.
const LAYERS: &[(&str, &[&[&str]])] = &[
    (
        "engine",
        &[
            &["error"],
            &["compare", "sweep", "allocation", "lot"],
            &["analysis", "probe"],
            &["rare"],
            &["simulation"],
            &["extremes"],
            &["method"],
            &["verification"],
            &["estimate"],
            &["evaluation"],
            &["problem"],
            &["plan"],
            &["magnitude"],
            &["assembly"],
            &["warning"],
            &["method_kind"],
            &["summary"],
        ],
    ),
    (
        "numeric",
        &[
            &["law"],
            &["surrogate", "verdict"],
            &["capability", "lot", "distribution_bounds"],
            &["moments"],
            &["sampling"],
            &["correlation"],
            &["dimension", "characteristic"],
            &["distribution", "fits", "requirement", "inspection"],
            &["pearson"],
            &["names", "elementary", "time", "unit", "labels", "points", "optimise"],
            &["json_form", "parallel", "power"],
        ],
    ),
];

fn layer(layers: &[&[&str]], module: &str) -> usize {
    layers
        .iter()
        .position(|layer| layer.contains(&module))
        .unwrap_or_else(|| panic!("module `{module}` stands in no layer: add it to LAYERS"))
}

/// The library of a package as code names it.
fn library(package: &str) -> String {
    if package == "engine" { "sensitol".to_owned() } else { format!("sensitol_{package}") }
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
fn packages_depend_downward_only() {
    let names: Vec<&str> = PACKAGES.iter().map(|(name, _)| *name).collect();
    for file in sources() {
        let allowed = PACKAGES.iter().find(|(name, _)| *name == file.package).expect("a package of the list").1;
        for other in names.iter().filter(|name| **name != file.package && !allowed.contains(name)) {
            let path = format!("{}::", library(other));
            let named = file.code().match_indices(&path).any(|(at, _)| !file.code()[..at].ends_with(['_', ':']));
            assert!(!named, "{} imports {other}", file.name());
        }
    }
}

#[test]
fn layers_import_downward_only() {
    let mut wrong = Vec::new();
    for (package, layers) in LAYERS {
        for (module, code) in modules(package) {
            let top = module.split('/').next().unwrap().to_owned();
            if top == "lib" {
                continue;
            }
            for import in imports(&code) {
                if import != top && layer(layers, &import) <= layer(layers, &top) {
                    wrong.push(format!("{package}: {module} imports {import}"));
                }
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
    for file in sources() {
        for print in ["print!", "println!", "eprint!", "eprintln!", "dbg!", "io::stdout", "io::stderr"] {
            assert!(file.package == "cli" || !file.code().contains(print), "{} contains {print}", file.name());
        }
    }
}

/// A solver is exchanged in one file: the minimisers have one, and the root of one unknown has another.
#[test]
fn one_file_knows_each_solver() {
    let knows = sources().into_iter().filter(|file| file.code().contains("argmin::")).map(|file| file.name());
    assert_eq!(
        knows.collect::<Vec<_>>(),
        ["crates/numeric/src/optimise/minimise.rs", "crates/numeric/src/optimise/root.rs"]
    );
}

#[test]
fn no_file_is_much_over_600_lines() {
    for file in sources() {
        let lines = file.text.lines().count();
        let most = match file.name().as_str() {
            "crates/cli/src/main.rs" => 40,
            // One list of all warnings.
            "src/warning/mod.rs" => 800,
            _ => 640,
        };
        assert!(lines <= most, "{} has {lines} lines: split it by idea", file.name());
    }
}

/// The files of every folder below a package.
fn folders(files: &[SourceFile]) -> BTreeMap<String, usize> {
    let mut found = BTreeMap::new();
    for file in files {
        let name = file.name();
        let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
        *found.entry(folder).or_default() += 1;
    }
    found
}

#[test]
fn no_folder_has_more_than_25_files() {
    let large: Vec<(String, usize)> = folders(&sources()).into_iter().filter(|(_, files)| *files > 25).collect();
    assert!(large.is_empty(), "folders to be split by job: {large:#?}");
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
    for file in sources() {
        for text in literals(&file.code()) {
            let names = file.package != "cli" && names_an_option(&text);
            assert!(!names, "{} names an option of the command line: {text}", file.name());
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
