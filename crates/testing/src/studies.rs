//! Short studies, and their faults.

use sensitol::{Analysis, Method, analyze};
use sensitol_numeric::dimension::Dimension;
use sensitol_study::{Study, StudyError};

/// Parses a study in TOML.
pub fn parse(text: &str) -> Result<Study, StudyError> {
    Study::from_toml(text, "study.toml")
}

/// Dimension `a` of a study with this line.
pub fn dimension(line: &str) -> Result<Dimension, StudyError> {
    let text = format!("[dimensions]\na = {line}\n[characteristics]\ny = {{ formula = \"a\" }}\n");
    parse(&text).map(|study| study.problem.dimensions()[0].clone())
}

/// Place, key, message and help of the fault, in one line each.
fn fault(text: &str) -> String {
    let error = parse(text).err().unwrap_or_else(|| panic!("valid: {text}"));
    let place = error.line_column().map_or("-".to_owned(), |(line, column)| format!("{line}:{column}"));
    let spanned = error.span.clone().map_or("", |span| &error.text[span]).lines().next().unwrap_or("").to_owned();
    let help = error.help().map_or(String::new(), |help| format!("\n  help: {help}"));
    format!("{place} [{spanned}] {}: {}{help}", error.key, error.fault)
}

/// Faults of several studies, one below the other.
pub fn faults(texts: &[&str]) -> String {
    texts.iter().map(|text| fault(text)).collect::<Vec<_>>().join("\n")
}

/// Analysis of a study by a method.
pub fn analysed(text: &str, method: Method) -> Analysis {
    let study = parse(text).unwrap_or_else(|error| panic!("{error}"));
    analyze(&study.problem, &method.into()).unwrap()
}
