//! Features and joints as the study writes them: extents, and the names that their numbers use.

use super::zones::frame::word;
use crate::expand::{Tree, Value};
use crate::scene::{AssemblyUses, EntryUses};
use crate::tree::Key;
use sensitol::assembly::formula::Formula;

/// Keys of the place of a feature.
const PLACES: [&str; 4] = ["plane", "axis", "point", "frame"];
/// Keys of directions.
const DIRECTIONS: [&str; 4] = ["normal", "along", "z", "x"];
/// Keys whose text is not a number.
const WORDS: [&str; 3] = ["datums", "distribution", "at"];
/// Keys of numbers in a zone that is a table.
const OF_ZONE: [&str; 3] = ["zone", "hole", "pin"];
/// Keys of numbers of a joint.
const OF_JOINT: [&str; 5] = ["gap", "length", "value", "offset", "tilt"];

/// Extent of a feature as written.
#[derive(Debug, Clone)]
pub(super) enum WrittenExtent {
    Unknown,
    Length(Tree),
    /// Components along x and y of the feature.
    Rectangle([Tree; 2]),
    /// Diameter of a round face.
    Round(Tree),
}

/// Features and joints as written, before zones and floats are replaced.
#[derive(Debug, Clone, Default)]
pub(crate) struct WrittenAssembly {
    pub(super) uses: AssemblyUses,
    /// Extents of the features, in the order of their uses.
    pub(super) extents: Vec<WrittenExtent>,
}

impl WrittenAssembly {
    pub(crate) fn of(study: &Tree) -> Self {
        let entries = |tree: Option<&Tree>| tree.map_or_else(Vec::new, |tree| tree.entries().to_vec());
        let mut written = Self::default();
        for (part, tree) in entries(study.get("parts")) {
            let full = |name: &str| format!("{}.{name}", part.name);
            for (key, tree) in tree.entries() {
                if PLACES.iter().any(|place| tree.get(place).is_some()) {
                    written.uses.features.push(EntryUses { name: full(&key.name), uses: of_feature(study, tree) });
                    written.extents.push(extent(tree));
                }
            }
            for (key, pattern) in entries(tree.get("patterns")) {
                let of = texts(pattern.get("of")).into_iter().map(full).collect();
                written.uses.patterns.push((full(&format!("patterns.{}", key.name)), of));
            }
        }
        for (key, tree) in entries(study.get("joints")) {
            let mut uses = Vec::new();
            tree.entries().iter().filter(|(key, _)| OF_JOINT.contains(&key.name.as_str())).for_each(|(_, value)| {
                add_names(study, value, &mut uses);
            });
            written.uses.joints.push(EntryUses { name: key.name, uses });
        }
        written
    }
}

/// Extent of a feature by its keys. Wrong ones are reported where zones are read.
fn extent(tree: &Tree) -> WrittenExtent {
    let is_plane = tree.get("plane").is_some();
    match (tree.get("size").map(|size| &size.value), tree.get("length"), tree.get("diameter").filter(|_| is_plane)) {
        (Some(Value::Array(items)), ..) => match &items[..] {
            [x, y] => WrittenExtent::Rectangle([x.clone(), y.clone()]),
            _ => WrittenExtent::Unknown,
        },
        (_, Some(length), _) => WrittenExtent::Length(length.clone()),
        (_, _, Some(diameter)) => WrittenExtent::Round(diameter.clone()),
        _ => WrittenExtent::Unknown,
    }
}

/// Names that the numbers of a feature use.
fn of_feature(study: &Tree, tree: &Tree) -> Vec<String> {
    let mut uses = Vec::new();
    for (Key { name, .. }, value) in tree.entries() {
        let name = name.as_str();
        match &value.value {
            _ if WORDS.contains(&name) => {}
            // The axis of a turned direction is a word.
            Value::Table(_) if DIRECTIONS.contains(&name) => {
                value.get("turned").into_iter().for_each(|angle| add_names(study, angle, &mut uses));
            }
            Value::Text(text) if DIRECTIONS.contains(&name) && word(text).is_some() => {}
            Value::Table(entries) => {
                entries.iter().filter(|(key, _)| OF_ZONE.contains(&key.name.as_str())).for_each(|(_, value)| {
                    add_names(study, value, &mut uses);
                });
            }
            _ => add_names(study, value, &mut uses),
        }
    }
    uses
}

/// Adds the names in a number: a name itself, or those of a formula.
fn add_names(study: &Tree, tree: &Tree, uses: &mut Vec<String>) {
    for text in texts(Some(tree)) {
        let is_name = ["dimensions", "constants", "formulas"]
            .iter()
            .any(|section| study.get(section).and_then(|of| of.get(text)).is_some());
        let names = match is_name {
            true => vec![text.to_owned()],
            // A formula that cannot be read is reported where it is read.
            false => Formula::parse(text).map_or_else(|_| Vec::new(), |formula| names(&formula)),
        };
        uses.extend(names);
    }
}

/// Names that a formula uses.
pub(super) fn names(formula: &Formula) -> Vec<String> {
    formula.names().map(|(name, _)| name.to_owned()).collect()
}

/// A text, or the texts of a list.
fn texts(tree: Option<&Tree>) -> Vec<&str> {
    match tree.map(|tree| &tree.value) {
        Some(Value::Text(text)) => vec![text],
        Some(Value::Array(items)) => items.iter().flat_map(|item| texts(Some(item))).collect(),
        _ => Vec::new(),
    }
}
