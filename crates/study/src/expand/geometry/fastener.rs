//! Expands fasteners: the play that remains when holes are off their places, as the formula of a characteristic.

use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::geometry::line::{Diameter, Part, literal, names, place, unit_of};
use crate::expand::geometry::{Expanded, Shape, shape};
use crate::expand::{OWN, Origin, Tree, Value, quoted, wrong_type};
use crate::tree::Key;
use sensitol_numeric::names::nearest;

/// Form of the key `fastener`, for faults.
const EXPECTED: &str =
    "a table such as { kind = \"fixed\", hole = \"h\", pin = \"p\", places = [\"hole_place\", \"thread\"] }";

/// Writes the formula of every fastener.
pub(super) fn expand(expanded: &mut Expanded) -> Result<(), Faults> {
    let study = expanded.tree.clone();
    let mut faults = Faults::default();
    for (key, entry) in study.get("characteristics").map_or(&[][..], Tree::entries) {
        let Some(frame) = entry.get("fastener") else { continue };
        let Some(formula) = faults.take(formula(&study, key, entry, frame)) else { continue };
        let keys = expanded.tree.get_mut("characteristics").and_then(|section| section.get_mut(&key.name));
        if let Some(keys) = keys.and_then(Tree::entries_mut) {
            let text = Tree { span: frame.span.clone(), value: Value::Text(formula) };
            let formula = Key { span: frame.span.clone(), name: "formula".to_owned() };
            keys.retain(|(key, _)| key.name != "fastener");
            keys.insert(0, (formula, text));
        }
        let (section, name) = ("characteristics", key.name.clone());
        let origin = Origin { section, name, key: format!("characteristics.{}", key.name), span: key.span.clone() };
        expanded.origins.push(origin);
    }
    faults.none()
}

fn formula(study: &Tree, key: &Key, entry: &Tree, frame: &Tree) -> Result<String, Fault> {
    let path = format!("characteristics.{}.fastener", key.name);
    if let Some(formula) = entry.get("formula") {
        let why = "say the same thing: leave one out".to_owned();
        let found = StudyFault::Conflict { a: "fastener", b: "formula", why };
        return Err(fault(formula.span.clone(), path, found));
    }
    let converted = matches!(study.get("units").map(|mode| &mode.value), Some(Value::Text(mode)) if mode == "convert");
    let unit = unit_of(entry).filter(|_| converted);
    let valid = ["kind", "hole", "holes", "pin", "places", "projection", "depth"];
    let frame = Part::of(frame, path.clone(), &valid, EXPECTED, unit)?;
    frame.needed(
        "kind",
        "write kind = \"fixed\" for a pin that stands in one part, \"floating\" for a bolt through two",
    )?;
    let fixed = frame.word("kind", "kind of fastener", &["fixed", "floating"])? == Some("fixed");
    let pin = frame.diameter(study, "pin", "write the diameter of the pin or bolt")?;
    let [first, second] = places(study, &frame, &path)?;
    if fixed {
        does_not_apply(&frame, &["holes"], "a fixed fastener", "it passes one hole: hole = \"h\"")?;
        let hole = frame.diameter(study, "hole", "write the diameter of the clearance hole")?;
        let tilt = tilt(&frame)?;
        let apart = |axis: &str| {
            let [a, b] = [&first, &second].map(|place| quoted(&format!("{place}{axis}")));
            match &tilt {
                None => Ok(format!("{a} - {b}")),
                Some(tilt) => {
                    let deviation = deviation(study, &frame, &second, axis, unit)?;
                    Ok(format!("{a} - ({b} + {tilt}*{deviation})"))
                }
            }
        };
        return Ok(format!("{} - {} - 2*hypot({}, {})", hole.text, pin.text, apart("_x")?, apart("_y")?));
    }
    does_not_apply(&frame, &["hole"], "a floating fastener", "it passes two holes: holes = [\"d1\", \"d2\"]")?;
    let instead = "the threads of a fixed fastener tilt, a bolt through two holes does not";
    does_not_apply(&frame, &["projection", "depth"], "a floating fastener", instead)?;
    let [one, two] = holes(study, &frame, &path)?.map(|hole| hole.text);
    let apart = |axis: &str| {
        let [a, b] = [&first, &second].map(|place| quoted(&format!("{place}{axis}")));
        format!("{a} - {b}")
    };
    let lens = format!("({one} + {two})/2 - hypot({}, {})", apart("_x"), apart("_y"));
    Ok(format!("min({one}, {two}, {lens}) - {}", pin.text))
}

fn does_not_apply(frame: &Part<'_>, keys: &[&'static str], to: &str, instead: &'static str) -> Result<(), Fault> {
    match keys.iter().find(|key| frame.get(key).is_some()) {
        None => Ok(()),
        Some(&key) => Err(frame.at(key, StudyFault::DoesNotApply { key, to: to.to_owned(), instead })),
    }
}

/// The two items of a list.
fn two<'t>(frame: &Part<'t>, key: &str, path: &str, instead: &str) -> Result<[&'t Tree; 2], Fault> {
    let tree = frame.needed(key, instead)?;
    match &tree.value {
        Value::Array(items) if items.len() == 2 => Ok([&items[0], &items[1]]),
        Value::Array(items) => Err(frame.at(key, StudyFault::FastenerPair { key: key.to_owned(), found: items.len() })),
        _ => Err(wrong_type(tree, format!("{path}.{key}"), "a list of two")),
    }
}

/// Names of the two positions.
fn places(study: &Tree, frame: &Part<'_>, path: &str) -> Result<[String; 2], Fault> {
    let instead = "write the positions of the two features, such as places = [\"hole_place\", \"thread\"]";
    let [first, second] = two(frame, "places", path, instead)?;
    let known: Vec<String> = (study.get("dimensions").map_or(&[][..], Tree::entries).iter())
        .filter(|(_, entry)| shape(entry) != Shape::Scalar)
        .map(|(key, _)| key.name.clone())
        .collect();
    let of = |tree: &Tree| match &tree.value {
        Value::Text(name) if known.contains(name) => Ok(name.clone()),
        Value::Text(name) => {
            let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
            let unknown =
                StudyFault::UnknownWord { what: "position", found: name.clone(), nearest, known: known.clone() };
            Err(fault(tree.span.clone(), format!("{path}.places"), unknown))
        }
        _ => Err(wrong_type(tree, format!("{path}.places"), "the name of a position")),
    };
    Ok([of(first)?, of(second)?])
}

/// The two holes that a bolt passes through.
fn holes(study: &Tree, frame: &Part<'_>, path: &str) -> Result<[Diameter; 2], Fault> {
    let instead = "write the diameters of the two holes, such as holes = [\"d1\", \"d2\"]";
    let both = two(frame, "holes", path, instead)?;
    let known = names(study);
    let of = |tree: &Tree| match &tree.value {
        Value::Text(name) if known.contains(name) || study.get("model").is_some() => {
            Ok(Diameter { text: quoted(name), formula: quoted(name) })
        }
        Value::Text(name) => {
            let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
            let (what, found, known) = ("dimension or formula", name.clone(), known.clone());
            let unknown = StudyFault::UnknownWord { what, found, nearest, known };
            Err(fault(tree.span.clone(), format!("{path}.holes"), unknown))
        }
        _ => Err(wrong_type(tree, format!("{path}.holes"), "the name of a dimension")),
    };
    Ok([of(both[0])?, of(both[1])?])
}

/// Factor by which the tilt of the threads adds to the deviation of their place: twice the projection divided by the depth. Returns None if
/// neither is given.
fn tilt(frame: &Part<'_>) -> Result<Option<String>, Fault> {
    match (frame.size("projection")?, frame.size("depth")?) {
        (None, None) => Ok(None),
        (Some(_), Some(0.0)) => Err(frame.at("depth", StudyFault::OutOfRange { value: 0.0, range: "above 0" })),
        (Some(projection), Some(depth)) => {
            Ok(Some(format!("2*{}/{}", literal(projection, None), literal(depth, None))))
        }
        (projection, _) => {
            let key = if projection.is_some() { "depth" } else { "projection" };
            let instead = "the threads tilt over their depth, and the pin projects from them: write both".to_owned();
            Err(frame.whole(StudyFault::MissingKey { key: key.to_owned(), instead }))
        }
    }
}

/// Deviation of a position from its nominal place, as a formula.
fn deviation(study: &Tree, frame: &Part<'_>, name: &str, axis: &str, unit: Option<&str>) -> Result<String, Fault> {
    let entry = study.get("dimensions").and_then(|section| section.get(name));
    let nominal = entry.and_then(|entry| entry.get("nominal")).and_then(place);
    let zero = entry.is_some_and(|entry| entry.get("position").is_none());
    let Some(nominal) = nominal.or(zero.then_some([0.0; 2])) else {
        let instead = format!("the tilt follows the deviation from the nominal place: write nominal of `{name}`");
        return Err(frame.at("places", StudyFault::MissingKey { key: "nominal".to_owned(), instead }));
    };
    // Only the own part of a relative position tilts the threads.
    let own = entry.is_some_and(|entry| entry.get("from").is_some());
    let own = quoted(&format!("{name}{}{axis}", if own { OWN } else { "" }));
    Ok(match nominal[usize::from(axis == "_y")] {
        0.0 => own,
        nominal => format!("({own} - {})", literal(nominal, unit)),
    })
}
