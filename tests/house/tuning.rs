//! The table of constants ([tests/tuning/README.md](../tuning/README.md)) has every constant of the methods as it is.

use sensitol_testing::repository;

use super::sources::sources;

/// Where constants decide what is evaluated and how sure a result is.
const FOLDERS: [&str; 6] = ["analysis", "estimate", "method", "simulation", "surrogate", "verification"];
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

/// The kinds, and the kind of each constant by file and name ([tests/tuning/kinds.toml](../tuning/kinds.toml)).
fn kinds() -> (toml::Table, toml::Table) {
    let text = std::fs::read_to_string(repository("tests/tuning/kinds.toml")).unwrap();
    let mut table: toml::Table = text.parse().unwrap();
    ["kinds", "constants"].map(|key| table.remove(key).unwrap().as_table().unwrap().clone()).into()
}

#[test]
fn every_constant_has_its_kind_and_its_row() {
    let page = std::fs::read_to_string(repository("tests/tuning/README.md")).unwrap();
    let (kinds, constants_by_file) = kinds();
    let sections: Vec<&str> = page.split("\n## ").skip(1).collect();
    let section = |kind: &str| sections.iter().find_map(|section| section.strip_prefix(kind)?.strip_prefix('\n'));
    let mut lacking = Vec::new();
    let mut seen = 0;
    for source in sources() {
        let (module, code) = (source.module(), source.code());
        if !FOLDERS.contains(&module.split('/').next().unwrap_or_default())
            || module.ends_with("/tests")
            || !["engine", "numeric"].contains(&source.package.as_str())
        {
            continue;
        }
        let files = [source.path.clone()];
        for (name, value) in constants(&code) {
            seen += 1;
            let of = |file: &String| Some((file.clone(), constants_by_file.get(file)?.get(&name)?.as_str()?));
            let Some((file, kind)) = files.iter().find_map(of).filter(|(_, kind)| kinds.contains_key(*kind)) else {
                lacking.push(format!("{module}: {name} has no kind"));
                continue;
            };
            let row = format!("| `{file}` | `{name}` | `{value}` |");
            if !section(kind).is_some_and(|rows| rows.contains(&row)) {
                lacking.push(format!("{kind}: {row}"));
            }
        }
    }
    assert!(seen > 200, "{seen} constants");
    assert!(lacking.is_empty(), "tests/tuning/kinds.toml and tests/tuning/measure.py: {lacking:#?}");
    let listed: usize = constants_by_file.values().map(|names| names.as_table().unwrap().len()).sum();
    assert_eq!(listed, seen, "kinds of constants that are no more");
}

#[test]
fn constants_are_found_in_every_form() {
    let code = "use a::b;\nconst ONE: f64 = 0.5;\npub(crate) const TWO: usize =\n    1 << 3;\nfn f() {\n    const IN: u64 = 7;\n}\nconst LIST: [f64; 2] = [1.0, 2.0];\nconst fn g() {}\n";
    let found = constants(code);
    let expected = [("ONE", "0.5"), ("TWO", "1 << 3"), ("IN", "7")];
    assert_eq!(found, expected.map(|(name, value)| (name.to_owned(), value.to_owned())));
}
