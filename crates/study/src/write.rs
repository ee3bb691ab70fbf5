//! How parts of a study are written, in TOML and in JSON: nothing else writes either.

use super::place::Format;
use super::tree::{Tree, Value};

/// A key with its value, both as they are written.
pub fn pair(format: Format, key: &str, value: &str) -> String {
    match format {
        Format::Toml => format!("{key} = {value}"),
        Format::Json => format!("\"{key}\": {value}"),
    }
}

/// An entry of a table below others: its name as it is written, and its value after `pad` more columns.
pub(super) fn entry(format: Format, name: &str, pad: usize, value: &str) -> String {
    match format {
        Format::Toml => format!("{name}{:pad$} = {value}\n", ""),
        Format::Json => format!("{name}:{:pad$} {value},\n", ""),
    }
}

/// A table of TOML on one line, of its pairs.
pub fn inline(pairs: impl IntoIterator<Item = String>) -> String {
    let pairs: Vec<String> = pairs.into_iter().collect();
    if pairs.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", pairs.join(", ")) }
}

/// An array of numbers or others, as they are written.
pub(super) fn array(items: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", items.into_iter().collect::<Vec<_>>().join(", "))
}

/// A value as TOML on one line.
pub(super) fn value(tree: &Tree) -> String {
    match &tree.value {
        Value::Table(entries) => {
            inline(entries.iter().map(|(key, tree)| pair(Format::Toml, &name(&key.name), &value(tree))))
        }
        Value::Array(items) => array(items.iter().map(value)),
        Value::Text(text) => quoted(text),
        Value::Number(number) => self::number(*number),
        Value::Integer(integer) => integer.to_string(),
        Value::Truth(truth) => truth.to_string(),
        // No study that was read has one.
        Value::Other(_) => quoted(""),
    }
}

/// The shortest decimals that are this double again, with a point or an exponent.
pub(super) fn number(number: f64) -> String {
    format!("{number:?}")
}

/// A key of TOML, in quotes where it needs them.
pub(super) fn name(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
    if bare { name.to_owned() } else { quoted(name) }
}

/// Text in quotes: a basic string of TOML.
pub fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => quoted += &format!("\\u{:04X}", u32::from(c)),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
