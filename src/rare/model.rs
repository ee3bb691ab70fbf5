//! Model evaluated at points in normal space.

use crate::assembly::{EvaluationError, Responses};
use crate::estimate::{Columns, NormalSpace};
use crate::evaluation::Evaluator;
use crate::problem::Problem;

/// Points that are evaluated between two checks of the time limit.
const BATCH: usize = 1 << 14;

/// Model in normal space.
pub(super) struct Model<'a> {
    pub(super) evaluator: Evaluator<'a>,
    pub(super) space: &'a NormalSpace<'a>,
    /// Number of points that were answered: the size of all samples together.
    pub(super) answered: u64,
    /// Number of points without a value and the first error, for every characteristic.
    pub(super) lost: Vec<(u64, Option<EvaluationError>)>,
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
    pub(super) fn new(evaluator: Evaluator<'a>, space: &'a NormalSpace<'a>) -> Self {
        let lost = vec![(0, None); evaluator.problem().characteristics().len()];
        Self { evaluator, space, answered: 0, lost }
    }

    pub(super) fn problem(&self) -> &'a Problem {
        self.evaluator.problem()
    }

    /// Evaluates these points, until the run is stopped.
    pub(super) fn ask(&mut self, normals: &Columns) -> Answers {
        let rows = normals.first().map_or(0, Vec::len);
        let outputs = self.problem().outputs().len();
        let mut answers = Answers { columns: vec![vec![f64::NAN; rows]; outputs], answered: vec![false; rows] };
        let mut first = 0;
        while first < rows && !self.evaluator.run().stopped() {
            let batch = BATCH.min(rows - first);
            let part = normals.iter().map(|column| column[first..first + batch].to_vec()).collect();
            let out = self.evaluator.ask(&self.space.points(&part));
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
        for (output, (lost, why)) in self.lost.iter_mut().enumerate() {
            if let Some(value) = out.value(row, output) {
                answers.columns[output][to] = value;
            }
            if let Some(error) = out.error(row, output) {
                *lost += 1;
                why.get_or_insert_with(|| error.clone());
            }
        }
    }
}
