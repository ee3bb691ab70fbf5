//! Content of an AP242 file: parts with tolerances, datums, dimensions and faces.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::aspect::Aspects;
use super::datum::{StepDatum, TargetRepresentations, datum};
use super::dimension::{DimensionValues, StepDimension, dimension, dimension_entities};
use super::face::{Faces, StepFace};
use super::measure::StepUnit;
use super::product::{PlacedPart, Products};
use super::tolerance::{GeometricTolerance, tolerance, tolerance_entities, upper_segments, zones};
use crate::part21::{Entity, EntityTable, Part21Error, StepValue};

/// Entities of drawn annotations: lines, fills and texts without meaning.
const ANNOTATIONS: [&str; 6] = [
    "ANNOTATION_OCCURRENCE",
    "ANNOTATION_CURVE_OCCURRENCE",
    "ANNOTATION_FILL_AREA_OCCURRENCE",
    "ANNOTATION_TEXT_OCCURRENCE",
    "DRAUGHTING_ANNOTATION_OCCURRENCE",
    "TESSELLATED_ANNOTATION_OCCURRENCE",
];

/// A part with everything that names its faces.
#[derive(Debug, Clone, PartialEq)]
pub struct StepPart {
    /// Number of the product definition; 0 if the file names none.
    pub definition: u64,
    /// Name of the product.
    pub name: String,
    /// Unit of coordinates.
    pub unit: StepUnit,
    /// Geometric tolerances.
    pub tolerances: Vec<GeometricTolerance>,
    /// Dimensions.
    pub dimensions: Vec<StepDimension>,
    /// Datums.
    pub datums: Vec<StepDatum>,
    /// Faces that tolerances, dimensions and datums name, and those that were requested.
    pub faces: BTreeMap<u64, StepFace>,
}

/// Content of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct StepModel {
    /// Parts, without assemblies that carry nothing themselves.
    pub parts: Vec<StepPart>,
    /// Parts at their places; empty for a file without an assembly.
    pub placed: Vec<PlacedPart>,
    /// Number of drawn annotations.
    pub annotations: usize,
}

impl StepModel {
    /// Reads the content of a file.
    ///
    /// `all_faces` also reads the faces that nothing names.
    ///
    /// # Errors
    /// If an entity that is needed is damaged or missing, or parts contain themselves.
    pub fn read(table: &EntityTable<'_>, all_faces: bool) -> Result<Self, Part21Error> {
        let products = Products::read(table)?;
        let aspects = Aspects::read(table)?;
        let mut parts: BTreeMap<u64, StepPart> = BTreeMap::new();
        for definition in products.definitions() {
            if !products.is_assembly(definition) {
                parts.insert(definition, part(&products, definition)?);
            }
        }
        let owner = Owner { table, products: &products };
        let (zones, upper) = (zones(table)?, upper_segments(table)?);
        for id in tolerance_entities(table) {
            let Some(entity) = table.get(id) else { continue };
            let found = tolerance(table, &aspects, entity, &zones, &upper)?;
            let definition = owner.definition(found.target)?;
            self::entry(&mut parts, &products, definition)?.tolerances.push(found);
        }
        let values = DimensionValues::read(table)?;
        for id in dimension_entities(table) {
            let Some(entity) = table.get(id) else { continue };
            let found = dimension(table, &aspects, &values, entity)?;
            let definition = owner.definition(found.aspects.first().copied().unwrap_or(0))?;
            self::entry(&mut parts, &products, definition)?.dimensions.push(found);
        }
        let representations = TargetRepresentations::read(table)?;
        for entity in table.of_kind("DATUM") {
            let found = datum(table, &aspects, &representations, entity)?;
            let definition = owner.definition(entity.id())?;
            self::entry(&mut parts, &products, definition)?.datums.push(found);
        }
        let mut faces = Faces::new(table);
        for part in parts.values_mut() {
            read_faces(part, &mut faces, all_faces.then_some(&products))?;
        }
        let annotations = ANNOTATIONS.iter().map(|kind| table.count(kind)).sum();
        Ok(Self { parts: parts.into_values().collect(), placed: products.placed()?, annotations })
    }

    /// Number of geometric tolerances of all parts.
    pub fn tolerance_count(&self) -> usize {
        self.parts.iter().map(|part| part.tolerances.len()).sum()
    }
}

/// A part without tolerances.
fn part(products: &Products<'_>, definition: u64) -> Result<StepPart, Part21Error> {
    Ok(StepPart {
        definition,
        name: products.name(definition)?,
        unit: products.length_unit(definition)?,
        tolerances: Vec::new(),
        dimensions: Vec::new(),
        datums: Vec::new(),
        faces: BTreeMap::new(),
    })
}

/// Part of a product definition. The only part takes what names none.
fn entry<'p>(
    parts: &'p mut BTreeMap<u64, StepPart>,
    products: &Products<'_>,
    definition: Option<u64>,
) -> Result<&'p mut StepPart, Part21Error> {
    let only = match parts.len() {
        1 => parts.keys().next().copied(),
        _ => None,
    };
    let definition = definition.or(only).unwrap_or(0);
    Ok(match parts.entry(definition) {
        Entry::Occupied(found) => found.into_mut(),
        Entry::Vacant(free) => free.insert(part(products, definition)?),
    })
}

/// Reads the faces of a part.
fn read_faces(part: &mut StepPart, faces: &mut Faces<'_>, all: Option<&Products<'_>>) -> Result<(), Part21Error> {
    let mut named: Vec<u64> = Vec::new();
    part.tolerances.iter().for_each(|tolerance| named.extend(&tolerance.faces));
    part.dimensions.iter().for_each(|dimension| named.extend(dimension.ends.iter().flatten()));
    part.datums.iter().for_each(|datum| named.extend(&datum.faces));
    if let Some(products) = all {
        named.extend(products.faces(part.definition)?);
    }
    for id in named {
        if !part.faces.contains_key(&id)
            && let Some(face) = faces.face(id)?
        {
            part.faces.insert(id, face);
        }
    }
    Ok(())
}

/// Finds the part of an aspect.
struct Owner<'a, 't> {
    table: &'t EntityTable<'t>,
    products: &'a Products<'t>,
}

impl Owner<'_, '_> {
    /// Product definition of an aspect, a dimension or a shape. Returns None if it names none.
    fn definition(&self, of: u64) -> Result<Option<u64>, Part21Error> {
        let mut at = of;
        // A tolerance of a dimension of an aspect of a shape has three steps.
        for _ in 0..4 {
            let Some(entity) = self.table.get(at) else { return Ok(None) };
            if entity.is("PRODUCT_DEFINITION_SHAPE") {
                return self.products.definition(at);
            }
            let Some(next) = self.shape(entity)? else { return Ok(None) };
            at = next;
        }
        Ok(None)
    }

    /// Shape of an aspect, or aspect of a dimension.
    fn shape(&self, entity: Entity<'_>) -> Result<Option<u64>, Part21Error> {
        let is_size = entity.kinds().any(super::dimension::is_dimension) && !entity.is("SHAPE_ASPECT");
        let (kind, index) = match is_size {
            true if entity.is("DIMENSIONAL_SIZE") || entity.kinds().any(|kind| kind.contains("SIZE")) => {
                ("DIMENSIONAL_SIZE", 0)
            }
            true => ("SHAPE_ASPECT_RELATIONSHIP", 2),
            false => ("SHAPE_ASPECT", 2),
        };
        Ok(entity.inherited(kind)?.get(index).and_then(StepValue::reference))
    }
}
