//! Values with their units.

use crate::part21::{Entity, EntityTable, Part21Error, StepValue};

/// Greatest number of units that are defined by others in a row. Files have at most two: degrees by radians, inches by millimetres.
const DEEPEST: usize = 8;

/// Unit of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepUnit {
    /// Metres in one unit.
    Length(f64),
    /// Radians in one unit.
    Angle(f64),
    /// Neither a length nor an angle, or not given.
    Other,
}

impl StepUnit {
    /// Millimetres.
    pub const MILLIMETRE: Self = Self::Length(1e-3);

    /// Name as a study writes it. Returns None if a study has none.
    pub fn name(self) -> Option<&'static str> {
        let (all, scale): (&[(f64, &str)], f64) = match self {
            Self::Length(scale) => {
                (&[(1e-3, "mm"), (0.0254, "in"), (1.0, "m"), (1e-2, "cm"), (1e-6, "um"), (0.3048, "ft")], scale)
            }
            Self::Angle(scale) => (&[(1.0, "rad"), (std::f64::consts::PI / 180.0, "deg")], scale),
            Self::Other => return None,
        };
        // Files write degrees with 6 to 17 digits.
        all.iter().find(|(known, _)| (scale / known - 1.0).abs() < 1e-6).map(|(_, name)| *name)
    }
}

/// A value with its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepMeasure {
    /// Value in the unit.
    pub value: f64,
    /// Unit.
    pub unit: StepUnit,
}

/// Reads a measure with its unit, in whichever of its types it stands. Returns None if the entity has no finite value.
pub(super) fn measure(table: &EntityTable<'_>, entity: Entity<'_>) -> Result<Option<StepMeasure>, Part21Error> {
    for (kind, arguments) in entity.all()? {
        if !kind.contains("MEASURE") {
            continue;
        }
        let Some(value) = arguments.iter().find_map(StepValue::number) else { continue };
        let unit = arguments.iter().find_map(StepValue::reference);
        let unit = match unit {
            Some(unit) => unit_of(table, table.referred(entity.id(), unit)?)?,
            None => StepUnit::Other,
        };
        return Ok(Some(StepMeasure { value, unit }));
    }
    Ok(None)
}

/// Quantity and SI scale of a unit.
pub(super) fn unit_of(table: &EntityTable<'_>, unit: Entity<'_>) -> Result<StepUnit, Part21Error> {
    let mut scale = 1.0;
    let mut at = unit;
    for _ in 0..DEEPEST {
        if let Some(own) = at.arguments("SI_UNIT")? {
            let words: Vec<Option<&str>> = own.iter().rev().take(2).map(StepValue::word).collect();
            let [Some(name), prefix] = words[..] else { return Ok(StepUnit::Other) };
            scale *= prefix_scale(prefix);
            return Ok(match name {
                "METRE" => StepUnit::Length(scale),
                "RADIAN" => StepUnit::Angle(scale),
                _ => StepUnit::Other,
            });
        }
        let Some(own) = at.arguments("CONVERSION_BASED_UNIT")? else { return Ok(StepUnit::Other) };
        let Some(factor) = own.iter().rev().find_map(StepValue::reference) else { return Ok(StepUnit::Other) };
        let factor = table.referred(at.id(), factor)?;
        let mut next = None;
        for (kind, arguments) in factor.all()? {
            let value = arguments.iter().find_map(StepValue::number);
            let unit = arguments.iter().find_map(StepValue::reference);
            if let (true, Some(value), Some(unit)) = (kind.contains("MEASURE"), value, unit) {
                scale *= value;
                next = Some(table.referred(factor.id(), unit)?);
                break;
            }
        }
        let Some(next) = next else { return Ok(StepUnit::Other) };
        at = next;
    }
    Ok(StepUnit::Other)
}

/// Factor of a prefix of the SI.
fn prefix_scale(prefix: Option<&str>) -> f64 {
    match prefix {
        Some("KILO") => 1e3,
        Some("HECTO") => 1e2,
        Some("DECA") => 1e1,
        Some("DECI") => 1e-1,
        Some("CENTI") => 1e-2,
        Some("MILLI") => 1e-3,
        Some("MICRO") => 1e-6,
        Some("NANO") => 1e-9,
        _ => 1.0,
    }
}
