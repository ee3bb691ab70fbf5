//! Reads joints that press a part against contacts: `on`, `targets`, `press` and `weight_at`.

use super::zones::frame::word;
use super::{feature, unknown_key};
use crate::error::{Fault, StudyFault, fault};
use crate::expand::{Tree, Value, wrong_type};
use crate::tree::Key;
use sensitol_spatial::{Assembly, JointKind, PartJoint, Press};

/// Keys of joints that press alone.
const OWN: [&str; 3] = ["press", "weight_at", "targets"];
/// Keys of a joint that presses.
const KEYS: [&str; 4] = ["on", "press", "weight_at", "targets"];
/// Direction of a weight without `press`.
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];

/// True if a joint presses a part against contacts.
pub(super) fn presses(tree: &Tree) -> bool {
    OWN.iter().any(|key| tree.get(key).is_some())
}

/// Reads a joint that presses.
pub(super) fn joint(key: &Key, tree: &Tree, assembly: &Assembly) -> Result<PartJoint, Fault> {
    let path = format!("joints.{}", key.name);
    let at = |name: &str| format!("{path}.{name}");
    // Keys of joints that take freedoms have no meaning beside a force.
    let press = OWN.into_iter().find(|key| tree.get(key).is_some()).unwrap_or("press");
    for (other, why) in [
        (
            "against",
            "are two ways to name what touches: let `against` name a plane with flatness and size, or write the contact points as `targets`",
        ),
        (
            "takes",
            "are two ways to hold a part: a joint that presses takes what its contacts stop, so leave out `takes`",
        ),
        ("gap", "are two ways to hold a part: contacts touch, so leave out `gap`"),
    ] {
        if tree.get(other).is_some() {
            let conflict = StudyFault::Conflict { a: press, b: other, why: why.to_owned() };
            return Err(fault(key.span.clone(), path, conflict));
        }
    }
    unknown_key(tree, &path, &KEYS)?;
    let missing = |name: &str, instead: &str| {
        let missing = StudyFault::MissingKey { key: name.into(), instead: instead.into() };
        fault(key.span.clone(), path.clone(), missing)
    };
    let plane =
        tree.get("on").ok_or_else(|| missing("on", "name the plane that the contacts touch: on = \"floor.top\""))?;
    let plane = feature(plane, &at("on"), assembly)?;
    let expected = "a list of contact points such as [\"table.leg1\", \"table.leg2\", \"table.leg3\"]";
    let given = tree.get("targets").ok_or_else(|| missing("targets", &format!("name {expected}")))?;
    let Value::Array(items) = &given.value else { return Err(wrong_type(given, at("targets"), expected)) };
    let targets = items.iter().map(|item| feature(item, &at("targets"), assembly)).collect::<Result<Vec<_>, _>>()?;
    let Some(&first) = targets.first() else { return Err(wrong_type(given, at("targets"), expected)) };
    let weight = tree.get("weight_at").map(|given| feature(given, &at("weight_at"), assembly)).transpose()?;
    let force = match tree.get("press") {
        Some(given) => force(given, &at("press"))?,
        None if weight.is_some() => DOWN,
        None => return Err(missing("press", "write the direction of the force: press = [0, 0, -1]")),
    };
    Ok(PartJoint {
        name: key.name.clone(),
        kind: JointKind::Contact,
        between: [plane, first],
        takes: None,
        value: None,
        offset: None,
        tilt: None,
        side_by_side: false,
        press: Some(Press { targets, force, weight }),
    })
}

/// Reads the direction of a force in the assembly.
fn force(tree: &Tree, key: &str) -> Result<[f64; 3], Fault> {
    let refused =
        || wrong_type(tree, key.to_owned(), "a direction of numbers in the assembly such as [0, 0, -1] or \"-z\"");
    let parts = match &tree.value {
        Value::Text(text) => word(text).ok_or_else(refused)?,
        Value::Array(items) => {
            let mut parts = Vec::new();
            for item in items {
                parts.push(match item.value {
                    Value::Number(value) => value,
                    Value::Integer(value) => value as f64,
                    _ => return Err(refused()),
                });
            }
            <[f64; 3]>::try_from(parts).map_err(|_| refused())?
        }
        _ => return Err(refused()),
    };
    let length = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return Err(refused());
    }
    Ok(parts.map(|part| part / length))
}
