//! The model's answer at some tolerances, held against what is required.

use super::constraint::Constraint;
use super::cost::Priced;
use super::response::Responses;
use super::result::{Kept, ShadowPrice};
use super::solve::Solved;
use crate::analysis::Analysis;
use crate::problem::Problem;
use crate::requirement::Requirement;

/// A constraint that is so near its bound is at it.
const BINDING: f64 = 1e-6;

/// Tolerances with their derivatives.
pub(super) struct Station {
    pub(super) problem: Problem,
    pub(super) analysis: Analysis,
    pub(super) responses: Responses,
}

impl Station {
    /// Whether everything of which something is required has moments.
    pub(super) fn answers(&self, constraints: &[Constraint]) -> bool {
        constraints.iter().all(|one| self.analysis.characteristics[one.characteristic].moments.is_some())
    }
}

/// Every requirement, with nothing known of it after.
pub(super) fn required(requirements: &[Option<Requirement>], station: &Station) -> Vec<Kept> {
    let of = |(characteristic, one): (usize, &Option<Requirement>)| {
        let requirement = (*one)?;
        let before = station.analysis.characteristics[characteristic].judge(requirement);
        Some(Kept { characteristic, requirement, before, after: None })
    };
    requirements.iter().enumerate().filter_map(of).collect()
}

/// What every limit costs.
pub(super) fn prices(
    station: &Station,
    priced: &[Priced],
    constraints: &[Constraint],
    solved: &Solved,
) -> Vec<ShadowPrice> {
    let mut prices: Vec<ShadowPrice> = Vec::new();
    for (constraint, &multiplier) in constraints.iter().zip(&solved.multipliers).filter(|(_, m)| **m > 0.0) {
        let c = constraint.characteristic;
        let Some([lower, upper, sigma]) = constraint.prices(&station.responses, priced, &solved.at, multiplier) else {
            continue;
        };
        let both = [lower, upper].into_iter().flatten().reduce(|a, b| a + b);
        let same = |other: &&Constraint| other.characteristic == c && *other != constraint;
        // The other side holds the cost up too, whichever of them the multipliers name.
        let other = constraints.iter().find(same);
        let binds = |other: &Constraint| other.value(&station.responses, priced, &solved.at) >= 1.0 - BINDING;
        let [lower, upper] = if other.is_some_and(binds) { [None, None] } else { [lower, upper] };
        match prices.iter_mut().find(|price| price.characteristic == c) {
            Some(price) => price.both = [price.both, both].into_iter().flatten().reduce(|a, b| a + b),
            None => prices.push(ShadowPrice { characteristic: c, both, lower, upper, sigma }),
        }
    }
    prices
}
