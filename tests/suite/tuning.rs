//! The table of constants ([docs/reference/tuning.md](../../docs/reference/tuning.md)) has every constant of the methods as it is.

use super::circles::Sources;
use super::support::repository;

/// Where constants decide what is evaluated and how sure a result is.
const FOLDERS: [&str; 5] = ["analysis", "method", "simulation", "surrogate", "verification"];
const TYPES: [&str; 5] = ["f64", "usize", "u64", "u32", "i32"];

/// Name and value of every number that is a constant in this code.
fn constants(code: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for statement in code.split_inclusive(';') {
        let Some(at) = statement.rfind("const ") else { continue };
        let Some((name, rest)) = statement[at + "const ".len()..].split_once(": ") else { continue };
        let Some((of, value)) = rest.split_once(" =") else { continue };
        let is_name = name.starts_with(|c: char| c.is_ascii_uppercase())
            && name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
        if is_name && TYPES.contains(&of) {
            let value = value.trim_end_matches(';').split_whitespace().collect::<Vec<_>>().join(" ");
            found.push((name.to_owned(), value.replace('|', "\\|")));
        }
    }
    found
}

#[test]
fn every_constant_has_its_row() {
    let page = std::fs::read_to_string(repository("docs/reference/tuning.md")).unwrap();
    let rows = |file: &str| page.split("\n## `").find_map(|part| part.strip_prefix(file)?.strip_prefix("`\n"));
    let sources = Sources::read();
    let mut lacking = Vec::new();
    let mut seen = 0;
    for (module, code) in &sources.0 {
        if !FOLDERS.contains(&module.split('/').next().unwrap_or_default()) || module.ends_with("/tests") {
            continue;
        }
        let rows = [format!("{module}.rs"), format!("{module}/mod.rs")].iter().find_map(|file| rows(file));
        for (name, value) in constants(code) {
            seen += 1;
            let row = format!("| `{name}` | `{value}` |");
            if !rows.is_some_and(|rows| rows.contains(&row)) {
                lacking.push(format!("{module}: {row}"));
            }
        }
    }
    assert!(seen > 200, "{seen} constants");
    assert!(lacking.is_empty(), "run tests/tuning/measure.py: {lacking:#?}");
}

#[test]
fn constants_are_found_in_every_form() {
    let code = "use a::b;\nconst ONE: f64 = 0.5;\npub(crate) const TWO: usize =\n    1 << 3;\nfn f() {\n    const IN: u64 = 7;\n}\nconst LIST: [f64; 2] = [1.0, 2.0];\nconst fn g() {}\n";
    let found = constants(code);
    let expected = [("ONE", "0.5"), ("TWO", "1 << 3"), ("IN", "7")];
    assert_eq!(found, expected.map(|(name, value)| (name.to_owned(), value.to_owned())));
}
