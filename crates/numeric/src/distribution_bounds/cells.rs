//! Cells of the band, each with a bound of the share within the limits that holds at all of its points.

use crate::distribution_bounds::simplex::{Column, Solution};
use crate::distribution_bounds::{ConditionalYield, DistributionPromise};

/// Values of a uniform distribution at which its mean share is bounded.
const SLICES: u32 = 256;

/// Cells in order, with a bound each.
pub(super) struct Cells<'c> {
    promise: &'c DistributionPromise,
    within: &'c dyn ConditionalYield,
    sign: f64,
    /// Ends of the cells, ascending.
    ends: Vec<f64>,
    /// Least value over each cell.
    least: Vec<f64>,
}

impl<'c> Cells<'c> {
    /// Divides the range into equal cells.
    pub(super) fn new(
        promise: &'c DistributionPromise,
        within: &'c dyn ConditionalYield,
        sign: f64,
        count: usize,
    ) -> Self {
        let [low, high] = promise.range();
        let mut ends: Vec<f64> = (0..=count).map(|end| low + (high - low) * end as f64 / count as f64).collect();
        // A distribution at the promised mean alone keeps every promise, so its place is an end.
        if !promise.is_symmetric() {
            ends.extend(promise.means());
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

    /// Greatest excess of a dual function of this curvature over its greater value at the ends of a cell.
    pub(super) fn bulge(&self, curvature: f64) -> f64 {
        let widest = self.ends.windows(2).map(|ends| ends[1] - ends[0]).fold(0.0, f64::max);
        // A parabola rises above the greater end by at most its curvature times a quarter of the squared width.
        curvature.max(0.0) * 0.25 * widest * widest
    }

    /// Splits the cells whose reduced cost is below `gap`. Returns false if none is.
    pub(super) fn split(&mut self, columns: &[Column], solution: &Solution, gap: f64, parts: usize) -> bool {
        let mut ends = vec![self.ends[0]];
        let mut least = Vec::new();
        let mut any = false;
        for (cell, pair) in columns.chunks(2).enumerate() {
            let [from, to] = [self.ends[cell], self.ends[cell + 1]];
            let matters = pair.iter().any(|column| solution.reduced_cost(column) <= gap);
            let middle = f64::midpoint(from, to);
            if matters && from < middle && middle < to {
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
