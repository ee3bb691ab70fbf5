//! Model evaluated at points in normal space, with a count of its cost.

use std::time::Duration;

use crate::assembly::{EvaluationError, NonRepeatable, Points, Request, Responses, Run};
use crate::problem::Problem;
use crate::rare::normal_space::{Columns, Space};
use sensitol_numeric::time::Instant;

/// Points that are evaluated between two checks of the time limit.
const BATCH: usize = 1 << 14;

/// Model with the counts of its evaluations.
pub(super) struct Model<'a> {
    pub(super) problem: &'a Problem,
    pub(super) space: &'a Space<'a>,
    run: &'a Run<'a>,
    /// Number of points that were answered.
    pub(super) answered: u64,
    /// Evaluations in addition to these: points that were tried again, minus those that were known.
    pub(super) extra: i64,
    pub(super) reused: u64,
    pub(super) retried: u64,
    /// Number of batches.
    pub(super) stages: u64,
    /// Number of points without a value of at least one characteristic.
    pub(super) failed: u64,
    /// For every characteristic, the number of points without a value, and the first error.
    pub(super) lost: Vec<(u64, Option<EvaluationError>)>,
    pub(super) in_model: Duration,
    /// Evaluations in which the model returned another value than before at the nominal point.
    pub(super) non_repeatable: Vec<NonRepeatable>,
}

pub(super) struct Answers {
    /// Column of values for every characteristic. NaN if there is none.
    columns: Vec<Vec<f64>>,
    /// True for each row that was finished before the run was stopped.
    answered: Vec<bool>,
}

impl Answers {
    pub(super) fn value(&self, row: usize, characteristic: usize) -> Option<f64> {
        Some(self.columns[characteristic][row]).filter(|value| !value.is_nan())
    }

    /// Values of all rows. None if a row has none.
    pub(super) fn values(&self, characteristic: usize) -> impl Iterator<Item = Option<f64>> + '_ {
        self.columns[characteristic].iter().map(|&value| Some(value).filter(|value| !value.is_nan()))
    }

    pub(super) fn answered(&self, row: usize) -> bool {
        self.answered[row]
    }
}

impl<'a> Model<'a> {
    pub(super) fn new(problem: &'a Problem, space: &'a Space<'a>, run: &'a Run<'a>) -> Self {
        let lost = vec![(0, None); problem.characteristics().len()];
        let (answered, extra, reused, failed) = (0, 0, 0, 0);
        Self {
            problem,
            space,
            run,
            answered,
            extra,
            reused,
            retried: 0,
            stages: 0,
            failed,
            lost,
            in_model: Duration::ZERO,
            non_repeatable: Vec::new(),
        }
    }

    pub(super) fn middle(&self) -> Vec<f64> {
        self.problem.dimensions().iter().map(|dimension| dimension.mean()).collect()
    }

    /// Evaluates these points, until the run is stopped.
    pub(super) fn ask(&mut self, normals: &Columns) -> Answers {
        let columns = self.space.values(normals);
        let (middle, rows) = (self.middle(), columns.first().map_or(0, Vec::len));
        let outputs = self.problem.outputs();
        let mut answers = Answers { columns: vec![vec![f64::NAN; rows]; outputs.len()], answered: vec![false; rows] };
        let mut first = 0;
        while first < rows && !self.run.stopped() {
            let batch = BATCH.min(rows - first);
            let mut points = Points::repeated(&middle, batch);
            for (d, column) in self.space.dimensions().zip(&columns) {
                points.column_mut(d).copy_from_slice(&column[first..first + batch]);
            }
            let mut out = Responses::open(batch, outputs.len());
            let begun = Instant::now();
            self.problem.function().evaluate(&Request::values(&points, outputs), self.run, &mut out);
            self.in_model += begun.elapsed();
            self.extra += out.extra();
            self.non_repeatable.extend(out.non_repeatable().iter().cloned());
            self.reused += out.count_reused() as u64;
            self.retried += out.count_retried() as u64;
            self.stages += 1;
            (0..batch).for_each(|row| self.learn(&out, row, first + row, &mut answers));
            first += batch;
        }
        answers
    }

    fn learn(&mut self, out: &Responses, row: usize, to: usize, answers: &mut Answers) {
        if (0..out.outputs()).all(|output| out.is_open(row, output)) {
            return;
        }
        answers.answered[to] = true;
        self.answered += 1;
        let mut failed = false;
        for (output, (lost, why)) in self.lost.iter_mut().enumerate() {
            if let Some(value) = out.value(row, output) {
                answers.columns[output][to] = value;
            }
            if let Some(error) = out.error(row, output) {
                failed = true;
                *lost += 1;
                why.get_or_insert_with(|| error.clone());
            }
        }
        self.failed += u64::from(failed);
    }
}
