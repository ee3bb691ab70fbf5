//! Products, their units, and the placed parts of an assembly.

use std::collections::{HashMap, HashSet};

use super::measure::{StepUnit, unit_of};
use super::placement::{Placement, placement};
use crate::part21::{Entity, EntityTable, Part21Error, Part21Fault, StepValue};

/// Greatest number of placed parts of an assembly. A study has far fewer.
const MOST_PLACED: usize = 10_000;

/// A part at its place in an assembly.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedPart {
    /// Number of the product definition.
    pub definition: u64,
    /// Name of the occurrence, or of the product.
    pub name: String,
    /// Placement in the assembly, in the unit of the part.
    pub placement: Placement,
}

/// Products of a file.
#[derive(Debug)]
pub(super) struct Products<'t> {
    table: &'t EntityTable<'t>,
    /// Product definition of each PRODUCT_DEFINITION_SHAPE.
    shapes: HashMap<u64, u64>,
    /// Representations of each product definition.
    representations: HashMap<u64, Vec<u64>>,
    /// Occurrences of parts in each product definition.
    uses: HashMap<u64, Vec<PartUse>>,
}

/// A part in an assembly.
#[derive(Debug)]
struct PartUse {
    part: u64,
    name: String,
    placement: Placement,
}

impl<'t> Products<'t> {
    pub(super) fn read(table: &'t EntityTable<'t>) -> Result<Self, Part21Error> {
        let mut found = Self { table, shapes: HashMap::new(), representations: HashMap::new(), uses: HashMap::new() };
        for shape in table.of_kind("PRODUCT_DEFINITION_SHAPE") {
            let arguments = shape.inherited("PROPERTY_DEFINITION")?;
            if let Some(definition) = arguments.get(2).and_then(StepValue::reference) {
                table.referred(shape.id(), definition)?;
                found.shapes.insert(shape.id(), definition);
            }
        }
        for link in table.of_kind("SHAPE_DEFINITION_REPRESENTATION") {
            let arguments = link.inherited("PROPERTY_DEFINITION_REPRESENTATION")?;
            let ends = [0, 1].map(|index| arguments.get(index).and_then(StepValue::reference));
            if let [Some(shape), Some(representation)] = ends
                && let Some(definition) = found.shapes.get(&shape)
            {
                table.referred(link.id(), representation)?;
                found.representations.entry(*definition).or_default().push(representation);
            }
        }
        let placements = found.placements()?;
        for occurrence in table.of_kind("NEXT_ASSEMBLY_USAGE_OCCURRENCE") {
            let arguments = occurrence.inherited("PRODUCT_DEFINITION_RELATIONSHIP")?;
            let ends = [3, 4].map(|index| arguments.get(index).and_then(StepValue::reference));
            let [Some(assembly), Some(part)] = ends else { continue };
            table.referred(occurrence.id(), assembly)?;
            table.referred(occurrence.id(), part)?;
            let name = arguments.get(1).and_then(StepValue::text).unwrap_or_default();
            let placement = placements.get(&occurrence.id()).copied().unwrap_or(Placement::IDENTITY);
            found.uses.entry(assembly).or_default().push(PartUse { part, name, placement });
        }
        Ok(found)
    }

    /// Placements of occurrences in their assemblies.
    fn placements(&self) -> Result<HashMap<u64, Placement>, Part21Error> {
        let mut found = HashMap::new();
        for link in self.table.of_kind("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION") {
            let arguments = link.inherited("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")?;
            let ends = [0, 1].map(|index| arguments.get(index).and_then(StepValue::reference));
            let [Some(relation), Some(shape)] = ends else { continue };
            let Some(&occurrence) = self.shapes.get(&shape) else { continue };
            let relation = self.table.referred(link.id(), relation)?;
            if let Some(placement) = self.transformation(relation, occurrence)? {
                found.insert(occurrence, placement);
            }
        }
        Ok(found)
    }

    /// Placement by a representation relationship with a transformation.
    fn transformation(&self, relation: Entity<'_>, occurrence: u64) -> Result<Option<Placement>, Part21Error> {
        let own = relation.arguments("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION")?.unwrap_or_default();
        let Some(transformation) = own.iter().rev().find_map(StepValue::reference) else { return Ok(None) };
        let ends = relation.inherited("REPRESENTATION_RELATIONSHIP")?;
        let second = ends.get(3).and_then(StepValue::reference);
        let transformation = self.table.referred(relation.id(), transformation)?;
        let Some(items) = transformation.arguments("ITEM_DEFINED_TRANSFORMATION")? else { return Ok(None) };
        let items = [2, 3].map(|index| items.get(index).and_then(StepValue::reference));
        let [Some(first), Some(last)] = items else { return Ok(None) };
        let from = placement(self.table, transformation.id(), first)?;
        let to = placement(self.table, transformation.id(), last)?;
        let (Some(from), Some(to)) = (from, to) else { return Ok(None) };
        let moves = to.of(&from.inverse());
        // The relation leads from the part to the assembly. Some writers state it the other way round.
        let arguments = self.table.referred(occurrence, occurrence)?.inherited("PRODUCT_DEFINITION_RELATIONSHIP")?;
        let part = arguments.get(4).and_then(StepValue::reference);
        let of_part = part.and_then(|part| self.representations.get(&part));
        let is_reversed = of_part.is_some_and(|of_part| second.is_some_and(|second| of_part.contains(&second)));
        Ok(Some(if is_reversed { moves.inverse() } else { moves }))
    }

    /// Product definition of a shape, or of the part of an occurrence. Returns None for an aspect without one.
    pub(super) fn definition(&self, shape: u64) -> Result<Option<u64>, Part21Error> {
        let Some(&definition) = self.shapes.get(&shape) else { return Ok(None) };
        let entity = self.table.referred(shape, definition)?;
        match entity.is("NEXT_ASSEMBLY_USAGE_OCCURRENCE") {
            true => {
                let arguments = entity.inherited("PRODUCT_DEFINITION_RELATIONSHIP")?;
                Ok(arguments.get(4).and_then(StepValue::reference))
            }
            false => Ok(Some(definition)),
        }
    }

    /// Product definitions that have a shape.
    pub(super) fn definitions(&self) -> Vec<u64> {
        let mut found: Vec<u64> = self.table.of_kind("PRODUCT_DEFINITION").map(|entity| entity.id()).collect();
        found.extend(self.table.of_kind("PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS").map(|entity| entity.id()));
        found.retain(|definition| self.representations.contains_key(definition) || self.uses.contains_key(definition));
        found
    }

    /// True if a product is an assembly.
    pub(super) fn is_assembly(&self, definition: u64) -> bool {
        self.uses.contains_key(&definition)
    }

    /// Name of the product of a definition.
    pub(super) fn name(&self, definition: u64) -> Result<String, Part21Error> {
        let Some(definition) = self.table.get(definition) else { return Ok(String::new()) };
        let arguments = definition.inherited("PRODUCT_DEFINITION")?;
        let Some(formation) = arguments.get(2).and_then(StepValue::reference) else { return Ok(String::new()) };
        let formation = self.table.referred(definition.id(), formation)?;
        let arguments = formation.inherited("PRODUCT_DEFINITION_FORMATION")?;
        let Some(product) = arguments.get(2).and_then(StepValue::reference) else { return Ok(String::new()) };
        let product = self.table.referred(formation.id(), product)?;
        let arguments = product.inherited("PRODUCT")?;
        let names = [1, 0].map(|index| arguments.get(index).and_then(StepValue::text).unwrap_or_default());
        Ok(names.into_iter().map(|name| name.trim().to_owned()).find(|name| !name.is_empty()).unwrap_or_default())
    }

    /// Unit of lengths of a part. Returns `Other` if its context has none.
    pub(super) fn length_unit(&self, definition: u64) -> Result<StepUnit, Part21Error> {
        for &representation in self.representations.get(&definition).map_or(&[][..], Vec::as_slice) {
            let representation = self.table.referred(definition, representation)?;
            let arguments = representation.inherited("REPRESENTATION")?;
            let Some(context) = arguments.get(2).and_then(StepValue::reference) else { continue };
            let context = self.table.referred(representation.id(), context)?;
            let own = context.arguments("GLOBAL_UNIT_ASSIGNED_CONTEXT")?.unwrap_or_default();
            for unit in own.last().map(StepValue::references).unwrap_or_default() {
                let unit = unit_of(self.table, self.table.referred(context.id(), unit)?)?;
                if matches!(unit, StepUnit::Length(_)) {
                    return Ok(unit);
                }
            }
        }
        Ok(StepUnit::Other)
    }

    /// Parts of the assemblies of a file at their places. Returns nothing for a file without an assembly.
    pub(super) fn placed(&self) -> Result<Vec<PlacedPart>, Part21Error> {
        let parts: HashSet<u64> = self.uses.values().flatten().map(|one| one.part).collect();
        let mut roots: Vec<u64> = self.uses.keys().filter(|assembly| !parts.contains(assembly)).copied().collect();
        roots.sort_unstable();
        if roots.is_empty()
            && let Some(first) = self.uses.keys().min()
        {
            return Err(self.fault(*first, Part21Fault::Cyclic(*first)));
        }
        let mut found = Vec::new();
        // Depth first in the order of the file: a part, its placement, and the assemblies above it.
        let mut open: Vec<(u64, String, Placement, Vec<u64>)> = Vec::new();
        open.extend(roots.into_iter().rev().map(|root| (root, String::new(), Placement::IDENTITY, Vec::new())));
        let mut visited = 0_usize;
        while let Some((definition, name, placement, above)) = open.pop() {
            visited += 1;
            if visited > MOST_PLACED {
                return Err(Part21Error { line: None, fault: Part21Fault::Parts(MOST_PLACED) });
            }
            if above.contains(&definition) {
                return Err(self.fault(definition, Part21Fault::Cyclic(definition)));
            }
            let Some(uses) = self.uses.get(&definition) else {
                found.push(PlacedPart { definition, name, placement });
                continue;
            };
            if open.len() + uses.len() > MOST_PLACED {
                return Err(Part21Error { line: None, fault: Part21Fault::Parts(MOST_PLACED) });
            }
            let mut above = above;
            above.push(definition);
            for one in uses.iter().rev() {
                open.push((one.part, one.name.clone(), placement.of(&one.placement), above.clone()));
            }
        }
        Ok(found)
    }

    fn fault(&self, entity: u64, fault: Part21Fault) -> Part21Error {
        Part21Error { line: self.table.get(entity).map(|entity| entity.line()), fault }
    }

    /// Numbers of all faces of the solids and surfaces of a part.
    pub(super) fn faces(&self, definition: u64) -> Result<Vec<u64>, Part21Error> {
        let mut linked: HashMap<u64, Vec<u64>> = HashMap::new();
        for relation in self.table.of_kind("SHAPE_REPRESENTATION_RELATIONSHIP") {
            if relation.is("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") {
                continue;
            }
            let arguments = relation.inherited("REPRESENTATION_RELATIONSHIP")?;
            let ends = [2, 3].map(|index| arguments.get(index).and_then(StepValue::reference));
            if let [Some(a), Some(b)] = ends {
                linked.entry(a).or_default().push(b);
                linked.entry(b).or_default().push(a);
            }
        }
        let mut open: Vec<u64> = self.representations.get(&definition).cloned().unwrap_or_default();
        let mut seen: HashSet<u64> = open.iter().copied().collect();
        let mut items = Vec::new();
        while let Some(id) = open.pop() {
            let representation = self.table.referred(definition, id)?;
            let arguments = representation.inherited("REPRESENTATION")?;
            items.extend(arguments.get(1).map(StepValue::references).unwrap_or_default());
            open.extend(linked.get(&id).into_iter().flatten().filter(|&&next| seen.insert(next)));
        }
        self.faces_of(definition, items)
    }

    fn faces_of(&self, from: u64, items: Vec<u64>) -> Result<Vec<u64>, Part21Error> {
        let mut found = Vec::new();
        let mut seen = HashSet::new();
        let mut open: Vec<u64> = items.into_iter().rev().collect();
        while let Some(id) = open.pop() {
            if !seen.insert(id) {
                continue;
            }
            let entity = self.table.referred(from, id)?;
            let holds = |kind: &str| {
                kind.ends_with("_SHELL")
                    || kind.ends_with("_BREP")
                    || kind.contains("BREP_")
                    || kind.ends_with("SURFACE_MODEL")
            };
            if entity.first_of(&super::aspect::FACES).is_some() {
                found.push(id);
            } else if entity.kinds().any(|kind| holds(kind) || kind == "CONNECTED_FACE_SET") {
                open.extend(super::aspect::inside(entity)?.into_iter().rev());
            }
        }
        Ok(found)
    }
}
