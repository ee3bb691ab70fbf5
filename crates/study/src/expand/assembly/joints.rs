//! Reads `[joints]`: which features a joint connects, and how many freedoms it takes.

use super::values::{Measures, Values};
use super::{feature, unknown_key};
use crate::error::{Fault, StudyFault, fault};
use crate::expand::{Tree, Value, wrong_type};
use crate::tree::Key;
use sensitol_numeric::names::nearest;
use sensitol_spatial::{Assembly, FeatureId, JointKind, PartJoint, Quantity};

/// Keys that name the two features of a joint, one of each.
const PAIRS: [(&str, &str, JointKind); 6] = [
    ("on", "against", JointKind::Contact),
    ("hole", "pin", JointKind::Pin),
    ("slot", "pin", JointKind::Slot),
    ("ball", "socket", JointKind::Ball),
    ("hole", "ball", JointKind::BallInHole),
    ("inside", "outside", JointKind::Round),
];
/// Keys with a list of the two features.
const LISTS: [(&str, JointKind); 8] = [
    ("outside", JointKind::Round),
    ("crossed", JointKind::Crossed),
    ("revolute", JointKind::Revolute),
    ("slide", JointKind::Slide),
    ("rigid", JointKind::Rigid),
    ("rod", JointKind::Rod),
    ("angle", JointKind::Angle),
    // An earlier name of `rigid`, which is read and not offered.
    (EARLIER, JointKind::Rigid),
];
/// Earlier name of `rigid`.
const EARLIER: &str = "fixed";

/// Features of a joint and its kind.
struct Connection {
    kind: JointKind,
    between: [FeatureId; 2],
    keys: Vec<&'static str>,
    side_by_side: bool,
}

/// Reads a joint.
pub(super) fn joint(key: &Key, tree: &Tree, assembly: &Assembly, values: &mut Values<'_>) -> Result<PartJoint, Fault> {
    let path = format!("joints.{}", key.name);
    if !matches!(tree.value, Value::Table(_)) {
        return Err(wrong_type(tree, path, "a joint such as { on = \"base.top\", against = \"block.bottom\" }"));
    }
    if super::press::presses(tree) {
        return super::press::joint(key, tree, assembly);
    }
    let connection = connection(key, tree, &path, assembly)?;
    let own: &[&str] = match connection.kind {
        JointKind::Contact | JointKind::Round | JointKind::Crossed | JointKind::Slot => &["takes", "gap"],
        JointKind::Pin => &["takes", "offset", "tilt"],
        JointKind::BallInHole => &["takes", "offset"],
        JointKind::Rod => &["length"],
        JointKind::Angle => &["value"],
        JointKind::Ball | JointKind::Revolute | JointKind::Slide | JointKind::Rigid => &["takes"],
    };
    let valid: Vec<&str> = connection.keys.iter().chain(own).copied().collect();
    unknown_key(tree, &path, &valid)?;
    let takes = match tree.get("takes") {
        None => None,
        Some(Tree { value: Value::Integer(takes), .. }) if (1..=6).contains(takes) => Some(*takes as usize),
        Some(other) => return Err(wrong_type(other, format!("{path}.takes"), "a number of freedoms from 1 to 6")),
    };
    let (name, measures) = match connection.kind {
        JointKind::Rod => ("length", Measures::Length),
        JointKind::Angle => ("value", Measures::Angle),
        _ => ("gap", Measures::Length),
    };
    let value = match tree.get(name) {
        Some(given) => Some(values.quantity(given, &format!("{path}.{name}"), measures)?),
        None if name != "gap" => {
            let instead = match connection.kind {
                JointKind::Rod => "write the length of the rod: length = \"L\"".to_owned(),
                _ => "write the angle: value = \"th\", or a number in degrees".to_owned(),
            };
            return Err(fault(key.span.clone(), path, StudyFault::MissingKey { key: name.into(), instead }));
        }
        None => None,
    };
    let mut two = |name: &str, measures: Measures| -> Result<Option<[Quantity; 2]>, Fault> {
        tree.get(name).map(|given| values.list(given, &format!("{path}.{name}"), measures)).transpose()
    };
    let (offset, tilt) = (two("offset", Measures::Length)?, two("tilt", Measures::Plain)?);
    Ok(PartJoint {
        name: key.name.clone(),
        kind: connection.kind,
        between: connection.between,
        takes,
        value,
        offset,
        tilt,
        side_by_side: connection.side_by_side,
        press: None,
    })
}

/// Kind of a joint by its keys, and its features.
fn connection(key: &Key, tree: &Tree, path: &str, assembly: &Assembly) -> Result<Connection, Fault> {
    for (a, b, kind) in PAIRS {
        if let (Some(first), Some(second)) = (tree.get(a), tree.get(b)) {
            let between =
                [feature(first, &format!("{path}.{a}"), assembly)?, feature(second, &format!("{path}.{b}"), assembly)?];
            return Ok(Connection { kind, between, keys: vec![a, b], side_by_side: false });
        }
    }
    for (list, kind) in LISTS {
        let Some(given) = tree.get(list) else { continue };
        let Value::Array(items) = &given.value else { continue };
        let [first, second] = &items[..] else {
            return Err(wrong_type(given, format!("{path}.{list}"), "a list of two features"));
        };
        let between = [
            feature(first, &format!("{path}.{list}"), assembly)?,
            feature(second, &format!("{path}.{list}"), assembly)?,
        ];
        return Ok(Connection { kind, between, keys: vec![list], side_by_side: list == "outside" });
    }
    let known: Vec<&str> =
        PAIRS.iter().flat_map(|(a, b, _)| [*a, *b]).chain(LISTS.iter().map(|(list, _)| *list)).collect();
    let known: Vec<&str> = known.into_iter().filter(|name| *name != EARLIER).collect();
    // One key of a pair needs the other.
    for (a, b, _) in PAIRS {
        for (have, lacks) in [(a, b), (b, a)] {
            if tree.get(have).is_some() {
                let instead = format!("`{have}` needs the other feature: {lacks} = \"part.feature\"");
                return Err(fault(
                    key.span.clone(),
                    path.to_owned(),
                    StudyFault::MissingKey { key: lacks.into(), instead },
                ));
            }
        }
    }
    if let Some((list, _)) = LISTS.iter().find(|(list, _)| tree.get(list).is_some()) {
        return Err(wrong_type(tree.get(list).unwrap_or(tree), format!("{path}.{list}"), "a list of two features"));
    }
    let found = tree.entries().first().map_or(String::new(), |(key, _)| key.name.clone());
    let nearest = nearest(&found, known.iter().copied()).map(str::to_owned);
    let mut known: Vec<String> = known.into_iter().map(str::to_owned).collect();
    known.sort_unstable();
    known.dedup();
    Err(fault(key.span.clone(), path.to_owned(), StudyFault::UnknownWord { what: "joint with", found, nearest, known }))
}
