//! List of the interactions of a characteristic.

use crate::analysis::result::interaction::{InteractionList, Missing, Row};
use crate::analysis::result::variance_share::Shares;
use crate::method::Outcome;
use crate::plan::Point;
use crate::problem::Problem;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::power::Wide;
use sensitol_numeric::surrogate::DerivativeOrigin;

/// Pairs on which a characteristic can depend, by their index among all listed pairs: those examined, and those whose interaction was
/// estimated. Pairs that were listed for another characteristic only are left out.
pub(in crate::analysis) fn pairs_of(outcome: &Outcome, c: usize) -> impl Iterator<Item = usize> + '_ {
    let mixed = &outcome.fitted[c].mixed;
    (0..mixed.len().min(outcome.pairs.len())).filter(move |&index| {
        let (j, k) = outcome.pairs[index];
        let assumed = mixed[index].is_some_and(|mixed| mixed.value == 0.0 && !mixed.origin.is_known());
        outcome.plan.joint(c, j, k) && !assumed
    })
}

/// Source of the part of a pair in the surface, or in the variance if there is no surface. Returns None if it has no part.
pub(in crate::analysis) fn origin_of(outcome: &Outcome, c: usize, index: usize) -> Option<DerivativeOrigin> {
    let fitted = &outcome.fitted[c];
    match &fitted.integrated {
        Some(integrated) => integrated.pairs.get(index)?.map(|_| DerivativeOrigin::Evaluated),
        None => fitted.mixed[index].map(|mixed| mixed.origin),
    }
}

pub(in crate::analysis) fn share_of(outcome: &Outcome, c: usize, index: usize, shares: Option<&Shares>) -> Option<f64> {
    shares?.pair(index, outcome.pairs[index], outcome.fitted[c].mixed[index].map(|mixed| mixed.value))
}

/// Mixed derivative of a pair of dimensions at the means: exact if it is known, else a difference.
pub(in crate::analysis) fn mixed_of(outcome: &Outcome, c: usize, index: usize) -> Option<Wide> {
    let (fitted, pair) = (&outcome.fitted[c], dimensions_of(outcome, index));
    let exact = fitted.exact.as_ref().and_then(|exact| exact.interaction(index, pair));
    let [j, k] = pair.map(|d| outcome.plan.axis(d).scale);
    exact.or_else(|| fitted.mixed[index].map(|mixed| Wide::of(mixed.value).over(j).over(k)))
}

pub(in crate::analysis) fn dimensions_of(outcome: &Outcome, index: usize) -> [usize; 2] {
    let (j, k) = outcome.pairs[index];
    [j, k].map(|position| outcome.plan.varying()[position])
}

/// Lists the pairs on which the characteristic can depend, strongest first. With a thousand dimensions the list takes as much memory as its
/// sources, so it is made last.
pub(in crate::analysis) fn listed(
    problem: &Problem,
    outcome: &Outcome,
    c: usize,
    shares: Option<&Shares>,
) -> InteractionList {
    let plan = &outcome.plan;
    let fitted = &outcome.fitted[c];
    let share = |index: usize| share_of(outcome, c, index, shares);
    // Sorting indices moves less memory than sorting whole rows.
    let mut order: Vec<u32> = pairs_of(outcome, c).map(|index| index as u32).collect();
    let mut strengths = vec![-1.0; outcome.pairs.len()];
    order.iter().for_each(|&index| strengths[index as usize] = share(index as usize).unwrap_or(-1.0));
    order.sort_by(|&a, &b| strengths[b as usize].total_cmp(&strengths[a as usize]));
    drop(strengths);
    let names = problem.dimensions().iter().map(|dimension| dimension.name().to_owned()).collect();
    let row = |&index: &u32| {
        let index = index as usize;
        let mixed = fitted.mixed[index];
        let [j, k] = dimensions_of(outcome, index);
        let together = problem.correlation().map_or(0.0, |correlation| correlation.of(j, k));
        let exact = fitted.exact.as_ref().and_then(|exact| exact.mixed[index]);
        let coefficient = mixed.map(|mixed| mixed.value);
        let mean_shift = match shares {
            Some(shares) => shares.pair_shift(index, coefficient, together),
            None => coefficient.map(|value| value * together),
        };
        let step = |d: usize| if exact.is_some() { plan.axis(d).scale } else { 0.5 * plan.axis(d).nearest_step() };
        let missing = (exact.is_none() && mixed.is_none()).then(|| missing(outcome, c, &[j, k]));
        // Mixed derivatives by dimensions of extreme size fit a double only in the characteristic's own unit.
        let in_unit = |mixed: Wide| mixed.times_power(problem.power(c)).checked();
        let rounding =
            fitted.centre.and_then(|centre| in_unit(Wide::of(f64::EPSILON * centre.abs()).over(step(j)).over(step(k))));
        let known = |value: Option<f64>| value.unwrap_or(f64::NAN);
        Row {
            dimensions: [j, k].map(|d| d as u32),
            mixed: known(mixed_of(outcome, c, index).and_then(in_unit)),
            missing,
            exact: exact.is_some(),
            origin: origin_of(outcome, c, index),
            rounding: known(rounding),
            share: known(share(index)),
            mean_shift: known(mean_shift),
        }
    };
    InteractionList::of(names, order.par_iter().map(row).collect())
}

/// Reason why a derivative by these dimensions is missing. It was not evaluated if the run was stopped before any of its points failed.
pub(in crate::analysis) fn missing(outcome: &Outcome, c: usize, dimensions: &[usize]) -> Missing {
    let within = |point: &Point| point.at().iter().all(|at| dimensions.contains(&(at.dimension as usize)));
    let failed = || outcome.evaluated.known.errors().any(|(point, of, _)| of == c && within(point));
    if outcome.evaluated.stopped().is_some() && !failed() { Missing::NotEvaluated } else { Missing::Failed }
}
