//! Writes parts of a study in TOML and JSON. No other module writes either.

use crate::folder::Format;
use crate::tree::{Tree, Value};

/// Text of a key with its value. Both are given as text of the format.
pub fn pair(format: Format, key: &str, value: &str) -> String {
    match format {
        Format::Toml => format!("{key} = {value}"),
        Format::Json => format!("\"{key}\": {value}"),
    }
}

/// Text of an entry in a table of entries. `pad` spaces align its value with those of the others.
pub(super) fn entry(format: Format, name: &str, pad: usize, value: &str) -> String {
    match format {
        Format::Toml => format!("{name}{:pad$} = {value}\n", ""),
        Format::Json => format!("{name}:{:pad$} {value},\n", ""),
    }
}

/// Text of a TOML table on one line, from its pairs.
pub fn inline(pairs: impl IntoIterator<Item = String>) -> String {
    let pairs: Vec<String> = pairs.into_iter().collect();
    if pairs.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", pairs.join(", ")) }
}

/// Text of an array, from its items.
pub(super) fn array(items: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", items.into_iter().collect::<Vec<_>>().join(", "))
}

/// Text of a value as TOML on one line.
pub(super) fn value(tree: &Tree) -> String {
    match &tree.value {
        Value::Table(entries) => {
            inline(entries.iter().map(|(key, tree)| pair(Format::Toml, &name(&key.name), &value(tree))))
        }
        Value::Array(items) => array(items.iter().map(value)),
        Value::Text(text) => quoted(text),
        Value::Number(number) => crate::write::number(*number),
        Value::Integer(integer) => integer.to_string(),
        Value::Truth(truth) => truth.to_string(),
        // No study that was read contains such a value.
        Value::Other(_) => quoted(""),
    }
}

/// Shortest text that is parsed as the same double, with a point or an exponent.
pub(super) fn number(number: f64) -> String {
    format!("{number:?}")
}

/// Text of a TOML key, in quotes if it needs them.
pub(super) fn name(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
    if bare { name.to_owned() } else { quoted(name) }
}

/// Text in quotes, as a basic string of TOML.
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
