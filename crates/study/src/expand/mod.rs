//! The short forms of a study, in the keys that everything below knows: dimensions, constants and formulas.
//!
//! The expansion is of the file's tree, before its types are read. The study that is read is therefore just what `expanded`
//! writes, and no analysis knows of the short form.

mod configurations;
mod from;
mod geometry;
mod joint;
mod processes;
mod toml;

use std::ops::Range;

use super::data::Data;
use super::error::{Fault, Faults, StudyFault, fault};
use super::tree::{Key, Tree, Value};
use sensitol::assembly::formula::is_plain;

/// A study in plain keys.
pub(super) struct Expanded {
    pub(super) tree: Tree,
    /// The names of its configurations, in the order of the file.
    pub(super) configurations: Vec<String>,
    /// For every entry that an element declares, section and name, with the key of the element and its place.
    pub(super) origins: Vec<Origin>,
    /// Things to know of its geometric elements.
    pub(super) elements: Elements,
}

/// Things to know of geometric elements beside their plain lines.
#[derive(Default)]
pub(super) struct Elements {
    /// Formulas of which the study need not use all.
    pub(super) made: Vec<String>,
    /// Sizes whose bands can close the clearance.
    pub(super) closing: Vec<Closing>,
}

/// A hole and a pin that may be larger.
pub(super) struct Closing {
    pub(super) element: String,
    /// Diameters as formulas.
    pub(super) hole: String,
    pub(super) pin: String,
}

/// Where an entry comes from.
pub(super) struct Origin {
    section: &'static str,
    name: String,
    /// The key of the element.
    key: String,
    span: Range<usize>,
}

/// A study in plain keys, with the nominal values and constants of a configuration where one is asked for.
pub(super) fn expand(tree: Tree, configuration: Option<&str>, data: &mut Data<'_>) -> Result<Expanded, Faults> {
    let mut expanded =
        Expanded { tree, configurations: Vec::new(), origins: Vec::new(), elements: Elements::default() };
    configurations::expand(&mut expanded, configuration, data)?;
    processes::expand(&mut expanded, data)?;
    geometry::fasteners(&mut expanded)?;
    joint::expand(&mut expanded);
    from::expand(&mut expanded)?;
    geometry::expand(&mut expanded)?;
    // The blocks of elements.
    joint::expand(&mut expanded);
    Ok(expanded)
}

impl Expanded {
    /// The study as TOML, every entry that an element declares with its origin in `text` as comment.
    pub(super) fn toml(&self, text: &str) -> String {
        toml::written(&self.tree, &self.origins, text)
    }
}

impl Tree {
    /// The entries of a table; none of anything else.
    fn entries(&self) -> &[(Key, Self)] {
        match &self.value {
            Value::Table(entries) => entries,
            _ => &[],
        }
    }

    fn entries_mut(&mut self) -> Option<&mut Vec<(Key, Self)>> {
        match &mut self.value {
            Value::Table(entries) => Some(entries),
            _ => None,
        }
    }

    fn get(&self, name: &str) -> Option<&Self> {
        self.entries().iter().find(|(key, _)| key.name == name).map(|(_, value)| value)
    }

    fn get_mut(&mut self, name: &str) -> Option<&mut Self> {
        self.entries_mut()?.iter_mut().find(|(key, _)| key.name == name).map(|(_, value)| value)
    }

    /// The table of this name, made where there is none.
    fn section(&mut self, name: &str) -> Option<&mut Vec<(Key, Self)>> {
        let entries = self.entries_mut()?;
        let place = entries.iter().position(|(key, _)| key.name == name).unwrap_or_else(|| {
            let table = Self { span: 0..0, value: Value::Table(Vec::new()) };
            entries.push((Key { span: 0..0, name: name.to_owned() }, table));
            entries.len() - 1
        });
        entries[place].1.entries_mut()
    }
}

/// The ending of the name of a relative dimension's own part.
const OWN: &str = ".own";

/// A name as a formula writes it.
fn quoted(name: &str) -> String {
    if is_plain(name) { name.to_owned() } else { format!("`{name}`") }
}

/// A fault of a value that is of another kind.
fn wrong_type(tree: &Tree, key: String, expected: &str) -> Fault {
    let found = match &tree.value {
        Value::Table(_) => "a table".to_owned(),
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Text(text) => format!("the text \"{text}\""),
        Value::Number(number) => format!("the number {number}"),
        Value::Integer(number) => format!("the number {number}"),
        Value::Truth(truth) => format!("`{truth}`"),
        Value::Other(what) => (*what).to_owned(),
    };
    fault(tree.span.clone(), key, StudyFault::WrongType { expected: expected.to_owned(), found })
}
