//! Geometric tolerances.

use std::collections::{HashMap, HashSet};

use super::aspect::{Aspects, inside};
use super::datum::{DatumReference, references};
use super::measure::{StepMeasure, measure};
use crate::part21::{Entity, EntityTable, Part21Error, StepValue};

/// Characteristic that a geometric tolerance controls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ToleranceKind {
    /// Flatness.
    Flatness,
    /// Straightness.
    Straightness,
    /// Roundness.
    Roundness,
    /// Cylindricity.
    Cylindricity,
    /// Profile of a line.
    LineProfile,
    /// Profile of a surface.
    SurfaceProfile,
    /// Angularity.
    Angularity,
    /// Perpendicularity.
    Perpendicularity,
    /// Parallelism.
    Parallelism,
    /// Position.
    Position,
    /// Concentricity of points.
    Concentricity,
    /// Coaxiality of axes.
    Coaxiality,
    /// Symmetry.
    Symmetry,
    /// Circular run-out.
    CircularRunout,
    /// Total run-out.
    TotalRunout,
    /// A tolerance whose type the file does not name.
    Other,
}

impl ToleranceKind {
    /// Entities of the fifteen tolerances, with their kinds.
    pub const ENTITIES: [(&'static str, Self); 15] = [
        ("FLATNESS_TOLERANCE", Self::Flatness),
        ("STRAIGHTNESS_TOLERANCE", Self::Straightness),
        ("ROUNDNESS_TOLERANCE", Self::Roundness),
        ("CYLINDRICITY_TOLERANCE", Self::Cylindricity),
        ("LINE_PROFILE_TOLERANCE", Self::LineProfile),
        ("SURFACE_PROFILE_TOLERANCE", Self::SurfaceProfile),
        ("ANGULARITY_TOLERANCE", Self::Angularity),
        ("PERPENDICULARITY_TOLERANCE", Self::Perpendicularity),
        ("PARALLELISM_TOLERANCE", Self::Parallelism),
        ("POSITION_TOLERANCE", Self::Position),
        ("CONCENTRICITY_TOLERANCE", Self::Concentricity),
        ("COAXIALITY_TOLERANCE", Self::Coaxiality),
        ("SYMMETRY_TOLERANCE", Self::Symmetry),
        ("CIRCULAR_RUNOUT_TOLERANCE", Self::CircularRunout),
        ("TOTAL_RUNOUT_TOLERANCE", Self::TotalRunout),
    ];

    /// Name in words.
    pub fn label(self) -> &'static str {
        match self {
            Self::Flatness => "flatness",
            Self::Straightness => "straightness",
            Self::Roundness => "roundness",
            Self::Cylindricity => "cylindricity",
            Self::LineProfile => "line profile",
            Self::SurfaceProfile => "surface profile",
            Self::Angularity => "angularity",
            Self::Perpendicularity => "perpendicularity",
            Self::Parallelism => "parallelism",
            Self::Position => "position",
            Self::Concentricity => "concentricity",
            Self::Coaxiality => "coaxiality",
            Self::Symmetry => "symmetry",
            Self::CircularRunout => "circular run-out",
            Self::TotalRunout => "total run-out",
            Self::Other => "tolerance",
        }
    }

    fn of(entity: Entity<'_>) -> Self {
        let found = Self::ENTITIES.iter().find(|(name, _)| entity.is(name));
        found.map_or(Self::Other, |(_, kind)| *kind)
    }
}

/// Material condition at which a tolerance holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MaterialCondition {
    /// Maximum material.
    Maximum,
    /// Least material.
    Least,
}

/// Shape of a tolerance zone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ZoneShape {
    /// Between two surfaces: the value is a width. The file names no other shape.
    Width,
    /// A cylinder or circle: the value is a diameter.
    Cylinder,
    /// A sphere: the value is a diameter.
    Sphere,
    /// Another shape, as the file names it.
    Other(String),
}

/// A geometric tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct GeometricTolerance {
    /// Number of the entity.
    pub entity: u64,
    /// Characteristic.
    pub kind: ToleranceKind,
    /// Name in the file, often that of its frame.
    pub name: String,
    /// Value. None if the file has none.
    pub value: Option<StepMeasure>,
    /// Material condition.
    pub condition: Option<MaterialCondition>,
    /// Other modifiers as the file names them, such as FREE_STATE.
    pub modifiers: Vec<String>,
    /// Shape of the zone.
    pub zone: ZoneShape,
    /// Length, area or displacement of a unit basis, a maximum or an unequal zone, with the type of its entity.
    pub extra: Vec<(String, StepMeasure)>,
    /// True if the file states datums.
    pub has_datums: bool,
    /// Datums in their order.
    pub datums: Vec<DatumReference>,
    /// Aspect, dimension or shape that it controls.
    pub target: u64,
    /// Numbers of the controlled faces.
    pub faces: Vec<u64>,
    /// True if it controls the whole part.
    pub whole: bool,
    /// Number and types of a controlled item that is not a face.
    pub other: Option<(u64, String)>,
    /// Upper segment of a composite frame of which this is the lower one.
    pub upper: Option<u64>,
}

impl GeometricTolerance {
    /// True if value, a face and the stated datums are known.
    pub fn is_complete(&self) -> bool {
        self.value.is_some() && !self.faces.is_empty() && (!self.has_datums || !self.datums.is_empty())
    }
}

/// Types beside the tolerance's own that carry a measure.
const EXTRA: [&str; 4] = [
    "GEOMETRIC_TOLERANCE_WITH_DEFINED_UNIT",
    "GEOMETRIC_TOLERANCE_WITH_DEFINED_AREA_UNIT",
    "GEOMETRIC_TOLERANCE_WITH_MAXIMUM_TOLERANCE",
    "UNEQUALLY_DISPOSED_GEOMETRIC_TOLERANCE",
];

/// Numbers of all geometric tolerances, in the order of the file.
pub(super) fn tolerance_entities(table: &EntityTable<'_>) -> Vec<u64> {
    let names = ToleranceKind::ENTITIES.iter().map(|(name, _)| *name).chain(["GEOMETRIC_TOLERANCE"]);
    let mut found: Vec<u64> = names.flat_map(|name| table.of_kind(name).map(|entity| entity.id())).collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Shapes of zones by the tolerance that they define.
pub(super) fn zones(table: &EntityTable<'_>) -> Result<HashMap<u64, ZoneShape>, Part21Error> {
    let mut found = HashMap::new();
    let zones: Vec<Entity<'_>> =
        table.of_kind("TOLERANCE_ZONE").chain(table.of_kind("TOLERANCE_ZONE_WITH_DATUM")).collect();
    for zone in zones {
        // In a simple entity the zone's own arguments follow the four of its aspect.
        let mut own = zone.inherited("TOLERANCE_ZONE")?;
        if own.len() > 4 {
            own.drain(..4);
        }
        let Some(form) = own.get(1).and_then(StepValue::reference) else { continue };
        let form = table.referred(zone.id(), form)?;
        let name = form.inherited("TOLERANCE_ZONE_FORM")?.first().and_then(StepValue::text).unwrap_or_default();
        let lower = name.to_ascii_lowercase();
        let shape = match lower.as_str() {
            _ if lower.contains("spher") => ZoneShape::Sphere,
            _ if lower.contains("cylind") || lower.contains("circ") && !lower.contains("between") => {
                ZoneShape::Cylinder
            }
            "" | "unknown" => continue,
            _ if lower.contains("parallel") || lower.contains("plane") => ZoneShape::Width,
            _ => ZoneShape::Other(name),
        };
        for tolerance in own.first().map(StepValue::references).unwrap_or_default() {
            found.insert(tolerance, shape.clone());
        }
    }
    Ok(found)
}

/// Upper segments of composite frames, by the lower ones.
pub(super) fn upper_segments(table: &EntityTable<'_>) -> Result<HashMap<u64, u64>, Part21Error> {
    let mut found = HashMap::new();
    for relation in table.of_kind("GEOMETRIC_TOLERANCE_RELATIONSHIP") {
        let arguments = relation.inherited("GEOMETRIC_TOLERANCE_RELATIONSHIP")?;
        let name = arguments.first().and_then(StepValue::text).unwrap_or_default();
        let ends = [2, 3].map(|index| arguments.get(index).and_then(StepValue::reference));
        if let ([Some(upper), Some(lower)], true) = (ends, name.to_ascii_lowercase().contains("composite")) {
            found.insert(lower, upper);
        }
    }
    Ok(found)
}

/// Reads a geometric tolerance.
pub(super) fn tolerance(
    table: &EntityTable<'_>,
    aspects: &Aspects<'_>,
    entity: Entity<'_>,
    zones: &HashMap<u64, ZoneShape>,
    upper: &HashMap<u64, u64>,
) -> Result<GeometricTolerance, Part21Error> {
    let arguments = entity.inherited("GEOMETRIC_TOLERANCE")?;
    let value = match arguments.get(2).and_then(StepValue::reference) {
        Some(value) => measure(table, table.referred(entity.id(), value)?)?,
        None => None,
    };
    let systems: Vec<u64> = match entity.arguments("GEOMETRIC_TOLERANCE_WITH_DATUM_REFERENCE")? {
        Some(own) => own.iter().flat_map(StepValue::references).collect(),
        // A simple tolerance with datums has them after the four arguments of every tolerance.
        None => {
            arguments.iter().skip(4).filter(|value| !value.items().is_empty()).flat_map(StepValue::references).collect()
        }
    };
    let target = arguments.get(3).and_then(StepValue::reference).unwrap_or(0);
    let mut found = GeometricTolerance {
        entity: entity.id(),
        kind: ToleranceKind::of(entity),
        name: arguments.first().and_then(StepValue::text).unwrap_or_default(),
        value,
        condition: None,
        modifiers: Vec::new(),
        zone: zones.get(&entity.id()).cloned().unwrap_or(ZoneShape::Width),
        extra: Vec::new(),
        has_datums: !systems.is_empty(),
        datums: references(table, entity.id(), &systems)?,
        target,
        faces: Vec::new(),
        whole: false,
        other: None,
        upper: upper.get(&entity.id()).copied(),
    };
    modifiers(table, entity, &mut found)?;
    if target != 0 {
        faces(aspects, table.referred(entity.id(), target)?, &mut found)?;
    }
    Ok(found)
}

/// Reads modifiers and the measures beside the value.
fn modifiers(table: &EntityTable<'_>, entity: Entity<'_>, found: &mut GeometricTolerance) -> Result<(), Part21Error> {
    for kind in ["GEOMETRIC_TOLERANCE_WITH_MODIFIERS", "MODIFIED_GEOMETRIC_TOLERANCE"] {
        let own = entity.arguments(kind)?.unwrap_or_default();
        let words = own.iter().flat_map(|value| value.items().iter().filter_map(StepValue::word).chain(value.word()));
        for word in words {
            match word {
                "MAXIMUM_MATERIAL_REQUIREMENT" | "MAXIMUM_MATERIAL_CONDITION" => {
                    found.condition = Some(MaterialCondition::Maximum);
                }
                "LEAST_MATERIAL_REQUIREMENT" | "LEAST_MATERIAL_CONDITION" => {
                    found.condition = Some(MaterialCondition::Least);
                }
                "REGARDLESS_OF_FEATURE_SIZE" => {}
                other => found.modifiers.push(other.to_owned()),
            }
        }
    }
    for kind in EXTRA {
        for id in entity.arguments(kind)?.unwrap_or_default().iter().flat_map(StepValue::references) {
            if let Some(value) = measure(table, table.referred(entity.id(), id)?)? {
                found.extra.push((kind.to_owned(), value));
            }
        }
    }
    Ok(())
}

/// Finds the faces that a tolerance controls: those of an aspect, or of the aspects that a dimension measures.
fn faces(aspects: &Aspects<'_>, target: Entity<'_>, found: &mut GeometricTolerance) -> Result<(), Part21Error> {
    if target.is("PRODUCT_DEFINITION_SHAPE") {
        found.whole = true;
        return Ok(());
    }
    let is_dimension = target.kinds().any(super::dimension::is_dimension) && !target.is("SHAPE_ASPECT");
    let from = if is_dimension { inside(target)? } else { vec![target.id()] };
    let mut seen = HashSet::new();
    for aspect in from {
        let items = aspects.items(aspect)?;
        found.faces.extend(items.faces.iter().filter(|face| seen.insert(**face)));
        found.whole |= items.whole;
        found.other = found.other.take().or(items.other);
    }
    Ok(())
}
