//! Position tolerances: two dimensions, the coordinates of a point within a circular zone.

use std::ops::Range;
use std::sync::Arc;

use crate::build::zone::{OF_DISC, is_even};
use crate::dimension::spread::only_normal;
use crate::dimension::{built, conflict, distribution};
use crate::entries::file::DimensionEntry;
use crate::entries::spanned::Spanned;
use crate::entries::values::NominalEntry;
use crate::error::{Fault, StudyFault, fault};
use sensitol_numeric::dimension::{Dimension, DimensionFault};
use sensitol_numeric::distribution::{Beta, DistributionError};

/// Names of the two dimensions of a position.
pub(super) fn names(name: &str) -> [String; 2] {
    ["x", "y"].map(|axis| format!("{name}_{axis}"))
}

/// Both coordinates. They are normal about the nominal with the radius of the zone as half-width, or the point is spread evenly over the
/// zone.
pub(super) fn position(
    name: &str,
    diameter: &Spanned<f64>,
    line: &Spanned<DimensionEntry>,
    model: &dyn Fn(&str) -> Option<f64>,
) -> Result<Vec<Dimension>, Fault> {
    let entry = line.get_ref();
    alone(entry)?;
    only_normal(entry, "a position")?;
    let radius = radius(diameter, entry)?;
    let names = names(name);
    let nominal = nominal(entry, names.each_ref().map(|name| model(name)), &line.span())?;
    let band = radius.map(|radius| [-radius, radius]);
    let coordinate = |(coordinate, nominal): (&String, f64)| {
        // A coordinate of a point that is spread evenly over a disc has a beta distribution.
        let distribution = match (band, is_even(entry)) {
            (None, true) => None,
            (Some([_, radius]), true) => {
                distribution(entry, nominal, band)?;
                let whole = |error: DistributionError| fault(diameter.span(), "position", DimensionFault::from(error));
                Some(Arc::new(Beta::about(nominal, radius, OF_DISC, OF_DISC).map_err(whole)?) as _)
            }
            (_, false) => distribution(entry, nominal, band)?,
        };
        built(coordinate, entry, nominal, band, distribution, line.span()).map(|dimension| dimension.within_zone(name))
    };
    names.iter().zip(nominal).map(coordinate).collect()
}

/// Radius of the zone. Returns None if the zone is a point.
fn radius(diameter: &Spanned<f64>, entry: &DimensionEntry) -> Result<Option<f64>, Fault> {
    let value = *diameter.get_ref();
    let failed = |found: StudyFault| Err(fault(diameter.span(), "position", found));
    if value < 0.0 {
        return failed(StudyFault::OutOfRange { value, range: "the diameter of a zone: 0 or above" });
    }
    if value == 0.0 && entry.sigma.as_ref().is_some_and(|sigma| *sigma.get_ref() != 0.0) {
        return failed(conflict("position", "sigma", "disagree: a zone of 0 has sigma 0"));
    }
    Ok((value > 0.0).then_some(0.5 * value))
}

fn nominal(entry: &DimensionEntry, model: [Option<f64>; 2], line: &Range<usize>) -> Result<[f64; 2], Fault> {
    match (&entry.nominal, model) {
        (Some(nominal), _) => match *nominal.get_ref() {
            NominalEntry::Two(values) => Ok(values),
            NominalEntry::One(value) => {
                let expected = "the nominal place of a position, two numbers such as [50.0, 30.0],".to_owned();
                let found = format!("the number {value}");
                Err(fault(nominal.span(), "nominal", StudyFault::WrongType { expected, found }))
            }
        },
        (None, [Some(x), Some(y)]) => Ok([x, y]),
        (None, _) => {
            let instead = "write the place on the drawing, such as nominal = [50.0, 30.0]".to_owned();
            Err(fault(line.clone(), "", StudyFault::MissingKey { key: "nominal".into(), instead }))
        }
    }
}

/// Checks that the line gives neither a band nor a distribution beside the zone.
fn alone(entry: &DimensionEntry) -> Result<(), Fault> {
    let bands: [(&'static str, Option<Range<usize>>); 3] = [
        ("tolerance", entry.tolerance.as_ref().map(Spanned::span)),
        ("limits", entry.limits.as_ref().map(Spanned::span)),
        ("fit", entry.fit.as_ref().map(Spanned::span)),
    ];
    for (key, span) in bands {
        if let Some(span) = span {
            return Err(fault(span, key, conflict("position", key, "say the same thing: leave one out")));
        }
    }
    let spreads: [(&'static str, Option<Range<usize>>); 4] = [
        ("measured", entry.measured.as_ref().map(Spanned::span)),
        ("distribution", entry.distribution.as_ref().filter(|_| !is_even(entry)).map(Spanned::span)),
        ("moments", entry.moments.as_ref().map(Spanned::span)),
        ("shift", entry.shift.as_ref().map(Spanned::span)),
    ];
    for (key, span) in spreads {
        if let Some(span) = span {
            let (to, instead) = (
                "a position".to_owned(),
                "its two coordinates are normal about the nominal place, or spread evenly: \"uniform\"",
            );
            return Err(fault(span, key, StudyFault::DoesNotApply { key, to, instead }));
        }
    }
    Ok(())
}
