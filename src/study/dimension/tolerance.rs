//! The tolerance band in its several forms.

use super::super::error::{Fault, StudyFault, fault};
use super::super::file::{DimensionEntry, ToleranceEntry};
use super::conflict;
use crate::dimension::DimensionFault;

/// Deviations from the nominal; None where there is no band or one of width 0.
pub(super) fn tolerance(entry: &DimensionEntry, nominal: f64) -> Result<Option<[f64; 2]>, Fault> {
    let (span, key, deviations) = match (&entry.tolerance, &entry.limits) {
        (None, None) => return Ok(None),
        (Some(_), Some(limits)) => {
            let same = conflict("tolerance", "limits", "say the same thing: leave one out");
            return Err(fault(limits.span(), "limits", same));
        }
        (None, Some(limits)) => (limits.span(), "limits", limits.get_ref().map(|limit| limit - nominal)),
        (Some(tolerance), None) => {
            let deviations = match *tolerance.get_ref() {
                ToleranceEntry::Half(half) if half < 0.0 => {
                    let negative = DimensionFault::NegativeTolerance { value: half };
                    return Err(fault(tolerance.span(), "tolerance", negative));
                }
                ToleranceEntry::Half(half) => [-half, half],
                ToleranceEntry::Deviations(deviations) => deviations,
            };
            (tolerance.span(), "tolerance", deviations)
        }
    };
    match deviations {
        [0.0, 0.0] => Ok(None),
        [lower, upper] if lower < upper => Ok(Some(deviations)),
        [lower, upper] if key == "tolerance" => Err(fault(span, key, StudyFault::Swapped { lower, upper })),
        _ => {
            let [lower, upper] = *entry.limits.as_ref().expect("the band came from limits").get_ref();
            Err(fault(span, key, StudyFault::Swapped { lower, upper }))
        }
    }
}
