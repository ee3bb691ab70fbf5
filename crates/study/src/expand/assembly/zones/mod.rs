//! Expands zones of features and floats of joints of an assembly in space into plain dimensions, formulas and blocks.
//!
//! A zone becomes a displacement (`shift`) and a rotation (`tilt`) of the frame of its feature, a float becomes the `offset` of a joint.

mod common;
mod cost;
mod datums;
mod deviation;
mod entry;
mod float;
pub(super) mod frame;
mod lines;
mod pattern;
mod torsor;

use crate::error::{Fault, Faults, StudyFault};
use crate::expand::{Expanded, Tree, Value};
use crate::faults::zone_fault::ZoneFault;
use crate::tree::Key;
use datums::{DatumIndices, DatumList};
use deviation::Torsor;
use entry::{MORE, ZONES, ZoneKind, ZonedFeature};
use lines::{LineOwners, Lines, at};
use sensitol_spatial::FeatureKind;
use torsor::DatumFacts;

/// Keys of zones that fit a kind of feature, with those of its datums and extent.
pub(super) fn keys(kind: FeatureKind) -> impl Iterator<Item = &'static str> {
    ZONES.into_iter().filter(move |(_, _, fits, _)| fits.contains(&kind)).map(|(key, ..)| key).chain(MORE)
}

/// Replaces zones and floats of an assembly by plain lines. Returns None if the study has no parts.
pub(in crate::expand) fn expand(expanded: &mut Expanded) -> Result<Option<LineOwners>, Faults> {
    let study = expanded.tree.clone();
    let Some(parts) = study.get("parts").filter(|parts| matches!(parts.value, Value::Table(_))) else {
        return Ok(None);
    };
    let converts = matches!(study.get("units").map(|mode| &mode.value), Some(Value::Text(mode)) if mode == "convert");
    let mut lines = Lines::new(super::values::length_unit(&study), converts);
    let mut faults = Faults::default();
    let mut features: Vec<ZonedFeature<'_>> = Vec::new();
    for (key, tree) in parts.entries() {
        for read in entry::features(&study, key, tree) {
            features.extend(faults.take(read));
        }
    }
    faults.none()?;
    let costs = cost::costs(&study, &features)?;
    lines.priced = costs.iter().map(|cost| cost.zone.clone()).collect();
    let mut faults = Faults::default();
    let materials = float::materials(&study, &features);
    for (key, tree) in parts.entries() {
        let of_part: Vec<&ZonedFeature<'_>> = features.iter().filter(|feature| feature.part == key.name).collect();
        let Some(commons) = faults.take(common::common_datums(&of_part)) else { continue };
        let with_commons: Vec<&ZonedFeature<'_>> = of_part.iter().copied().chain(&commons).collect();
        let deviations = part(&study, (key, tree), &with_commons, &materials, &mut lines);
        let Some(found) = faults.take(deviations) else { continue };
        let entry = expanded.tree.get_mut("parts").and_then(|parts| parts.get_mut(&key.name));
        if let Some(entries) = entry.and_then(Tree::entries_mut) {
            entries.retain(|(key, _)| key.name != "patterns");
        }
        expanded.open_zones.extend(of_part.iter().flat_map(|feature| datums::open_zones(feature, &with_commons)));
        for (feature, torsor) in of_part.iter().zip(found) {
            write(expanded, feature, &torsor, &lines);
        }
    }
    float::expand(expanded, &study, &features, &mut lines, &mut faults);
    faults.none()?;
    expanded.free_zones = cost::free(&study, &features, &costs, &lines);
    expanded.zones = cost::write(&mut expanded.tree, costs, &features, &lines)?;
    Ok(Some(lines.write(expanded)))
}

/// Deviations of the features of a part, in their order. Common datums stand after the features of the study.
fn part(
    study: &Tree,
    (key, tree): (&Key, &Tree),
    features: &[&ZonedFeature<'_>],
    materials: &[(String, &'static str, String)],
    lines: &mut Lines,
) -> Result<Vec<Torsor>, Fault> {
    let (mut own, mut indices) = (Vec::new(), Vec::new());
    for feature in features {
        let index = |datum: &str| features.iter().position(|other| other.name == datum);
        if let Some(pair) = feature.common {
            own.push(Torsor::default());
            indices.push(DatumIndices { own: pair.into_iter().filter_map(index).collect(), orientation: None });
            continue;
        }
        let datums = datums::named(feature, &DatumList::of(feature), features)?;
        let orientation = DatumList::of_orientation(feature);
        let orientation = orientation.map(|names| datums::named(feature, &names, features)).transpose()?;
        check_axis(feature, &datums)?;
        let axis = datums.iter().find(|datum| datum.kind == FeatureKind::Axis);
        let facts = DatumFacts {
            tilts: datums::tilts(feature, orientation.as_ref().unwrap_or(&datums)),
            axis: axis.and_then(|datum| Some((datum.name, datum.frame?))),
            material: (materials.iter())
                .find(|(name, ..)| *name == feature.full())
                .map(|(_, kind, diameter)| (*kind, diameter.clone())),
        };
        own.push(torsor::torsor(feature, &facts, lines)?);
        let places = |datums: &[&ZonedFeature<'_>]| datums.iter().filter_map(|datum| index(datum.name)).collect();
        indices.push(DatumIndices { own: places(&datums), orientation: orientation.as_deref().map(places) });
    }
    let written = features.iter().take_while(|feature| feature.common.is_none()).count();
    pattern::patterns(study, key, tree, &features[..written], &mut own, lines)?;
    datums::carried(features, &indices, own, lines)
}

/// Checks that a zone about an axis has an axis as its first datum, if it has datums.
fn check_axis(feature: &ZonedFeature<'_>, datums: &[&ZonedFeature<'_>]) -> Result<(), Fault> {
    let Some(zone) = feature.zone(&[ZoneKind::Eccentricity]) else { return Ok(()) };
    match datums.first() {
        Some(first)
            if first.kind != FeatureKind::Axis && datums.iter().all(|datum| datum.kind != FeatureKind::Axis) =>
        {
            let (datum, kind) = (first.name.to_owned(), first.kind.name());
            let found: StudyFault = ZoneFault::NoAxis { zone: zone.key, datum, kind }.into();
            Err(at(&feature.owner, "datums", &feature.datum_span, found))
        }
        _ => Ok(()),
    }
}

/// Writes a deviation in place of the zones of a feature.
fn write(expanded: &mut Expanded, feature: &ZonedFeature<'_>, torsor: &Torsor, lines: &Lines) {
    let Some(entry) = (expanded.tree.get_mut("parts"))
        .and_then(|parts| parts.get_mut(feature.part)?.get_mut(feature.name)?.entries_mut())
    else {
        return;
    };
    let is_face = feature.kind == FeatureKind::Plane;
    entry.retain(|(key, _)| {
        let name = key.name.as_str();
        !(ZONES.iter().any(|(zone, ..)| *zone == name) || MORE.contains(&name) || (is_face && name == "diameter"))
    });
    let owner = &feature.owner;
    for (name, parts) in [("shift", &torsor.shift), ("tilt", &torsor.tilt)] {
        if parts.iter().all(Option::is_none) {
            continue;
        }
        let written = feature.tree.get(name).map(|tree| &tree.value);
        let item = |i: usize| -> Tree {
            let given = match written {
                Some(Value::Array(items)) => items.get(i).and_then(|item| match (&item.value, frame::number(item)) {
                    (_, Some(0.0)) => None,
                    (_, Some(value)) if name == "shift" => Some(lines.length(&lines::Extent::Number(value))),
                    (_, Some(value)) => Some(format!("({value:?})")),
                    (Value::Text(text), None) if sensitol::assembly::formula::is_plain(text) => Some(text.clone()),
                    (Value::Text(text), None) => Some(format!("({text})")),
                    _ => None,
                }),
                _ => None,
            };
            let terms: Vec<String> = given.into_iter().chain(parts[i].clone()).collect();
            match terms.is_empty() {
                true => lines::number(owner, 0.0),
                false => lines::text(owner, terms.join(" + ")),
            }
        };
        let value = lines.list(owner, vec![item(0), item(1), item(2)]);
        entry.retain(|(key, _)| key.name != name);
        entry.push((Key { span: owner.span.clone(), name: name.to_owned() }, value));
    }
}
