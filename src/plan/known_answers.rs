//! The answers so far, per point and characteristic.

use std::collections::BTreeMap;

use hashbrown::HashTable;
use hashbrown::hash_table::Entry;

use super::Point;
use crate::assembly::EvaluationError;

/// Answers by point. An entry is a value, an error, or open.
#[derive(Debug, Clone, Default)]
pub struct KnownAnswers {
    characteristics: usize,
    /// Places among the points, by their hashes: a million points stand here once.
    rows: HashTable<u32>,
    points: Vec<Point>,
    /// A column per characteristic, NaN where there is no value.
    values: Vec<Vec<f64>>,
    errors: BTreeMap<(u32, u32), EvaluationError>,
}

impl KnownAnswers {
    /// Nothing yet of `characteristics` characteristics.
    pub fn nothing(characteristics: usize) -> Self {
        Self { characteristics, values: vec![Vec::new(); characteristics], ..Self::default() }
    }

    /// How many characteristics every point has.
    pub(crate) fn characteristics(&self) -> usize {
        self.characteristics
    }

    /// Makes room for so many points more.
    pub(crate) fn reserve(&mut self, points: usize) {
        self.rows.reserve(points, |&row| self.points[row as usize].mixed());
        self.points.reserve(points);
        self.values.iter_mut().for_each(|column| column.reserve(points));
    }

    /// The place of a point, a new one where it has none. The next two keep what it answered there.
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

    /// Keeps the value of a characteristic at a place.
    pub(crate) fn set(&mut self, place: u32, characteristic: usize, value: f64) {
        self.values[characteristic][place as usize] = value;
    }

    /// Keeps why a characteristic has no value at a place.
    pub(crate) fn fail(&mut self, place: u32, characteristic: usize, error: EvaluationError) {
        self.errors.insert((place, characteristic as u32), error);
    }

    fn row(&self, point: &Point) -> Option<u32> {
        if self.points.is_empty() {
            return None;
        }
        self.rows.find(point.mixed(), |&row| self.points[row as usize] == *point).copied()
    }

    /// Whether the point was evaluated, with whatever success.
    pub(crate) fn tried(&self, point: &Point) -> bool {
        self.row(point).is_some()
    }

    /// The value of a characteristic at a point, where it is known.
    pub(crate) fn value(&self, point: &Point, characteristic: usize) -> Option<f64> {
        let value = self.values[characteristic][self.row(point)? as usize];
        (!value.is_nan()).then_some(value)
    }

    /// Every point that was evaluated, in order.
    pub(crate) fn points(&self) -> &[Point] {
        &self.points
    }

    /// Every known value of a characteristic.
    pub(crate) fn values(&self, characteristic: usize) -> impl Iterator<Item = f64> {
        self.values[characteristic].iter().copied().filter(|value| !value.is_nan())
    }

    /// Why a characteristic has no value at a point.
    pub(crate) fn error(&self, point: &Point, characteristic: usize) -> Option<&EvaluationError> {
        self.errors.get(&(self.row(point)?, characteristic as u32))
    }

    /// Whether any point failed for any characteristic.
    pub(crate) fn has_failures(&self) -> bool {
        !self.errors.is_empty()
    }

    /// How many points lost at least one characteristic.
    pub(crate) fn failed_points(&self) -> usize {
        let mut rows: Vec<u32> = self.errors.keys().map(|&(row, _)| row).collect();
        rows.dedup();
        rows.len()
    }

    /// Every error with its point and characteristic, in the order of evaluation.
    pub(crate) fn errors(&self) -> impl Iterator<Item = (&Point, usize, &EvaluationError)> {
        self.errors
            .iter()
            .map(|(&(row, characteristic), error)| (&self.points[row as usize], characteristic as usize, error))
    }
}
