//! Expands geometric tolerances: a feature control frame becomes dimensions, formulas and blocks.
//!
//! | line | plain lines |
//! |---|---|
//! | position with a bonus | coordinates on a zone of radius 1, times half the zone that the size leaves |
//! | float | likewise, with the radial clearance |
//! | pin and slot | a float in the hole, one across the slot, and the rotation of both |
//! | profile, orientation, form, eccentricity, symmetry | a band or a circular zone |
//!
//! A line with a fault is left out. The faults of all lines are reported together.

mod fastener;
mod float;
mod line;
mod plain;
mod position;
mod size;
mod zones;

pub(super) use line::place;

use crate::error::{Fault, Faults, StudyFault};
use crate::expand::{Expanded, Origin, Tree, Value};
use crate::tree::Key;
use line::Line;
use plain::Plain;
use sensitol_numeric::labels::LABELS;

/// Names that a line of `[dimensions]` declares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// A number.
    Scalar,
    /// `NAME_x` and `NAME_y`.
    Planar,
    /// `NAME_x`, `NAME_y` and `NAME_rot`.
    Located,
}

impl Shape {
    /// Endings of the declared names.
    pub(super) fn axes(self) -> &'static [&'static str] {
        match self {
            Self::Scalar => &[""],
            Self::Planar => &["_x", "_y"],
            Self::Located => &["_x", "_y", "_rot"],
        }
    }
}

/// Kind of geometric element, given by a key of the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Element {
    Position,
    Float,
    Locate,
    Profile,
    Orientation,
    Form,
    Eccentricity,
    Symmetry,
}

const ELEMENTS: [(&str, Element); 16] = [
    ("position", Element::Position),
    ("float", Element::Float),
    ("locate", Element::Locate),
    ("profile", Element::Profile),
    ("perpendicularity", Element::Orientation),
    ("parallelism", Element::Orientation),
    ("angularity", Element::Orientation),
    ("flatness", Element::Form),
    ("straightness", Element::Form),
    ("roundness", Element::Form),
    ("cylindricity", Element::Form),
    ("runout", Element::Eccentricity),
    ("total_runout", Element::Eccentricity),
    ("coaxiality", Element::Eccentricity),
    ("concentricity", Element::Eccentricity),
    ("symmetry", Element::Symmetry),
];

/// Further keys of elements: the key, the elements that it applies to, and the text to write if it stands elsewhere.
const MORE: [(&str, &[Element], &str); 3] = [
    ("length", &[Element::Profile, Element::Orientation], "it belongs to a profile or an orientation"),
    ("axis", &[Element::Orientation], "it belongs to perpendicularity, parallelism or angularity"),
    ("side", &[Element::Form], "it belongs to flatness, straightness, roundness or cylindricity"),
];

/// Elements of a line, in the order of [`ELEMENTS`].
fn elements(entry: &Tree) -> impl Iterator<Item = (&'static str, Element)> + '_ {
    ELEMENTS.iter().filter(|(key, _)| entry.get(key).is_some()).copied()
}

/// Shape of a line of `[dimensions]`.
pub(super) fn shape(entry: &Tree) -> Shape {
    let is = |tree: Option<&Tree>, words: &[&str]| match tree.map(|tree| &tree.value) {
        Some(Value::Text(text)) => words.contains(&text.as_str()),
        _ => false,
    };
    match elements(entry).next() {
        Some((_, Element::Position | Element::Eccentricity)) => Shape::Planar,
        Some((_, Element::Locate)) => Shape::Located,
        Some((key, Element::Float)) => {
            let law = entry.get(key).and_then(|float| float.get("law"));
            if is(law, &["disc", "rim"]) { Shape::Planar } else { Shape::Scalar }
        }
        Some((_, Element::Orientation)) => match entry.get("axis").map(|axis| &axis.value) {
            Some(Value::Truth(true)) => Shape::Planar,
            _ => Shape::Scalar,
        },
        _ => Shape::Scalar,
    }
}

/// True if a line can be measured from another. Play is between two sizes and has no nominal place.
pub(super) fn takes_from(entry: &Tree) -> bool {
    elements(entry).all(|(_, element)| !matches!(element, Element::Float | Element::Locate))
}

/// Writes the formulas of fasteners. They are characteristics of places that are not expanded yet.
pub(super) fn fasteners(expanded: &mut Expanded) -> Result<(), Faults> {
    fastener::expand(expanded)
}

/// Replaces every element by plain lines.
pub(super) fn expand(expanded: &mut Expanded) -> Result<(), Faults> {
    let study = expanded.tree.clone();
    let mut faults = Faults::default();
    let (mut dimensions, mut formulas) = (Vec::new(), Vec::new());
    let (mut blocks, mut products, mut closing) = (Vec::new(), Vec::new(), Vec::new());
    let mut origins = Vec::new();
    let Some(lines) = study.get("dimensions").filter(|section| matches!(section.value, Value::Table(_))) else {
        return Ok(());
    };
    for (name, entry) in lines.entries() {
        let line = Line { study: &study, key: name, entry };
        let made = match plain(&line) {
            Ok(Some(made)) => made,
            Ok(None) => {
                dimensions.push((name.clone(), entry.clone()));
                continue;
            }
            Err(found) => {
                faults.0.push(found);
                continue;
            }
        };
        let key = format!("dimensions.{}", line.shown());
        let mut origin = |section: &'static str, name: &str| {
            let (name, key, span) = (name.to_owned(), key.clone(), line.key.span.clone());
            origins.push(Origin { section, name, key, span });
        };
        made.dimensions.iter().for_each(|(key, _)| origin("dimensions", &key.name));
        made.formulas.iter().for_each(|(key, _)| origin("formulas", &key.name));
        dimensions.extend(made.dimensions.into_iter().map(|(key, made)| (key, labelled(made, entry))));
        formulas.extend(made.formulas);
        blocks.extend(made.blocks);
        products.extend(made.products);
        closing.extend(made.closing);
    }
    faults.none()?;
    if origins.is_empty() {
        return Ok(());
    }
    if let Some(section) = expanded.tree.section("dimensions") {
        *section = dimensions;
    }
    expanded.elements.closing.extend(closing);
    expanded.elements.made.extend(formulas.iter().map(|(key, _)| key.name.clone()));
    if !formulas.is_empty()
        && let Some(section) = expanded.tree.section("formulas")
    {
        section.extend(formulas);
    }
    add_blocks(&mut expanded.tree, blocks);
    add_products(&mut expanded.tree, products);
    expanded.origins.extend(origins);
    Ok(())
}

/// Adds the texts of a line to a dimension made from it.
fn labelled(mut made: Tree, line: &Tree) -> Tree {
    let missing = |(key, _): &&(Key, Tree)| LABELS.contains(&key.name.as_str()) && made.get(&key.name).is_none();
    let labels: Vec<(Key, Tree)> = line.entries().iter().filter(missing).cloned().collect();
    made.entries_mut().into_iter().for_each(|keys| keys.extend(labels.iter().cloned()));
    made
}

/// Adds blocks of elements behind those of the study.
pub(super) fn add_blocks(tree: &mut Tree, blocks: Vec<Tree>) {
    if blocks.is_empty() {
        return;
    }
    match tree.get_mut("joint").map(|list| &mut list.value) {
        Some(Value::Array(list)) => list.extend(blocks),
        // Another value is a fault that is reported where it is read.
        Some(_) => {}
        None => {
            let list = Tree { span: 0..0, value: Value::Array(blocks) };
            let key = Key { span: 0..0, name: "joint".to_owned() };
            tree.entries_mut().into_iter().for_each(|entries| entries.push((key.clone(), list.clone())));
        }
    }
}

/// Adds pairs with known products behind those that the study names.
fn add_products(tree: &mut Tree, products: Vec<Tree>) {
    if products.is_empty() {
        return;
    }
    let Some(section) = tree.section("analysis") else { return };
    match section.iter_mut().find(|(key, _)| key.name == "products").map(|(_, list)| &mut list.value) {
        Some(Value::Array(list)) => list.extend(products),
        Some(_) => {}
        None => {
            let list = Tree { span: 0..0, value: Value::Array(products) };
            section.push((Key { span: 0..0, name: "products".to_owned() }, list));
        }
    }
}

/// Plain lines of an element. Returns None if the line is plain already.
fn plain(line: &Line<'_>) -> Result<Option<Plain>, Fault> {
    let mut found = elements(line.entry);
    let first = found.next();
    if let (Some((a, _)), Some((b, _))) = (first, found.next()) {
        let why = "are two elements: write a line of its own for each".to_owned();
        return Err(line.at_key(b, StudyFault::Conflict { a, b, why }));
    }
    for (key, of, instead) in MORE {
        // The key `side` belongs to a form, or to the mean of a process in a plain line.
        let sign = |side: &Tree| matches!(&side.value, Value::Text(text) if text != "out");
        let process = key == "side" && first.is_none() && line.entry.get("side").is_some_and(sign);
        if line.entry.get(key).is_some() && !process && first.is_none_or(|(_, element)| !of.contains(&element)) {
            let to = first.map_or("a dimension".to_owned(), |(key, _)| format!("`{key}`"));
            return Err(line.at_key(key, StudyFault::DoesNotApply { key, to, instead }));
        }
    }
    let Some((key, element)) = first else { return Ok(None) };
    match element {
        Element::Position => position::plain(line),
        Element::Float => float::float(line).map(Some),
        Element::Locate => float::locate(line).map(Some),
        Element::Profile => zones::profile(line).map(Some),
        Element::Orientation => zones::orientation(line, key).map(Some),
        Element::Form => zones::form(line, key).map(Some),
        Element::Eccentricity => zones::eccentricity(line, key).map(Some),
        Element::Symmetry => zones::symmetry(line, key).map(Some),
    }
}
