//! Plain words: sentence patterns that need a second reading do not occur in first pages, and do not spread elsewhere.

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use sensitol_testing::repository;

/// Pattern with its reason, and the most occurrences in documents and comments. Changes may lower the number, never raise it.
struct Pattern {
    name: &'static str,
    why: &'static str,
    most: usize,
    found: fn(&str) -> usize,
}

const PATTERNS: [Pattern; 3] = [
    Pattern {
        name: "a sentence that begins with What",
        why: "its subject comes last: name the thing first",
        most: WHAT,
        found: what,
    },
    Pattern {
        name: "nobody, somebody",
        why: "a person who is no part of the system: name the user, the program or the cause",
        most: NOBODY,
        found: |text| ["nobody", "somebody"].iter().map(|word| text.to_lowercase().matches(word).count()).sum(),
    },
    Pattern {
        name: "is no <noun>",
        why: "say what it is, or `is not a`",
        most: IS_NO,
        found: |text| text.matches(" is no ").count() - text.matches("here is no ").count(),
    },
];
const WHAT: usize = 6;
const NOBODY: usize = 0;
const IS_NO: usize = 17;

/// Counts sentences and comments that begin with `What` and are not questions.
fn what(text: &str) -> usize {
    let mut found = 0;
    for (at, _) in text.match_indices("What ") {
        let before = text[..at].trim_end_matches(' ');
        let begins = before.is_empty() || before.ends_with(['.', '\n', '/', '!', '|', '-', '#', ':']);
        let end = text[at..].find(['.', '?', '\n', '|']).unwrap_or(0);
        found += usize::from(begins && !text[at + end..].starts_with('?'));
    }
    found
}

/// First pages of a new user.
const FIRST: [&str; 6] = [
    "README.md",
    "docs/commands.md",
    "docs/methods.md",
    "docs/examples.md",
    "docs/how-to/read-the-report.md",
    "docs/reference/commands.md",
];

#[test]
fn first_pages_and_help_are_plain() {
    let mut texts: Vec<(String, String)> =
        FIRST.iter().map(|page| ((*page).to_owned(), std::fs::read_to_string(repository(page)).unwrap())).collect();
    for study in ["first-study", "shaft-and-bore", "engine-balance"] {
        let study = format!("examples/{study}/study.toml");
        let output = Command::new(env!("CARGO_BIN_EXE_sensitol"))
            .current_dir(repository("."))
            .args(["analyze", &study, "-v"])
            .output()
            .unwrap();
        let text = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
        assert!(text.lines().count() > 20, "{study}");
        texts.push((study, text));
    }
    for (name, text) in &texts {
        for pattern in &PATTERNS {
            assert_eq!((pattern.found)(text), 0, "{name}: {}: {}", pattern.name, pattern.why);
        }
    }
}

/// The README is one screen of text and its example.
#[test]
fn the_readme_is_short() {
    let text = std::fs::read_to_string(repository("README.md")).unwrap();
    let words = text.split_whitespace().count();
    assert!(words <= 900, "{words} words");
    let install = text.lines().position(|line| line.contains("cargo install")).unwrap();
    assert!(install <= 10, "line {install}");
}

/// In every example of formulas and built-in models, the default report of a characteristic takes at most 30 lines: a row for each of some
/// twelve figures and intervals, after verdict and contributors, which fit half a screen. Lines have at most 80 columns, except those of the
/// brief at the end, which are never broken.
#[test]
fn default_reports_are_short() {
    let mut wide = Vec::new();
    for (name, path) in sensitol_testing::example_studies() {
        let text = std::fs::read_to_string(&path).unwrap();
        if text.contains("command =") || text.contains("${") {
            continue;
        }
        let output = Command::new(env!("CARGO_BIN_EXE_sensitol"))
            .args(["analyze", path.to_str().unwrap(), "--journal", "none"])
            .output()
            .unwrap();
        let report = String::from_utf8(output.stdout).unwrap();
        let report = report.rsplit_once("\n\n").map_or(&report[..], |(body, _)| body);
        // A section begins at the margin and ends at the next one.
        let mut section = Vec::new();
        for line in report.lines() {
            if !line.starts_with(' ') && !line.is_empty() {
                section.clear();
            }
            section.push(line);
            let lines = section.iter().filter(|line| !line.is_empty()).count();
            assert!(lines <= 30 || report.starts_with(section[0]), "{name}: {lines} lines\n{}", section.join("\n"));
        }
        wide.extend(report.lines().filter(|line| line.chars().count() > 80).map(|line| format!("{name}: {line}")));
    }
    assert!(wide.is_empty(), "{wide:#?}");
}

#[test]
fn the_patterns_do_not_spread() {
    let mut texts = Vec::new();
    for folder in ["docs", "src", "adapters", "examples"] {
        walk(&repository(folder), &mut texts);
    }
    assert!(texts.len() > 300, "{}", texts.len());
    for pattern in &PATTERNS {
        let count: usize = texts.iter().map(|text| (pattern.found)(text)).sum();
        assert!(count <= pattern.most, "{}: {count} of at most {}: {}", pattern.name, pattern.most, pattern.why);
        // A number that is far too large would permit new occurrences.
        assert!(count + 20 >= pattern.most, "{}: {count}; lower the number from {}", pattern.name, pattern.most);
    }
}

fn walk(folder: &Path, texts: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path: PathBuf = entry.unwrap().path();
        if path.is_dir() {
            walk(&path, texts);
        } else if path.extension().is_some_and(|extension| extension == "rs" || extension == "md") {
            texts.push(std::fs::read_to_string(&path).unwrap());
        }
    }
}
