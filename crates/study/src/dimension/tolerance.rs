//! Tolerance band in its several forms.

use std::ops::Range;

use crate::dimension::conflict;
use crate::entries::file::DimensionEntry;
use crate::entries::spanned::Spanned;
use crate::entries::values::{Deviation, ToleranceEntry};
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::dimension::DimensionFault;
use sensitol_numeric::fits;

/// Deviations from the nominal. Returns None if there is no band or its width is 0.
pub(super) fn tolerance(entry: &DimensionEntry, nominal: f64) -> Result<Option<[f64; 2]>, Fault> {
    one_form(entry)?;
    let (span, key, deviations) = match (&entry.tolerance, &entry.limits, &entry.fit) {
        (Some(tolerance), _, _) => (tolerance.span(), "tolerance", deviations(tolerance, nominal)?),
        (None, Some(limits), _) => (limits.span(), "limits", limits.get_ref().map(|limit| limit - nominal)),
        (None, None, Some(class)) => return fit(class, entry.unit.as_deref(), nominal).map(Some),
        (None, None, None) => return Ok(None),
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

/// Checks that only one of tolerance, limits and fit gives the band.
fn one_form(entry: &DimensionEntry) -> Result<(), Fault> {
    let forms: [(&'static str, Option<Range<usize>>); 3] = [
        ("tolerance", entry.tolerance.as_ref().map(Spanned::span)),
        ("limits", entry.limits.as_ref().map(Spanned::span)),
        ("fit", entry.fit.as_ref().map(Spanned::span)),
    ];
    let mut given = forms.into_iter().filter_map(|(key, span)| Some((key, span?)));
    match (given.next(), given.next()) {
        (Some((first, _)), Some((key, span))) => {
            Err(fault(span, key, conflict(first, key, "say the same thing: leave one out")))
        }
        _ => Ok(()),
    }
}

fn deviations(tolerance: &Spanned<ToleranceEntry>, nominal: f64) -> Result<[f64; 2], Fault> {
    let failed = |found: StudyFault| fault(tolerance.span(), "tolerance", found);
    let value = |deviation: Deviation| match deviation {
        Deviation::Value(value) => Ok(value),
        Deviation::Percent(_) if nominal == 0.0 => {
            Err(failed(conflict("tolerance", "nominal", "do not go together: percent of 0 is 0, so write a number")))
        }
        Deviation::Percent(percent) => Ok(percent * nominal.abs() / 100.0),
    };
    match *tolerance.get_ref() {
        ToleranceEntry::Half(half) => match value(half)? {
            half if half < 0.0 => Err(failed(DimensionFault::NegativeTolerance { value: half }.into())),
            half => Ok([-half, half]),
        },
        ToleranceEntry::Deviations([lower, upper]) => Ok([value(lower)?, value(upper)?]),
    }
}

/// Deviations of a fit. The unit must be mm, in which ISO 286 is written: nothing is converted here.
fn fit(class: &Spanned<String>, unit: Option<&str>, nominal: f64) -> Result<[f64; 2], Fault> {
    match unit {
        Some("mm") => fits::deviations(nominal, class.get_ref()).map_err(|error| fault(class.span(), "fit", error)),
        Some(unit) => {
            let to = format!("a dimension in `{unit}`");
            let instead = "fits of ISO 286 are in millimetres: write the tolerance as numbers, or everything in mm";
            Err(fault(class.span(), "fit", StudyFault::DoesNotApply { key: "fit", to, instead }))
        }
        None => {
            let instead = "fits of ISO 286 are in millimetres: write unit = \"mm\"".to_owned();
            Err(fault(class.span(), "fit", StudyFault::MissingKey { key: "unit".into(), instead }))
        }
    }
}
