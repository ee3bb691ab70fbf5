//! Plain lines that replace a geometric element.

use crate::expand::geometry::plain;
use std::ops::Range;

use crate::expand::geometry::line::Line;
use crate::expand::geometry::{Shape, shape};
use crate::expand::{Closing, Tree, Value};
use crate::tree::Key;

/// Plain lines of one element: dimensions, formulas and blocks.
#[derive(Default)]
pub(super) struct Plain {
    pub(super) dimensions: Vec<(Key, Tree)>,
    pub(super) formulas: Vec<(Key, Tree)>,
    pub(super) blocks: Vec<Tree>,
    /// Pairs of dimensions with known products.
    pub(super) products: Vec<Tree>,
    /// Pairs of sizes whose bands overlap, so that the clearance may be 0.
    pub(super) closing: Vec<Closing>,
}

/// Unit of a dimension or formula of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    /// Unit of the line.
    Line,
    /// Radians if the line has a unit.
    Angle,
    /// A plain number. It has a unit only if all units are converted.
    Plain,
}

impl Plain {
    /// Adds a dimension with these keys.
    pub(super) fn dimension(&mut self, line: &Line<'_>, name: String, of: Of, keys: Vec<(Key, Tree)>) {
        let unit = unit(line, of).map(|unit| ("unit", text(line, unit)));
        let mut keys = keys;
        keys.extend(unit.map(|(key, tree)| (plain::key(line, key), tree)));
        self.dimensions.push((named(line, name), table(line, keys)));
    }

    pub(super) fn formula(&mut self, line: &Line<'_>, name: String, of: Of, formula: String) {
        let formula = text(line, formula);
        let tree = match unit(line, of) {
            None => formula,
            Some(unit) => table(line, vec![(key(line, "formula"), formula), (key(line, "unit"), text(line, unit))]),
        };
        self.formulas.push((named(line, name), tree));
    }

    /// Adds the products of the sizes in a formula and the places on a unit zone. Sizes that are not plain dimensions are left out.
    pub(super) fn product(&mut self, line: &Line<'_>, sizes: &[String], places: &[String]) {
        let dimensions = line.study.get("dimensions");
        let is_dimension = |name: &&String| {
            dimensions.is_some_and(|section| section.get(name).is_some_and(|entry| shape(entry) == Shape::Scalar))
        };
        for size in sizes.iter().filter(is_dimension) {
            let pair = |place: &String| list(line, vec![text(line, size.clone()), text(line, place.clone())]);
            self.products.extend(places.iter().map(pair));
        }
    }

    pub(super) fn block(&mut self, line: &Line<'_>, of: [String; 2], law: &str) {
        let of = list(line, of.into_iter().map(|name| text(line, name)).collect());
        self.blocks.push(table(line, vec![(key(line, "of"), of), (key(line, "law"), text(line, law))]));
    }
}

fn unit(line: &Line<'_>, of: Of) -> Option<String> {
    let written = || match line.entry.get("unit").map(|unit| &unit.value) {
        Some(Value::Text(unit)) => Some(unit.clone()),
        _ => None,
    };
    match of {
        Of::Line => written(),
        Of::Angle => written().map(|_| "rad".to_owned()),
        Of::Plain => written().filter(|_| line.converted()).map(|_| "1".to_owned()),
    }
}

fn span(line: &Line<'_>) -> Range<usize> {
    line.entry.span.clone()
}

fn named(line: &Line<'_>, name: String) -> Key {
    Key { span: line.key.span.clone(), name }
}

pub(super) fn key(line: &Line<'_>, name: &str) -> Key {
    Key { span: span(line), name: name.to_owned() }
}

pub(super) fn text(line: &Line<'_>, text: impl Into<String>) -> Tree {
    Tree { span: span(line), value: Value::Text(text.into()) }
}

pub(super) fn number(line: &Line<'_>, value: f64) -> Tree {
    Tree { span: span(line), value: Value::Number(value) }
}

pub(super) fn list(line: &Line<'_>, items: Vec<Tree>) -> Tree {
    Tree { span: span(line), value: Value::Array(items) }
}

pub(super) fn pair(line: &Line<'_>, values: [f64; 2]) -> Tree {
    list(line, values.map(|value| number(line, value)).to_vec())
}

fn table(line: &Line<'_>, keys: Vec<(Key, Tree)>) -> Tree {
    Tree { span: span(line), value: Value::Table(keys) }
}

/// Keys of a line, without these.
pub(super) fn others(line: &Line<'_>, but: &[&str]) -> Vec<(Key, Tree)> {
    let kept = |(key, _): &&(Key, Tree)| !but.contains(&key.name.as_str());
    line.entry.entries().iter().filter(kept).cloned().collect()
}
