//! Writes a tree as a study file in TOML.

use crate::expand::{Origin, Tree, Value};
use crate::write;

/// Text of the whole study: plain keys first, then the sections, each with one line for an entry.
pub(super) fn written(tree: &Tree, origins: &[Origin], text: &str) -> String {
    let mut out = String::new();
    let is_section = |tree: &Tree| match &tree.value {
        Value::Table(_) => true,
        Value::Array(items) => items.iter().any(|item| matches!(item.value, Value::Table(_))),
        _ => false,
    };
    for (key, value) in tree.entries().iter().filter(|(_, value)| !is_section(value)) {
        out += &format!("{} = {}\n", write::name(&key.name), write::value(value));
    }
    for (key, section) in tree.entries().iter().filter(|(_, value)| is_section(value)) {
        let tables: Vec<&Tree> = match &section.value {
            Value::Array(items) => items.iter().collect(),
            _ => vec![section],
        };
        let list = matches!(section.value, Value::Array(_));
        for table in tables {
            let name = write::name(&key.name);
            let separator = if out.is_empty() { "" } else { "\n" };
            out += &if list { format!("{separator}[[{name}]]\n") } else { format!("{separator}[{name}]\n") };
            for (entry, value) in table.entries() {
                let origin = origins.iter().find(|origin| origin.section == key.name && origin.name == entry.name);
                let comment = origin.map_or_else(String::new, |origin| {
                    let line = 1 + text.get(..origin.span.start).unwrap_or_default().matches('\n').count();
                    format!(" # of {}, line {line}", origin.key)
                });
                out += &format!("{} = {}{comment}\n", write::name(&entry.name), write::value(value));
            }
        }
    }
    out
}
