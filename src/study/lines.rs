//! The section `[dimensions]` as it was written, to be written again with some of it changed.

use super::tree::{Tree, Value};

/// For every entry its keys, with their values as TOML.
pub(super) fn of(study: &Tree) -> Vec<(String, Vec<(String, String)>)> {
    let dimensions = entries(study).iter().find(|(key, _)| key.name == "dimensions");
    let keys = |entry: &Tree| entries(entry).iter().map(|(key, value)| (key.name.clone(), toml(value))).collect();
    dimensions
        .map_or(&[][..], |(_, section)| entries(section))
        .iter()
        .map(|(name, entry)| (name.name.clone(), keys(entry)))
        .collect()
}

fn entries(tree: &Tree) -> &[(super::tree::Key, Tree)] {
    match &tree.value {
        Value::Table(entries) => entries,
        _ => &[],
    }
}

/// A value on one line.
fn toml(tree: &Tree) -> String {
    match &tree.value {
        Value::Table(entries) => {
            let pairs: Vec<String> =
                entries.iter().map(|(key, value)| format!("{} = {}", name(&key.name), toml(value))).collect();
            if pairs.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", pairs.join(", ")) }
        }
        Value::Array(items) => format!("[{}]", items.iter().map(toml).collect::<Vec<_>>().join(", ")),
        Value::Text(text) => quoted(text),
        // The shortest decimals that are this double again, with a point or an exponent.
        Value::Number(number) => format!("{number:?}"),
        Value::Integer(integer) => integer.to_string(),
        Value::Truth(truth) => truth.to_string(),
        // No study that was read has one.
        Value::Other(_) => quoted(""),
    }
}

fn name(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
    if bare { name.to_owned() } else { quoted(name) }
}

/// A basic string.
fn quoted(text: &str) -> String {
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
