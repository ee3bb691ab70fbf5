//! Reads lines of `[dimensions]`: a dimension, or the two of a position, from tolerance and distribution in their several forms.

mod kinds;
mod measured;
mod mixture;
mod off_centre;
mod position;
mod process;
mod promise;
mod spread;
mod tolerance;

use std::ops::Range;
use std::sync::Arc;

use crate::build::inflation as conventions;
use crate::data::Data;
use crate::entries::file::{DimensionEntry, Entries};
use crate::entries::spanned::Spanned;
use crate::entries::values::NominalEntry;
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::dimension::{Convention, Dimension, DimensionError};
use spread::Spread;

/// Distribution of a line. Returns None if the dimension does not vary. Parts of a mixture are read by the same function.
fn distribution(entry: &DimensionEntry, nominal: f64, tolerance: Option<[f64; 2]>) -> Result<Spread, Fault> {
    kinds::distribution(entry, nominal, tolerance, mixture::mixture, process::normal)
}

/// Dimensions of a line. A fault has the key below that of the dimension. `model` gives the nominal values of a built-in model. `data`
/// collects the files that the line reads, and their warnings.
pub(super) fn dimensions(
    name: &Spanned<String>,
    entry: &Spanned<DimensionEntry>,
    model: &dyn Fn(&str) -> Option<f64>,
    data: &mut Data<'_>,
) -> Result<Vec<Dimension>, Fault> {
    match &entry.get_ref().position {
        Some(diameter) => position::position(name.get_ref(), diameter, entry, model),
        None => dimension(name.get_ref(), entry, model(name.get_ref()), data).map(|dimension| vec![dimension]),
    }
}

/// Names of all dimensions with their places. A position declares two.
pub(super) fn names(entries: &Entries<DimensionEntry>) -> Vec<Spanned<String>> {
    let of_line = |(name, entry): &(Spanned<String>, Spanned<DimensionEntry>)| match entry.get_ref().position {
        Some(_) => position::names(name.get_ref()).map(|coordinate| Spanned::new(name.span(), coordinate)).to_vec(),
        None => vec![name.clone()],
    };
    entries.0.iter().flat_map(of_line).collect()
}

fn dimension(
    name: &str,
    entry: &Spanned<DimensionEntry>,
    model: Option<f64>,
    data: &mut Data<'_>,
) -> Result<Dimension, Fault> {
    let (line, entry) = (entry.span(), entry.get_ref());
    let law = measured::law(name, entry, data)?;
    let mean =
        law.as_ref().filter(|_| entry.tolerance.is_none() && entry.fit.is_none()).map(|law| law.distribution.mean());
    let nominal = nominal(entry, model, mean, &line)?;
    let tolerance = tolerance::tolerance(entry, nominal)?;
    let distribution = match &law {
        Some(law) => {
            measured::outside(name, nominal, tolerance, law, data);
            Some(Arc::clone(&law.distribution))
        }
        None => distribution(entry, nominal, tolerance)?,
    };
    built(name, entry, nominal, tolerance, distribution, line)
}

/// Dimension with this distribution and band, and with the unit and step of the entry.
fn built(
    name: &str,
    entry: &DimensionEntry,
    nominal: f64,
    tolerance: Option<[f64; 2]>,
    distribution: Spread,
    line: Range<usize>,
) -> Result<Dimension, Fault> {
    let whole = |error: DimensionError| fault(line, "", error.fault);
    let mut dimension = match distribution {
        None => Dimension::fixed(name, nominal),
        Some(distribution) => Dimension::distributed(name, nominal, tolerance, distribution),
    }
    .map_err(whole)?
    .with_labels(entry.labels());
    if let Some(unit) = &entry.unit {
        dimension = dimension.with_unit(unit);
    }
    if let Some(step) = &entry.step {
        let at_step = |error: DimensionError| fault(step.span(), "step", error.fault);
        dimension = dimension.with_step(*step.get_ref()).map_err(at_step)?;
    }
    Ok(dimension.with_convention(convention(entry, nominal, tolerance)?))
}

/// The dimension as a process makes it that states its distribution, with this half-width.
pub(super) fn made(
    old: &Dimension,
    process: &DimensionEntry,
    half: f64,
    line: Range<usize>,
) -> Result<Dimension, Fault> {
    promise::refuse(process, "a process")?;
    let band = old.opened(old.reach(), half / old.half_band());
    let distribution = distribution(process, old.nominal(), Some(band))?;
    let own = convention(process, old.nominal(), Some(band))?;
    let spread = distribution.ok_or_else(|| fault(line.clone(), "", spread::needs_band("distribution")))?;
    let made = Dimension::distributed(old.name(), old.nominal(), Some(band), spread);
    let whole = |error: DimensionError| fault(line, "", error.fault);
    let convention = Convention { lot: own.lot, promise: own.promise, ..*old.convention() };
    Ok(old.remade(made.map_err(whole)?).with_convention(convention))
}

/// Convention of the line: RSS factor, mean shift, degrees of freedom, lots, and what is promised of an unknown distribution.
fn convention(entry: &DimensionEntry, nominal: f64, tolerance: Option<[f64; 2]>) -> Result<Convention, Fault> {
    let rss_factor = entry.rss_factor.as_ref().map(|given| conventions::factor(given, "rss_factor")).transpose()?;
    let mean_shift = entry.mean_shift.as_ref().map(|given| conventions::mean_shift(given, "mean_shift")).transpose()?;
    // A process is known only for a normal distribution.
    let standing = process::standing(entry, tolerance)?;
    let lot = match (standing.known(), spread::sigma(entry, tolerance), tolerance) {
        (true, Ok(Some(sigma)), Some([lower, upper])) => {
            Some(standing.lot(sigma, 0.5 * (upper - lower), spread::shift(entry)))
        }
        _ => None,
    };
    let promise = promise::promise(entry, nominal, tolerance)?;
    Ok(Convention { rss_factor, mean_shift, degrees: degrees(entry)?, lot, promise })
}

/// Degrees of freedom for an uncertainty budget: as given, or those of a Student distribution.
fn degrees(entry: &DimensionEntry) -> Result<Option<f64>, Fault> {
    let of_law = entry.distribution.as_ref().and_then(|law| law.get_ref().degrees.as_ref());
    let Some(given) = &entry.degrees else { return Ok(of_law.map(|degrees| *degrees.get_ref())) };
    if of_law.is_some() {
        let why = "say the same thing: leave one out";
        return Err(fault(given.span(), "degrees", conflict("distribution.degrees", "degrees", why)));
    }
    match *given.get_ref() {
        value if value >= 1.0 => Ok(Some(value)),
        value => Err(fault(given.span(), "degrees", StudyFault::OutOfRange { value, range: "1 or above" })),
    }
}

/// Nominal value: as given, or of the model, or the middle of the limits, or the mean of the measured values.
fn nominal(entry: &DimensionEntry, model: Option<f64>, mean: Option<f64>, line: &Range<usize>) -> Result<f64, Fault> {
    let middle = entry.limits.as_ref().map(|limits| 0.5 * (limits.get_ref()[0] + limits.get_ref()[1]));
    let given = match &entry.nominal {
        None => None,
        Some(nominal) => match *nominal.get_ref() {
            NominalEntry::One(value) => Some(value),
            NominalEntry::Two(_) => {
                let instead = "two nominal values are those of a position: write the diameter of its zone, such as position = 0.2";
                let missing = StudyFault::MissingKey { key: "position".into(), instead: instead.into() };
                return Err(fault(nominal.span(), "nominal", missing));
            }
        },
    };
    given.or(model).or(middle).or(mean).ok_or_else(|| {
        let instead = "write the value on the drawing, such as nominal = 10.0".to_owned();
        fault(line.clone(), "", StudyFault::MissingKey { key: "nominal".into(), instead })
    })
}

/// Least and greatest value of a line. Returns None if it has no band, and for a line at fault, whose fault is reported elsewhere.
pub(super) fn limits(entry: &DimensionEntry) -> Option<[f64; 2]> {
    let nominal = nominal(entry, None, None, &(0..0)).ok()?;
    let [lower, upper] = tolerance::tolerance(entry, nominal).ok()??;
    Some([nominal + lower, nominal + upper])
}

fn conflict(a: &'static str, b: &'static str, why: &str) -> StudyFault {
    StudyFault::Conflict { a, b, why: why.to_owned() }
}
