//! Expands relative dimensions: `x2 = { nominal = 40, tolerance = 0.1, from = "x1" }` is `x1` plus a dimension of its own.

use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::geometry::{Shape, place, shape, takes_from};
use crate::expand::{Expanded, OWN, Origin, Tree, Value, quoted, wrong_type};
use crate::tree::Key;
use sensitol_numeric::names::nearest;
use sensitol_numeric::unit::Unit;

/// A relative dimension, before it is checked.
struct Relative {
    /// Index of the dimension in its section.
    place: usize,
    name: String,
    bases: Vec<(String, std::ops::Range<usize>)>,
    shape: Shape,
}

/// Replaces every relative dimension by a dimension of its own and a formula.
pub(super) fn expand(expanded: &mut Expanded) -> Result<(), Faults> {
    let mut faults = Faults::default();
    let Some(relatives) = relatives(&expanded.tree, &mut faults) else { return faults.none() };
    for relative in &relatives {
        checked(&expanded.tree, relative, &relatives).into_iter().for_each(|found| faults.0.push(found));
    }
    faults.none()?;
    for relative in &relatives {
        replace(expanded, relative);
    }
    Ok(())
}

/// Dimensions with the key `from`. Returns None if the study has no dimensions.
fn relatives(tree: &Tree, faults: &mut Faults) -> Option<Vec<Relative>> {
    let dimensions = tree.get("dimensions")?.entries();
    let mut relatives = Vec::new();
    for (place, (key, entry)) in dimensions.iter().enumerate() {
        let Some(from) = entry.get("from").filter(|_| takes_from(entry)) else { continue };
        let at = format!("dimensions.{}.from", key.name);
        let expected = "the name of a dimension or formula such as \"x1\", or a list of such names";
        let texts: Option<Vec<_>> = match &from.value {
            Value::Text(text) => Some(vec![(text.clone(), from.span.clone())]),
            Value::Array(items) if !items.is_empty() => (items.iter())
                .map(|item| match &item.value {
                    Value::Text(text) => Some((text.clone(), item.span.clone())),
                    _ => None,
                })
                .collect(),
            _ => None,
        };
        match texts {
            Some(bases) => {
                relatives.push(Relative { place, name: key.name.clone(), bases, shape: shape(entry) });
            }
            None => faults.0.push(wrong_type(from, at, expected)),
        }
    }
    (!relatives.is_empty()).then_some(relatives)
}

/// First fault of a relative dimension. Returns None if it has none.
fn checked(tree: &Tree, relative: &Relative, all: &[Relative]) -> Option<Fault> {
    let dimensions = tree.get("dimensions")?.entries();
    let (key, entry) = &dimensions[relative.place];
    let name = &relative.name;
    if !["nominal", "limits", "measured"].iter().any(|known| entry.get(known).is_some()) {
        let instead =
            format!("it is measured from `{}`: write its distance, such as nominal = 40", relative.bases[0].0);
        let missing = StudyFault::MissingKey { key: "nominal".into(), instead };
        return Some(fault(key.span.clone(), format!("dimensions.{name}"), missing));
    }
    let own = format!("{name}{OWN}");
    if ["dimensions", "formulas", "constants"]
        .iter()
        .any(|section| tree.get(section).is_some_and(|of| of.get(&own).is_some()))
    {
        let taken = StudyFault::NameTaken { name: own, by: "another entry" };
        return Some(fault(key.span.clone(), format!("dimensions.{name}"), taken));
    }
    let formulas = tree.get("formulas").map_or(&[][..], Tree::entries);
    let characteristics = tree.get("characteristics").map_or(&[][..], Tree::entries);
    let places = || dimensions.iter().filter(|(_, entry)| shape(entry) != Shape::Scalar);
    let axes = |(key, entry): &(Key, Tree)| {
        shape(entry).axes().iter().map(|axis| format!("{}{axis}", key.name)).collect::<Vec<_>>()
    };
    let mut known: Vec<String> = match relative.shape {
        Shape::Planar | Shape::Located => places().map(|(key, _)| key.name.clone()).collect(),
        Shape::Scalar => (dimensions.iter().filter(|(_, entry)| shape(entry) == Shape::Scalar))
            .chain(formulas)
            .chain(characteristics.iter().filter(|(_, entry)| entry.get("formula").is_some()))
            .map(|(key, _)| key.name.clone())
            .chain(places().flat_map(axes))
            .collect(),
    };
    known.retain(|known| known != name);
    for (base, span) in &relative.bases {
        let at = |found: StudyFault| fault(span.clone(), format!("dimensions.{name}.from"), found);
        if base == name {
            return Some(at(StudyFault::FromCircle { path: vec![name.clone()] }));
        }
        if !known.contains(base) {
            let nearest = nearest(base, known.iter().map(String::as_str)).map(str::to_owned);
            let what = if relative.shape == Shape::Scalar { "dimension or formula" } else { "position" };
            return Some(at(StudyFault::UnknownWord { what, found: base.clone(), nearest, known }));
        }
        if let Some(path) = circle(name, base, all) {
            return Some(at(StudyFault::FromCircle { path }));
        }
    }
    None
}

/// Chain of names from a dimension back to itself. Returns None if there is none.
fn circle(name: &str, base: &str, all: &[Relative]) -> Option<Vec<String>> {
    let mut paths = vec![vec![name.to_owned(), base.to_owned()]];
    while let Some(path) = paths.pop() {
        let last = path.last().expect("a path has an end");
        for (next, _) in all.iter().filter(|other| other.name == *last).flat_map(|other| &other.bases) {
            if next == name {
                return Some(path);
            }
            if !path.contains(next) {
                let mut longer = path.clone();
                longer.push(next.clone());
                paths.push(longer);
            }
        }
    }
    None
}

fn replace(expanded: &mut Expanded, relative: &Relative) {
    let own = format!("{}{OWN}", relative.name);
    let key = format!("dimensions.{}", relative.name);
    let mut span = 0..0;
    let mut from = 0..0;
    let dimensions = expanded.tree.get("dimensions").map_or(&[][..], Tree::entries);
    let located: Vec<String> = (dimensions.iter())
        .filter(|(_, entry)| shape(entry) == Shape::Located)
        .map(|(key, _)| key.name.clone())
        .collect();
    let at = dimensions.get(relative.place).and_then(|(_, entry)| place(entry.get("nominal")?)).unwrap_or([0.0; 2]);
    // The lever of a rotation has the unit of the place. An unknown unit is left out.
    let unit = match dimensions.get(relative.place).and_then(|(_, entry)| entry.get("unit")).map(|unit| &unit.value) {
        Some(Value::Text(unit)) if Unit::parse(unit).is_some() => format!("[{unit}]"),
        _ => String::new(),
    };
    if let Some(dimensions) = expanded.tree.get_mut("dimensions").and_then(Tree::entries_mut) {
        let (name, entry) = &mut dimensions[relative.place];
        span = name.span.clone();
        name.name.clone_from(&own);
        if let Some(keys) = entry.entries_mut() {
            from = keys.iter().find(|(key, _)| key.name == "from").map_or(0..0, |(_, value)| value.span.clone());
            keys.retain(|(key, _)| key.name != "from");
        }
    }
    expanded.origins.push(Origin { section: "dimensions", name: own.clone(), key: key.clone(), span: span.clone() });
    for axis in relative.shape.axes() {
        let name = format!("{}{axis}", relative.name);
        let term = |term: &str| quoted(&format!("{term}{axis}"));
        let of_base = |(base, _): &(String, std::ops::Range<usize>)| match located.contains(base) {
            true => term(base) + &turned(base, axis, at, &unit),
            false => term(base),
        };
        let terms = relative.bases.iter().map(of_base).chain([term(&own)]);
        let text = terms.collect::<Vec<_>>().join(" + ");
        if let Some(formulas) = expanded.tree.section("formulas") {
            let formula = Tree { span: from.clone(), value: Value::Text(text) };
            formulas.push((Key { span: span.clone(), name: name.clone() }, formula));
        }
        if relative.shape != Shape::Scalar {
            expanded.elements.made.push(name.clone());
        }
        expanded.origins.push(Origin { section: "formulas", name, key: key.clone(), span: span.clone() });
    }
    renamed(&mut expanded.tree, &relative.name, &own);
}

/// Renames a relative dimension to its own part in costs, correlations and blocks.
fn renamed(tree: &mut Tree, name: &str, own: &str) {
    if let Some(costs) = tree.get_mut("costs").and_then(Tree::entries_mut) {
        for (key, entry) in costs {
            if key.name == name {
                own.clone_into(&mut key.name);
            }
            entry.get_mut("same_as").into_iter().for_each(|same| text(same, name, own));
        }
    }
    if let Some(Value::Array(pairs)) = tree.get_mut("correlation").map(|list| &mut list.value) {
        pairs.iter_mut().filter_map(|pair| pair.get_mut("between")).for_each(|between| text(between, name, own));
    }
    if let Some(Value::Array(blocks)) = tree.get_mut("joint").map(|list| &mut list.value) {
        blocks.iter_mut().filter_map(|block| block.get_mut("of")).for_each(|of| text(of, name, own));
    }
    if let Some(pairs) = tree.get_mut("analysis").and_then(|analysis| analysis.get_mut("pairs")) {
        text(pairs, name, own);
    }
}

/// Replaces a text, or those in a list.
fn text(tree: &mut Tree, name: &str, own: &str) {
    match &mut tree.value {
        Value::Text(found) if found == name => own.clone_into(found),
        Value::Array(items) => items.iter_mut().for_each(|item| text(item, name, own)),
        _ => {}
    }
}

/// Term that the rotation of a located part adds to a coordinate of a feature at this nominal place.
fn turned(base: &str, axis: &str, [x, y]: [f64; 2], unit: &str) -> String {
    let rotation = quoted(&format!("{base}_rot"));
    // A rotation moves a feature by -y along x, and by x along y.
    let lever = if axis == "_x" { -y } else { x };
    match lever {
        0.0 => String::new(),
        lever if lever < 0.0 => format!(" - {rotation}*{:?}{unit}", -lever),
        lever => format!(" + {rotation}*{lever:?}{unit}"),
    }
}
