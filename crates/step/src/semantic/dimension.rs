//! Dimensions of size and location, with their limits.

use std::collections::HashMap;

use super::aspect::{AspectItems, Aspects};
use super::datum::item_name;
use super::measure::{StepMeasure, measure};
use crate::part21::{Entity, EntityTable, Part21Error, StepValue};

/// Entities of sizes.
const SIZES: [&str; 4] =
    ["DIMENSIONAL_SIZE", "ANGULAR_SIZE", "DIMENSIONAL_SIZE_WITH_PATH", "DIMENSIONAL_SIZE_WITH_DATUM_FEATURE"];
/// Entities of locations.
const LOCATIONS: [&str; 4] =
    ["DIMENSIONAL_LOCATION", "ANGULAR_LOCATION", "DIRECTED_DIMENSIONAL_LOCATION", "DIMENSIONAL_LOCATION_WITH_PATH"];

/// True for the name of a type of dimension.
pub(super) fn is_dimension(kind: &str) -> bool {
    SIZES.contains(&kind) || LOCATIONS.contains(&kind)
}

/// Quantity that a dimension measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DimensionKind {
    /// A diameter.
    Diameter,
    /// A radius.
    Radius,
    /// An angle.
    Angle,
    /// A distance of two faces, or a width or length of one feature.
    Length,
}

/// Limits of a dimension.
#[derive(Debug, Clone, PartialEq)]
pub enum DimensionLimits {
    /// Lower and upper deviation from the nominal value.
    Deviations([StepMeasure; 2]),
    /// Lower and upper limit.
    Values([StepMeasure; 2]),
    /// A greatest value alone.
    Maximum(StepMeasure),
    /// A least value alone.
    Minimum(StepMeasure),
    /// A tolerance class of ISO 286 such as H7.
    Fit(String),
    /// A theoretically exact value, which has no tolerance.
    Exact,
    /// A reference value.
    Reference,
    /// None in the file.
    None,
}

/// A dimension.
#[derive(Debug, Clone, PartialEq)]
pub struct StepDimension {
    /// Number of the entity.
    pub entity: u64,
    /// Name in the file, such as diameter or linear distance.
    pub name: String,
    /// Quantity.
    pub kind: DimensionKind,
    /// Nominal value. None if the file has none.
    pub value: Option<StepMeasure>,
    /// Limits.
    pub limits: DimensionLimits,
    /// True if the file gives deviations or a tolerance class as PLUS_MINUS_TOLERANCE.
    pub has_plus_minus: bool,
    /// Faces: of the feature of a size, or of the two ends of a location.
    pub ends: Vec<Vec<u64>>,
    /// Aspects of the ends.
    pub aspects: Vec<u64>,
    /// True for a size, false for a location.
    pub is_size: bool,
}

/// Values and limits of all dimensions of a file.
#[derive(Debug)]
pub(super) struct DimensionValues {
    /// Representations by dimension.
    representations: HashMap<u64, Vec<u64>>,
    /// Ranges of tolerance by dimension.
    ranges: HashMap<u64, u64>,
    /// Names of the qualifiers of representation items that other entities give.
    qualified: HashMap<u64, Vec<u64>>,
}

impl DimensionValues {
    pub(super) fn read(table: &EntityTable<'_>) -> Result<Self, Part21Error> {
        let mut found = Self { representations: HashMap::new(), ranges: HashMap::new(), qualified: HashMap::new() };
        for link in table.of_kind("DIMENSIONAL_CHARACTERISTIC_REPRESENTATION") {
            let arguments = link.inherited("DIMENSIONAL_CHARACTERISTIC_REPRESENTATION")?;
            let ends = [0, 1].map(|index| arguments.get(index).and_then(StepValue::reference));
            if let [Some(dimension), Some(representation)] = ends {
                found.representations.entry(dimension).or_default().push(representation);
            }
        }
        for tolerance in table.of_kind("PLUS_MINUS_TOLERANCE") {
            let arguments = tolerance.inherited("PLUS_MINUS_TOLERANCE")?;
            let ends = [0, 1].map(|index| arguments.get(index).and_then(StepValue::reference));
            if let [Some(range), Some(dimension)] = ends {
                found.ranges.insert(dimension, range);
            }
        }
        for qualification in table.of_kind("MEASURE_QUALIFICATION") {
            let arguments = qualification.inherited("MEASURE_QUALIFICATION")?;
            let (Some(measure), Some(qualifiers)) = (arguments.get(2).and_then(StepValue::reference), arguments.get(3))
            else {
                continue;
            };
            found.qualified.entry(measure).or_default().extend(qualifiers.references());
        }
        Ok(found)
    }
}

/// Numbers of all dimensions, in the order of the file.
pub(super) fn dimension_entities(table: &EntityTable<'_>) -> Vec<u64> {
    let mut found: Vec<u64> =
        SIZES.iter().chain(&LOCATIONS).flat_map(|name| table.of_kind(name).map(|entity| entity.id())).collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Reads a dimension.
pub(super) fn dimension(
    table: &EntityTable<'_>,
    aspects: &Aspects<'_>,
    values: &DimensionValues,
    entity: Entity<'_>,
) -> Result<StepDimension, Part21Error> {
    let is_size = entity.first_of(&SIZES).is_some();
    let own = match is_size {
        true => entity.inherited("DIMENSIONAL_SIZE")?,
        false => entity.inherited("SHAPE_ASPECT_RELATIONSHIP")?,
    };
    let reference = |index: usize| own.get(index).and_then(StepValue::reference);
    let (name, ends) = match is_size {
        true => (own.get(1), vec![reference(0)]),
        false => (own.first(), vec![reference(2), reference(3)]),
    };
    let name = name.and_then(StepValue::text).unwrap_or_default();
    let of: Vec<u64> = ends.into_iter().flatten().collect();
    let mut faces = Vec::new();
    for &aspect in &of {
        table.referred(entity.id(), aspect)?;
        let items: AspectItems = aspects.items(aspect)?;
        faces.push(items.faces);
    }
    let lower = name.to_ascii_lowercase();
    let is_angle = entity.is("ANGULAR_SIZE") || entity.is("ANGULAR_LOCATION");
    let kind = match lower.as_str() {
        _ if is_angle => DimensionKind::Angle,
        _ if lower.contains("diameter") => DimensionKind::Diameter,
        _ if lower.contains("radius") => DimensionKind::Radius,
        _ => DimensionKind::Length,
    };
    let mut found = StepDimension {
        entity: entity.id(),
        name,
        kind,
        value: None,
        limits: DimensionLimits::None,
        has_plus_minus: values.ranges.contains_key(&entity.id()),
        ends: faces,
        aspects: of,
        is_size,
    };
    for &representation in values.representations.get(&entity.id()).map_or(&[][..], Vec::as_slice) {
        value(table, values, table.referred(entity.id(), representation)?, &mut found)?;
    }
    if let Some(&range) = values.ranges.get(&entity.id()) {
        found.limits = plus_minus(table, table.referred(entity.id(), range)?)?.unwrap_or(found.limits);
    }
    Ok(found)
}

/// Reads nominal value and limits from a representation.
fn value(
    table: &EntityTable<'_>,
    values: &DimensionValues,
    representation: Entity<'_>,
    found: &mut StepDimension,
) -> Result<(), Part21Error> {
    let arguments = representation.inherited("REPRESENTATION")?;
    let mut limits = [None, None];
    for item in arguments.get(1).map(StepValue::references).unwrap_or_default() {
        let item = table.referred(representation.id(), item)?;
        let name = item_name(item)?.to_ascii_lowercase();
        if item.is("DESCRIPTIVE_REPRESENTATION_ITEM") {
            let text = item.inherited("DESCRIPTIVE_REPRESENTATION_ITEM")?.last().and_then(StepValue::text);
            note(&text.unwrap_or_default(), found);
            continue;
        }
        let Some(measured) = measure(table, item)? else { continue };
        let qualifiers = qualifiers(table, values, item)?;
        let is = |words: [&str; 2]| {
            words.iter().any(|word| name.contains(word) || qualifiers.iter().any(|one| one.contains(word)))
        };
        if is(["lower limit", "minimum"]) {
            limits[0] = Some(measured);
        } else if is(["upper limit", "maximum"]) {
            limits[1] = Some(measured);
        } else {
            qualifiers.iter().for_each(|text| note(text, found));
            found.value = found.value.or(Some(measured));
        }
    }
    match limits {
        [Some(lower), Some(upper)] => {
            found.limits = DimensionLimits::Values([lower, upper]);
            let middle = 0.5 * (lower.value + upper.value);
            found.value = found.value.or(Some(StepMeasure { value: middle, unit: lower.unit }));
        }
        // A single limit such as R 0.1 max stands as the nominal value.
        [Some(only), None] => {
            found.limits = DimensionLimits::Minimum(only);
            found.value = found.value.or(Some(only));
        }
        [None, Some(only)] => {
            found.limits = DimensionLimits::Maximum(only);
            found.value = found.value.or(Some(only));
        }
        [None, None] => {}
    }
    Ok(())
}

/// Takes a note or qualifier that makes a dimension exact or auxiliary.
fn note(text: &str, found: &mut StepDimension) {
    let lower = text.to_ascii_lowercase();
    if lower.contains("theoretical") || lower.contains("basic") {
        found.limits = DimensionLimits::Exact;
    } else if lower.contains("auxiliary") || lower.contains("reference") {
        found.limits = DimensionLimits::Reference;
    }
}

/// Names of the qualifiers of an item.
fn qualifiers(table: &EntityTable<'_>, values: &DimensionValues, item: Entity<'_>) -> Result<Vec<String>, Part21Error> {
    let own = item.arguments("QUALIFIED_REPRESENTATION_ITEM")?.unwrap_or_default();
    let mut ids: Vec<u64> = own.iter().flat_map(StepValue::references).collect();
    ids.extend(values.qualified.get(&item.id()).into_iter().flatten());
    let mut found = Vec::new();
    for id in ids {
        let qualifier = table.referred(item.id(), id)?;
        let arguments = qualifier.arguments("TYPE_QUALIFIER")?.unwrap_or_default();
        found.extend(arguments.first().and_then(StepValue::text).map(|text| text.to_ascii_lowercase()));
    }
    Ok(found)
}

/// Reads deviations or a tolerance class. Returns None if the range is neither.
fn plus_minus(table: &EntityTable<'_>, range: Entity<'_>) -> Result<Option<DimensionLimits>, Part21Error> {
    if let Some(arguments) = range.arguments("LIMITS_AND_FITS")? {
        let text = |index: usize| arguments.get(index).and_then(StepValue::text).unwrap_or_default();
        let (form, grade) = (text(0), text(2));
        let grade = grade.trim().trim_start_matches("IT").trim().to_owned();
        let class = format!("{}{grade}", form.trim());
        return Ok((!grade.is_empty() && !form.trim().is_empty()).then_some(DimensionLimits::Fit(class)));
    }
    let Some(arguments) = range.arguments("TOLERANCE_VALUE")? else { return Ok(None) };
    let mut bounds = Vec::new();
    for bound in arguments.iter().filter_map(StepValue::reference) {
        bounds.extend(measure(table, table.referred(range.id(), bound)?)?);
    }
    let Ok([lower, upper]) = <[StepMeasure; 2]>::try_from(bounds) else { return Ok(None) };
    let ordered = if lower.value <= upper.value { [lower, upper] } else { [upper, lower] };
    Ok(Some(DimensionLimits::Deviations(ordered)))
}
