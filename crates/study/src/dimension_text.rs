//! Section `[dimensions]` as written, for callers that write it again with changes.

use crate::tree::{Tree, Value};
use crate::write;

/// Entries of the section, with their keys and their values as TOML.
pub(super) fn of(study: &Tree) -> Vec<(String, Vec<(String, String)>)> {
    let dimensions = entries(study).iter().find(|(key, _)| key.name == "dimensions");
    let keys =
        |entry: &Tree| entries(entry).iter().map(|(key, value)| (key.name.clone(), write::value(value))).collect();
    dimensions
        .map_or(&[][..], |(_, section)| entries(section))
        .iter()
        .map(|(name, entry)| (name.name.clone(), keys(entry)))
        .collect()
}

fn entries(tree: &Tree) -> &[(crate::tree::Key, Tree)] {
    match &tree.value {
        Value::Table(entries) => entries,
        _ => &[],
    }
}
