//! How a dimension spreads: the kinds of distribution, and what each makes of band, sigma and shift.

use std::ops::Range;
use std::sync::Arc;

use super::super::error::{Fault, StudyFault, fault};
use super::super::file::DimensionEntry;
use super::super::spanned::Spanned;
use super::conflict;
use crate::dimension::DimensionFault;
use crate::distribution::{CentralMoments, Distribution, DistributionError, Normal, Uniform};
use crate::names::nearest;

/// Sigmas within half a tolerance band, unless the study says otherwise.
const SIGMAS: f64 = 3.0;
/// Two ways of giving sigma agree when they differ by no more than this.
const AGREE: f64 = 1e-9;
/// The kinds of distribution.
pub(in crate::study) const KINDS: [&str; 2] = ["normal", "uniform"];

/// The distribution of this line; None when it does not vary.
pub(super) fn distribution(
    entry: &DimensionEntry,
    nominal: f64,
    tolerance: Option<[f64; 2]>,
) -> Result<Option<Arc<dyn Distribution>>, Fault> {
    match kind(entry)? {
        Kind::Moments => moments(entry, nominal),
        Kind::Normal => normal(entry, nominal, tolerance),
        Kind::Uniform => uniform(entry, nominal, tolerance),
    }
}

enum Kind {
    Normal,
    Uniform,
    Moments,
}

fn kind(entry: &DimensionEntry) -> Result<Kind, Fault> {
    if entry.moments.is_some() {
        let why = || "are two ways of giving a distribution: leave one out".to_owned();
        let excluded: [(&'static str, Option<Range<usize>>); 4] = [
            ("distribution", entry.distribution.as_ref().map(Spanned::span)),
            ("sigma", entry.sigma.as_ref().map(Spanned::span)),
            ("sigmas", entry.sigmas.as_ref().map(Spanned::span)),
            ("cp", entry.cp.as_ref().map(Spanned::span)),
        ];
        for (key, span) in excluded {
            if let Some(span) = span {
                return Err(fault(span, key, StudyFault::Conflict { a: "moments", b: key, why: why() }));
            }
        }
        return Ok(Kind::Moments);
    }
    let Some(distribution) = &entry.distribution else { return Ok(Kind::Normal) };
    match distribution.get_ref().kind.as_str() {
        "normal" => Ok(Kind::Normal),
        "uniform" => Ok(Kind::Uniform),
        found => {
            let nearest = nearest(found, KINDS).map(str::to_owned);
            let known = KINDS.map(str::to_owned).to_vec();
            let unknown = StudyFault::UnknownWord { what: "distribution", found: found.to_owned(), nearest, known };
            Err(fault(distribution.span(), "distribution", unknown))
        }
    }
}

/// Mean = the band's middle plus `shift`; sigma = half band / `sigmas`, or as given.
fn normal(
    entry: &DimensionEntry,
    nominal: f64,
    tolerance: Option<[f64; 2]>,
) -> Result<Option<Arc<dyn Distribution>>, Fault> {
    let per_band = sigmas(entry)?;
    let given = entry.sigma.as_ref();
    let from_band =
        tolerance.map(|[lower, upper]| 0.5 * (upper - lower) / per_band.as_ref().map_or(SIGMAS, |&(_, _, n)| n));
    let sigma = match (given, from_band) {
        (None, None) => return nothing_to_spread(entry),
        (Some(sigma), None) => {
            // `tolerance = 0` beside a sigma contradicts it.
            if let (Some(band), true) = (&entry.tolerance, *sigma.get_ref() != 0.0) {
                let disagree = conflict("tolerance", "sigma", "disagree: a band of 0 has sigma 0");
                return Err(fault(band.span(), "tolerance", disagree));
            }
            if let Some((key, span, _)) = per_band {
                return Err(fault(span, key, needs_band(key)));
            }
            *sigma.get_ref()
        }
        (None, Some(from_band)) => from_band,
        (Some(sigma), Some(from_band)) => {
            if let Some((key, _, _)) = per_band.filter(|_| !agree(*sigma.get_ref(), from_band)) {
                let why = format!("disagree: {} against {from_band}", sigma.get_ref());
                return Err(fault(sigma.span(), "sigma", StudyFault::Conflict { a: key, b: "sigma", why }));
            }
            *sigma.get_ref()
        }
    };
    if sigma == 0.0 && tolerance.is_none() && entry.shift.is_none() {
        return Ok(None);
    }
    let middle = tolerance.map_or(0.0, |[lower, upper]| 0.5 * (lower + upper));
    let mean = nominal + middle + shift(entry);
    let span = given.map_or(0..0, Spanned::span);
    shared(Normal::new(mean, sigma), span, "sigma")
}

/// The support is the band; mean and sigma follow from it.
fn uniform(
    entry: &DimensionEntry,
    nominal: f64,
    tolerance: Option<[f64; 2]>,
) -> Result<Option<Arc<dyn Distribution>>, Fault> {
    let to = || "a uniform distribution".to_owned();
    if let Some((key, span, _)) = sigmas(entry)? {
        let instead = "its sigma follows from the band";
        return Err(fault(span, key, StudyFault::DoesNotApply { key, to: to(), instead }));
    }
    if let Some(shift) = &entry.shift {
        let instead = "move the limits instead";
        return Err(fault(shift.span(), "shift", StudyFault::DoesNotApply { key: "shift", to: to(), instead }));
    }
    let Some([lower, upper]) = tolerance else {
        if let Some(sigma) = &entry.sigma {
            return Err(fault(sigma.span(), "sigma", needs_band("sigma")));
        }
        return nothing_to_spread(entry);
    };
    let half = 0.5 * (upper - lower);
    let sigma = half / 3f64.sqrt();
    if let Some(given) = entry.sigma.as_ref().filter(|given| !agree(*given.get_ref(), sigma)) {
        let why = format!("disagree: uniform over this band has sigma {sigma}");
        return Err(fault(given.span(), "sigma", StudyFault::Conflict { a: "tolerance", b: "sigma", why }));
    }
    shared(Uniform::about(nominal + 0.5 * (lower + upper), half), 0..0, "tolerance")
}

/// Known by moments: mean = nominal plus `shift`, whatever the band.
fn moments(entry: &DimensionEntry, nominal: f64) -> Result<Option<Arc<dyn Distribution>>, Fault> {
    let moments = entry.moments.as_ref().expect("the kind was told by them");
    shared(CentralMoments::new(nominal + shift(entry), *moments.get_ref()), moments.span(), "moments")
}

fn shift(entry: &DimensionEntry) -> f64 {
    entry.shift.as_ref().map_or(0.0, |shift| *shift.get_ref())
}

/// A key, its place and its value as a number of sigmas.
type PerBand = (&'static str, Range<usize>, f64);

/// How many sigmas half a band has, where the study says.
fn sigmas(entry: &DimensionEntry) -> Result<Option<PerBand>, Fault> {
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
    match (of_sigmas, of_cp) {
        (Some((_, _, sigmas)), Some((_, span, of_cp))) if !agree(sigmas, of_cp) => {
            let why = format!("disagree: cp = sigmas/3 would be {}", sigmas / SIGMAS);
            Err(fault(span, "cp", StudyFault::Conflict { a: "sigmas", b: "cp", why }))
        }
        (of_sigmas, of_cp) => Ok(of_sigmas.or(of_cp)),
    }
}

/// A dimension without band and sigma is fixed, unless something in it speaks of variation.
fn nothing_to_spread(entry: &DimensionEntry) -> Result<Option<Arc<dyn Distribution>>, Fault> {
    let flat = entry.tolerance.is_some() || entry.limits.is_some();
    let speaks: [(&'static str, Option<Range<usize>>); 4] = [
        ("distribution", entry.distribution.as_ref().map(Spanned::span)),
        ("shift", entry.shift.as_ref().map(Spanned::span)),
        ("sigmas", entry.sigmas.as_ref().map(Spanned::span)),
        ("cp", entry.cp.as_ref().map(Spanned::span)),
    ];
    for (key, span) in speaks {
        // A tolerance that is set to 0 for once leaves the rest of the line alone.
        if let Some(span) = span.filter(|_| !flat || key == "shift") {
            return Err(fault(span, key, needs_band(key)));
        }
    }
    Ok(None)
}

fn needs_band(key: &'static str) -> StudyFault {
    StudyFault::MissingKey {
        key: "tolerance".into(),
        instead: format!("`{key}` needs a tolerance or limits beside it"),
    }
}

fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() <= AGREE * a.abs().max(b.abs())
}

fn shared<D: Distribution + 'static>(
    distribution: Result<D, DistributionError>,
    span: Range<usize>,
    key: &'static str,
) -> Result<Option<Arc<dyn Distribution>>, Fault> {
    match distribution {
        Ok(distribution) => Ok(Some(Arc::new(distribution))),
        Err(error) => Err(fault(span, key, DimensionFault::from(error))),
    }
}
