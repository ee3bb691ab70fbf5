//! Datums, their features and targets, and references to them.

use std::collections::{HashMap, HashSet};

use super::aspect::{Aspects, TARGETS};
use super::measure::{StepMeasure, measure};
use super::placement::{Placement, placement};
use crate::part21::{Entity, EntityTable, Part21Error, StepValue};

/// Greatest number of levels from a datum system to a datum: compartment, common datum, element, datum.
const DEEPEST: usize = 8;

/// A datum target.
#[derive(Debug, Clone, PartialEq)]
pub struct DatumTarget {
    /// Number of the entity.
    pub entity: u64,
    /// Number of the target, as in A1.
    pub name: String,
    /// Kind, such as point, line, circle, rectangle or area.
    pub shape: String,
    /// Place, if the file gives it.
    pub placement: Option<Placement>,
    /// Sizes with their names, such as target diameter.
    pub sizes: Vec<(String, StepMeasure)>,
}

/// A datum with its features.
#[derive(Debug, Clone, PartialEq)]
pub struct StepDatum {
    /// Number of the entity.
    pub entity: u64,
    /// Letter.
    pub letter: String,
    /// Numbers of the faces of its features.
    pub faces: Vec<u64>,
    /// Datum targets.
    pub targets: Vec<DatumTarget>,
}

/// A reference of a tolerance to a datum, or to several that form a common one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DatumReference {
    /// Letters: one, or those of a common datum.
    pub letters: Vec<String>,
    /// Modifiers as the file names them, such as MAXIMUM_MATERIAL_REQUIREMENT.
    pub modifiers: Vec<String>,
}

/// Representations of place and sizes, by datum target.
#[derive(Debug, Default)]
pub(super) struct TargetRepresentations(HashMap<u64, Vec<u64>>);

impl TargetRepresentations {
    /// Reads the representations of all targets in one pass over the properties of the file.
    pub(super) fn read(table: &EntityTable<'_>) -> Result<Self, Part21Error> {
        let mut found = Self::default();
        let targets: HashSet<u64> = TARGETS.iter().flat_map(|kind| table.of_kind(kind).map(|one| one.id())).collect();
        if targets.is_empty() {
            return Ok(found);
        }
        let mut definitions = HashMap::new();
        for definition in table.of_kind("PROPERTY_DEFINITION") {
            let of = definition.inherited("PROPERTY_DEFINITION")?.get(2).and_then(StepValue::reference);
            if let Some(target) = of.filter(|of| targets.contains(of)) {
                definitions.insert(definition.id(), target);
            }
        }
        for kind in ["PROPERTY_DEFINITION_REPRESENTATION", "SHAPE_DEFINITION_REPRESENTATION"] {
            for link in table.of_kind(kind) {
                let arguments = link.inherited("PROPERTY_DEFINITION_REPRESENTATION")?;
                let ends = [0, 1].map(|index| arguments.get(index).and_then(StepValue::reference));
                if let [Some(definition), Some(representation)] = ends
                    && let Some(target) = definitions.get(&definition)
                {
                    found.0.entry(*target).or_default().push(representation);
                }
            }
        }
        Ok(found)
    }
}

/// Letter of a datum.
fn letter(datum: Entity<'_>) -> Result<Option<String>, Part21Error> {
    let arguments = datum.arguments("DATUM")?.unwrap_or_default();
    Ok(arguments.last().and_then(StepValue::text).map(|text| text.trim().to_owned()).filter(|text| !text.is_empty()))
}

/// Reads a datum.
pub(super) fn datum(
    table: &EntityTable<'_>,
    aspects: &Aspects<'_>,
    representations: &TargetRepresentations,
    datum: Entity<'_>,
) -> Result<StepDatum, Part21Error> {
    let mut faces = aspects.datum_items(datum.id())?.faces;
    let mut seen: HashSet<u64> = faces.iter().copied().collect();
    let mut targets = Vec::new();
    for &other in aspects.above(datum.id()).iter().chain(aspects.below(datum.id())) {
        let other = table.referred(datum.id(), other)?;
        if other.first_of(&TARGETS).is_none() {
            continue;
        }
        targets.push(target(table, representations, other)?);
        // The feature of a target stands above it.
        for &feature in aspects.above(other.id()) {
            faces.extend(aspects.items(feature)?.faces.into_iter().filter(|face| seen.insert(*face)));
        }
    }
    Ok(StepDatum { entity: datum.id(), letter: letter(datum)?.unwrap_or_default(), faces, targets })
}

/// Reads a datum target with the representation of its place and sizes.
fn target(
    table: &EntityTable<'_>,
    representations: &TargetRepresentations,
    entity: Entity<'_>,
) -> Result<DatumTarget, Part21Error> {
    let aspect = entity.inherited("SHAPE_ASPECT")?;
    let own = match entity.first_of(&TARGETS) {
        Some(kind) => entity.arguments(kind)?.unwrap_or_default(),
        None => Vec::new(),
    };
    let mut found = DatumTarget {
        entity: entity.id(),
        name: own.last().and_then(StepValue::text).unwrap_or_default(),
        shape: aspect.get(1).and_then(StepValue::text).unwrap_or_default(),
        placement: None,
        sizes: Vec::new(),
    };
    for &representation in representations.0.get(&entity.id()).map_or(&[][..], Vec::as_slice) {
        sizes(table, table.referred(entity.id(), representation)?, &mut found)?;
    }
    Ok(found)
}

/// Reads place and sizes of a target from a representation.
fn sizes(table: &EntityTable<'_>, representation: Entity<'_>, target: &mut DatumTarget) -> Result<(), Part21Error> {
    let arguments = representation.inherited("REPRESENTATION")?;
    for item in arguments.get(1).map(StepValue::references).unwrap_or_default() {
        let item = table.referred(representation.id(), item)?;
        if item.is("AXIS2_PLACEMENT_3D") {
            target.placement = placement(table, representation.id(), item.id())?;
        } else if let Some(found) = measure(table, item)? {
            target.sizes.push((item_name(item)?, found));
        }
    }
    Ok(())
}

/// Name of a representation item.
pub(super) fn item_name(item: Entity<'_>) -> Result<String, Part21Error> {
    Ok(item.inherited("REPRESENTATION_ITEM")?.first().and_then(StepValue::text).unwrap_or_default())
}

/// Reads the references of a tolerance: datum systems, compartments, or datums.
pub(super) fn references(
    table: &EntityTable<'_>,
    from: u64,
    systems: &[u64],
) -> Result<Vec<DatumReference>, Part21Error> {
    let mut found = Vec::new();
    for &system in systems {
        let system = table.referred(from, system)?;
        if system.is("DATUM_SYSTEM") {
            let own = system.arguments("DATUM_SYSTEM")?.unwrap_or_default();
            for compartment in own.last().map(StepValue::references).unwrap_or_default() {
                found.extend(compartment_reference(table, table.referred(system.id(), compartment)?)?);
            }
        } else {
            found.extend(compartment_reference(table, system)?);
        }
    }
    Ok(found)
}

/// Reads a compartment of a datum system. Returns None if it names no datum.
fn compartment_reference(table: &EntityTable<'_>, entity: Entity<'_>) -> Result<Option<DatumReference>, Part21Error> {
    let mut found = DatumReference { letters: Vec::new(), modifiers: Vec::new() };
    let mut open = vec![(entity, 0)];
    while let Some((entity, depth)) = open.pop() {
        if entity.is("DATUM") {
            found.letters.extend(letter(entity)?);
            continue;
        }
        if depth >= DEEPEST || found.letters.len() > 100 {
            continue;
        }
        // DATUM_REFERENCE and REFERENCED_MODIFIED_DATUM are of AP203, the others of AP242.
        let is_general = entity.is("DATUM_REFERENCE_COMPARTMENT") || entity.is("DATUM_REFERENCE_ELEMENT");
        let arguments = match is_general {
            true => {
                let mut arguments = entity.inherited("GENERAL_DATUM_REFERENCE")?;
                arguments.split_off(arguments.len().saturating_sub(2))
            }
            false if entity.is("DATUM_REFERENCE") || entity.is("REFERENCED_MODIFIED_DATUM") => {
                entity.all()?.into_iter().flat_map(|(_, arguments)| arguments).collect()
            }
            false => continue,
        };
        for argument in &arguments {
            words(argument, &mut found.modifiers);
            for next in argument.references().into_iter().rev() {
                let next = table.referred(entity.id(), next)?;
                if next.is("DATUM_REFERENCE_MODIFIER_WITH_VALUE") {
                    let own = next.all()?.into_iter().flat_map(|(_, own)| own).collect::<Vec<_>>();
                    own.iter().for_each(|argument| words(argument, &mut found.modifiers));
                } else {
                    open.push((next, depth + 1));
                }
            }
        }
    }
    Ok(Some(found).filter(|found| !found.letters.is_empty()))
}

/// Adds the words of an argument and of its lists.
fn words(argument: &StepValue<'_>, found: &mut Vec<String>) {
    found.extend(argument.word().into_iter().map(str::to_owned));
    found.extend(argument.items().iter().filter_map(|item| item.word()).map(str::to_owned));
}
