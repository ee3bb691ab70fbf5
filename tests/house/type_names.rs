//! Names of public types: each stands for one thing, and says which.

use std::collections::BTreeMap;
use sensitol_testing::repository;


/// Names that say nothing by themselves.
const EMPTY: [&str; 9] = ["One", "Found", "Known", "At", "Own", "Rest", "Ask", "Given", "Bought"];

/// The types and traits of the library by name, with the files that define them: the public ones, or all.
fn types(all: bool) -> BTreeMap<String, Vec<String>> {
    let root = repository("src");
    let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut folders = vec![root.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let file = path.strip_prefix(&root).unwrap().display().to_string().replace('\\', "/");
            if file == "cli" {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            if !file.ends_with(".rs") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            for line in text.lines() {
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
                found.entry(name).or_default().push(file.clone());
            }
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
