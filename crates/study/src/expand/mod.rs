//! Expands the short forms of a study into plain dimensions, constants and formulas.
//!
//! The expansion changes the tree of the file before it is read into types. The study that is read is therefore exactly the one that
//! `expanded` writes, and no analysis needs to handle a short form.

mod assembly;
mod configurations;
mod from;
mod general;
mod geometry;
mod groups;
mod joint_entry;
mod matrix;
mod processes;
mod sides;
mod toml;

use std::ops::Range;

use crate::data::Data;
use crate::error::{Fault, Faults, StudyFault, fault};
use crate::scene::{OpenZone, SpatialFacts};
use crate::tree::{Key, Tree, Value};
pub(super) use assembly::NominalValues;
use assembly::WrittenAssembly;
use sensitol::assembly::formula::is_plain;
use sensitol::assembly::implicit::EquationSubject;

/// A study with plain keys only.
pub(super) struct Expanded {
    pub(super) tree: Tree,
    /// Names of the configurations, in the order of the file.
    pub(super) configurations: Vec<String>,
    /// Origins of all entries that a geometric element declares.
    pub(super) origins: Vec<Origin>,
    /// Facts about the geometric elements that the plain lines do not hold.
    pub(super) elements: Elements,
    /// Mobility and poses of an assembly in space; None if the study has none.
    pub(super) spatial: Option<SpatialFacts>,
    /// Zones of features in space whose datums leave something free that they bound.
    open_zones: Vec<OpenZone>,
    /// Zones with a cost.
    pub(super) zones: Vec<ZonePlace>,
    /// Zones without a cost whose dimensions follow their widths.
    pub(super) free_zones: Vec<ZoneMembers>,
    /// Dimensions without a tolerance to which a general one would apply, with half of it. Empty if the study has general tolerances.
    general: Vec<(String, f64)>,
}

/// Facts about geometric elements and joints that their plain lines do not hold.
#[derive(Default)]
pub(super) struct Elements {
    /// Names of formulas that the study need not use.
    pub(super) made: Vec<String>,
    /// Pairs of sizes whose bands overlap, so that the clearance may be 0.
    pub(super) closing: Vec<Closing>,
    /// Joints of rigid parts, by the names of their equations.
    pub(super) subjects: Vec<(String, EquationSubject)>,
}

/// Place of a zone in the study.
#[derive(Debug, Clone)]
pub(super) struct ZonePlace {
    /// Line of `[costs]` that names it.
    pub(super) cost: String,
    /// Keys below `parts` that lead to its width.
    pub(super) path: Vec<String>,
}

impl ZonePlace {
    /// Full name of the zone, such as `housing.bore.position`.
    pub(super) fn name(&self) -> String {
        let keys = self.path.iter().filter(|key| *key != "patterns");
        keys.map(String::as_str).collect::<Vec<_>>().join(".")
    }
}

/// Zone whose dimensions follow one width.
pub(super) struct ZoneMembers {
    pub(super) place: ZonePlace,
    /// Names of the dimensions, with their half bands per half width.
    pub(super) members: Vec<(String, f64)>,
    /// Full name of the zone that this one refines; None if it refines none.
    pub(super) within: Option<String>,
}

/// A hole with a pin that may be larger than it.
pub(super) struct Closing {
    pub(super) element: String,
    /// Diameter of the hole, as a formula.
    pub(super) hole: String,
    pub(super) pin: String,
}

/// Origin of an entry: the key of its element with its place.
pub(super) struct Origin {
    section: &'static str,
    name: String,
    key: String,
    span: Range<usize>,
}

/// Expands a study. Sets the nominal values and constants of `configuration` if one is given. `nominal` evaluates a study at its nominal
/// dimensions.
pub(super) fn expand(
    tree: Tree,
    configuration: Option<&str>,
    data: &mut Data<'_>,
    nominal: NominalValues<'_>,
) -> Result<Expanded, Faults> {
    let mut expanded = Expanded {
        tree,
        configurations: Vec::new(),
        origins: Vec::new(),
        elements: Elements::default(),
        spatial: None,
        open_zones: Vec::new(),
        zones: Vec::new(),
        free_zones: Vec::new(),
        general: Vec::new(),
    };
    configurations::expand(&mut expanded, configuration, data)?;
    processes::expand(&mut expanded, data)?;
    sides::expand(&mut expanded)?;
    expanded.general = general::applicable(&expanded.tree);
    general::expand(&mut expanded)?;
    groups::expand(&mut expanded)?;
    assembly::face_points::expand(&mut expanded)?;
    let written = WrittenAssembly::of(&expanded.tree);
    let owners = assembly::zones::expand(&mut expanded)?;
    geometry::fasteners(&mut expanded)?;
    crate::expand::joint_entry::expand(&mut expanded);
    from::expand(&mut expanded)?;
    match owners {
        None => geometry::expand(&mut expanded)?,
        Some(owners) => {
            geometry::expand(&mut expanded).map_err(|faults| owners.renamed(faults))?;
            owners.rename_origins(&mut expanded);
        }
    }
    // A second time, for the blocks that geometric elements have added.
    crate::expand::joint_entry::expand(&mut expanded);
    assembly::expand(&mut expanded, written, nominal)?;
    matrix::expand(&mut expanded, data)?;
    Ok(expanded)
}

impl Expanded {
    /// Text of the study as TOML. An entry from an element has its origin in `text` as comment.
    pub(super) fn toml(&self, text: &str) -> String {
        toml::written(&self.tree, &self.origins, text)
    }
}

impl Tree {
    /// Entries of a table. Returns an empty list for other values.
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

    /// Table of this name, which is added if there is none. Returns None if the value is not a table.
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

/// Ending of the name of the own part of a relative dimension.
const OWN: &str = ".own";

/// Name in the form that formulas need, in backquotes if it is not plain.
fn quoted(name: &str) -> String {
    if is_plain(name) { name.to_owned() } else { format!("`{name}`") }
}

/// Fault of a value of the wrong kind.
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
