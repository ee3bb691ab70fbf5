//! Form within size: a zone of form that no other tolerance leaves room for.
//!
//! | standard | rule |
//! |---|---|
//! | ASME Y14.5, Rule 1; ISO 14405-1 with the envelope | the form of a round surface lies within the band of its size |
//! | ISO 8015 without the envelope | size and form are independent: `side = "out"` adds the form to the size |
//! | both | the form of a face lies within its profile and its orientation; the straightness of an axis is free of its size |

use super::entry::{ZoneEntry, ZoneKind, ZonedFeature};
use super::lines::at;
use crate::error::{Fault, StudyFault};
use crate::expand::geometry::limits;
use crate::expand::{Tree, Value};
use crate::faults::zone_fault::ZoneFault;
use sensitol_spatial::FeatureKind;

/// Part of a band by which rounding of its ends may lessen it.
const ROUNDING: f64 = 1e-9;

/// Checks the width of a zone of form. A width or size that is a formula is not examined.
pub(super) fn check(study: &Tree, feature: &ZonedFeature<'_>, length_unit: Option<&str>) -> Result<(), Fault> {
    let Some(zone) = feature.zone(&[ZoneKind::Form]) else { return Ok(()) };
    let Some(wide) = zone.width.number() else { return Ok(()) };
    let found = match feature.kind {
        FeatureKind::Plane => beyond_zone(feature, zone, wide),
        // The straightness of an axis is that of its middle line, which may leave the envelope.
        FeatureKind::Axis if zone.key == "straightness" => None,
        FeatureKind::Axis | FeatureKind::Point | FeatureKind::Frame => {
            beyond_size(study, feature, zone, wide, length_unit)
        }
    };
    match found {
        Some(found) => Err(at(&feature.owner, zone.key, &zone.span, StudyFault::from(found))),
        None => Ok(()),
    }
}

/// Zone of the place or the orientation of a face that is tighter than its form.
fn beyond_zone(feature: &ZonedFeature<'_>, zone: &ZoneEntry<'_>, wide: f64) -> Option<ZoneFault> {
    let others = feature.zones.iter().filter(|other| other.kind != ZoneKind::Form);
    let (bound, tight) =
        others.filter_map(|other| Some((other.key, other.width.number()?))).find(|(_, of)| wide > *of)?;
    Some(ZoneFault::FormBeyondZone { form: zone.key, wide, bound, tight })
}

/// Size of a round surface whose band is tighter than its form.
fn beyond_size(
    study: &Tree,
    feature: &ZonedFeature<'_>,
    zone: &ZoneEntry<'_>,
    wide: f64,
    length_unit: Option<&str>,
) -> Option<ZoneFault> {
    // With `side` the form is added to the size.
    if zone.table.is_some_and(|table| table.get("side").is_some()) {
        return None;
    }
    let Value::Text(size) = &feature.tree.get("diameter")?.value else { return None };
    let ([least, greatest], unit) = limits(study, size)?;
    let tight = greatest - least;
    let same_unit = unit.is_none() || unit == length_unit;
    // A size without a tolerance bounds nothing.
    let beyond = same_unit && tight > 0.0 && wide > tight * (1.0 + ROUNDING);
    beyond.then(|| ZoneFault::FormBeyondSize { form: zone.key, wide, size: size.clone(), tight })
}
