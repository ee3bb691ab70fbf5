//! Points that are evaluated elsewhere, as CSV: written without answers, read with them.

use std::collections::HashSet;
use std::path::Path;

use super::failure::Failure;
use crate::assembly::{Points, Table};
use crate::document::csv::{guarded, unguarded};
use crate::problem::Problem;

/// A column for every input that the model is sent, a row for every point, every number to its last digit.
///
/// `points` are of the dimensions. Points that send the same numbers stand once.
pub(super) fn table(problem: &Problem, points: &[Vec<f64>]) -> String {
    let of_dimensions = || problem.dimensions().iter().map(|dimension| dimension.name().to_owned()).collect();
    match problem.function().sent(&Points::from_rows(points)) {
        None => written(of_dimensions(), points.to_vec()),
        Some((inputs, sent)) => {
            let names = inputs.into_iter().map(|input| input.name).collect();
            let mut seen = HashSet::new();
            let mut rows: Vec<Vec<f64>> = (0..sent.rows()).map(|row| sent.row(row)).collect();
            rows.retain(|row| seen.insert(row.iter().map(|x| x.to_bits()).collect::<Vec<u64>>()));
            written(names, rows)
        }
    }
}

/// Points of the model's own inputs, as [`table`] writes those of the dimensions.
pub(super) fn of_model(problem: &Problem, points: &[Vec<f64>]) -> String {
    let nominal: Vec<f64> = problem.dimensions().iter().map(crate::dimension::Dimension::nominal).collect();
    let names = match problem.function().sent(&Points::from_rows(&[nominal])) {
        None => problem.dimensions().iter().map(|dimension| dimension.name().to_owned()).collect(),
        Some((inputs, _)) => inputs.into_iter().map(|input| input.name).collect(),
    };
    written(names, points.to_vec())
}

fn written(names: Vec<String>, points: Vec<Vec<f64>>) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(names.iter().map(|name| guarded(name))).expect("memory takes any record");
    for point in points {
        writer.write_record(point.iter().map(f64::to_string)).expect("memory takes any record");
    }
    String::from_utf8(writer.into_inner().expect("memory is always flushed")).expect("text and numbers are UTF-8")
}

/// Reads a table with a header. Empty cells are unknown; everything else is a finite number.
pub(super) fn read(path: &Path) -> Result<Table, Failure> {
    let failed = |reason: String| Failure::Points { path: path.to_owned(), reason };
    let mut reader = csv::Reader::from_path(path).map_err(|error| failed(error.to_string()))?;
    let columns: Vec<String> = reader
        .headers()
        .map_err(|error| failed(error.to_string()))?
        .iter()
        .map(|name| unguarded(name.trim()).to_owned())
        .collect();
    if let Some(twice) = columns.iter().enumerate().find(|(index, name)| columns[..*index].contains(name)) {
        return Err(failed(format!("column `{}` stands twice", twice.1)));
    }
    let mut rows = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| failed(error.to_string()))?;
        let cell = |(column, text): (usize, &str)| match text.trim() {
            "" => Ok(None),
            // A column of remarks is nobody's business here.
            text => match text.parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(Some(value)),
                _ if columns[column].ends_with(" error") => Ok(None),
                _ => Err(failed(format!(
                    "line {}, column `{}`: `{text}` is not a finite number",
                    index + 2,
                    columns[column]
                ))),
            },
        };
        rows.push(record.iter().enumerate().map(cell).collect::<Result<Vec<_>, _>>()?);
    }
    Ok(Table::new(columns, rows))
}
