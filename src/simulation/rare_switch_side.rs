//! Assemblies beyond switches that are seldom met, and their effect on standard errors.
//!
//! A jump that one assembly in a million meets is in no sample of 100 000 points, and the sample gives no hint of it. A surrogate agrees
//! with every point too. A formula reports its switches. Some points beyond those that are seldom met show the contribution of that side to
//! the sums that give standard errors. A moment has not settled if one side adds more to its sum than all the points of the sample do.

use crate::assembly::Run;
use crate::estimate::{RareSides, seldom_sides};
use crate::problem::Problem;
use crate::simulation::control_variate::{Control, Twin};
use crate::simulation::surface_difference::squares;
use crate::warning::Warning;

/// Switches of one characteristic, with points of the seldom sides.
pub(super) struct RareSwitchSides {
    sides: RareSides,
    /// Rises of the surrogate at these points. Empty if there is none.
    rises: Vec<f64>,
}

impl RareSwitchSides {
    /// Searches for the switches of a characteristic with this sigma. Returns None if it reports no switch.
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

    /// Number of evaluations of the search.
    pub(super) fn evaluations(&self) -> u64 {
        self.sides.values.len() as u64
    }

    /// Contributions of the sides to the means of the 2nd, 4th, 6th and 8th powers of deviations, in units of sigma.
    pub(super) fn powers(&self, mean: f64, sigma: f64) -> [f64; 4] {
        let of = |order: i32| self.sum(|_, value| ((value - mean) / sigma).powi(order));
        [of(2), of(4), of(6), of(8)]
    }

    /// Contributions of the sides to the mean squares of the differences to a surrogate.
    pub(super) fn differences(&self, twin: &Twin) -> [f64; 4] {
        let of =
            |k: usize| self.sum(|row, value| self.rises.get(row).map_or(0.0, |&rise| squares(value, rise, twin)[k]));
        [of(0), of(1), of(2), of(3)]
    }

    fn sum(&self, of: impl Fn(usize, f64) -> f64) -> f64 {
        let points = self.sides.values.iter().zip(&self.sides.weights).enumerate();
        points.filter(|(_, (value, _))| value.is_finite()).map(|(row, (&value, weight))| weight * of(row, value)).sum()
    }

    /// Name of the switch that the fewest assemblies meet.
    pub(super) fn rarest(&self) -> Option<String> {
        let rarest = self.sides.switches.iter().min_by(|a, b| a.probability.total_cmp(&b.probability));
        rarest.map(|found| found.name.clone())
    }

    /// Warnings of the switches, for a sample with this number of points.
    pub(super) fn warnings(&self, characteristic: &str, points: u64) -> impl Iterator<Item = Warning> {
        self.sides.switches.iter().filter_map(move |found| found.warning(characteristic, Some(points)))
    }
}
