//! Dimensions with measured values: `{ measured = "pin.csv", column = "d_mm" }`.

use std::ops::Range;
use std::sync::Arc;

use crate::data::{Column, Data, DataFault, DataProblem};
use crate::entries::file::DimensionEntry;
use crate::entries::spanned::Spanned;
use crate::entries::vocabulary::MEASURED_MODELS;
use crate::error::{Fault, StudyFault, fault};
use sensitol::warning::Warning;
use sensitol_numeric::dimension::DimensionFault;
use sensitol_numeric::distribution::{Distribution, DistributionError, Measured, PearsonLaw, Resample, outliers};
use sensitol_numeric::names::nearest;

/// Smallest number of values: four moments of four values have no meaning.
const LEAST: usize = 5;
/// Number of values below which a warning is given: the moments from the third on are then guesses.
const SMALL: usize = 30;
/// Resolution of a gauge, in sigmas of the values, from which it counts as coarse: a tenth of the process spread of six sigma (Measurement
/// Systems Analysis, AIAG, 4th edition, chapter I-E).
const RESOLUTION: f64 = 0.6;
/// Greatest number of lines and values that a warning names.
const NAMED: usize = 5;

/// Distribution of measured values, with their column.
pub(super) struct Law {
    pub(super) distribution: Arc<dyn Distribution>,
    pub(super) column: Column,
}

/// Distribution of the measured values of a line. Returns None if the line names none.
pub(super) fn law(name: &str, entry: &DimensionEntry, data: &mut Data<'_>) -> Result<Option<Law>, Fault> {
    let Some(measured) = &entry.measured else {
        return match [("column", &entry.column), ("model", &entry.model)].into_iter().find(|(_, key)| key.is_some()) {
            None => Ok(None),
            Some((key, given)) => {
                let instead = format!("`{key}` is for measured values: write measured = \"values.csv\" beside it");
                let span = given.as_ref().map_or(0..0, Spanned::span);
                Err(fault(span, key, StudyFault::MissingKey { key: "measured".into(), instead }))
            }
        };
    };
    conflicts(entry)?;
    let pearson = is_pearson(entry)?;
    let column =
        data.column_of(name, measured.get_ref(), entry.column.as_ref().map(|column| column.get_ref().as_str()));
    let column = column.map_err(|found| {
        let (span, key) = match (&*found.problem, &entry.column) {
            (DataProblem::UnknownColumn { .. } | DataProblem::ColumnTwice { .. }, Some(column)) => {
                (column.span(), "column")
            }
            _ => (measured.span(), "measured"),
        };
        fault(span, key, found)
    })?;
    let whole = |problem| {
        let (file, column) = (measured.get_ref().clone(), Some(column.name.clone()));
        fault(measured.span(), "measured", DataFault { file, line: None, column, problem: Box::new(problem) })
    };
    let values = &column.values;
    if values.len() < LEAST {
        let problem = DataProblem::TooFew { found: values.len(), missing: column.missing.len(), least: LEAST };
        return Err(whole(problem));
    }
    let refused = |error: DistributionError| match (error, &entry.model) {
        (DistributionError::NoVariation { count, value: Some(value) }, _) => {
            whole(DataProblem::Constant { count, value })
        }
        (error, Some(model)) => fault(model.span(), "model", DimensionFault::from(error)),
        (error, None) => fault(measured.span(), "measured", DimensionFault::from(error)),
    };
    let empirical = Measured::new(values).map_err(refused)?;
    warn(name, measured.get_ref(), &column, &empirical, data);
    let distribution: Arc<dyn Distribution> = match pearson {
        true => Arc::new(PearsonLaw::fitted(values).map_err(refused)?),
        false => Arc::new(empirical),
    };
    Ok(Some(Law { distribution, column }))
}

/// Checks that the line states no other distribution or place: the values determine both.
fn conflicts(entry: &DimensionEntry) -> Result<(), Fault> {
    let excluded: [(&'static str, Option<Range<usize>>); 6] = [
        ("distribution", entry.distribution.as_ref().map(Spanned::span)),
        ("moments", entry.moments.as_ref().map(Spanned::span)),
        ("sigma", entry.sigma.as_ref().map(Spanned::span)),
        ("sigmas", entry.sigmas.as_ref().map(Spanned::span)),
        ("cp", entry.cp.as_ref().map(Spanned::span)),
        ("cpk", entry.cpk.as_ref().map(Spanned::span)),
    ];
    for (key, span) in excluded {
        if let Some(span) = span {
            let why = "are two ways of giving a distribution: leave one out".to_owned();
            return Err(fault(span, key, StudyFault::Conflict { a: "measured", b: key, why }));
        }
    }
    if let Some(drift) = &entry.drift {
        let (to, instead) = ("measured values".to_owned(), "they drift already");
        return Err(fault(drift.span(), "drift", StudyFault::DoesNotApply { key: "drift", to, instead }));
    }
    if let Some(shift) = &entry.shift {
        let (to, instead) = ("measured values".to_owned(), "they lie where they were measured");
        return Err(fault(shift.span(), "shift", StudyFault::DoesNotApply { key: "shift", to, instead }));
    }
    Ok(())
}

fn is_pearson(entry: &DimensionEntry) -> Result<bool, Fault> {
    let Some(model) = &entry.model else { return Ok(false) };
    match model.get_ref().as_str() {
        "empirical" => Ok(false),
        "pearson" => Ok(true),
        found => {
            let nearest = nearest(found, MEASURED_MODELS).map(str::to_owned);
            let known = MEASURED_MODELS.map(str::to_owned).to_vec();
            let what = "model of measured values";
            Err(fault(model.span(), "model", StudyFault::UnknownWord { what, found: found.to_owned(), nearest, known }))
        }
    }
}

/// Adds warnings of missing values, small samples, outliers and coarse gauges.
fn warn(name: &str, file: &str, column: &Column, law: &Measured, data: &mut Data<'_>) {
    let (dimension, file, values) = (|| name.to_owned(), file.to_owned(), column.values.len());
    if !column.missing.is_empty() {
        let lines = column.missing.iter().take(NAMED).copied().collect();
        let (missing, rows) = (column.missing.len(), column.missing.len() + values);
        let file = file.clone();
        data.warnings.push(Warning::MissingValues { dimension: dimension(), file, missing, rows, lines });
    }
    if values < SMALL {
        data.warnings.push(Warning::SmallSample { dimension: dimension(), values, enough: SMALL, others: Vec::new() });
    }
    let mut far = outliers(&column.values);
    if !far.is_empty() {
        let count = far.len();
        far.truncate(NAMED);
        let first = far.into_iter().map(|i| (column.values[i], column.lines[i])).collect();
        data.warnings.push(Warning::Outliers { dimension: dimension(), file, count, values, first });
    }
    let distinct = law.sample().values();
    let resolution = distinct.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    if distinct.len() < values && resolution > RESOLUTION * law.sigma() {
        let (sigma, distinct, others) = (law.sigma(), distinct.len(), Vec::new());
        data.warnings.push(Warning::CoarseResolution { dimension: dimension(), resolution, sigma, distinct, others });
    }
}

/// Adds a warning if values lie outside of the tolerance band.
pub(super) fn outside(name: &str, nominal: f64, band: Option<[f64; 2]>, law: &Law, data: &mut Data<'_>) {
    let Some([lower, upper]) = band else { return };
    let (low, high) = (nominal + lower, nominal + upper);
    // Values that were computed from limits may differ from them by rounding.
    let slack = 4.0 * f64::EPSILON * low.abs().max(high.abs());
    let far = |value: f64| value < low - slack || value > high + slack;
    let column = &law.column;
    let mut all = column.values.iter().zip(&column.lines).filter(|&(&value, _)| far(value));
    let first: Vec<(f64, u64)> = all.by_ref().take(NAMED).map(|(&value, &line)| (value, line)).collect();
    if !first.is_empty() {
        let (count, values) = (first.len() + all.count(), column.values.len());
        let mean_too = far(law.distribution.mean());
        let dimension = name.to_owned();
        data.warnings.push(Warning::OutsideBand { dimension, count, values, first, mean_too });
    }
}
