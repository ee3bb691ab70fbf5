//! The model's answer at some tolerances, held against what is required.

use super::constraint::{Constraint, kept};
use super::cost::Priced;
use super::requirement::Requirement;
use super::response::Responses;
use super::result::{Kept, ShadowPrice};
use super::solve::Solved;
use crate::analysis::Analysis;
use crate::problem::Problem;

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

/// What there is of a requirement, in its own measure.
pub(super) fn measure(station: &Station, characteristic: usize, requirement: Requirement) -> Option<f64> {
    let analysis = &station.analysis.characteristics[characteristic];
    let limits = analysis.characteristic.limits();
    let ones = vec![1.0; station.problem.dimensions().len()];
    match requirement {
        Requirement::Yield(_) => analysis.capability?.yield_(),
        Requirement::Cpk(_) => analysis.capability?.cpk,
        Requirement::Sigma(_) => Some(analysis.moments?.sigma()),
        Requirement::Rss => {
            let mean = analysis.moments?.mean();
            let rss = station.responses.rss_squared(characteristic, &[], &ones)?.0.sqrt();
            let below = limits.lower().map(|lower| rss / (mean - lower));
            let above = limits.upper().map(|upper| rss / (upper - mean));
            below.into_iter().chain(above).reduce(f64::max)
        }
        Requirement::WorstCase => {
            let ([low, high], nominal) = (analysis.worst_case?, analysis.nominal?);
            let below = limits.lower().map(|lower| (nominal - low) / (nominal - lower));
            let above = limits.upper().map(|upper| (high - nominal) / (upper - nominal));
            below.into_iter().chain(above).reduce(f64::max)
        }
    }
}

/// Every requirement, with nothing known of it after.
pub(super) fn required(requirements: &[Option<Requirement>], station: &Station) -> Vec<Kept> {
    let of = |(characteristic, one): (usize, &Option<Requirement>)| {
        let requirement = (*one)?;
        let (before, met_before) = judged(station, characteristic, requirement);
        Some(Kept { characteristic, requirement, before, after: None, met_before, met_after: false })
    };
    requirements.iter().enumerate().filter_map(of).collect()
}

/// What there is of a requirement, and whether that is enough.
pub(super) fn judged(station: &Station, characteristic: usize, requirement: Requirement) -> (Option<f64>, bool) {
    let limits = station.problem.characteristics()[characteristic].limits();
    let ones = vec![1.0; station.problem.dimensions().len()];
    let constraints = Constraint::of(characteristic, requirement, limits);
    let met = constraints.iter().all(|constraint| kept(constraint.value_at(&station.responses, &ones)));
    (measure(station, characteristic, requirement), met)
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
