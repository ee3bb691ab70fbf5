//! Expands faces that touch at points: a face with form that a force presses, and a face with datum targets.
//!
//! | entry | plain lines |
//! |---|---|
//! | corner or target of the face | a point of the part, and with form a dimension: the deviation there along the normal |
//! | `against` of a joint with `press` | the four corners as `targets` |
//! | joint of a face with `targets` | a joint of the plane with each target |

use std::ops::Range;

use super::press::presses;
use super::values::length_unit;
use super::zones::frame::{ConstantFrame, number};
use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Expanded, Origin, Tree, Value, quoted, wrong_type};
use crate::faults::zone_fault::ZoneFault;
use crate::tree::Key;

/// Signs of the corners along x and y of the face, around it.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
/// Keys of the law of a zone that a dimension has too.
const SPREAD: [&str; 3] = ["distribution", "sigmas", "cp"];
/// Zones that move the frame of a face.
const MOVING: [&str; 7] =
    ["profile", "position", "parallelism", "perpendicularity", "angularity", "runout", "total_runout"];
/// Part of a direction that is rounding.
const ROUNDING: f64 = 1e-14;

/// A face that touches at points, as written.
struct PointedFace<'t> {
    part: &'t str,
    name: &'t str,
    span: Range<usize>,
    tree: &'t Tree,
}

/// Replaces the faces that touch at points by these points.
pub(in crate::expand) fn expand(expanded: &mut Expanded) -> Result<(), Faults> {
    let study = expanded.tree.clone();
    let mut faults = Faults::default();
    let mut targeted: Vec<(String, String)> = Vec::new();
    for (key, joint) in study.get("joints").map_or(&[][..], Tree::entries) {
        if presses(joint) {
            if let Some(face) = face(&study, joint, "against") {
                faults.take(press(expanded, &study, (key, joint), &face));
            }
            continue;
        }
        let sides = [("against", "on"), ("on", "against")].map(|(side, other)| {
            Some((face(&study, joint, side).filter(|face| face.tree.get("targets").is_some())?, other))
        });
        if let [Some(_), Some(_)] = sides {
            let why = "are both faces with `targets`: a joint touches at the targets of one of them".to_owned();
            let conflict = StudyFault::Conflict { a: "on", b: "against", why };
            faults.0.push(fault(key.span.clone(), format!("joints.{}", key.name), conflict));
        }
        for (face, _) in sides.iter().flatten() {
            targeted.push((face.part.to_owned(), face.name.to_owned()));
        }
        if let Some((face, other)) = sides.into_iter().flatten().next() {
            faults.take(rest(expanded, &study, (key, joint), (&face, other)));
        }
    }
    faults.take(take_out_targets(expanded, &study, &targeted));
    faults.none()
}

/// Takes the targets out of all faces. A face whose targets no joint uses is a fault, unless a joint names a feature that does not exist:
/// that is reported where the joint is read, as it is the cause.
fn take_out_targets(expanded: &mut Expanded, study: &Tree, used: &[(String, String)]) -> Result<(), Fault> {
    let is_misspelt = study.get("joints").map_or(&[][..], Tree::entries).iter().any(|(_, joint)| {
        ["on", "against"].iter().any(|side| joint.get(side).is_some_and(|name| !is_feature(study, name)))
    });
    for (part, features) in study.get("parts").map_or(&[][..], Tree::entries) {
        let pointed = features.entries().iter().filter(|(_, face)| face.get("plane").is_some());
        for (key, targets) in pointed.filter_map(|(key, face)| Some((key, face.get("targets")?))) {
            let is_used = used.iter().any(|(of, name)| *of == part.name && *name == key.name);
            if !is_used && !is_misspelt {
                let to = "a face that no joint without `press` names in `on` or `against`".to_owned();
                let instead = "name the face in such a joint, or leave `targets` out";
                let unused = StudyFault::DoesNotApply { key: "targets", to, instead };
                return Err(fault(targets.span.clone(), format!("parts.{}.{}.targets", part.name, key.name), unused));
            }
            let parts = expanded.tree.get_mut("parts");
            let face = parts.and_then(|parts| parts.get_mut(&part.name)?.get_mut(&key.name)?.entries_mut());
            face.into_iter().for_each(|keys| keys.retain(|(key, _)| key.name != "targets"));
        }
    }
    Ok(())
}

/// True for the full name of a feature of the study. Other values than texts are reported where the joint is read.
fn is_feature(study: &Tree, name: &Tree) -> bool {
    let Value::Text(name) = &name.value else { return true };
    let Some((part, name)) = name.split_once('.') else { return false };
    study.get("parts").and_then(|parts| parts.get(part)?.get(name)).is_some()
}

/// Refuses a name of the study that is one of those made here.
fn refuse_taken(study: &Tree, path: &[&str], name: &str, by: &'static str) -> Result<(), Fault> {
    let section = path.iter().try_fold(study, |tree, key| tree.get(key));
    let taken = section.and_then(|section| section.entries().iter().find(|(key, _)| key.name == name));
    taken.map_or(Ok(()), |(key, _)| {
        let taken = StudyFault::NameTaken { name: name.to_owned(), by };
        Err(fault(key.span.clone(), format!("{}.{name}", path.join(".")), taken))
    })
}

/// Plane that a key of a joint names. Returns None for other features.
fn face<'t>(study: &'t Tree, joint: &'t Tree, key: &str) -> Option<PointedFace<'t>> {
    let Value::Text(name) = &joint.get(key)?.value else { return None };
    let (part, name) = name.split_once('.')?;
    let (key, tree) = study.get("parts")?.get(part)?.entries().iter().find(|(key, _)| key.name == name)?;
    tree.get("plane").is_some().then(|| PointedFace { part, name, span: key.span.clone(), tree })
}

/// Replaces a pressed face by its corners.
fn press(
    expanded: &mut Expanded,
    study: &Tree,
    (key, joint): (&Key, &Tree),
    face: &PointedFace<'_>,
) -> Result<(), Fault> {
    if let Some(targets) = joint.get("targets") {
        let why = "are two ways to name what touches: keep one".to_owned();
        let conflict = StudyFault::Conflict { a: "against", b: "targets", why };
        return Err(fault(targets.span.clone(), format!("joints.{}.targets", key.name), conflict));
    }
    let [x, y] = face.extents()?;
    if face.tree.get("flatness").is_none() {
        let instead = "a face without form lies on the plane: leave out `press`, or give the face its form, such as flatness = 0.05";
        return Err(face.missing("flatness", instead));
    }
    let corners = CORNERS.map(|[along_x, along_y]| [0.5 * along_x * x, 0.5 * along_y * y]);
    let names = face.points(expanded, study, "corner", &corners)?;
    let joint = expanded.tree.get_mut("joints").and_then(|joints| joints.get_mut(&key.name)?.entries_mut());
    if let Some(keys) = joint {
        keys.retain(|(key, _)| key.name != "against");
        let targets = names.iter().map(|name| face.made(Value::Text(name.clone()))).collect();
        keys.push((Key { span: key.span.clone(), name: "targets".into() }, face.made(Value::Array(targets))));
    }
    Ok(())
}

/// Replaces a joint of a face with targets by a joint for each target.
fn rest(
    expanded: &mut Expanded,
    study: &Tree,
    (key, joint): (&Key, &Tree),
    (face, other): (&PointedFace<'_>, &str),
) -> Result<(), Fault> {
    let targets = face.targets()?;
    if let Some(takes) = joint.get("takes").filter(|takes| number(takes) != Some(targets.len() as f64)) {
        let why =
            format!("disagree: {} of the face take as many freedoms, so leave out `takes`", counted(targets.len()));
        let conflict = StudyFault::Conflict { a: "takes", b: "targets", why };
        return Err(fault(takes.span.clone(), format!("joints.{}.takes", key.name), conflict));
    }
    let names = face.points(expanded, study, "target", &targets)?;
    for index in 1..=names.len() {
        refuse_taken(study, &["joints"], &format!("{} {index}", key.name), "the joint at a datum target")?;
    }
    let of_target = |(index, name): (usize, String)| {
        let mut keys: Vec<(Key, Tree)> = (joint.entries().iter())
            .filter(|(key, _)| !["on", "against", "takes"].contains(&key.name.as_str()))
            .cloned()
            .collect();
        let own = |name: &str| Key { span: key.span.clone(), name: name.to_owned() };
        keys.extend(joint.get(other).map(|plane| (own("on"), plane.clone())));
        keys.push((own("against"), face.made(Value::Text(name))));
        let name = format!("{} {}", key.name, index + 1);
        (own(&name), Tree { span: joint.span.clone(), value: Value::Table(keys) })
    };
    let joints: Vec<(Key, Tree)> = names.into_iter().enumerate().map(of_target).collect();
    if let Some(all) = expanded.tree.get_mut("joints").and_then(Tree::entries_mut)
        && let Some(place) = all.iter().position(|(other, _)| other.name == key.name)
    {
        all.splice(place..=place, joints);
    }
    Ok(())
}

fn counted(targets: usize) -> String {
    format!("{targets} target{}", if targets == 1 { "" } else { "s" })
}

impl PointedFace<'_> {
    fn path(&self) -> String {
        format!("parts.{}.{}", self.part, self.name)
    }

    /// A value at the place of the face.
    fn made(&self, value: Value) -> Tree {
        Tree { span: self.span.clone(), value }
    }

    fn missing(&self, key: &str, instead: &str) -> Fault {
        let missing = StudyFault::MissingKey { key: key.to_owned(), instead: instead.to_owned() };
        fault(self.span.clone(), self.path(), missing)
    }

    /// Extents along x and y.
    fn extents(&self) -> Result<[f64; 2], Fault> {
        let Some(size) = self.tree.get("size") else {
            let instead = "a pressed face touches at its corners: write its extents, such as size = [60, 40]";
            return Err(self.missing("size", instead));
        };
        let expected = "two numbers beside `press`: the extents along x and y of the face, such as [60, 40]";
        let extents = pair(size).filter(|extents| extents.iter().all(|extent| *extent > 0.0));
        extents.ok_or_else(|| wrong_type(size, format!("{}.size", self.path()), expected))
    }

    /// Places of the targets in the frame of the face.
    fn targets(&self) -> Result<Vec<[f64; 2]>, Fault> {
        let given = self.tree.get("targets").unwrap_or(self.tree);
        let expected = "one to three places along x and y of the face, such as [[20, 10], [140, 10], [80, 90]]";
        let places = match &given.value {
            Value::Array(items) if (1..=3).contains(&items.len()) => items.iter().map(pair).collect::<Option<_>>(),
            _ => None,
        };
        let places: Vec<[f64; 2]> =
            places.ok_or_else(|| wrong_type(given, format!("{}.targets", self.path()), expected))?;
        // The origin of the frame is the middle of the face. A size in words of dimensions is not compared.
        let Some(size) = self.tree.get("size").and_then(pair) else { return Ok(places) };
        let is_outside =
            |place: &[f64; 2]| (0..2).any(|axis| place[axis].abs() > 0.5 * size[axis].abs() * (1.0 + ROUNDING));
        if let Some(index) = places.iter().position(is_outside) {
            let face = format!("{}.{}", self.part, self.name);
            let outside = ZoneFault::TargetOutside { target: index + 1, face, at: places[index], size };
            return Err(fault(given.span.clone(), format!("{}.targets", self.path()), outside));
        }
        Ok(places)
    }

    /// Adds points of the face at these places, and their deviations if the face has form. Returns the names of the points.
    fn points(
        &self,
        expanded: &mut Expanded,
        study: &Tree,
        what: &str,
        places: &[[f64; 2]],
    ) -> Result<Vec<String>, Fault> {
        let form = self.form(length_unit(study))?;
        let own = |name: &str| Key { span: self.span.clone(), name: name.to_owned() };
        let moves = MOVING.iter().any(|zone| self.tree.get(zone).is_some());
        let mut names = Vec::new();
        for (index, place) in places.iter().enumerate() {
            let name = format!("{} {what} {}", self.name, index + 1);
            let deviation = format!("{}.{}.{what}{}", self.part, self.name, index + 1);
            names.push(format!("{}.{name}", self.part));
            refuse_taken(study, &["parts", self.part], &name, "a point of a face that touches")?;
            if form.is_some() {
                for section in ["dimensions", "constants", "formulas"] {
                    refuse_taken(study, &[section], &deviation, "the form of a face at a point")?;
                }
            }
            // A face may touch in several joints.
            if expanded.tree.get("parts").and_then(|parts| parts.get(self.part)?.get(&name)).is_some() {
                continue;
            }
            let coordinates = self.coordinates(study, *place, form.as_ref().map(|_| deviation.as_str()))?;
            let coordinates = coordinates.map(|value| self.made(value)).to_vec();
            let mut keys = vec![(own("point"), self.made(Value::Array(coordinates)))];
            if moves {
                keys.push((own("datums"), self.made(Value::Text(self.name.to_owned()))));
            }
            let part = expanded.tree.get_mut("parts").and_then(|parts| parts.get_mut(self.part)?.entries_mut());
            part.into_iter().for_each(|part| part.push((own(&name), self.made(Value::Table(keys.clone())))));
            let Some(form) = &form else { continue };
            expanded.tree.section("dimensions").into_iter().for_each(|all| all.push((own(&deviation), form.clone())));
            let key = format!("parts.{}.{name} (form at a {what})", self.part);
            expanded.origins.push(Origin { section: "dimensions", name: deviation, key, span: self.span.clone() });
        }
        Ok(names)
    }

    /// Coordinates of a place of the face in the frame of the part, with a deviation along the normal.
    fn coordinates(&self, study: &Tree, place: [f64; 2], deviation: Option<&str>) -> Result<[Value; 3], Fault> {
        let Some(frame) = ConstantFrame::of(self.tree, "normal") else {
            let expected = "words or numbers for a face that touches at points, such as \"-z\"";
            let normal = self.tree.get("normal").unwrap_or(self.tree);
            return Err(wrong_type(normal, format!("{}.normal", self.path()), expected));
        };
        let origin = match self.tree.get("plane").map(|tree| &tree.value) {
            Some(Value::Array(items)) if items.len() == 3 => items,
            _ => {
                return Err(wrong_type(self.tree, format!("{}.plane", self.path()), "a list of 3 numbers or formulas"));
            }
        };
        let unit = length_unit(study).map_or_else(String::new, |unit| format!("[{unit}]"));
        let [x, y, z] = frame.axes;
        Ok([0, 1, 2].map(|i| {
            let offset = place[0] * x[i] + place[1] * y[i];
            let deviation = deviation.filter(|_| z[i].abs() > ROUNDING);
            let at = match (&origin[i].value, number(&origin[i])) {
                (_, Some(value)) if deviation.is_none() => return Value::Number(value + offset),
                (_, Some(value)) => length(value + offset, &unit),
                (Value::Text(text), None) => format!("({}) + {}", in_formula(study, text), length(offset, &unit)),
                // Other values are reported where the plane is read.
                _ => length(offset, &unit),
            };
            Value::Text(match deviation {
                Some(deviation) => format!("{at} + ({:?})*{}", z[i], quoted(deviation)),
                None => at,
            })
        }))
    }

    /// Dimension of the form at one point. Returns None for a face without form.
    fn form(&self, unit: Option<String>) -> Result<Option<Tree>, Fault> {
        let Some(zone) = self.tree.get("flatness") else { return Ok(None) };
        let path = format!("{}.flatness", self.path());
        let width = zone.get("zone").unwrap_or(zone);
        let Some(value) = number(width).filter(|width| width.is_finite() && *width >= 0.0) else {
            return Err(wrong_type(width, path, "a number of 0 or above for a face that touches at points"));
        };
        let is_out = match zone.get("side") {
            None => false,
            Some(Tree { value: Value::Text(side), .. }) if side == "out" => true,
            Some(other) => return Err(wrong_type(other, format!("{path}.side"), "\"out\"")),
        };
        let tree = |value: Value| Tree { span: zone.span.clone(), value };
        let key = |name: &str| Key { span: zone.span.clone(), name: name.to_owned() };
        let band = match is_out {
            true => Value::Array([0.0, value].map(|end| tree(Value::Number(end))).to_vec()),
            false => Value::Number(0.5 * value),
        };
        let mut keys = vec![(key("nominal"), tree(Value::Number(0.0))), (key("tolerance"), tree(band))];
        keys.extend(unit.map(|unit| (key("unit"), tree(Value::Text(unit)))));
        for name in SPREAD {
            let given = zone.get(name).or_else(|| self.tree.get(name).filter(|_| name == "distribution"));
            // The default law of a zone is that of a dimension.
            let given = given.filter(|given| !matches!(&given.value, Value::Text(law) if law == "normal"));
            keys.extend(given.map(|given| (key(name), given.clone())));
        }
        Ok(Some(tree(Value::Table(keys))))
    }
}

/// A coordinate as it stands in a formula: a name in quotes if it needs them.
fn in_formula(study: &Tree, text: &str) -> String {
    let is_name = |section: &&str| study.get(section).is_some_and(|all| all.get(text).is_some());
    match ["dimensions", "constants", "formulas"].iter().any(is_name) {
        true => quoted(text),
        false => text.to_owned(),
    }
}

/// Two numbers of a list.
fn pair(tree: &Tree) -> Option<[f64; 2]> {
    let Value::Array(items) = &tree.value else { return None };
    let numbers: Vec<f64> = items.iter().map(number).collect::<Option<_>>()?;
    <[f64; 2]>::try_from(numbers).ok().filter(|pair| pair.iter().all(|number| number.is_finite()))
}

/// Number as a length in a formula.
fn length(value: f64, unit: &str) -> String {
    match value < 0.0 {
        true => format!("(-{:?}{unit})", -value),
        false => format!("{value:?}{unit}"),
    }
}
