//! A line of the study as written, and faults at its places.

use crate::decimal::{KEPT, decimal};
use crate::error::{Fault, StudyFault, fault};
use crate::expand::geometry;
use crate::expand::{OWN, Tree, Value, quoted, wrong_type};
use crate::tree::Key;
use sensitol::assembly::formula::{Formula, is_plain};
use sensitol_numeric::names::nearest;
use sensitol_numeric::unit::Unit;

/// A line of `[dimensions]` with the study around it.
pub(super) struct Line<'t> {
    pub(super) study: &'t Tree,
    pub(super) key: &'t Key,
    pub(super) entry: &'t Tree,
}

/// A table within a line, with its full key.
pub(super) struct Part<'t> {
    path: String,
    tree: &'t Tree,
    /// Unit of its numbers in formulas; None unless units are converted.
    unit: Option<&'t str>,
}

impl<'t> Line<'t> {
    pub(super) fn name(&self) -> &'t str {
        &self.key.name
    }

    /// Name of the line in the study. The ending for the own part of a relative dimension is left out.
    pub(super) fn shown(&self) -> &'t str {
        self.name().strip_suffix(OWN).unwrap_or(self.name())
    }

    fn path(&self, key: &str) -> String {
        format!("dimensions.{}.{key}", self.shown())
    }

    pub(super) fn at_key(&self, key: &str, found: StudyFault) -> Fault {
        let place = self.entry.entries().iter().find(|(known, _)| known.name == key);
        let span = place.map_or(self.key.span.clone(), |(known, _)| known.span.clone());
        fault(span, self.path(key), found)
    }

    /// Value of a key that is known to exist.
    pub(super) fn value(&self, key: &str) -> &'t Tree {
        self.entry.get(key).unwrap_or(self.entry)
    }

    /// Number of a required key that is not negative: a zone or a length.
    pub(super) fn size(&self, key: &str) -> Result<f64, Fault> {
        size(self.value(key), self.path(key))
    }

    /// Value of `length`, which must be above 0. Returns None if it is not given.
    pub(super) fn length(&self) -> Result<Option<f64>, Fault> {
        let Some(tree) = self.entry.get("length") else { return Ok(None) };
        let value = size(tree, self.path("length"))?;
        let range = "above 0";
        if value > 0.0 { Ok(Some(value)) } else { Err(self.at_key("length", StudyFault::OutOfRange { value, range })) }
    }

    /// Table of a key, without other keys than `valid`.
    pub(super) fn table(&self, key: &'static str, valid: &[&str], expected: &str) -> Result<Part<'t>, Fault> {
        let unit = self.converted().then(|| self.unit()).flatten();
        Part::of(self.value(key), self.path(key), valid, expected, unit)
    }

    /// Unit of the line. Returns None if it has none or an unknown one.
    pub(super) fn unit(&self) -> Option<&'t str> {
        unit_of(self.entry)
    }

    /// True if units are converted, so that numbers in formulas need units.
    pub(super) fn converted(&self) -> bool {
        matches!(self.study.get("units").map(|mode| &mode.value), Some(Value::Text(mode)) if mode == "convert")
    }
}

impl<'t> Part<'t> {
    pub(super) fn of(
        tree: &'t Tree,
        path: String,
        valid: &[&str],
        expected: &str,
        unit: Option<&'t str>,
    ) -> Result<Self, Fault> {
        if !matches!(tree.value, Value::Table(_)) {
            return Err(wrong_type(tree, path, expected));
        }
        let part = Self { path, tree, unit };
        match tree.entries().iter().find(|(key, _)| !valid.contains(&key.name.as_str())) {
            None => Ok(part),
            Some((key, _)) => {
                let nearest = nearest(&key.name, valid.iter().copied()).map(str::to_owned);
                let valid = valid.iter().map(|&key| key.to_owned()).collect();
                let unknown = StudyFault::UnknownKey { key: key.name.clone(), nearest, valid };
                Err(fault(key.span.clone(), format!("{}.{}", part.path, key.name), unknown))
            }
        }
    }

    pub(super) fn get(&self, key: &str) -> Option<&'t Tree> {
        self.tree.get(key)
    }

    pub(super) fn at(&self, key: &str, found: StudyFault) -> Fault {
        let span = self.get(key).map_or(self.tree.span.clone(), |tree| tree.span.clone());
        fault(span, format!("{}.{key}", self.path), found)
    }

    /// Fault of the table as a whole.
    pub(super) fn whole(&self, found: StudyFault) -> Fault {
        fault(self.tree.span.clone(), self.path.clone(), found)
    }

    /// Value of a required key.
    pub(super) fn needed(&self, key: &str, instead: &str) -> Result<&'t Tree, Fault> {
        let missing = || self.whole(StudyFault::MissingKey { key: key.to_owned(), instead: instead.to_owned() });
        self.get(key).ok_or_else(missing)
    }

    /// Number that is not negative. Returns None if it is not given.
    pub(super) fn size(&self, key: &str) -> Result<Option<f64>, Fault> {
        self.get(key).map(|tree| size(tree, format!("{}.{key}", self.path))).transpose()
    }

    /// Word out of a list. Returns None if it is not given.
    pub(super) fn word(&self, key: &str, what: &'static str, known: &[&'static str]) -> Result<Option<&'t str>, Fault> {
        let Some(tree) = self.get(key) else { return Ok(None) };
        match &tree.value {
            Value::Text(text) if known.contains(&text.as_str()) => Ok(Some(text)),
            Value::Text(text) => {
                let nearest = nearest(text, known.iter().copied()).map(str::to_owned);
                let known = known.iter().map(|&word| word.to_owned()).collect();
                Err(self.at(key, StudyFault::UnknownWord { what, found: text.clone(), nearest, known }))
            }
            _ => Err(wrong_type(tree, format!("{}.{key}", self.path), "a text in quotes")),
        }
    }

    /// Diameter of a feature in the form that formulas need: a name, a number or a formula.
    pub(super) fn diameter(&self, study: &Tree, key: &str, instead: &str) -> Result<Diameter, Fault> {
        let tree = self.needed(key, instead)?;
        let path = || format!("{}.{key}", self.path);
        match &tree.value {
            Value::Number(_) | Value::Integer(_) => {
                let value = size(tree, path())?;
                Ok(Diameter { text: literal(value, self.unit), formula: number(value) })
            }
            Value::Text(text) if is_plain(text) || names(study).contains(text) => {
                // The outputs of a model are not known here, so any plain name may be one.
                if study.get("model").is_none() && !names(study).contains(text) {
                    let known = names(study);
                    let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
                    let what = "dimension or formula";
                    return Err(self.at(key, StudyFault::UnknownWord { what, found: text.clone(), nearest, known }));
                }
                Ok(Diameter { text: quoted(text), formula: quoted(text) })
            }
            Value::Text(text) => match Formula::parse(text) {
                Ok(_) => Ok(Diameter { text: format!("({text})"), formula: text.clone() }),
                Err(error) => Err(self.at(key, StudyFault::Formula(error.fault))),
            },
            _ => Err(wrong_type(tree, path(), "the name of a dimension such as \"D\", a number, or a formula")),
        }
    }
}

/// Diameter of a feature.
pub(super) struct Diameter {
    /// Text of the diameter as a term of a formula.
    pub(super) text: String,
    /// Text of the diameter as a formula of its own, without units.
    pub(super) formula: String,
}

/// Unit of an entry. Returns None if it has none or an unknown one.
pub(super) fn unit_of(entry: &Tree) -> Option<&str> {
    match entry.get("unit").map(|unit| &unit.value) {
        Some(Value::Text(unit)) => Some(unit.as_str()).filter(|unit| Unit::parse(unit).is_some()),
        _ => None,
    }
}

/// All names that a formula can use, except the outputs of a model.
pub(super) fn names(study: &Tree) -> Vec<String> {
    let of = |section: &str| study.get(section).map_or(&[][..], Tree::entries);
    let dimensions = of("dimensions").iter().flat_map(|(key, entry)| {
        geometry::shape(entry).axes().iter().map(|axis| format!("{}{axis}", key.name)).collect::<Vec<_>>()
    });
    let characteristics = of("characteristics").iter().filter(|(_, entry)| entry.get("formula").is_some());
    (["formulas", "constants", "unknowns"].into_iter().flat_map(of))
        .chain(characteristics)
        .map(|(key, _)| key.name.clone())
        .chain(dimensions)
        .collect()
}

pub(super) fn as_number(tree: &Tree) -> Option<f64> {
    match tree.value {
        Value::Number(value) => Some(value),
        Value::Integer(value) => Some(value as f64),
        _ => None,
    }
}

fn size(tree: &Tree, path: String) -> Result<f64, Fault> {
    match as_number(tree) {
        None => Err(wrong_type(tree, path, "a number")),
        Some(value) if value < 0.0 => {
            Err(fault(tree.span.clone(), path, StudyFault::OutOfRange { value, range: "0 or above" }))
        }
        Some(value) => Ok(value),
    }
}

/// Text of a number in a formula. Rounding errors of sums of decimals are removed.
pub(super) fn number(value: f64) -> String {
    let value = decimal(value, KEPT);
    if value < 0.0 { format!("({value:?})") } else { format!("{value:?}") }
}

/// Text of a number in a formula, with its unit.
pub(super) fn literal(value: f64, unit: Option<&str>) -> String {
    match unit {
        Some(unit) => format!("{}[{unit}]", number(value)),
        None => number(value),
    }
}

/// The two coordinates of a place. Returns None for other values.
pub(in crate::expand) fn place(tree: &Tree) -> Option<[f64; 2]> {
    match &tree.value {
        Value::Array(items) if items.len() == 2 => Some([as_number(&items[0])?, as_number(&items[1])?]),
        _ => None,
    }
}
