//! Answers that were evaluated elsewhere: a table of points and values in place of a program.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use super::{Ask, AssemblyFunction, EvaluationError, Responses, Run, Signature};

/// Coordinates are the same when they differ by no more than this part of themselves: a spreadsheet keeps 15 digits.
const SAME: f64 = 1e-12;

/// Named columns of numbers, None where a cell is empty: dimensions and outputs, in any order.
#[derive(Debug, Default)]
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<Option<f64>>>,
    /// Rows that answered some point, and points that no row answers.
    asked: Mutex<(Vec<bool>, usize)>,
}

impl Table {
    /// Every row has a cell for every column.
    pub fn new(columns: Vec<String>, rows: Vec<Vec<Option<f64>>>) -> Self {
        assert!(rows.iter().all(|row| row.len() == columns.len()), "a row has a cell for every column");
        let asked = Mutex::new((vec![false; rows.len()], 0));
        Self { columns, rows, asked }
    }

    /// The names of its columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Rows, from 0, that answered no point so far.
    pub fn unused(&self) -> Vec<usize> {
        let asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        (0..self.rows.len()).filter(|&row| !asked.0[row]).collect()
    }

    /// Points asked for so far that no row answers.
    pub fn missing(&self) -> usize {
        self.asked.lock().unwrap_or_else(PoisonError::into_inner).1
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }
}

/// A table as assembly function: what stands in it is known, nothing else is.
pub struct Given {
    signature: Signature,
    table: std::sync::Arc<Table>,
    /// The table's columns of the dimensions.
    inputs: Vec<usize>,
    /// Rows by the exact doubles of their point.
    exact: HashMap<Vec<u64>, usize>,
}

impl Given {
    /// Of the dimensions and outputs of `signature`.
    ///
    /// # Errors
    /// The first dimension for which there is no column.
    pub fn new(signature: Signature, table: std::sync::Arc<Table>) -> Result<Self, String> {
        let column = |input: &super::Input| table.column(&input.name).ok_or_else(|| input.name.clone());
        let inputs = signature.inputs.iter().map(column).collect::<Result<Vec<usize>, String>>()?;
        let exact = (table.rows.iter().enumerate())
            .filter_map(|(row, cells)| {
                Some((bits(&inputs.iter().map(|&column| cells[column]).collect::<Option<Vec<_>>>()?), row))
            })
            .collect();
        Ok(Self { signature, table, inputs, exact })
    }

    fn find(&self, point: &[f64]) -> Option<usize> {
        let near = |row: &Vec<Option<f64>>| {
            let close = |(&column, x): (&usize, &f64)| {
                row[column].is_some_and(|cell| (cell - x).abs() <= SAME * x.abs().max(f64::MIN_POSITIVE))
            };
            self.inputs.iter().zip(point).all(close)
        };
        self.exact.get(&bits(point)).copied().or_else(|| self.table.rows.iter().position(near))
    }
}

/// 0 has one sign only.
fn bits(point: &[f64]) -> Vec<u64> {
    point.iter().map(|x| (x + 0.0).to_bits()).collect()
}

impl AssemblyFunction for Given {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn evaluate(&self, ask: &Ask<'_>, run: &Run<'_>, out: &mut Responses) {
        let columns: Vec<Option<usize>> =
            ask.outputs.iter().map(|&output| self.table.column(&self.signature.outputs[output].name)).collect();
        let mut known = 0;
        for row in 0..ask.points.rows() {
            let found = self.find(&ask.points.row(row));
            {
                let mut asked = self.table.asked.lock().unwrap_or_else(PoisonError::into_inner);
                match found {
                    Some(found) => {
                        asked.0[found] = true;
                        known += 1;
                    }
                    None => asked.1 += 1,
                }
            }
            for (output, column) in columns.iter().enumerate() {
                match found.zip(*column).and_then(|(found, column)| self.table.rows[found][column]) {
                    Some(value) => out.set(row, output, value),
                    None => out.fail(row, output, EvaluationError::NotGiven),
                }
            }
        }
        // Nothing was evaluated here: what is known was known before, and the rest costs nothing.
        out.reused(known);
        out.spent(known as i64 - ask.points.rows() as i64);
        run.finished(&(0..ask.points.rows()).collect::<Vec<_>>(), out);
    }
}
