//! Style of the sources: short functions, and documents that begin with the thing.

use std::collections::BTreeMap;

use super::sources::{SourceFile, sources};

/// Lines of the longest function: what fits on two screens.
const LONGEST: usize = 80;

/// First words of a document that name no thing.
const REJECTED: [&str; 18] = [
    "how", "where", "whether", "which", "what", "who", "whose", "why", "by", "of", "as", "with", "those", "and", "or",
    "but", "its", "their",
];

/// Documents that begin with a rejected word, by package. Those that are left are descriptions of the JSON Schema. The numbers only fall.
const LEFT: [(&str, usize); 7] =
    [("cli", 11), ("engine", 0), ("external", 0), ("models", 0), ("numeric", 0), ("report", 0), ("study", 0)];

/// Functions of a file with more lines than `most`: name and lines.
fn long_functions(text: &str, most: usize) -> Vec<(String, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (start, line) in lines.iter().enumerate() {
        // The declaration of a trait's function has no body.
        let Some(name) = function(line).filter(|_| !line.ends_with(';')) else { continue };
        let indent = &line[..line.len() - line.trim_start().len()];
        let end = format!("{indent}}}");
        let Some(length) = lines[start..].iter().position(|line| *line == end) else { continue };
        if length + 1 > most {
            found.push((name.to_owned(), length + 1));
        }
    }
    found
}

/// Name of the function that a line begins.
fn function(line: &str) -> Option<&str> {
    let (before, rest) = line.split_once("fn ")?;
    let is_start = before
        .split_whitespace()
        .all(|word| ["const", "async", "unsafe", "extern", "\"C\""].contains(&word) || word.starts_with("pub"));
    let name = rest.split(['(', '<']).next()?;
    (is_start && name.chars().all(|c| c.is_alphanumeric() || c == '_')).then_some(name)
}

/// First words of the documents of a file that are rejected, with their lines.
fn rejected_openers(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut before = "";
    for (at, line) in text.lines().enumerate() {
        let line = line.trim_start();
        let marker = ["///", "//!"].into_iter().find(|marker| line.starts_with(marker)).unwrap_or("");
        if !marker.is_empty() && marker != before {
            let first: String = line[3..].trim_start().chars().take_while(|c| c.is_ascii_alphabetic()).collect();
            if REJECTED.contains(&first.to_lowercase().as_str()) {
                found.push((at + 1, line.to_owned()));
            }
        }
        before = marker;
    }
    found
}

#[test]
fn functions_have_at_most_80_lines() {
    let long = |file: &SourceFile| {
        let name = file.name();
        long_functions(&file.text, LONGEST)
            .into_iter()
            .map(move |(function, lines)| format!("{name}: {function} ({lines})"))
    };
    let found: Vec<String> = sources().iter().flat_map(long).collect();
    assert!(found.is_empty(), "functions to be split into steps: {found:#?}");
}

#[test]
fn documents_begin_with_a_noun_or_a_verb() {
    let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in sources() {
        let openers = rejected_openers(&file.text);
        let named = openers.into_iter().map(|(line, text)| format!("{}:{line}: {text}", file.name()));
        found.entry(file.package.clone()).or_default().extend(named);
    }
    for (package, openers) in found {
        let most = LEFT.iter().find(|(name, _)| *name == package).map_or(0, |(_, most)| *most);
        assert!(openers.len() <= most, "{package}: {} documents, {most} are allowed: {openers:#?}", openers.len());
    }
}

#[test]
fn the_checks_find_what_they_seek() {
    let text = "/// How long it is.\npub(crate) const fn long<T>() {\n    a();\n    b();\n}\n\n/// Length.\n/// What follows is free.\nfn short() {}\n";
    assert_eq!(long_functions(text, 3), [("long".to_owned(), 4)]);
    assert_eq!(rejected_openers(text), [(1, "/// How long it is.".to_owned())]);
}
