//! Names of public types: each stands for one thing, and says which.

use super::sources::sources;
use std::collections::BTreeMap;

/// Names that say nothing by themselves.
const EMPTY: [&str; 9] = ["One", "Found", "Known", "At", "Own", "Rest", "Ask", "Given", "Bought"];

/// The types and traits of the library by name, with the files that define them: the public ones, or all.
fn types(all: bool) -> BTreeMap<String, Vec<String>> {
    let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in sources().into_iter().filter(|file| file.package != "cli") {
        for line in file.text.lines() {
            let starts = ["pub struct ", "pub enum ", "pub trait "];
            let kinds = ["struct ", "enum ", "trait ", "type "];
            let line = line.trim_start();
            let bare = line.strip_prefix("pub(crate) ").or(line.strip_prefix("pub(super) "));
            let bare = bare.or(line.strip_prefix("pub ")).unwrap_or(line);
            let Some(rest) = (match all {
                true => kinds.iter().find_map(|start| bare.strip_prefix(start)),
                false => starts.iter().find_map(|start| line.strip_prefix(start)),
            }) else {
                continue;
            };
            let name = rest.chars().take_while(|c| c.is_alphanumeric()).collect();
            found.entry(name).or_default().push(file.name());
        }
    }
    found
}

#[test]
fn no_two_public_types_have_one_name() {
    let all = types(false);
    assert!(all.len() > 100, "the sources were read");
    let twice: Vec<_> = all.iter().filter(|(_, files)| files.len() > 1).collect();
    assert!(twice.is_empty(), "names of several types: {twice:#?}");
}

#[test]
fn no_type_has_a_name_that_says_nothing() {
    let all = types(true);
    let there: Vec<_> = all.iter().filter(|(name, _)| EMPTY.contains(&name.as_str())).collect();
    assert!(there.is_empty(), "rename these: {there:#?}");
}
