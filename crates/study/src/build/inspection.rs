//! Reads `gauge` and `guard` of a characteristic.

use crate::entries::file::CharacteristicEntry;
use crate::entries::guard::GuardEntry;
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::inspection::{Guard, Inspection, InspectionError};

/// Adds the gauge and the guard band to a characteristic.
pub(crate) fn inspected(
    characteristic: Characteristic,
    entry: &CharacteristicEntry,
    key: &str,
) -> Result<Characteristic, Fault> {
    let Some(gauge) = &entry.gauge else {
        let Some(guard) = &entry.guard else { return Ok(characteristic) };
        let instead =
            "a guard band belongs to a gauge: write gauge = 0.015, its standard deviation (0 for one without error)";
        let missing = StudyFault::MissingKey { key: "gauge".into(), instead: instead.to_owned() };
        return Err(fault(guard.span(), format!("{key}.guard"), missing));
    };
    let of_gauge = |error: InspectionError| fault(gauge.span(), format!("{key}.gauge"), error);
    let mut inspection = Inspection::new(*gauge.get_ref()).map_err(of_gauge)?;
    let mut at = (gauge.span(), "gauge");
    if let Some(guard) = &entry.guard {
        let (span, wanted) = match guard.get_ref() {
            GuardEntry::Width(width) => (guard.span(), Guard::Width(*width)),
            GuardEntry::Table(table) => (table.false_accept.span(), Guard::FalseAccept(*table.false_accept.get_ref())),
        };
        inspection =
            inspection.with_guard(wanted).map_err(|error| fault(span.clone(), format!("{key}.guard"), error))?;
        // Without limits the gauge is at fault. With limits it is the guard.
        if characteristic.limits().exist() {
            at = (span, "guard");
        }
    }
    let (span, part) = at;
    characteristic.with_inspection(inspection).map_err(|error| fault(span, format!("{key}.{part}"), error))
}
