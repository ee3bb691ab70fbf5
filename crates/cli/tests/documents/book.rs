//! The book of the documentation: its summary lists every page, and pages without console blocks show code that runs in other tests.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use super::docs::documents;
use sensitol_testing::repository;

const SUMMARY: &str = "docs/book/SUMMARY.md";

fn read(path: &str) -> String {
    std::fs::read_to_string(repository(path)).unwrap()
}

/// Removes `..` from a path.
fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => assert!(normal.pop(), "{path:?} leaves the repository"),
            Component::Normal(name) => normal.push(name),
            _ => {}
        }
    }
    normal
}

#[test]
fn the_book_has_every_page() {
    let text = read(SUMMARY);
    let targets = text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
    let entries: Vec<String> = targets
        .map(|target| normal(&Path::new(SUMMARY).parent().unwrap().join(target)).to_str().unwrap().replace('\\', "/"))
        .collect();
    for entry in &entries {
        assert!(repository(entry).is_file(), "{SUMMARY} names {entry}, which is not there");
        assert_eq!(entries.iter().filter(|one| *one == entry).count(), 1, "{SUMMARY} names {entry} twice");
    }
    let missing: Vec<String> = documents().into_iter().filter(|page| !entries.contains(page)).collect();
    assert!(missing.is_empty(), "{SUMMARY} does not name {missing:?}");
}

/// The version of mdBook is defined in one place, from which the gate installs it.
#[test]
fn the_gate_builds_the_book() {
    assert!(read(".ci/run").contains("docs/book/build --install"));
    assert!(read("tests/run").contains("tests/book/run"));
    let pinned = read("docs/book/build").lines().filter(|line| line.starts_with("version=")).count();
    assert_eq!(pinned, 1);
}

/// Returns the blocks of a page in this language.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    page.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap().to_owned()).collect()
}

/// Every block of the page on Rust is also an example of rustdoc, which `cargo test` runs.
#[test]
fn examples_in_rust_are_those_of_rustdoc() {
    let examples: BTreeSet<String> = ["src/lib.rs", "crates/study/src/lib.rs", "crates/report/src/to_document.rs"]
        .iter()
        .map(|file| {
            let text = read(file);
            let comments = text.lines().filter_map(|line| {
                let line = line.trim_start();
                let line = line.strip_prefix("//!").or_else(|| line.strip_prefix("///"))?;
                Some(line.strip_prefix(' ').unwrap_or(line))
            });
            // Lines that begin with a hash are hidden.
            comments.filter(|line| !line.starts_with("# ")).collect::<Vec<_>>().join("\n")
        })
        .collect();
    let shown = blocks(&read("docs/how-to/rust.md"), "rust");
    assert_eq!(shown.len(), 4);
    for block in shown {
        let example = format!("```\n{block}```");
        assert!(examples.iter().any(|text| text.contains(&example)), "no example of rustdoc is\n{block}");
    }
}

/// The refused study is in a folder of its own, because every study of an example must be readable.
#[test]
fn the_page_on_units_shows_what_check_says() {
    let folder = tempfile::tempdir().unwrap();
    let study = read("examples/mixed-units/as-written.toml").replace("\"warn\"", "\"check\"");
    std::fs::write(folder.path().join("bracket.toml"), study).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_sensitol"))
        .args(["check", "bracket.toml"])
        .current_dir(folder.path())
        .env("LC_ALL", "C.UTF-8")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = format!("```text\n{}```\n", String::from_utf8(output.stderr).unwrap());
    sensitol_testing::generated("docs/how-to/units.md", "check", &said);
}
