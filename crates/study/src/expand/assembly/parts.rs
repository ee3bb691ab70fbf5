//! Reads `[parts.NAME]`: the pose of a part at the start, and its features.

use super::unknown_key;
use super::values::{Measures, Values};
use super::zones::frame::word;
use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Tree, Value, wrong_type};
use crate::tree::Key;
use sensitol_spatial::{Direction, Feature, FeatureKind, Quantity, RigidPart};

/// The kinds of features: the key of the place, and the key of the direction.
const KINDS: [(&str, &str, FeatureKind); 4] = [
    ("plane", "normal", FeatureKind::Plane),
    ("axis", "along", FeatureKind::Axis),
    ("point", "", FeatureKind::Point),
    ("frame", "z", FeatureKind::Frame),
];

/// Reads a part.
pub(super) fn part(key: &Key, tree: &Tree, values: &mut Values<'_>) -> Result<RigidPart, Faults> {
    let path = format!("parts.{}", key.name);
    let Value::Table(entries) = &tree.value else {
        return Err(
            wrong_type(tree, path, "a table of features such as top = { plane = [0, 0, 10], normal = \"z\" }").into()
        );
    };
    let mut faults = Faults::default();
    if key.name.contains('.') || key.name.contains('`') {
        let why = wrong_type(tree, path.clone(), "a part whose name has no `.` and no backquote");
        faults.0.push(Fault { span: Some(key.span.clone()), ..why });
    }
    let mut part =
        RigidPart { name: key.name.clone(), ground: false, at: [0.0; 3], turned: [0.0; 3], features: Vec::new() };
    for (name, value) in entries {
        let path = format!("{path}.{}", name.name);
        let read = match name.name.as_str() {
            "ground" => match value.value {
                Value::Truth(ground) => {
                    part.ground = ground;
                    Ok(())
                }
                _ => Err(wrong_type(value, path, "`true` or `false`")),
            },
            "at" => place(value, &path, values.length_factor()).map(|at| part.at = at),
            "turned" => place(value, &path, std::f64::consts::PI / 180.0).map(|turned| part.turned = turned),
            _ => feature(name, value, &path, values).map(|feature| part.features.push(feature)),
        };
        faults.0.extend(read.err());
    }
    faults.none()?;
    Ok(part)
}

/// Three numbers at which the search starts.
fn place(tree: &Tree, key: &str, factor: f64) -> Result<[f64; 3], Fault> {
    let expected = "a list of three numbers";
    let Value::Array(items) = &tree.value else { return Err(wrong_type(tree, key.to_owned(), expected)) };
    let mut found = Vec::new();
    for item in items {
        match item.value {
            Value::Number(value) if value.is_finite() => found.push(value * factor),
            Value::Integer(value) => found.push(value as f64 * factor),
            _ => return Err(wrong_type(item, key.to_owned(), "a number, at which the search starts")),
        }
    }
    found.try_into().map_err(|_| wrong_type(tree, key.to_owned(), expected))
}

/// Reads a feature.
fn feature(key: &Key, tree: &Tree, path: &str, values: &mut Values<'_>) -> Result<Feature, Fault> {
    if !matches!(tree.value, Value::Table(_)) {
        return Err(wrong_type(tree, path.to_owned(), "a feature such as { axis = [0, 0, 50], along = \"x\" }"));
    }
    if key.name.contains('.') || key.name.contains('`') {
        return Err(wrong_type(tree, path.to_owned(), "a feature whose name has no `.` and no backquote"));
    }
    let given: Vec<&(&str, &str, FeatureKind)> = KINDS.iter().filter(|(kind, ..)| tree.get(kind).is_some()).collect();
    let (kind_key, direction_key, kind) = match given[..] {
        [only] => *only,
        [(a, ..), (b, ..), ..] => {
            let why = "are two kinds of feature: write a feature of its own for each".to_owned();
            return Err(fault(key.span.clone(), path.to_owned(), StudyFault::Conflict { a, b, why }));
        }
        [] => {
            let instead =
                "a feature is a plane, an axis, a point or a frame: { plane = [0, 0, 10], normal = \"z\" }".to_owned();
            let missing = StudyFault::MissingKey { key: "plane".into(), instead };
            return Err(fault(key.span.clone(), path.to_owned(), missing));
        }
    };
    let valid: &[&str] = match kind {
        FeatureKind::Plane => &["plane", "normal", "x", "shift", "tilt", "targets"],
        FeatureKind::Axis => &["axis", "along", "x", "diameter", "shift", "tilt"],
        FeatureKind::Point => &["point", "diameter", "shift"],
        FeatureKind::Frame => &["frame", "z", "x", "shift", "tilt"],
    };
    // Zones and targets are replaced before the feature is read: their keys stand here for suggestions.
    let valid: Vec<&str> = valid.iter().copied().chain(super::zones::keys(kind)).collect();
    unknown_key(tree, path, &valid)?;
    let at = |name: &str| format!("{path}.{name}");
    let z = match tree.get(direction_key) {
        Some(given) => direction(given, &at(direction_key), values)?,
        None if kind == FeatureKind::Point => axis(2),
        None => {
            let instead = format!("write the direction of the {kind_key}, such as {direction_key} = \"z\"");
            let missing = StudyFault::MissingKey { key: direction_key.into(), instead };
            return Err(fault(key.span.clone(), path.to_owned(), missing));
        }
    };
    let origin = tree.get(kind_key).map(|place| values.list(place, &at(kind_key), Measures::Length));
    let mut optional = |name: &str, measures: Measures| -> Result<Option<[Quantity; 3]>, Fault> {
        tree.get(name).map(|given| values.list(given, &at(name), measures)).transpose()
    };
    let (shift, tilt) = (optional("shift", Measures::Length)?, optional("tilt", Measures::Plain)?);
    let diameter = tree.get("diameter").map(|given| values.quantity(given, &at("diameter"), Measures::Length));
    Ok(Feature {
        name: key.name.clone(),
        kind,
        origin: origin.transpose()?.unwrap_or([0.0; 3].map(Quantity::constant)),
        z,
        x: tree.get("x").map(|given| direction(given, &at("x"), values)).transpose()?,
        diameter: diameter.transpose()?,
        shift,
        tilt,
    })
}

/// Direction along an axis of the part.
fn axis(index: usize) -> Direction {
    Direction::Along([0, 1, 2].map(|i| Quantity::constant(f64::from(u8::from(i == index)))))
}

/// Reads a direction: a word, a vector, or a direction that is turned.
fn direction(tree: &Tree, key: &str, values: &mut Values<'_>) -> Result<Direction, Fault> {
    let expected = "a direction such as \"x\", \"-z\", [1, 1, 0] or { turned = \"th\", about = \"y\", from = \"z\" }";
    let refused = || wrong_type(tree, key.to_owned(), expected);
    match &tree.value {
        Value::Text(text) => {
            word(text).map(|parts| Direction::Along(parts.map(Quantity::constant))).ok_or_else(refused)
        }
        Value::Array(_) => {
            let parts: [Quantity; 3] = values.list(tree, key, Measures::Plain)?;
            if parts.iter().all(|part| part.formula.is_none() && part.value == 0.0) {
                return Err(wrong_type(tree, key.to_owned(), "a direction that is not [0, 0, 0]"));
            }
            Ok(Direction::Along(parts))
        }
        Value::Table(_) => {
            unknown_key(tree, key, &["turned", "about", "from"])?;
            let constant = |name: &str| match tree.get(name).map(|tree| &tree.value) {
                Some(Value::Text(text)) => word(text).ok_or_else(refused),
                _ => Err(refused()),
            };
            let angle = tree.get("turned").ok_or_else(refused)?;
            let angle = values.quantity(angle, &format!("{key}.turned"), Measures::Angle)?;
            Ok(Direction::Turned { angle, about: constant("about")?, from: constant("from")? })
        }
        _ => Err(refused()),
    }
}

/// All numbers of a feature.
pub(super) fn quantities(feature: &mut Feature) -> impl Iterator<Item = &mut Quantity> {
    fn of_direction(direction: &mut Direction) -> &mut [Quantity] {
        match direction {
            Direction::Along(parts) => parts,
            Direction::Turned { angle, .. } => std::slice::from_mut(angle),
        }
    }
    (feature.origin.iter_mut())
        .chain(of_direction(&mut feature.z))
        .chain(feature.x.iter_mut().flat_map(of_direction))
        .chain(&mut feature.diameter)
        .chain(feature.shift.iter_mut().flatten())
        .chain(feature.tilt.iter_mut().flatten())
}
