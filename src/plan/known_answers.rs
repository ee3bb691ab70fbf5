//! Known answers, by point and characteristic.

use std::collections::BTreeMap;

use hashbrown::HashTable;
use hashbrown::hash_table::Entry;

use super::Point;
use crate::assembly::EvaluationError;

/// Answers by point. An entry is a value, an error, or open.
#[derive(Debug, Clone, Default)]
pub struct KnownAnswers {
    characteristics: usize,
    /// Indices of points, keyed by the hashes of the points, so that a million points are stored once.
    rows: HashTable<u32>,
    points: Vec<Point>,
    /// Column per characteristic, NaN if there is no value.
    values: Vec<Vec<f64>>,
    errors: BTreeMap<(u32, u32), EvaluationError>,
}

impl KnownAnswers {
    /// No answers yet, for `characteristics` characteristics.
    pub fn nothing(characteristics: usize) -> Self {
        Self { characteristics, values: vec![Vec::new(); characteristics], ..Self::default() }
    }

    /// Number of characteristics of every point.
    pub(crate) fn characteristics(&self) -> usize {
        self.characteristics
    }

    /// Reserves memory for this number of further points.
    pub(crate) fn reserve(&mut self, points: usize) {
        self.rows.reserve(points, |&row| self.points[row as usize].mixed());
        self.points.reserve(points);
        self.values.iter_mut().for_each(|column| column.reserve(points));
    }

    /// Index of a point, which is added if it is new. `set` and `fail` store its answers.
    pub(crate) fn place(&mut self, point: &Point) -> u32 {
        let Self { rows, points, values, .. } = self;
        let own = |&row: &u32| points[row as usize] == *point;
        match rows.entry(point.mixed(), own, |&row| points[row as usize].mixed()) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(free) => {
                let row = u32::try_from(points.len()).expect("fewer than four billion points");
                free.insert(row);
                points.push(point.clone());
                values.iter_mut().for_each(|column| column.push(f64::NAN));
                row
            }
        }
    }

    /// Stores the value of a characteristic at a point.
    pub(crate) fn set(&mut self, place: u32, characteristic: usize, value: f64) {
        self.values[characteristic][place as usize] = value;
    }

    /// Stores the error of a characteristic without a value at a point.
    pub(crate) fn fail(&mut self, place: u32, characteristic: usize, error: EvaluationError) {
        self.errors.insert((place, characteristic as u32), error);
    }

    fn row(&self, point: &Point) -> Option<u32> {
        if self.points.is_empty() {
            return None;
        }
        self.rows.find(point.mixed(), |&row| self.points[row as usize] == *point).copied()
    }

    /// True if the point was evaluated, with or without success.
    pub(crate) fn tried(&self, point: &Point) -> bool {
        self.row(point).is_some()
    }

    /// Value of a characteristic at a point. Returns None if it is unknown.
    pub(crate) fn value(&self, point: &Point, characteristic: usize) -> Option<f64> {
        let value = self.values[characteristic][self.row(point)? as usize];
        (!value.is_nan()).then_some(value)
    }

    /// Points that were evaluated, in order.
    pub(crate) fn points(&self) -> &[Point] {
        &self.points
    }

    /// Known values of a characteristic.
    pub(crate) fn values(&self, characteristic: usize) -> impl Iterator<Item = f64> {
        self.values[characteristic].iter().copied().filter(|value| !value.is_nan())
    }

    /// Error of a characteristic without a value at a point.
    pub(crate) fn error(&self, point: &Point, characteristic: usize) -> Option<&EvaluationError> {
        self.errors.get(&(self.row(point)?, characteristic as u32))
    }

    /// True if any point failed for any characteristic.
    pub(crate) fn has_failures(&self) -> bool {
        !self.errors.is_empty()
    }

    /// Number of points that failed for at least one characteristic.
    pub(crate) fn failed_points(&self) -> usize {
        let mut rows: Vec<u32> = self.errors.keys().map(|&(row, _)| row).collect();
        rows.dedup();
        rows.len()
    }

    /// Errors with their points and characteristics, in the order of evaluation.
    pub(crate) fn errors(&self) -> impl Iterator<Item = (&Point, usize, &EvaluationError)> {
        self.errors
            .iter()
            .map(|(&(row, characteristic), error)| (&self.points[row as usize], characteristic as usize, error))
    }
}
