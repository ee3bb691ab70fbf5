//! Expands patterns: features that move as one body within a wide zone, and each of them within a narrow one.
//!
//! The body is displaced across the axes and turned about their middle. Both share the zone: the farthest feature leaves it by neither alone.

use super::datums::{PartTorsor, add, push};
use super::deviation::Torsor;
use super::entry::{ZoneEntry, ZoneKind, ZonedFeature, zone};
use super::frame::{ConstantFrame, cross, dot, place};
use super::lines::{Extent, LineUnit, Lines, Owner, at};
use super::torsor::SHARED;
use crate::error::{Fault, StudyFault, fault};
use crate::expand::assembly::unknown_key;
use crate::expand::{Tree, Value, wrong_type};
use crate::faults::zone_fault::ZoneFault;
use crate::tree::Key;
use sensitol_numeric::names::nearest;
use sensitol_spatial::FeatureKind;

/// A pattern as written.
struct Pattern<'f, 't> {
    owner: Owner,
    name: String,
    features: Vec<&'f ZonedFeature<'t>>,
    frame: ConstantFrame,
    upper: ZoneEntry<'t>,
    lower: Option<ZoneEntry<'t>>,
}

/// Adds the deviations of all patterns of a part to those of its features.
pub(super) fn patterns(
    study: &Tree,
    part: &Key,
    tree: &Tree,
    features: &[&ZonedFeature<'_>],
    own: &mut [Torsor],
    lines: &mut Lines,
) -> Result<(), Fault> {
    let Some(all) = tree.get("patterns") else { return Ok(()) };
    let path = format!("parts.{}.patterns", part.name);
    let Value::Table(entries) = &all.value else {
        let expected = "a table of patterns such as bolts = { of = [\"h1\", \"h2\"], position = 0.5, within = 0.1 }";
        return Err(wrong_type(all, path, expected));
    };
    for (key, tree) in entries {
        let pattern = read(study, part, key, tree, features)?;
        write(&pattern, features, own, lines);
    }
    Ok(())
}

fn read<'f, 't>(
    study: &Tree,
    part: &Key,
    key: &Key,
    tree: &'t Tree,
    all: &[&'f ZonedFeature<'t>],
) -> Result<Pattern<'f, 't>, Fault> {
    let path = format!("parts.{}.patterns.{}", part.name, key.name);
    unknown_key(tree, &path, &["of", "position", "within"])?;
    let owner = Owner { key: path.clone(), span: key.span.clone(), note: String::new(), zone: None };
    let expected = "the axes of the pattern such as of = [\"h1\", \"h2\"]";
    let Some(Value::Array(items)) = tree.get("of").map(|of| &of.value) else {
        return Err(wrong_type(tree.get("of").unwrap_or(tree), format!("{path}.of"), expected));
    };
    let mut features: Vec<&'f ZonedFeature<'t>> = Vec::new();
    for item in items {
        let Value::Text(name) = &item.value else { return Err(wrong_type(item, format!("{path}.of"), expected)) };
        let Some(found) = all.iter().find(|feature| feature.name == *name) else {
            let known: Vec<String> = all.iter().map(|feature| feature.name.to_owned()).collect();
            let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
            let unknown = StudyFault::UnknownWord { what: "feature of this part", found: name.clone(), nearest, known };
            return Err(fault(item.span.clone(), format!("{path}.of"), unknown));
        };
        if found.kind != FeatureKind::Axis {
            return Err(wrong_type(item, format!("{path}.of"), "the name of an axis"));
        }
        if let Some(zone) = found.zone(&[ZoneKind::Location, ZoneKind::Eccentricity]) {
            let why = "both place the feature: keep the zone in the pattern, as `within`".to_owned();
            return Err(at(
                &found.owner,
                zone.key,
                &zone.span,
                StudyFault::Conflict { a: "pattern", b: zone.key, why },
            ));
        }
        features.push(found);
    }
    if features.len() < 2 {
        return Err(wrong_type(tree.get("of").unwrap_or(tree), format!("{path}.of"), "a list of two axes or more"));
    }
    let parallel =
        |frame: &ConstantFrame, other: &ConstantFrame| (dot(frame.axes[2], other.axes[2]).abs() - 1.0).abs() < 1e-9;
    let frame = features[0].frame;
    for feature in &features {
        match (&frame, &feature.frame) {
            (Some(first), Some(own)) if parallel(first, own) => {}
            _ => {
                let found = ZoneFault::VaryingDirection { feature: feature.full() };
                return Err(at(&owner, "of", &key.span, found.into()));
            }
        }
    }
    let segment = |name: &'static str| -> Result<Option<ZoneEntry<'t>>, Fault> {
        let Some((found, given)) = tree.entries().iter().find(|(key, _)| key.name == name) else { return Ok(None) };
        zone(study, (name, ZoneKind::Eccentricity), found, given, &format!("{path}.{name}"), false).map(Some)
    };
    let (Some(upper), Some(frame)) = (segment("position")?, frame) else {
        let instead = "write the zone of the pattern as one body: position = 0.5".to_owned();
        let missing = StudyFault::MissingKey { key: "position".into(), instead };
        return Err(fault(key.span.clone(), path, missing));
    };
    let name = format!("{}.{}", part.name, key.name);
    Ok(Pattern { owner, name, features, frame, upper, lower: segment("within")? })
}

/// Writes the lines of a pattern, and adds its terms to the features.
fn write(pattern: &Pattern<'_, '_>, all: &[&ZonedFeature<'_>], own: &mut [Torsor], lines: &mut Lines) {
    let Pattern { name, features, frame, upper, .. } = pattern;
    let [x, y, z] = frame.axes;
    let levers: Vec<[Extent; 3]> = features.iter().map(|feature| lever(feature, features, lines)).collect();
    let radius = radius(&levers, [x, y], lines);
    let half = lines.scaled(&upper.width, 0.5);
    let note = match upper.uniform {
        true => "position: the body evenly in the zone, its turn shares it",
        false => "position: 3 sigma = half the zone in x and y, the turn at the farthest axis over sqrt 2",
    };
    let owner = Owner { note: note.to_owned(), zone: Some(upper.label(name)), ..pattern.owner.clone() };
    let (at_name, turn_name) = (format!("{name}.at"), format!("{name}.tilt"));
    let shared = upper.uniform && upper.width != Extent::Number(0.0);
    let spread = if shared { &[][..] } else { &upper.spread[..] };
    let by = if upper.uniform { 1.0 } else { SHARED };
    let turn = lines.band(&owner, &turn_name, &lines.angle(&half, &radius, by), LineUnit::Angle, spread);
    let both = if shared {
        let bands =
            ["_x", "_y"].map(|axis| lines.band(&owner, &format!("{at_name}{axis}"), &half, LineUnit::Length, spread));
        lines.block(&owner, &[&turn, &bands[0], &bands[1]], "bicone");
        bands.map(|band| band.text)
    } else {
        lines.circle(&owner, &at_name, &half, LineUnit::Length, spread)
    };
    for (feature, lever) in features.iter().zip(&levers) {
        let Some(index) = all.iter().position(|other| other.name == feature.name) else { continue };
        let mut taken = PartTorsor::default();
        push(&mut taken.shift, x, &both[0]);
        push(&mut taken.shift, y, &both[1]);
        for (i, arm) in lever.iter().enumerate().filter(|(_, arm)| **arm != Extent::Number(0.0)) {
            let along = [0, 1, 2].map(|k| f64::from(u8::from(k == i)));
            push(&mut taken.shift, cross(z, along), &format!("{}*{}", lines.length(arm), turn.text));
        }
        if let Some(zone) = &pattern.lower {
            let note = "position within the pattern: 3 sigma = half the zone in x and y of the middle";
            let note = if zone.uniform { "position within the pattern: the middle evenly in the zone" } else { note };
            let owner = Owner { note: note.to_owned(), zone: Some(zone.label(name)), ..feature.owner.clone() };
            let half = lines.scaled(&zone.width, 0.5);
            let within = lines.circle(&owner, &format!("{}.at", feature.full()), &half, LineUnit::Length, &zone.spread);
            for (axis, text) in within.into_iter().enumerate() {
                own[index].shift[axis] = Some(text);
            }
        }
        if let Some(frame) = &feature.frame {
            add(&mut own[index], &taken, frame, feature.kind);
        }
    }
}

/// Coordinates of a feature from the middle of the pattern.
fn lever(feature: &ZonedFeature<'_>, features: &[&ZonedFeature<'_>], lines: &Lines) -> [Extent; 3] {
    let places: Vec<[Extent; 3]> = features.iter().map(|feature| place(feature.tree)).collect();
    let own = place(feature.tree);
    [0, 1, 2].map(|i| {
        let numbers: Option<Vec<f64>> = places.iter().map(|place| place[i].number()).collect();
        match (numbers, own[i].number()) {
            (Some(numbers), Some(own)) => {
                let middle = numbers.iter().sum::<f64>() / numbers.len() as f64;
                lines.scaled(&Extent::Number(own - middle), 1.0)
            }
            _ => {
                let sum = places.iter().map(|place| lines.length(&place[i])).collect::<Vec<_>>().join(" + ");
                Extent::Formula(format!("({} - ({sum})/{})", lines.length(&own[i]), places.len()))
            }
        }
    })
}

/// Distance of the farthest axis from the middle, or of the first one if the places are formulas.
fn radius(levers: &[[Extent; 3]], across: [[f64; 3]; 2], lines: &Lines) -> Extent {
    let number = |lever: &[Extent; 3]| -> Option<f64> {
        // A place along the axes has no part in the distance.
        let is_across = |i: usize| across.iter().any(|axis| axis[i].abs() > 1e-12);
        let mut numbers = [0.0; 3];
        for (i, place) in lever.iter().enumerate().filter(|&(i, _)| is_across(i)) {
            numbers[i] = place.number()?;
        }
        Some(libm::hypot(dot(numbers, across[0]), dot(numbers, across[1])))
    };
    let numbers: Option<Vec<f64>> = levers.iter().map(number).collect();
    match numbers {
        Some(numbers) => Extent::Number(numbers.into_iter().fold(0.0, f64::max)),
        None => {
            let along = |axis: [f64; 3]| {
                let parts = levers[0].iter().zip(axis).filter(|(_, part)| part.abs() > 1e-12);
                let parts: Vec<String> =
                    parts.map(|(lever, part)| format!("({part:?})*{}", lines.length(lever))).collect();
                parts.join(" + ")
            };
            Extent::Formula(format!("hypot({}, {})", along(across[0]), along(across[1])))
        }
    }
}
