//! Cells of the band, each with a bound of the share within the limits that holds at all of its points.

use crate::distribution_bounds::simplex::{Column, Solution};
use crate::distribution_bounds::{DistributionPromise, YieldAtValue};

/// Number of cells at the beginning: an isolated limit is found by bounds, not by chance.
const BEGIN: usize = 64;
/// Values of a uniform distribution at which its mean share is bounded.
const SLICES: u32 = 256;

/// Cells in order, with a bound each.
pub(super) struct Cells<'c> {
    promise: &'c DistributionPromise,
    within: &'c dyn YieldAtValue,
    sign: f64,
    /// Ends of the cells, ascending.
    ends: Vec<f64>,
    /// Least value over each cell.
    least: Vec<f64>,
}

impl<'c> Cells<'c> {
    /// Divides the range into equal cells, and at a mean that keeps the promise.
    pub(super) fn new(promise: &'c DistributionPromise, within: &'c dyn YieldAtValue, sign: f64, mean: f64) -> Self {
        let [low, high] = promise.range();
        let mut ends: Vec<f64> = (0..=BEGIN).map(|end| low + (high - low) * end as f64 / BEGIN as f64).collect();
        // A distribution at this mean alone keeps every promise: the program begins with it.
        if !promise.is_symmetric() {
            ends.push(mean);
        }
        ends.sort_unstable_by(f64::total_cmp);
        ends.dedup();
        let mut cells = Self { promise, within, sign, ends, least: Vec::new() };
        cells.least = cells.ends.windows(2).map(|ends| cells.bound([ends[0], ends[1]])).collect();
        cells
    }

    pub(super) fn count(&self) -> usize {
        self.least.len()
    }

    /// Two columns for each cell, one at each end, with the bound of the cell.
    pub(super) fn columns(&self) -> Vec<Column> {
        let column = |(ends, least): (&[f64], &f64)| [ends[0], ends[1]].map(|x| Column { x, value: *least });
        self.ends.windows(2).zip(&self.least).flat_map(column).collect()
    }

    /// Value of a distribution of the mixture at a place: `sign` times its share within the limits.
    pub(super) fn value(&self, x: f64) -> f64 {
        let middle = self.promise.middle();
        let pair = |t: f64| 0.5 * (self.within.at(middle - t) + self.within.at(middle + t));
        self.sign
            * match (self.promise.is_symmetric(), self.promise.is_unimodal()) {
                (false, _) => self.within.at(x),
                (true, false) => pair(x),
                (true, true) if x == 0.0 => self.within.at(middle),
                (true, true) => {
                    let at = |slice: u32| x * (f64::from(slice) + 0.5) / f64::from(SLICES);
                    (0..SLICES).map(|slice| pair(at(slice))).sum::<f64>() / f64::from(SLICES)
                }
            }
    }

    /// Least value over a cell.
    fn bound(&self, [from, to]: [f64; 2]) -> f64 {
        let middle = self.promise.middle();
        let pair = |from: f64, to: f64| {
            let [left, right] =
                [[middle - to, middle - from], [middle + from, middle + to]].map(|of| self.within.over(of));
            [0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1])]
        };
        let [least, greatest] = match (self.promise.is_symmetric(), self.promise.is_unimodal()) {
            (false, _) => self.within.over([from, to]),
            (true, false) => pair(from, to),
            (true, true) => {
                // Slices of the uniform distribution of any half-width in the cell: the slice `i` lies between these ends.
                let slice = |slice: u32| {
                    let share = |part: u32| f64::from(part) / f64::from(SLICES);
                    pair(share(slice) * from, share(slice + 1) * to)
                };
                let sums = (0..SLICES).map(slice).fold([0.0, 0.0], |sum, of| [sum[0] + of[0], sum[1] + of[1]]);
                sums.map(|sum| sum / f64::from(SLICES))
            }
        };
        if self.sign > 0.0 { least } else { -greatest }
    }

    /// Least distance of the value of each cell above the dual function, at all points of the cell.
    pub(super) fn room(&self, columns: &[Column], solution: &Solution) -> Vec<f64> {
        let of = |(ends, pair): (&[f64], &[Column])| {
            let width = ends[1] - ends[0];
            // A parabola rises above the greater of two of its values by at most its curvature times a quarter of their squared distance.
            let bulge = solution.curvature().max(0.0) * 0.25 * width * width;
            pair.iter().map(|column| solution.reduced_cost(column)).fold(f64::MAX, f64::min) - bulge
        };
        self.ends.windows(2).zip(columns.chunks(2)).map(of).collect()
    }

    /// Splits the cells with less room than `gap`. Returns false if there is none that can be split.
    pub(super) fn split(&mut self, room: &[f64], gap: f64, parts: usize) -> bool {
        let mut ends = vec![self.ends[0]];
        let mut least = Vec::new();
        let mut any = false;
        for (cell, room) in room.iter().enumerate() {
            let [from, to] = [self.ends[cell], self.ends[cell + 1]];
            let middle = f64::midpoint(from, to);
            if *room <= gap && from < middle && middle < to {
                any = true;
                for part in 1..=parts {
                    let end = if part == parts { to } else { from + (to - from) * part as f64 / parts as f64 };
                    let begin = *ends.last().unwrap_or(&from);
                    least.push(self.bound([begin, end]));
                    ends.push(end);
                }
            } else {
                ends.push(to);
                least.push(self.least[cell]);
            }
        }
        (self.ends, self.least) = (ends, least);
        any
    }
}
