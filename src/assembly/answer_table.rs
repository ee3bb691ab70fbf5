//! Answers that were evaluated elsewhere: a table of points and values that replaces a program.

use std::collections::{HashMap, HashSet};
use std::sync::{Mutex, PoisonError};

use crate::assembly::request::bits;
use crate::assembly::{AssemblyFunction, EvaluationError, ModelInfo, NoColumn, Request, Responses, Run, Signature};

/// Relative difference below which coordinates are equal: a spreadsheet keeps 15 digits.
const SAME: f64 = 1e-12;

/// Named columns of numbers for dimensions and outputs, in any order; None for an empty cell.
#[derive(Debug, Default)]
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<Option<f64>>>,
    asked: Mutex<Asked>,
}

/// Points that were looked up in a table so far.
#[derive(Debug, Default)]
struct Asked {
    /// Flags of the rows that answered a point.
    used: Vec<bool>,
    /// Points without an answer in the first batch that had any, each once. Later points depend on these answers.
    missing: Vec<Vec<f64>>,
}

impl Table {
    /// Creates a table. Every row must have a cell for every column.
    pub fn new(columns: Vec<String>, rows: Vec<Vec<Option<f64>>>) -> Self {
        assert!(rows.iter().all(|row| row.len() == columns.len()), "a row has a cell for every column");
        let asked = Mutex::new(Asked { used: vec![false; rows.len()], missing: Vec::new() });
        Self { columns, rows, asked }
    }

    /// Returns the error that the table has no column of this name.
    fn lacks(&self, name: &str) -> NoColumn {
        NoColumn::among(name, self.columns.iter().map(String::as_str))
    }

    /// Returns the rows, from 0, that answered no point so far.
    pub fn unused(&self) -> Vec<usize> {
        let asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        (0..self.rows.len()).filter(|&row| !asked.used[row]).collect()
    }

    /// Returns the points that no row answers, each once, with coordinates in the order of the inputs. They belong to the first batch with
    /// such points, because later batches would change with their answers.
    pub fn missing(&self) -> Vec<Vec<f64>> {
        self.asked.lock().unwrap_or_else(PoisonError::into_inner).missing.clone()
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }
}

/// Table as an assembly function. Only its rows have values.
pub struct GivenAnswers {
    signature: Signature,
    table: std::sync::Arc<Table>,
    /// Columns of the table that hold the dimensions.
    inputs: Vec<usize>,
    /// Rows by the exact doubles of their point.
    exact: HashMap<Vec<u64>, usize>,
}

impl GivenAnswers {
    /// Creates the function for the dimensions and outputs of `signature`.
    ///
    /// # Errors
    /// Fails for the first dimension that has no column.
    pub fn new(signature: Signature, table: std::sync::Arc<Table>) -> Result<Self, NoColumn> {
        let column = |input: &crate::assembly::Input| table.column(&input.name).ok_or_else(|| table.lacks(&input.name));
        let inputs = signature.inputs.iter().map(column).collect::<Result<Vec<usize>, NoColumn>>()?;
        let exact = (table.rows.iter().enumerate())
            .filter_map(|(row, cells)| {
                Some((bits(&inputs.iter().map(|&column| cells[column]).collect::<Option<Vec<_>>>()?), row))
            })
            .collect();
        // The user evaluates every requested point outside of this program, so that such a model is never sampled without a request.
        let signature = Signature { costly: true, cheap: false, ..signature };
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

impl AssemblyFunction for GivenAnswers {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        let names = outputs.iter().map(|&output| &self.signature.outputs[output].name);
        match names.into_iter().find(|name| self.table.column(name).is_none()) {
            Some(name) => Err(EvaluationError::NoColumn(self.table.lacks(name))),
            None => Ok(None),
        }
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        let columns: Vec<Option<usize>> =
            request.outputs.iter().map(|&output| self.table.column(&self.signature.outputs[output].name)).collect();
        let mut known = 0;
        let (mut missing, mut seen) = (Vec::new(), HashSet::new());
        for row in 0..request.points.rows() {
            let point = request.points.row(row);
            let found = self.find(&point);
            match found {
                Some(found) => {
                    self.table.asked.lock().unwrap_or_else(PoisonError::into_inner).used[found] = true;
                    known += 1;
                }
                None if seen.insert(bits(&point)) => missing.push(point),
                None => {}
            }
            for (output, column) in columns.iter().enumerate() {
                match found.zip(*column).and_then(|(found, column)| self.table.rows[found][column]) {
                    Some(value) => out.set(row, output, value),
                    None => out.fail(row, output, EvaluationError::NotGiven),
                }
            }
        }
        let mut asked = self.table.asked.lock().unwrap_or_else(PoisonError::into_inner);
        if asked.missing.is_empty() {
            asked.missing = missing;
        }
        drop(asked);
        // Nothing is evaluated here: rows of the table cost nothing, and missing points were not evaluated.
        out.reused(known);
        out.spent(known as i64 - request.points.rows() as i64);
        run.finished(&(0..request.points.rows()).collect::<Vec<_>>(), out);
    }
}
