//! Spread of a dimension: `sigma`, `sigmas`, `cp` and `shift`, with their contradictions.

use std::ops::Range;
use std::sync::Arc;

use crate::decimal::{SAID, decimal};
use crate::dimension::conflict;
use crate::entries::file::DimensionEntry;
use crate::entries::spanned::Spanned;
use crate::entries::vocabulary::SIGMAS;
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::distribution::Distribution;

/// Relative difference within which two ways of giving sigma agree.
const AGREE: f64 = 1e-9;

/// Distribution of a dimension; None if it does not vary.
pub(super) type Spread = Option<Arc<dyn Distribution>>;

/// Sigma as given, or half the band by `sigmas`. Returns None if neither a sigma nor a band is given.
pub(super) fn sigma(entry: &DimensionEntry, tolerance: Option<[f64; 2]>) -> Result<Option<f64>, Fault> {
    let per_band = sigmas(entry)?;
    let from_band =
        tolerance.map(|[lower, upper]| 0.5 * (upper - lower) / per_band.as_ref().map_or(SIGMAS, |&(_, _, n)| n));
    let Some(sigma) = &entry.sigma else { return Ok(from_band) };
    let given = *sigma.get_ref();
    match from_band {
        None => {
            // A sigma beside `tolerance = 0` contradicts it.
            if let (Some(band), true) = (&entry.tolerance, given != 0.0) {
                let disagree = conflict("tolerance", "sigma", "disagree: a band of 0 has sigma 0");
                return Err(fault(band.span(), "tolerance", disagree));
            }
            if let Some((key, span, _)) = per_band {
                return Err(fault(span, key, needs_band(key)));
            }
        }
        Some(from_band) => {
            if let Some((key, _, _)) = per_band.filter(|_| !agree(given, from_band)) {
                let why = format!("disagree: {} against {}", decimal(given, SAID), decimal(from_band, SAID));
                return Err(fault(sigma.span(), "sigma", StudyFault::Conflict { a: key, b: "sigma", why }));
            }
        }
    }
    Ok(Some(given))
}

pub(super) fn shift(entry: &DimensionEntry) -> f64 {
    entry.shift.as_ref().map_or(0.0, |shift| *shift.get_ref())
}

/// A key with its place, and its value as a number of sigmas.
pub(super) type PerBand = (&'static str, Range<usize>, f64);

/// Number of sigmas in half a band. Returns None if the study does not give it.
pub(super) fn sigmas(entry: &DimensionEntry) -> Result<Option<PerBand>, Fault> {
    let positive = |key: &'static str, given: &Spanned<f64>, factor: f64| {
        let value = *given.get_ref();
        if value > 0.0 {
            Ok((key, given.span(), factor * value))
        } else {
            Err(fault(given.span(), key, StudyFault::OutOfRange { value, range: "above 0" }))
        }
    };
    let of_sigmas = entry.sigmas.as_ref().map(|sigmas| positive("sigmas", sigmas, 1.0)).transpose()?;
    let of_cp = entry.cp.as_ref().map(|cp| positive("cp", cp, SIGMAS)).transpose()?;
    let of_cpk = entry.cpk.as_ref().map(|cpk| positive("cpk", cpk, SIGMAS)).transpose()?;
    if let (Some((_, _, cp)), Some((_, span, cpk))) = (&of_cp, &of_cpk)
        && cpk > cp
    {
        let why = format!("disagree: cpk {} is above cp {}", cpk / SIGMAS, cp / SIGMAS);
        return Err(fault(span.clone(), "cpk", StudyFault::Conflict { a: "cp", b: "cpk", why }));
    }
    // Without cp the mean lies in the middle of the band, and cpk equals cp.
    let of_cp = of_cp.or(of_cpk);
    match (of_sigmas, of_cp) {
        (Some((_, _, sigmas)), Some((key, span, of_cp))) if !agree(sigmas, of_cp) => {
            let why = format!("disagree: {key} = sigmas/3 would be {}", sigmas / SIGMAS);
            Err(fault(span, key, StudyFault::Conflict { a: "sigmas", b: key, why }))
        }
        (of_sigmas, of_cp) => Ok(of_sigmas.or(of_cp)),
    }
}

/// Returns None: without band and sigma the dimension is fixed. Fails if the line has a key that describes variation.
pub(super) fn nothing_to_spread(entry: &DimensionEntry) -> Result<Spread, Fault> {
    let flat = entry.tolerance.is_some() || entry.limits.is_some() || entry.position.is_some();
    let speaks: [(&'static str, Option<Range<usize>>); 7] = [
        ("distribution", entry.distribution.as_ref().map(Spanned::span)),
        ("shift", entry.shift.as_ref().map(Spanned::span)),
        ("sigmas", entry.sigmas.as_ref().map(Spanned::span)),
        ("cp", entry.cp.as_ref().map(Spanned::span)),
        ("cpk", entry.cpk.as_ref().map(Spanned::span)),
        ("side", entry.side.as_ref().map(Spanned::span)),
        ("drift", entry.drift.as_ref().map(Spanned::span)),
    ];
    for (key, span) in speaks {
        // A tolerance set to 0 as a trial leaves the other keys of the line as they are.
        if let Some(span) = span.filter(|_| !flat || key == "shift") {
            return Err(fault(span, key, needs_band(key)));
        }
    }
    Ok(None)
}

pub(super) fn needs_band(key: &'static str) -> StudyFault {
    StudyFault::MissingKey {
        key: "tolerance".into(),
        instead: format!("`{key}` needs a tolerance or limits beside it"),
    }
}

pub(super) fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() <= AGREE * a.abs().max(b.abs())
}

/// True if the tolerance is given as 0.
pub(super) fn is_flat(entry: &DimensionEntry) -> bool {
    entry.tolerance.as_ref().is_some_and(|tolerance| tolerance.get_ref().is_zero())
}

/// Refuses keys that only apply to a normal distribution.
pub(super) fn only_normal(entry: &DimensionEntry, to: &str) -> Result<(), Fault> {
    let span = |of: &Option<Spanned<f64>>| of.as_ref().map(Spanned::span);
    let keys: [(&'static str, Option<Range<usize>>); 3] = [
        ("drift", span(&entry.drift)),
        ("side", entry.side.as_ref().map(Spanned::span)),
        ("cpk", span(&entry.cpk).filter(|_| entry.cp.is_some())),
    ];
    for (key, span) in keys {
        if let Some(span) = span {
            let instead = "it is for normal distributions; write the mean and the spread of this one by its own keys";
            return Err(fault(span, key, StudyFault::DoesNotApply { key, to: to.to_owned(), instead }));
        }
    }
    Ok(())
}
