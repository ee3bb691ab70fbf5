//! From one line of `[dimensions]` to a dimension: tolerance and distribution in their several forms.

mod spread;
mod tolerance;

use std::ops::Range;

use super::error::{Fault, StudyFault, fault};
use super::file::DimensionEntry;
use super::spanned::Spanned;
use crate::dimension::{Dimension, DimensionError};
#[cfg(feature = "cli")]
pub(super) use spread::KINDS;

/// The dimension of this line, or what is wrong at which key below the dimension's; `model` is the value that the model gives it by itself.
pub(super) fn dimension(name: &str, entry: &Spanned<DimensionEntry>, model: Option<f64>) -> Result<Dimension, Fault> {
    let (line, entry) = (entry.span(), entry.get_ref());
    let nominal = nominal(entry, model, &line)?;
    let tolerance = tolerance::tolerance(entry, nominal)?;
    let distribution = spread::distribution(entry, nominal, tolerance)?;
    let whole = |error: DimensionError| fault(line, "", error.fault);
    let mut dimension = match distribution {
        None => Dimension::fixed(name, nominal),
        Some(distribution) => Dimension::distributed(name, nominal, tolerance, distribution),
    }
    .map_err(whole)?;
    if let Some(unit) = &entry.unit {
        dimension = dimension.with_unit(unit);
    }
    if let Some(step) = &entry.step {
        let at_step = |error: DimensionError| fault(step.span(), "step", error.fault);
        dimension = dimension.with_step(*step.get_ref()).map_err(at_step)?;
    }
    Ok(dimension)
}

fn nominal(entry: &DimensionEntry, model: Option<f64>, line: &Range<usize>) -> Result<f64, Fault> {
    let middle = entry.limits.as_ref().map(|limits| 0.5 * (limits.get_ref()[0] + limits.get_ref()[1]));
    let given = entry.nominal.as_ref().map(|nominal| *nominal.get_ref());
    given.or(model).or(middle).ok_or_else(|| {
        let instead = "write the value on the drawing, such as nominal = 10.0".to_owned();
        fault(line.clone(), "", StudyFault::MissingKey { key: "nominal".into(), instead })
    })
}

fn conflict(a: &'static str, b: &'static str, why: &str) -> StudyFault {
    StudyFault::Conflict { a, b, why: why.to_owned() }
}
