//! Points for evaluation elsewhere, as CSV: written without answers, read with them.

use std::collections::HashSet;
use std::path::Path;

use crate::failure::Failure;
use sensitol::assembly::{Points, Table};
use sensitol::problem::Problem;
use sensitol_report::document::csv::{guarded, unguarded};
use sensitol_study::table::{NumberFault, NumberStyle, delimiter, records};

/// Writes a column for every input of the model and a row for every point, in full precision.
///
/// `points` hold values of the dimensions. Points with equal model inputs appear once.
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

/// Writes points of the model's inputs in the format of [`table`].
pub(super) fn of_model(problem: &Problem, points: &[Vec<f64>]) -> String {
    let nominal: Vec<f64> = problem.dimensions().iter().map(sensitol_numeric::dimension::Dimension::nominal).collect();
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

/// Delimiters in the order of trial. Written files use commas.
const CANDIDATES: [u8; 3] = [b',', b';', b'\t'];

/// Reads a table with a header, in English or German number format. Empty cells are unknown; all others must be finite numbers.
pub(super) fn read(path: &Path) -> Result<Table, Failure> {
    let failed = |reason: String| Failure::Points { path: path.to_owned(), reason };
    let bytes = std::fs::read(path).map_err(|error| failed(error.to_string()))?;
    let text = std::str::from_utf8(&bytes).map_err(|_| failed("it is not UTF-8 text".to_owned()))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let delimiter = delimiter(text, CANDIDATES);
    let mut records = records(text, delimiter);
    let header = records.next().map(|(_, header)| header).unwrap_or_default();
    let columns: Vec<String> = header.iter().map(|name| unguarded(name).to_owned()).collect();
    if let Some(twice) = columns.iter().enumerate().find(|(index, name)| columns[..*index].contains(name)) {
        return Err(failed(format!("column `{}` stands twice", twice.1)));
    }
    let records: Vec<(u64, csv::StringRecord)> = records.collect();
    if let Some((line, record)) = records.iter().find(|(_, record)| record.len() != columns.len()) {
        return Err(failed(format!("line {line}: {} cells, and {} in the header", record.len(), columns.len())));
    }
    let mut rows = vec![vec![None; columns.len()]; records.len()];
    for (index, name) in columns.iter().enumerate() {
        let cells: Vec<(usize, &str)> =
            records.iter().map(|(_, record)| &record[index]).enumerate().filter(|(_, cell)| !cell.is_empty()).collect();
        let style = NumberStyle::of(cells.iter().map(|(_, cell)| *cell), delimiter == b',');
        for (place, &(row, cell)) in cells.iter().enumerate() {
            rows[row][index] = match style.number(place, cell) {
                Ok(value) => Some(value),
                // Text in a column of errors is a remark.
                Err(_) if name.ends_with(" error") => None,
                Err(found) => {
                    let why = match found {
                        NumberFault::NoNumber { comma: true } => {
                            "is not a number: decimal commas need semicolons or tabs between the columns".to_owned()
                        }
                        NumberFault::TwoMarks { other, .. } => {
                            format!("has another decimal mark than line {}", records[cells[other].0].0)
                        }
                        _ => "is not a finite number".to_owned(),
                    };
                    return Err(failed(format!("line {}, column `{name}`: `{cell}` {why}", records[row].0)));
                }
            };
        }
    }
    Ok(Table::new(columns, rows))
}
