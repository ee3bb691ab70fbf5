//! Shape aspects: the faces that a tolerance, datum or dimension refers to.

use std::collections::{HashMap, HashSet};

use crate::part21::{Entity, EntityTable, Part21Error, Part21Fault, StepValue};

/// Relations of an aspect to its parts, to its sources, and of datum features to datums.
const RELATIONS: [&str; 5] = [
    "SHAPE_ASPECT_RELATIONSHIP",
    "SHAPE_ASPECT_DERIVING_RELATIONSHIP",
    "FEATURE_FOR_DATUM_TARGET_RELATIONSHIP",
    "SHAPE_ASPECT_ASSOCIATIVITY",
    "SHAPE_ASPECT_TRANSITION",
];
/// Subtypes of the relation that are dimensions.
const DIMENSIONS: [&str; 4] =
    ["DIMENSIONAL_LOCATION", "ANGULAR_LOCATION", "DIRECTED_DIMENSIONAL_LOCATION", "DIMENSIONAL_LOCATION_WITH_PATH"];
/// Entities that link an aspect to an item of a representation.
const USAGES: [&str; 2] = ["GEOMETRIC_ITEM_SPECIFIC_USAGE", "ITEM_IDENTIFIED_REPRESENTATION_USAGE"];
/// Items that consist of faces.
const SHELLS: [&str; 6] = [
    "OPEN_SHELL",
    "CLOSED_SHELL",
    "CONNECTED_FACE_SET",
    "ORIENTED_OPEN_SHELL",
    "ORIENTED_CLOSED_SHELL",
    "SURFACED_OPEN_SHELL",
];
/// Faces.
pub(super) const FACES: [&str; 3] = ["ADVANCED_FACE", "FACE_SURFACE", "ORIENTED_FACE"];
/// Types of datum targets.
pub(super) const TARGETS: [&str; 2] = ["PLACED_DATUM_TARGET_FEATURE", "DATUM_TARGET"];
/// Greatest number of entities that all relations together lead to. A part of 200 MB has some ten million edges.
const MOST: usize = 20_000_000;

/// Number of visited entities, over all aspects of a file.
#[derive(Debug, Default)]
pub(super) struct Effort(std::cell::Cell<usize>);

impl Effort {
    /// Counts visited entities.
    pub(super) fn add(&self, from: u64, count: usize) -> Result<(), Part21Error> {
        self.0.set(self.0.get().saturating_add(count));
        match self.0.get() > MOST {
            true => Err(Part21Error { line: None, fault: Part21Fault::Wide(from, MOST) }),
            false => Ok(()),
        }
    }
}

/// Items that an aspect names.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct AspectItems {
    /// Numbers of faces.
    pub(super) faces: Vec<u64>,
    /// True if the aspect names a solid or the whole part.
    pub(super) whole: bool,
    /// Number and types of an item that is not a face. None if there is no other item.
    pub(super) other: Option<(u64, String)>,
}

/// Relations of all aspects of a file.
#[derive(Debug)]
pub(super) struct Aspects<'t> {
    table: &'t EntityTable<'t>,
    items: HashMap<u64, Vec<u64>>,
    /// Aspects that an aspect relates to itself: its parts or sources.
    below: HashMap<u64, Vec<u64>>,
    /// Aspects that relate this one to themselves.
    above: HashMap<u64, Vec<u64>>,
    pub(super) effort: Effort,
}

impl<'t> Aspects<'t> {
    pub(super) fn read(table: &'t EntityTable<'t>) -> Result<Self, Part21Error> {
        let mut found = Self {
            table,
            items: HashMap::new(),
            below: HashMap::new(),
            above: HashMap::new(),
            effort: Effort::default(),
        };
        for kind in USAGES {
            for usage in table.of_kind(kind) {
                let arguments = usage.inherited("ITEM_IDENTIFIED_REPRESENTATION_USAGE")?;
                let definition = arguments.get(2).and_then(StepValue::reference);
                let (Some(definition), Some(items)) = (definition, arguments.get(4)) else { continue };
                let aspect = aspect_of(table, table.referred(usage.id(), definition)?)?;
                found.items.entry(aspect).or_default().extend(items.references());
            }
        }
        let mut seen = HashSet::new();
        for kind in RELATIONS {
            for relation in table.of_kind(kind) {
                if relation.first_of(&DIMENSIONS).is_some() || !seen.insert(relation.id()) {
                    continue;
                }
                let arguments = relation.inherited("SHAPE_ASPECT_RELATIONSHIP")?;
                let ends = [2, 3].map(|index| arguments.get(index).and_then(StepValue::reference));
                let [Some(relating), Some(related)] = ends else { continue };
                table.referred(relation.id(), relating)?;
                table.referred(relation.id(), related)?;
                found.below.entry(relating).or_default().push(related);
                found.above.entry(related).or_default().push(relating);
            }
        }
        Ok(found)
    }

    /// Items of an aspect and of all aspects below it.
    pub(super) fn items(&self, aspect: u64) -> Result<AspectItems, Part21Error> {
        self.items_of(vec![aspect])
    }

    /// Items of a datum: its own, and those of its datum features.
    pub(super) fn datum_items(&self, datum: u64) -> Result<AspectItems, Part21Error> {
        let mut from = vec![datum];
        from.extend(self.above(datum));
        self.items_of(from)
    }

    /// Aspects that relate this one to themselves.
    pub(super) fn above(&self, aspect: u64) -> &[u64] {
        self.above.get(&aspect).map_or(&[], Vec::as_slice)
    }

    /// Aspects that this one relates to itself.
    pub(super) fn below(&self, aspect: u64) -> &[u64] {
        self.below.get(&aspect).map_or(&[], Vec::as_slice)
    }

    fn items_of(&self, from: Vec<u64>) -> Result<AspectItems, Part21Error> {
        let mut found = AspectItems::default();
        let mut seen: HashSet<u64> = from.iter().copied().collect();
        // In the order of the file, so that names of features follow it.
        let mut open: Vec<u64> = from.into_iter().rev().collect();
        let mut items = HashSet::new();
        while let Some(aspect) = open.pop() {
            self.effort.add(aspect, 1)?;
            for &item in self.items.get(&aspect).map_or(&[][..], Vec::as_slice) {
                self.add_item(aspect, item, &mut items, &mut found)?;
            }
            for &next in self.below(aspect).iter().rev() {
                if seen.insert(next) {
                    open.push(next);
                }
            }
        }
        Ok(found)
    }

    /// Adds an item of a representation: a face, the faces of a shell, a solid, or another one.
    fn add_item(
        &self,
        from: u64,
        item: u64,
        seen: &mut HashSet<u64>,
        found: &mut AspectItems,
    ) -> Result<(), Part21Error> {
        let mut open = vec![(from, item)];
        while let Some((from, item)) = open.pop() {
            if !seen.insert(item) {
                continue;
            }
            self.effort.add(item, 1)?;
            let entity = self.table.referred(from, item)?;
            if entity.is("ORIENTED_FACE") || entity.first_of(&SHELLS).is_some() {
                open.extend(inside(entity)?.into_iter().rev().map(|face| (item, face)));
            } else if entity.first_of(&FACES).is_some() {
                found.faces.push(item);
            } else if entity.kinds().any(|kind| kind.ends_with("_BREP") || kind.starts_with("BREP_")) {
                found.whole = true;
            } else if found.other.is_none() {
                found.other = Some((item, entity.kind_text()));
            }
        }
        Ok(())
    }
}

/// Entities that an entity names in any argument.
pub(super) fn inside(entity: Entity<'_>) -> Result<Vec<u64>, Part21Error> {
    let all = entity.all()?;
    Ok(all.iter().flat_map(|(_, arguments)| arguments.iter().flat_map(StepValue::references)).collect())
}

/// Aspect of a definition: the aspect itself, or the one that a property describes.
fn aspect_of(table: &EntityTable<'_>, definition: Entity<'_>) -> Result<u64, Part21Error> {
    if let Some(arguments) = definition.arguments("PROPERTY_DEFINITION")?
        && let Some(aspect) = arguments.get(2).and_then(StepValue::reference)
        && table.referred(definition.id(), aspect)?.kinds().any(|kind| kind.ends_with("SHAPE_ASPECT"))
    {
        return Ok(aspect);
    }
    Ok(definition.id())
}
