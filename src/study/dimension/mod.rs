//! From one line of `[dimensions]` to a dimension: tolerance and distribution in their several forms.

mod measured;
mod spread;
mod tolerance;

use std::ops::Range;
use std::sync::Arc;

use serde_spanned::Spanned;

use super::data::Data;
use super::error::{Fault, StudyFault, fault};
use super::file::DimensionEntry;
use crate::dimension::{Dimension, DimensionError};

/// The dimension of this line, or what is wrong at which key below the dimension's; `model` is the value that the model gives it by itself.
/// What it needs beside the study, and what is odd about it, is in `data`.
pub(super) fn dimension(
    name: &str,
    entry: &Spanned<DimensionEntry>,
    model: Option<f64>,
    data: &mut Data<'_>,
) -> Result<Dimension, Fault> {
    let (line, entry) = (entry.span(), entry.get_ref());
    let law = measured::law(name, entry, data)?;
    let mean = law.as_ref().filter(|_| entry.tolerance.is_none()).map(|law| law.distribution.mean());
    let nominal = nominal(entry, model, mean, &line)?;
    let tolerance = tolerance::tolerance(entry, nominal)?;
    let distribution = match &law {
        Some(law) => {
            measured::outside(name, nominal, tolerance, law, data);
            Some(Arc::clone(&law.distribution))
        }
        None => spread::distribution(entry, nominal, tolerance)?,
    };
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

/// As given, or of the model, or the middle of the limits, or the mean of what was measured.
fn nominal(entry: &DimensionEntry, model: Option<f64>, mean: Option<f64>, line: &Range<usize>) -> Result<f64, Fault> {
    let middle = entry.limits.as_ref().map(|limits| 0.5 * (limits.get_ref()[0] + limits.get_ref()[1]));
    let given = entry.nominal.as_ref().map(|nominal| *nominal.get_ref());
    given.or(model).or(middle).or(mean).ok_or_else(|| {
        let instead = "write the value on the drawing, such as nominal = 10.0".to_owned();
        fault(line.clone(), "", StudyFault::MissingKey { key: "nominal".into(), instead })
    })
}

fn conflict(a: &'static str, b: &'static str, why: &str) -> StudyFault {
    StudyFault::Conflict { a, b, why: why.to_owned() }
}
