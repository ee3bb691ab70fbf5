//! Facts of an unknown distribution, `distribution = "any"`.

use crate::dimension::conflict;
use crate::dimension::kinds::within;
use crate::entries::file::{DimensionEntry, DistributionEntry};
use crate::entries::vocabulary::{KINDS, Kind};
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::dimension::BandPromise;

/// Refuses an unknown distribution where only a known one has a meaning, such as `a part of a mixture`.
pub(super) fn refuse(entry: &DimensionEntry, to: &str) -> Result<(), Fault> {
    let table = entry.distribution.as_ref().filter(|table| is_any(table.get_ref()));
    let Some(table) = table else { return Ok(()) };
    let instead = "give it a known one, such as \"uniform\": an unknown distribution is for a dimension as a whole";
    let key = "distribution";
    Err(fault(table.span(), key, StudyFault::DoesNotApply { key: "any", to: to.to_owned(), instead }))
}

fn is_any(table: &DistributionEntry) -> bool {
    KINDS.iter().any(|known| known.1 == Kind::Any && known.0 == table.kind)
}

/// Promise of a line about its distribution, in half bands. Returns None if the distribution is known, or if the dimension does not vary.
pub(super) fn promise(
    entry: &DimensionEntry,
    nominal: f64,
    tolerance: Option<[f64; 2]>,
) -> Result<Option<BandPromise>, Fault> {
    let table = entry.distribution.as_ref().map(|table| table.get_ref()).filter(|table| is_any(table));
    let (Some(table), Some([lower, upper])) = (table, tolerance) else { return Ok(None) };
    let (middle, half) = (nominal + 0.5 * (lower + upper), 0.5 * (upper - lower));
    if half == 0.0 {
        return Ok(None);
    }
    let symmetric = table.symmetric.as_ref().is_some_and(|of| *of.get_ref());
    let unimodal = table.unimodal.as_ref().filter(|of| *of.get_ref());
    if let (Some(unimodal), false) = (unimodal, symmetric) {
        let instead = "add symmetric = true: bounds are known for symmetric ones";
        let to = "an unknown distribution that is not symmetric".to_owned();
        return Err(fault(
            unimodal.span(),
            within("unimodal"),
            StudyFault::DoesNotApply { key: "unimodal", to, instead },
        ));
    }
    let sigma = match &table.sigma_at_most {
        Some(given) if !given.get_ref().is_finite() || *given.get_ref() <= 0.0 => {
            let found = StudyFault::OutOfRange { value: *given.get_ref(), range: "above 0" };
            return Err(fault(given.span(), within("sigma_at_most"), found));
        }
        Some(given) => Some(given.get_ref() / half),
        None => None,
    };
    let mean = match &table.mean {
        Some(given) => {
            let ends = given.get_ref().map(|end| (end - middle) / half);
            // The allowance admits an end of the band in spite of rounding.
            let outside = ends.iter().position(|end| !end.is_finite() || end.abs() > 1.0 + 1e-9);
            if let Some(end) = outside {
                let value = given.get_ref()[end];
                let found = StudyFault::OutOfRange { value, range: "within the tolerance band" };
                return Err(fault(given.span(), within("mean"), found));
            }
            if ends[0] > ends[1] {
                let found = StudyFault::OutOfRange {
                    value: given.get_ref()[1],
                    range: "the greatest mean, not below the least",
                };
                return Err(fault(given.span(), within("mean"), found));
            }
            if symmetric && (ends[0] > 1e-9 || ends[1] < -1e-9) {
                let why = "contradict each other: the mean of a symmetric distribution is the middle of the band";
                return Err(fault(given.span(), within("mean"), conflict("mean", "symmetric", why)));
            }
            Some(ends.map(|end| end.clamp(-1.0, 1.0)))
        }
        None => None,
    };
    // The mean of a symmetric distribution is the middle, and the range around it says nothing more.
    let mean = mean.filter(|_| !symmetric);
    Ok(Some(BandPromise { mean, sigma, symmetric, unimodal: unimodal.is_some() }))
}
