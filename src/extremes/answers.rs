//! Known values of the model. Every point is evaluated once, for all characteristics, within the budget.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use crate::assembly::{EvaluationError, NonRepeatable, Points, Request, Responses, Run};
use crate::evaluation::BATCH;
use crate::problem::Problem;
use crate::summary::{RunSummary, StopReason};
use sensitol_numeric::time::Instant;

/// Values at all points known so far, and the cost of their evaluation.
pub(super) struct Answers<'a> {
    problem: &'a Problem,
    run: &'a Run<'a>,
    /// Evaluations that are left of the budget. None if there is no limit.
    left: Option<usize>,
    rows: HashMap<Vec<u64>, usize>,
    points: Vec<Vec<f64>>,
    /// Value of each characteristic for every row. NaN if it has none.
    values: Vec<Vec<f64>>,
    pub(super) spent: Spent,
    pub(super) failures: Vec<Failures>,
}

/// Points at which a characteristic has no value: their number, and the error at the first.
#[derive(Debug, Clone, Default)]
pub(super) struct Failures {
    pub(super) count: usize,
    pub(super) first: Option<EvaluationError>,
}

/// Cost of the evaluations.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Spent {
    /// Numbers of evaluations and stages, and times.
    pub run: RunSummary,
    /// True if points were left out because the budget was spent.
    pub over_budget: bool,
    /// Evaluations in which the model returned another value than before at the nominal point.
    pub non_repeatable: Vec<NonRepeatable>,
}

impl<'a> Answers<'a> {
    pub(super) fn new(problem: &'a Problem, left: Option<usize>, run: &'a Run<'a>) -> Self {
        let failures = vec![Failures::default(); problem.characteristics().len()];
        let (points, values) = (Vec::new(), Vec::new());
        Self { problem, run, left, rows: HashMap::new(), points, values, spent: Spent::default(), failures }
    }

    /// Adds a point with known values, unless it is known already.
    pub(super) fn learn(&mut self, point: &[f64], values: Vec<f64>) {
        if let Entry::Vacant(entry) = self.rows.entry(bits(point)) {
            entry.insert(self.points.len());
            self.points.push(point.to_vec());
            self.values.push(values);
        }
    }

    /// True if no more points can be evaluated.
    pub(super) fn ended(&self) -> bool {
        self.spent.run.unfinished() || self.spent.over_budget
    }

    /// Returns the value of a characteristic at a point. Returns None if it is not known.
    pub(super) fn value(&self, point: &[f64], characteristic: usize) -> Option<f64> {
        let value = self.values[*self.rows.get(&bits(point))?][characteristic];
        (!value.is_nan()).then_some(value)
    }

    /// Every known point, with the values of all characteristics. NaN if there is none.
    pub(super) fn known(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        self.points.iter().zip(&self.values).map(|(point, values)| (&point[..], &values[..]))
    }

    /// Returns the points that are not known yet, each once.
    pub(super) fn unknown(&self, points: impl Iterator<Item = Vec<f64>>) -> Vec<Vec<f64>> {
        let mut seen = HashSet::new();
        let new = |point: &Vec<f64>| {
            let bits = bits(point);
            !self.rows.contains_key(&bits) && seen.insert(bits)
        };
        points.filter(new).collect()
    }

    /// Evaluates these points, each once, in batches, as far as the budget goes.
    pub(super) fn ask(&mut self, points: Vec<Vec<f64>>) {
        let mut new = self.unknown(points.into_iter());
        if let Some(left) = self.left.map(|left| left.saturating_sub(self.spent.run.evaluations as usize))
            && new.len() > left
        {
            new.truncate(left);
            self.spent.over_budget = true;
            self.spent.run.stopped.get_or_insert(StopReason::Budget);
        }
        let rows = (BATCH / self.problem.dimensions().len()).max(1);
        for batch in new.chunks(rows) {
            if !self.spent.run.unfinished() {
                self.send(batch);
            }
        }
    }

    fn send(&mut self, batch: &[Vec<f64>]) {
        let mut out = Responses::open(batch.len(), self.problem.outputs().len());
        let begun = Instant::now();
        let points = Points::from_rows(batch);
        self.problem.function().evaluate(&Request::values(&points, self.problem.outputs()), self.run, &mut out);
        self.spent.run.in_model += begun.elapsed();
        self.spent.run.stages += 1;
        for (row, point) in batch.iter().enumerate() {
            self.keep(point, row, &out);
        }
        let spent = &mut self.spent.run;
        spent.evaluations = spent.evaluations.saturating_add_signed(out.extra());
        spent.cached += out.count_reused() as u64;
        spent.retried += out.count_retried() as u64;
        self.spent.non_repeatable.extend(out.non_repeatable().iter().cloned());
    }

    /// Keeps the answers to one point. A row with open outputs was not finished. It counts as sent only if some output
    /// was answered.
    fn keep(&mut self, point: &[f64], row: usize, out: &Responses) {
        let columns = 0..out.outputs();
        if columns.clone().any(|c| out.is_open(row, c)) {
            self.spent.run.stopped = Some(self.run.why_open());
        }
        if columns.clone().all(|c| out.is_open(row, c)) {
            return;
        }
        self.spent.run.evaluations += 1;
        self.spent.run.failed += u64::from(columns.clone().any(|c| out.error(row, c).is_some()));
        for c in columns.clone() {
            if let Some(error) = out.error(row, c) {
                self.failures[c].count += 1;
                self.failures[c].first.get_or_insert_with(|| error.clone());
            }
        }
        self.learn(point, columns.map(|c| out.value(row, c).unwrap_or(f64::NAN)).collect());
    }
}

/// Bits of a point as a key. Adding 0 turns -0 into 0, so that both have the same key.
fn bits(point: &[f64]) -> Vec<u64> {
    point.iter().map(|x| (x + 0.0).to_bits()).collect()
}
