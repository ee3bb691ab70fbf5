//! Known values of the model. Every point is evaluated once, for all characteristics, within the budget.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use crate::assembly::{EvaluationError, Points, Responses};
use crate::evaluation::{BATCH, Evaluator};

/// Values at all points known so far.
pub(super) struct Answers<'a> {
    pub(super) evaluator: Evaluator<'a>,
    rows: HashMap<Vec<u64>, usize>,
    points: Vec<Vec<f64>>,
    /// Value of each characteristic for every row. NaN if it has none.
    values: Vec<Vec<f64>>,
    pub(super) failures: Vec<Failures>,
}

/// Points at which a characteristic has no value: their number, and the error at the first.
#[derive(Debug, Clone, Default)]
pub(super) struct Failures {
    pub(super) count: usize,
    pub(super) first: Option<EvaluationError>,
}

impl<'a> Answers<'a> {
    pub(super) fn new(evaluator: Evaluator<'a>) -> Self {
        let failures = vec![Failures::default(); evaluator.problem().characteristics().len()];
        Self { evaluator, rows: HashMap::new(), points: Vec::new(), values: Vec::new(), failures }
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
        self.evaluator.stopped().is_some()
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
        new.truncate(self.evaluator.affordable(new.len()));
        let rows = (BATCH / self.evaluator.problem().dimensions().len()).max(1);
        for batch in new.chunks(rows) {
            if !self.evaluator.summary().unfinished() {
                let out = self.evaluator.ask(&Points::from_rows(batch));
                batch.iter().enumerate().for_each(|(row, point)| self.keep(point, row, &out));
            }
        }
    }

    /// Keeps the answers to one point. A point without any answer was not evaluated.
    fn keep(&mut self, point: &[f64], row: usize, out: &Responses) {
        let columns = 0..out.outputs();
        if columns.clone().all(|c| out.is_open(row, c)) {
            return;
        }
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
