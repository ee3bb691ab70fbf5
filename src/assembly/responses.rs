//! Answers of an assembly function.

use std::collections::BTreeMap;

use crate::assembly::EvaluationError;
use crate::assembly::NonRepeatable;
use sensitol_numeric::power::Power;

/// Answers of a batch: a column per requested output, and an error for each entry without a value.
///
/// An entry starts open. It then becomes either a finite value or an error. An entry that is still open at the end belongs to a point that
/// was not finished.
///
/// ```
/// use sensitol::assembly::{EvaluationError, Responses};
/// let mut out = Responses::open(3, 1);
/// out.set(0, 0, 5.997);
/// out.set(1, 0, f64::NAN); // what is not finite never leaves as a number
/// assert_eq!(out.value(0, 0), Some(5.997));
/// assert!(matches!(out.error(1, 0), Some(EvaluationError::NotFinite { .. })));
/// assert!(out.value(2, 0).is_none() && out.error(2, 0).is_none()); // still open
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Responses {
    rows: usize,
    outputs: usize,
    /// Values by column, NaN for an entry without a value.
    values: Vec<f64>,
    errors: BTreeMap<(usize, usize), EvaluationError>,
    /// Number of evaluations in addition to one for each answered row.
    extra: i64,
    /// Number of rows whose answers were known already.
    reused: usize,
    /// Number of points that were sent again.
    retried: usize,
    /// Points at which the model gave different answers.
    non_repeatable: Vec<NonRepeatable>,
    /// Points of earlier batches whose answers are not trusted any more.
    revoked: Vec<Vec<f64>>,
    /// Number of rows whose answers a stop left without their check.
    unchecked: usize,
    /// Derivatives by every input, if a model sends them.
    gradients: BTreeMap<(usize, usize), Vec<f64>>,
}

impl Responses {
    /// Creates open entries for `rows` points and `outputs` asked outputs.
    pub fn open(rows: usize, outputs: usize) -> Self {
        Self {
            rows,
            outputs,
            values: vec![f64::NAN; rows * outputs],
            errors: BTreeMap::new(),
            extra: 0,
            reused: 0,
            retried: 0,
            non_repeatable: Vec::new(),
            revoked: Vec::new(),
            unchecked: 0,
            gradients: BTreeMap::new(),
        }
    }

    /// Discards all answers and opens entries of a new shape. The memory is reused.
    pub(crate) fn reopen(&mut self, rows: usize, outputs: usize) {
        let mut values = std::mem::take(&mut self.values);
        values.clear();
        values.resize(rows * outputs, f64::NAN);
        *self = Self { rows, outputs, values, ..Self::open(0, 0) };
    }

    /// True if nothing is answered or noted yet. The check is fast if the first rows are answered.
    pub(crate) fn is_untouched(&self) -> bool {
        self.errors.is_empty()
            && (self.extra, self.reused, self.retried, self.unchecked) == (0, 0, 0, 0)
            && self.non_repeatable.is_empty()
            && self.revoked.is_empty()
            && self.gradients.is_empty()
            && self.values.iter().fold(true, |all, value| all & value.is_nan())
    }

    /// Returns the number of points.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Returns the number of requested outputs.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Answers one entry. A value that is not finite becomes an error.
    pub fn set(&mut self, row: usize, output: usize, value: f64) {
        if value.is_finite() {
            // The last answer counts, even after an error.
            if !self.errors.is_empty() {
                self.errors.remove(&(row, output));
            }
            self.values[output * self.rows + row] = value;
        } else {
            self.fail(row, output, EvaluationError::NotFinite { value });
        }
    }

    /// Adds the derivatives of one entry by every input.
    pub fn set_gradient(&mut self, row: usize, output: usize, gradient: Vec<f64>) {
        self.gradients.insert((row, output), gradient);
    }

    /// Returns the derivatives of one entry by every input, if the model sent them.
    pub fn gradient(&self, row: usize, output: usize) -> Option<&[f64]> {
        self.gradients.get(&(row, output)).map(Vec::as_slice)
    }

    /// Answers entries from a row on, like [`set`](Self::set) one by one.
    pub fn set_rows(&mut self, first: usize, output: usize, values: &[f64]) {
        if self.errors.is_empty() && all_finite(values) {
            let start = output * self.rows + first;
            self.values[start..start + values.len()].copy_from_slice(values);
        } else {
            values.iter().zip(first..).for_each(|(&value, row)| self.set(row, output, value));
        }
    }

    /// Answers one entry with an error.
    pub fn fail(&mut self, row: usize, output: usize, error: EvaluationError) {
        self.values[output * self.rows + row] = f64::NAN;
        self.errors.insert((row, output), error);
    }

    /// Returns the rows with an answer in some output. A row that is open in every output was not sent, or not finished.
    pub fn answered(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.rows).filter(|&row| (0..self.outputs).any(|output| !self.is_open(row, output)))
    }

    /// True if an entry has neither value nor error.
    pub(crate) fn has_open_entries(&self) -> bool {
        if self.errors.is_empty() {
            return !all_finite(&self.values);
        }
        // An entry with an error is NaN too, so every other NaN is an open entry.
        self.values.iter().filter(|value| value.is_nan()).count() > self.errors.len()
    }

    /// Returns the number of rows with an error in some output.
    pub(crate) fn failed_rows(&self) -> usize {
        let mut last = None;
        // Errors are in the order of their rows.
        self.errors.keys().filter(|(row, _)| last.replace(*row) != Some(*row)).count()
    }

    /// Returns the value, if there is one.
    pub fn value(&self, row: usize, output: usize) -> Option<f64> {
        let value = self.values[output * self.rows + row];
        (!value.is_nan()).then_some(value)
    }

    /// Returns the error, if there is one.
    pub fn error(&self, row: usize, output: usize) -> Option<&EvaluationError> {
        self.errors.get(&(row, output))
    }

    /// True if an entry has neither value nor error.
    pub fn is_open(&self, row: usize, output: usize) -> bool {
        self.value(row, output).is_none() && self.error(row, output).is_none()
    }

    /// Adds evaluations in addition to one for each answered row, such as second tries. The number is negative for answers without an
    /// evaluation.
    pub fn spent(&mut self, extra: i64) {
        self.extra += extra;
    }

    /// Counts rows whose answers were known already. They cost no evaluation.
    #[doc(hidden)]
    pub fn reused(&mut self, rows: usize) {
        self.reused += rows;
        self.extra -= rows as i64;
    }

    /// Counts points that were sent again. [`spent`](Self::spent) includes them too.
    pub fn retried(&mut self, points: usize) {
        self.retried += points;
    }

    /// Returns the number of points that were sent again.
    pub fn count_retried(&self) -> usize {
        self.retried
    }

    /// Notes that the model gave different answers for a point.
    pub fn note_non_repeatable(&mut self, non_repeatable: impl IntoIterator<Item = NonRepeatable>) {
        self.non_repeatable.extend(non_repeatable);
    }

    /// Returns the points at which the model gave different answers.
    pub fn non_repeatable(&self) -> &[NonRepeatable] {
        &self.non_repeatable
    }

    /// Notes a point of an earlier batch whose answer is not trusted any more.
    pub fn revoke(&mut self, point: Vec<f64>) {
        self.revoked.push(point);
    }

    /// Returns the points of earlier batches whose answers are not trusted any more.
    pub fn revoked(&self) -> &[Vec<f64>] {
        &self.revoked
    }

    /// Counts rows whose answers a stop left without their check. Nothing can be concluded from them.
    pub fn leave_unchecked(&mut self, rows: usize) {
        self.unchecked += rows;
    }

    /// Returns the number of rows whose answers a stop left without their check.
    pub fn count_unchecked(&self) -> usize {
        self.unchecked
    }

    /// Returns the number of rows whose answers were known already.
    pub fn count_reused(&self) -> usize {
        self.reused
    }

    /// Returns the number of evaluations in addition to one for each answered row.
    pub fn extra(&self) -> i64 {
        self.extra
    }

    /// Returns all values of one output, NaN for each that is missing.
    pub fn column(&self, output: usize) -> &[f64] {
        &self.values[output * self.rows..(output + 1) * self.rows]
    }

    /// Copies one entry from other responses: its value, its error, or nothing if it is open.
    pub fn pass_on(&mut self, row: usize, output: usize, from: &Responses, from_row: usize, from_output: usize) {
        if let Some(value) = from.value(from_row, from_output) {
            self.set(row, output, value);
            if let Some(gradient) = from.gradient(from_row, from_output) {
                self.set_gradient(row, output, gradient.to_vec());
            }
        } else if let Some(error) = from.error(from_row, from_output) {
            self.fail(row, output, error.clone());
        }
    }

    /// Returns the number of these rows that have an output without a value.
    pub fn failed_among(&self, rows: &[usize]) -> usize {
        rows.iter().filter(|&&row| (0..self.outputs).any(|output| self.value(row, output).is_none())).count()
    }

    /// Iterates over the errors with row and output, in order.
    pub fn errors(&self) -> impl Iterator<Item = (usize, usize, &EvaluationError)> {
        self.errors.iter().map(|(&(row, output), error)| (row, output, error))
    }

    /// Multiplies an output, and its slopes, by a factor.
    pub(crate) fn multiply(&mut self, output: usize, factor: f64) {
        let start = output * self.rows;
        self.values[start..start + self.rows].iter_mut().for_each(|value| *value *= factor);
        let of_output = self.gradients.iter_mut().filter(|((_, of), _)| *of == output);
        of_output.for_each(|(_, gradient)| gradient.iter_mut().for_each(|slope| *slope *= factor));
    }

    /// Multiplies an output, and its slopes, by a power of two. A value that becomes infinite is an error.
    pub(crate) fn multiply_by(&mut self, output: usize, power: Power) {
        let start = output * self.rows;
        let column = &mut self.values[start..start + self.rows];
        column.iter_mut().for_each(|value| *value = power.times(*value));
        let infinite: Vec<usize> = (0..self.rows).filter(|&row| self.values[start + row].is_infinite()).collect();
        for row in infinite {
            self.fail(row, output, EvaluationError::NotFinite { value: self.values[start + row] });
        }
        let of_output = self.gradients.iter_mut().filter(|((_, of), _)| *of == output);
        of_output.for_each(|(_, gradient)| gradient.iter_mut().for_each(|slope| *slope = power.times(*slope)));
    }

    /// Copies the answers of a block to the rows from `first` on.
    pub(crate) fn adopt(&mut self, first: usize, block: Responses) {
        for output in 0..self.outputs {
            let start = output * self.rows + first;
            self.values[start..start + block.rows].copy_from_slice(block.column(output));
        }
        self.extra += block.extra;
        self.reused += block.reused;
        self.retried += block.retried;
        self.unchecked += block.unchecked;
        self.non_repeatable.extend(block.non_repeatable.iter().cloned());
        self.revoked.extend(block.revoked);
        let gradients = block.gradients.into_iter();
        self.gradients.extend(gradients.map(|((row, output), gradient)| ((first + row, output), gradient)));
        self.errors.extend(block.errors.into_iter().map(|((row, output), error)| ((first + row, output), error)));
    }
}

/// True if no value is infinite or NaN.
#[inline(always)]
pub(crate) fn all_finite(values: &[f64]) -> bool {
    // 0 times a finite number is 0, and 0 times any other is NaN.
    let (blocks, rest) = values.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for block in blocks {
        sums.iter_mut().zip(block).for_each(|(sum, value)| *sum += 0.0 * value);
    }
    sums.iter().sum::<f64>() == 0.0 && rest.iter().all(|value| value.is_finite())
}
