//! The interactions of a characteristic, two dimensions each, and how they are listed.

use std::sync::Arc;

use serde::{Serialize, Serializer};

use super::shares::Shares;
use crate::method::Outcome;
use crate::parallel::prelude::*;
use crate::plan::Point;
use crate::problem::Problem;

/// The joint effect of two dimensions.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Interaction {
    /// The two dimensions.
    // Their names are shared: N of them may have N (N - 1)/2 pairs.
    #[serde(serialize_with = "names")]
    #[cfg_attr(feature = "cli", schemars(with = "[String; 2]"))]
    pub dimensions: [Arc<str>; 2],
    /// Mixed second derivative at the means; None where it is missing.
    pub mixed: Option<f64>,
    /// Why it is missing; None where it is not.
    pub missing: Option<Missing>,
    /// Whether it is exact rather than a difference.
    pub exact: bool,
    /// The largest effect of rounding errors of the characteristic's own size on it.
    pub rounding: Option<f64>,
    /// Share of the variance.
    pub share: Option<f64>,
    /// How far it moves the mean: not at all unless the two are correlated.
    pub mean_shift: Option<f64>,
}

fn names<S: Serializer>(names: &[Arc<str>; 2], serializer: S) -> Result<S::Ok, S::Error> {
    names.each_ref().map(|name| &**name).serialize(serializer)
}

/// Why a derivative is missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Missing {
    /// A point that it takes has no value.
    Failed,
    /// A point that it takes was not evaluated before the run was stopped.
    NotEvaluated,
}

/// The pairs on which a characteristic can depend, by their places among all that were examined.
pub(super) fn pairs_of(outcome: &Outcome, c: usize) -> impl Iterator<Item = usize> + '_ {
    (0..outcome.fitted[c].mixed.len().min(outcome.pairs.len())).filter(move |&index| {
        let (j, k) = outcome.pairs[index];
        outcome.plan.joint(c, j, k)
    })
}

pub(super) fn share_of(outcome: &Outcome, c: usize, index: usize, shares: Option<&Shares>) -> Option<f64> {
    shares?.pair(index, outcome.pairs[index], outcome.fitted[c].mixed[index].map(|mixed| mixed.value))
}

/// The mixed derivative of a pair of dimensions at the means: exact where that is known, a difference elsewhere.
pub(super) fn mixed_of(outcome: &Outcome, c: usize, index: usize) -> Option<f64> {
    let fitted = &outcome.fitted[c];
    let exact = fitted.exact.as_ref().and_then(|exact| exact.mixed[index]);
    let [j, k] = dimensions_of(outcome, index).map(|d| outcome.plan.axis(d).scale);
    exact.or_else(|| fitted.mixed[index].map(|mixed| mixed.value / j / k))
}

pub(super) fn dimensions_of(outcome: &Outcome, index: usize) -> [usize; 2] {
    let (j, k) = outcome.pairs[index];
    [j, k].map(|position| outcome.plan.varying()[position])
}

/// Whether every mixed derivative that a characteristic can have is known.
pub(super) fn knows_all_pairs(outcome: &Outcome, c: usize) -> bool {
    let pairs = || pairs_of(outcome, c);
    pairs().count() == outcome.plan.pairs_of(c) && pairs().all(|index| mixed_of(outcome, c, index).is_some())
}

/// Of the pairs on which the characteristic can depend, strongest first. Of a thousand dimensions the list takes more memory than all it follows
/// from, so that it is made last.
pub(super) fn listed(problem: &Problem, outcome: &Outcome, c: usize, shares: Option<&Shares>) -> Vec<Interaction> {
    let plan = &outcome.plan;
    let fitted = &outcome.fitted[c];
    let share = |index: usize| share_of(outcome, c, index, shares);
    // Places are sorted rather than rows of several words and two names.
    let mut order: Vec<(u32, f64)> =
        pairs_of(outcome, c).map(|index| (index as u32, share(index).unwrap_or(-1.0))).collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let names: Vec<Arc<str>> = problem.dimensions().iter().map(|dimension| dimension.name().into()).collect();
    let interaction = |index: usize| {
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
        Interaction {
            dimensions: [j, k].map(|d| Arc::clone(&names[d])),
            missing,
            mixed: mixed_of(outcome, c, index),
            exact: exact.is_some(),
            rounding: fitted.centre.map(|centre| f64::EPSILON * centre.abs() / step(j) / step(k)),
            share: share(index),
            mean_shift,
        }
    };
    order.par_iter().map(|&(index, _)| interaction(index as usize)).collect()
}

/// Why a derivative by these dimensions is missing: what was stopped before any of its points failed was not evaluated.
pub(super) fn missing(outcome: &Outcome, c: usize, dimensions: &[usize]) -> Missing {
    let within = |point: &Point| point.at().iter().all(|at| dimensions.contains(&(at.dimension as usize)));
    let failed = || outcome.evaluated.known.errors().any(|(point, of, _)| of == c && within(point));
    if outcome.evaluated.stopped.is_some() && !failed() { Missing::NotEvaluated } else { Missing::Failed }
}
