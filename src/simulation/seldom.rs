//! Assemblies beyond switches that are seldom met, and what a sample lacks without them.
//!
//! A jump that one assembly in a million meets is in no sample of 100 000 points, and nothing in the sample tells of it; a surrogate
//! beside it agrees with every point. A formula tells its switches. Some points beyond those that are seldom met show what that side
//! adds to the sums on which standard errors rest. A moment has not settled where one side adds more to its sum than all the
//! points of the sample do.

use super::control::{Control, Twin};
use super::difference::squares;
use crate::assembly::Run;
use crate::problem::Problem;
use crate::verification::{SeldomSides, seldom_sides};
use crate::warning::Warning;

/// The switches of one characteristic, with the sums of the seldom sides.
pub(super) struct Seldom {
    sides: SeldomSides,
    /// The surrogate at these points; empty without one.
    rises: Vec<f64>,
}

impl Seldom {
    /// Of a characteristic with this sigma; None where it tells no switch.
    pub(super) fn of(
        problem: &Problem,
        c: usize,
        control: Option<&Control<'_>>,
        (seed, sigma): (u64, f64),
        run: &Run<'_>,
    ) -> Option<Self> {
        let sides = seldom_sides(problem, c, (seed, sigma), run)?;
        let rises = control.map(|control| control.rises(&sides.points).swap_remove(c)).unwrap_or_default();
        Some(Self { sides, rises })
    }

    /// Evaluations that it took.
    pub(super) fn evaluations(&self) -> u64 {
        self.sides.values.len() as u64
    }

    /// The parts that the sides add to the means of the 2nd, 4th, 6th and 8th powers of deviations, in units of sigma.
    pub(super) fn powers(&self, mean: f64, sigma: f64) -> [f64; 4] {
        let of = |order: i32| self.sum(|_, value| ((value - mean) / sigma).powi(order));
        [of(2), of(4), of(6), of(8)]
    }

    /// The parts that they add to the mean squares of the differences to a surrogate.
    pub(super) fn differences(&self, twin: &Twin) -> [f64; 4] {
        let of =
            |k: usize| self.sum(|row, value| self.rises.get(row).map_or(0.0, |&rise| squares(value, rise, twin)[k]));
        [of(0), of(1), of(2), of(3)]
    }

    fn sum(&self, of: impl Fn(usize, f64) -> f64) -> f64 {
        let points = self.sides.values.iter().zip(&self.sides.weights).enumerate();
        points.filter(|(_, (value, _))| value.is_finite()).map(|(row, (&value, weight))| weight * of(row, value)).sum()
    }

    /// The name of the switch that fewest assemblies meet.
    pub(super) fn rarest(&self) -> Option<String> {
        let rarest = self.sides.switches.iter().min_by(|a, b| a.probability.total_cmp(&b.probability));
        rarest.map(|found| found.name.clone())
    }

    /// The warnings that tell of the switches, beside a sample of so many points.
    pub(super) fn warnings(&self, characteristic: &str, points: u64) -> impl Iterator<Item = Warning> {
        self.sides.switches.iter().filter_map(move |found| found.warning(characteristic, Some(points)))
    }
}
