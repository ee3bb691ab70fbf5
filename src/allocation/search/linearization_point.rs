//! Linearization point: the analysis at some tolerances, with the derivatives for the next step.

use std::rc::Rc;

use crate::allocation::choice::single_offer::Setting;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::result::allocation::{Kept, ShadowPrice};
use crate::allocation::result::solver_result::{Chosen, Solved};
use crate::allocation::surface::response::Responses;
use crate::analysis::{Analysis, Findings};
use crate::problem::Problem;
use sensitol_numeric::requirement::Requirement;

/// Relative distance from its bound within which a constraint is active.
const BINDING: f64 = 1e-6;

/// Tolerances with their derivatives.
pub(in crate::allocation) struct LinearizationPoint {
    pub(in crate::allocation) problem: Problem,
    /// Analysis with the results that a search reads.
    pub(in crate::allocation) analysis: Analysis,
    pub(in crate::allocation) findings: Findings,
    pub(in crate::allocation) responses: Responses,
}

impl LinearizationPoint {
    /// True if every characteristic with a requirement has moments.
    pub(in crate::allocation) fn answers(&self, constraints: &[Constraint]) -> bool {
        constraints.iter().all(|one| self.analysis.characteristics[one.characteristic].moments.is_some())
    }
}

/// Linearization point that kept everything by its own analysis, with its cost.
pub(in crate::allocation) struct Seen {
    pub(in crate::allocation) station: Rc<LinearizationPoint>,
    pub(in crate::allocation) chosen: Chosen,
    pub(in crate::allocation) cost: f64,
}

/// Every requirement with its value before, and none after.
pub(in crate::allocation) fn required(requirements: &[(usize, Requirement)], before: &Analysis) -> Vec<Kept> {
    let of = |&(characteristic, requirement): &(usize, Requirement)| {
        let before = before.characteristics[characteristic].judge(requirement);
        Kept { characteristic, requirement, before, after: None, sampled: None }
    };
    requirements.iter().map(of).collect()
}

/// Relative move of a limit for its price.
const MOVED: f64 = 1e-4;
/// Part of a slope outside the span of others up to which it depends on them.
const DEPENDENT: f64 = 1e-6;

/// Price of every limit, at tolerances that were found.
pub(in crate::allocation) fn prices(setting: &Setting<'_>, solved: &Solved) -> Vec<ShadowPrice> {
    let (responses, priced) = (setting.responses, setting.priced);
    let mut prices: Vec<ShadowPrice> = Vec::new();
    let binds = |one: &Constraint| one.value(responses, priced, &solved.at) >= 1.0 - BINDING;
    for (constraint, &multiplier) in
        setting.constraints.iter().zip(&solved.multipliers).filter(|(one, m)| **m > 0.0 && !one.is_joint())
    {
        let c = constraint.characteristic;
        let Some([lower, upper, sigma]) = constraint.prices(responses, priced, &solved.at, multiplier) else {
            continue;
        };
        let both = [lower, upper].into_iter().flatten().reduce(|a, b| a + b);
        let same = |other: &&Constraint| other.characteristic == c && *other != constraint;
        // The other side is active too, even if only one of them has a multiplier.
        let other = setting.constraints.iter().find(same);
        let [lower, upper] = if other.is_some_and(binds) { [None, None] } else { [lower, upper] };
        match prices.iter_mut().find(|price| price.characteristic == c) {
            Some(price) => price.both = [price.both, both].into_iter().flatten().reduce(|a, b| a + b),
            None => {
                prices.push(ShadowPrice { characteristic: c, both, widen: None, narrow: None, lower, upper, sigma })
            }
        }
    }
    match alike(setting, solved) {
        Some(characteristics) => characteristics.into_iter().map(|c| on_either_side(setting, solved, c)).collect(),
        None => {
            for price in &mut prices {
                (price.widen, price.narrow) = (price.both.or(price.sigma), price.both.or(price.sigma));
            }
            prices
        }
    }
}

/// Active characteristics, if their slopes depend on each other. Multipliers are then not unique. Returns None
/// otherwise.
fn alike(setting: &Setting<'_>, solved: &Solved) -> Option<Vec<usize>> {
    let binds = |one: &&Constraint| one.value(setting.responses, setting.priced, &solved.at) >= 1.0 - BINDING;
    let binding: Vec<&Constraint> = setting.constraints.iter().filter(|one| !one.is_joint()).filter(binds).collect();
    // A single characteristic has one price. The check saves the slopes, which take longer than values.
    if binding.windows(2).all(|pair| pair[0].characteristic == pair[1].characteristic) {
        return None;
    }
    let mut characteristics: Vec<usize> = Vec::new();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut dependent = false;
    for one in binding {
        if characteristics.contains(&one.characteristic) {
            continue;
        }
        let linearised = one.linearised(setting.responses, setting.priced, &solved.at)?;
        characteristics.push(one.characteristic);
        let is_free = |g: usize| {
            let (t, group) = (solved.at[g], &setting.priced[g]);
            t > group.tightest() * (1.0 + BINDING) && t < group.loosest() * (1.0 - BINDING)
        };
        let mut slopes: Vec<f64> = linearised.slopes;
        slopes.iter_mut().enumerate().filter(|&(g, _)| !is_free(g)).for_each(|(_, slope)| *slope = 0.0);
        let length = |slopes: &[f64]| slopes.iter().map(|slope| slope * slope).sum::<f64>().sqrt();
        let whole = length(&slopes);
        for known in &basis {
            let along: f64 = known.iter().zip(&slopes).map(|(a, b)| a * b).sum();
            slopes.iter_mut().zip(known).for_each(|(slope, known)| *slope -= along * known);
        }
        let left = length(&slopes);
        dependent |= left <= DEPENDENT * whole;
        if left > 0.0 {
            basis.push(slopes.into_iter().map(|slope| slope / left).collect());
        }
    }
    dependent.then_some(characteristics)
}

/// Saving if the limits of one characteristic are widened, and cost if they are narrowed. Each comes from solving again
/// with moved limits, extrapolated from two steps.
fn on_either_side(setting: &Setting<'_>, solved: &Solved, c: usize) -> ShadowPrice {
    let room = setting.constraints.iter().filter(|one| one.characteristic == c).find_map(Constraint::extent);
    let cost = |by: f64| {
        let moved: Vec<Constraint> = (setting.constraints.iter())
            .map(|one| if one.characteristic == c { one.widened(by) } else { Some(*one) })
            .collect::<Option<_>>()?;
        let setting = Setting { constraints: &moved, anywhere: false, ..*setting };
        setting.solve(&solved.at).filter(|found| found.converged).map(|found| found.cost)
    };
    let slope = |sign: f64| {
        let step = MOVED * room?;
        let here = cost(0.0)?;
        let per_unit = |step: f64| Some(sign * (here - cost(sign * step)?) / step);
        let price = 2.0 * per_unit(0.5 * step)? - per_unit(step)?;
        // A difference that is rounding of the same cost is zero.
        Some(if price.abs() * step < DEPENDENT * MOVED * here.abs() { 0.0 } else { price })
    };
    let (widen, narrow) = (slope(1.0), slope(-1.0));
    ShadowPrice { characteristic: c, both: None, widen, narrow, lower: None, upper: None, sigma: None }
}
