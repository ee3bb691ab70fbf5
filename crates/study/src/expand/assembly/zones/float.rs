//! Expands floats of joints: where a pin lies in its hole, and the form of faces that touch.

use super::entry::{ZoneKind, ZonedFeature};
use super::frame::{ConstantFrame, constant, dot};
use super::lines::{Extent, LineUnit, Lines, Owner, at, key, text};
use crate::error::{Fault, Faults, StudyFault};
use crate::expand::assembly::press::presses;
use crate::expand::{Expanded, Tree, Value, quoted, wrong_type};
use crate::tree::Key;
use sensitol_numeric::names::nearest;
use sensitol_spatial::FeatureKind;

/// Laws of a float.
const LAWS: [&str; 6] = ["disc", "rim", "uniform", "contact", "+", "-"];
/// Keys of floats, which the joint itself does not have.
const KEYS: [&str; 3] = ["float", "toward", "tilt_float"];

/// Diameters of features that joints use as holes or pins: full name, `hole` or `pin`, and the name of the dimension.
pub(super) fn materials(study: &Tree, features: &[ZonedFeature<'_>]) -> Vec<(String, &'static str, String)> {
    let mut found = Vec::new();
    for (_, joint) in study.get("joints").map_or(&[][..], Tree::entries) {
        for kind in ["hole", "pin"] {
            let Some(Value::Text(name)) = joint.get(kind).map(|tree| &tree.value) else { continue };
            let feature = features.iter().find(|feature| feature.full() == *name);
            if let Some(Value::Text(diameter)) = feature.and_then(|feature| Some(&feature.tree.get("diameter")?.value))
            {
                found.push((name.clone(), kind, diameter.clone()));
            }
        }
    }
    found
}

/// Writes the offsets of joints with a float, and the form of touching faces.
pub(super) fn expand(
    expanded: &mut Expanded,
    study: &Tree,
    features: &[ZonedFeature<'_>],
    lines: &mut Lines,
    faults: &mut Faults,
) {
    for (name, joint) in study.get("joints").map_or(&[][..], Tree::entries) {
        let owner =
            Owner { key: format!("joints.{}", name.name), span: name.span.clone(), note: String::new(), zone: None };
        if KEYS.iter().any(|key| joint.get(key).is_some()) {
            let Some(keys) = faults.take(float(study, name, joint, &owner, features, lines)) else { continue };
            replace(expanded, name, &KEYS, keys);
        } else if joint.get("on").is_some() {
            let Some(Some(gap)) = faults.take(form(joint, features, lines)) else { continue };
            replace(expanded, name, &["gap"], vec![(key(&owner, "gap"), text(&owner, gap))]);
        }
    }
}

/// Replaces keys of a joint.
fn replace(expanded: &mut Expanded, name: &Key, old: &[&str], new: Vec<(Key, Tree)>) {
    let joint = expanded.tree.get_mut("joints").and_then(|joints| joints.get_mut(&name.name));
    if let Some(keys) = joint.and_then(Tree::entries_mut) {
        keys.retain(|(key, _)| !old.contains(&key.name.as_str()));
        keys.extend(new);
    }
}

/// Feature that a key of a joint names. An unknown one is reported where the joint is read.
fn feature<'f, 't>(joint: &Tree, key: &str, features: &'f [ZonedFeature<'t>]) -> Option<&'f ZonedFeature<'t>> {
    let Value::Text(name) = &joint.get(key)?.value else { return None };
    features.iter().find(|feature| feature.full() == *name)
}

/// Keys `offset` and `tilt` of a joint with a float.
fn float(
    study: &Tree,
    name: &Key,
    joint: &Tree,
    owner: &Owner,
    features: &[ZonedFeature<'_>],
    lines: &mut Lines,
) -> Result<Vec<(Key, Tree)>, Fault> {
    let given = KEYS.iter().find_map(|key| Some((*key, joint.get(key)?)));
    let Some((first, first_tree)) = given else { return Ok(Vec::new()) };
    let inner = if joint.get("pin").is_some() { "pin" } else { "ball" };
    if joint.get("hole").is_none() || joint.get(inner).is_none() {
        let (to, instead) = ("this joint", "it belongs to a hole with a pin or a ball: write a gap, or leave it out");
        let found = StudyFault::DoesNotApply { key: first, to: to.into(), instead };
        return Err(at(owner, first, &first_tree.span, found));
    }
    if joint.get("offset").is_some() {
        let why = "both say where the pin lies in its hole: keep one".to_owned();
        return Err(at(owner, first, &first_tree.span, StudyFault::Conflict { a: "offset", b: first, why }));
    }
    let (Some(hole), Some(pin)) = (feature(joint, "hole", features), feature(joint, inner, features)) else {
        return Ok(Vec::new());
    };
    let law = law(joint, owner)?;
    let sizes = sizes(owner, (first, first_tree), [hole, pin])?;
    let toward = match joint.get("toward") {
        None => [1.0, 0.0],
        Some(tree) => direction(tree, hole.frame.as_ref(), owner)?,
    };
    let both = matches!(law, "disc" | "rim");
    if let (true, Some(tree)) = (both, joint.get("toward")) {
        let instead = "write float = \"+\" to press the pin to that side, or leave toward out";
        let found = StudyFault::DoesNotApply { key: "toward", to: format!("a float `{law}`"), instead };
        return Err(at(owner, "toward", &tree.span, found));
    }
    let tilts = tilts(joint, owner, both)?;
    let float = format!("{}.float", name.name);
    let line = |name: &str, note: &str, lines: &mut Lines| {
        let mut frame = sizes.clone();
        frame.push((key(owner, "law"), text(owner, law)));
        let owner = Owner { note: note.to_owned(), ..owner.clone() };
        let frame = Tree { span: first_tree.span.clone(), value: Value::Table(frame) };
        lines.dimension(&owner, name.to_owned(), LineUnit::Length, vec![("float", frame)], &[]);
    };
    let pair = |name: &str, texts: [String; 2], lines: &Lines| {
        (key(owner, name), lines.list(owner, texts.map(|one| text(owner, one)).to_vec()))
    };
    if let Some(length_tree) = tilts {
        let Some(length) = hole.tree.get("length") else {
            let instead = format!("write the length of the hole: `{}` needs length = 40", hole.full());
            let missing = StudyFault::MissingKey { key: "length".into(), instead };
            return Err(at(owner, "tilt_float", &length_tree.span, missing));
        };
        let length = super::entry::extent_of(study, length, &format!("{}.length", hole.owner.key), "above 0")?;
        let ends = [".end1", ".end2"].map(|end| format!("{float}{end}"));
        let note = format!("{law}: both ends of the pin, each in its circle");
        ends.iter().for_each(|end| line(end, &note, lines));
        let coordinate = |end: usize, axis: &str| quoted(&format!("{}{axis}", ends[end]));
        let middle = ["_x", "_y"].map(|axis| format!("({} + {})/2", coordinate(0, axis), coordinate(1, axis)));
        let length = lines.length(&length);
        let slope = ["_x", "_y"].map(|axis| format!("({} - {})/{length}", coordinate(1, axis), coordinate(0, axis)));
        return Ok(vec![pair("offset", middle, lines), pair("tilt", slope, lines)]);
    }
    line(&float, law, lines);
    let offset = match both {
        true => ["_x", "_y"].map(|axis| quoted(&format!("{float}{axis}"))),
        false => toward.map(|part| match part {
            _ if part == 0.0 => "0".to_owned(),
            _ if part == 1.0 => quoted(&float),
            _ => format!("({part:?})*{}", quoted(&float)),
        }),
    };
    // A plain 0 has no unit: a constant in its place.
    let items = offset.map(|one| if one == "0" { super::lines::number(owner, 0.0) } else { text(owner, one) });
    Ok(vec![(key(owner, "offset"), lines.list(owner, items.to_vec()))])
}

/// Keys `hole` and `pin` of a float: the diameters of the two features.
fn sizes(
    owner: &Owner,
    (first, first_tree): (&str, &Tree),
    [hole, pin]: [&ZonedFeature<'_>; 2],
) -> Result<Vec<(Key, Tree)>, Fault> {
    let mut sizes = Vec::new();
    for (kind, of) in [("hole", hole), ("pin", pin)] {
        let Some(diameter) = of.tree.get("diameter") else {
            let instead = format!("a float needs the diameter of `{}`: diameter = \"D\"", of.full());
            let missing = StudyFault::MissingKey { key: "diameter".into(), instead };
            return Err(at(owner, first, &first_tree.span, missing));
        };
        sizes.push((key(owner, kind), diameter.clone()));
    }
    Ok(sizes)
}

/// Law of a float. A direction alone presses the pin to that side.
fn law(joint: &Tree, owner: &Owner) -> Result<&'static str, Fault> {
    let Some(tree) = joint.get("float") else {
        return Ok(if joint.get("toward").is_some() { "+" } else { "disc" });
    };
    match &tree.value {
        Value::Text(found) => LAWS.into_iter().find(|law| law == found).ok_or_else(|| {
            let (nearest, known) = (nearest(found, LAWS).map(str::to_owned), LAWS.map(str::to_owned).to_vec());
            let unknown = StudyFault::UnknownWord { what: "law of a float", found: found.clone(), nearest, known };
            at(owner, "float", &tree.span, unknown)
        }),
        _ => Err(wrong_type(
            tree,
            format!("{}.float", owner.key),
            "\"disc\", \"rim\", \"uniform\", \"contact\", \"+\" or \"-\"",
        )),
    }
}

/// Parts of a direction along x and y of the hole.
fn direction(tree: &Tree, hole: Option<&ConstantFrame>, owner: &Owner) -> Result<[f64; 2], Fault> {
    let expected = "a direction across the hole such as \"-z\" or [0, 0, -1], in the frame of its part";
    let refused = || wrong_type(tree, format!("{}.toward", owner.key), expected);
    let (toward, frame) = (constant(tree).ok_or_else(refused)?, hole.ok_or_else(refused)?);
    let [x, y] = [dot(toward, frame.axes[0]), dot(toward, frame.axes[1])];
    let length = libm::hypot(x, y);
    if length < 1e-6 {
        return Err(refused());
    }
    Ok([x / length, y / length].map(|part| if part.abs() < 1e-12 { 0.0 } else { part }))
}

/// Place of `tilt_float = true`. Returns None if the clearance leaves no tilt.
fn tilts<'t>(joint: &'t Tree, owner: &Owner, both: bool) -> Result<Option<&'t Tree>, Fault> {
    let Some(tree) = joint.get("tilt_float") else { return Ok(None) };
    let Value::Truth(wanted) = tree.value else {
        return Err(wrong_type(tree, format!("{}.tilt_float", owner.key), "true or false"));
    };
    let refused = |to: &str, instead: &'static str| {
        let found = StudyFault::DoesNotApply { key: "tilt_float", to: to.to_owned(), instead };
        Err(at(owner, "tilt_float", &tree.span, found))
    };
    let takes = joint.get("takes").map(|takes| &takes.value);
    if !wanted {
        return Ok(None);
    }
    if joint.get("ball").is_some() || matches!(takes, Some(Value::Integer(takes)) if *takes != 4) {
        return refused("a joint that leaves the tilts free", "write takes = 4, or leave it out");
    }
    if !both {
        return refused("a float along one line", "write float = \"disc\" or \"rim\"");
    }
    Ok(Some(tree))
}

/// Gap of two faces that touch, with their form; None if neither has a zone of form.
fn form(joint: &Tree, features: &[ZonedFeature<'_>], lines: &mut Lines) -> Result<Option<String>, Fault> {
    let mut terms = Vec::new();
    if let (Some(of), true) = (feature(joint, "on", features), presses(joint))
        && let Some(zone) = of.zone(&[ZoneKind::Form])
    {
        let to = "a plane with contacts that press".to_owned();
        let instead = "give each contact a deviation of its own: shift = [0, 0, \"f1\"]";
        let found = StudyFault::DoesNotApply { key: zone.key, to, instead };
        return Err(at(&of.owner, zone.key, &zone.span, found));
    }
    for of in ["on", "against"].into_iter().filter_map(|key| feature(joint, key, features)) {
        let Some(zone) = of.zone(&[ZoneKind::Form]) else { continue };
        if of.kind == FeatureKind::Axis && zone.key == "straightness" {
            continue;
        }
        let name = format!("{}.form", of.full());
        terms.push(quoted(&name));
        if lines.has(&name) {
            continue;
        }
        let side = zone.table.and_then(|table| table.get("side"));
        let out = matches!(side.map(|side| &side.value), Some(Value::Text(side)) if side == "out");
        if let Some(side) = side.filter(|_| !out) {
            return Err(wrong_type(side, format!("{}.{}.side", of.owner.key, zone.key), "\"out\""));
        }
        let note =
            format!("{}: at the contact, {}", zone.key, if out { "0 .. zone" } else { "half the zone on either side" });
        let owner = Owner { note, zone: Some(zone.label(&of.full())), ..of.owner.clone() };
        match (&zone.width, out) {
            (Extent::Number(width), true) => {
                lines.offset_band(&owner, &name, [0.0, *width], &zone.spread);
            }
            (Extent::Formula(_), true) => {
                let instead = "write the zone as a number beside `side`".to_owned();
                let missing = StudyFault::MissingKey { key: "zone".into(), instead };
                return Err(at(&of.owner, zone.key, &zone.span, missing));
            }
            (width, false) => {
                let half = lines.scaled(width, 0.5);
                lines.band(&owner, &name, &half, LineUnit::Length, &zone.spread);
            }
        }
    }
    if terms.is_empty() {
        return Ok(None);
    }
    let given = joint.get("gap").and_then(|gap| match (&gap.value, super::frame::number(gap)) {
        (_, Some(value)) => Some(lines.length(&Extent::Number(value))),
        (Value::Text(text), None) if sensitol::assembly::formula::is_plain(text) => Some(text.clone()),
        (Value::Text(text), None) => Some(format!("({text})")),
        _ => None,
    });
    Ok(Some(given.into_iter().chain(terms).collect::<Vec<_>>().join(" + ")))
}
