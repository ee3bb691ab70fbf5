//! Yields of the assemblies that keep the limits of another characteristic.
//!
//! ```text
//! P(own kept | other kept) = P(both kept) / P(other kept)
//! ```
//!
//! If few assemblies keep the other limits, the difference of the yields is smaller than its error. Both are counted at points of a cheap
//! model then, and the yield stays None for a costly one. It is the own yield if both characteristics depend on different independent
//! inputs.

use crate::analysis::CharacteristicAnalysis;
use crate::analysis::distribution::yield_selection::joint_of;
use crate::analysis::sampling::sample_budget::SampleBudget;
use crate::estimate::{ConditionalYield, Verified, conditions, counted_condition, most_points_given};
use crate::method::Options;
use crate::problem::Problem;
use sensitol_numeric::law::SurfaceLaw;
use sensitol_numeric::verdict;

/// Greatest error of a joint yield, as a part of the share of assemblies that count. Two of them reach from 0 to 1.
const MOST_ERROR: f64 = 0.5;
/// Error of a conditional yield above which points of a cheap model are counted too.
const ROUGH: f64 = 1e-2;
/// Error of a conditional yield, as a part of the yield itself, above which points of a cheap model are counted too.
const ROUGH_SHARE: f64 = 0.5;

/// Conditional yields of the characteristics that are given another, by their places. None if the yields or their errors are unknown.
pub(in crate::analysis) fn conditional_yields(
    problem: &Problem,
    options: &Options,
    left: &mut SampleBudget,
    characteristics: &[CharacteristicAnalysis],
    laws: &[Option<SurfaceLaw>],
) -> Vec<(usize, Option<ConditionalYield>)> {
    let mut found = Vec::new();
    for [c, given] in conditions(problem) {
        found.push((c, of_pair(problem, options, left, characteristics, laws, [c, given])));
    }
    found
}

fn of_pair(
    problem: &Problem,
    options: &Options,
    left: &mut SampleBudget,
    characteristics: &[CharacteristicAnalysis],
    laws: &[Option<SurfaceLaw>],
    [c, given]: [usize; 2],
) -> Option<ConditionalYield> {
    let rejected = |c: usize| characteristics[c].distribution.capability.and_then(|of| of.rejected());
    let [own, other] = [rejected(c)?, rejected(given)?];
    let measured =
        |c: usize, rejected: f64| (rejected, characteristics[c].evidence.sampling.as_ref().map(|of| of.rejected));
    let name = characteristics[given].characteristic.name();
    if are_independent(problem, [c, given]) {
        let interval = characteristics[c].yield_interval()?;
        return Some(ConditionalYield { given: name.to_owned(), value: 1.0 - own, interval: Some(interval) });
    }
    let by_yields = by_yields(problem, options, left, characteristics, laws, [c, given], 1.0 - other);
    let rough = by_yields.is_none_or(|of| of.error > ROUGH || of.error > ROUGH_SHARE * of.value);
    let free = options.budget.is_none() && !problem.function().signature().costly;
    let seed = options.seed.unwrap_or(Options::SEED);
    let by_points = match rough && free && left.take(most_points_given()) {
        true => counted_condition(problem, [c, given], seed),
        false => None,
    };
    let by_yields =
        by_yields.and_then(|of| Some((of.value, verdict::share(verdict::about(of.value, Some(of.error))?))));
    let width = |(_, [low, high]): &(f64, [f64; 2])| high - low;
    let found = by_points.into_iter().chain(by_yields).min_by(|a, b| width(a).total_cmp(&width(b)));
    let (value, interval) = found?;
    Some(ConditionalYield::new(name, value, interval, [measured(c, own), measured(given, other)]))
}

/// Conditional yield by the joint yield of both characteristics. Returns None if its error is as large as the share `kept` of assemblies
/// that count, because the difference of the yields says nothing about them then.
fn by_yields(
    problem: &Problem,
    options: &Options,
    left: &mut SampleBudget,
    characteristics: &[CharacteristicAnalysis],
    laws: &[Option<SurfaceLaw>],
    [c, given]: [usize; 2],
    kept: f64,
) -> Option<Verified> {
    let both = joint_of(problem, options, left, characteristics, laws, &[c, given])?;
    let of_other = characteristics[given].error_estimate.as_ref().and_then(|of| of.yield_).unwrap_or(0.0);
    if kept <= 0.0 || libm::hypot(both.error, of_other) >= MOST_ERROR * kept {
        return None;
    }
    let value = (both.value / kept).clamp(0.0, 1.0);
    Some(Verified { value, error: libm::hypot(both.error, value * of_other) / kept })
}

/// True if two characteristics depend on different dimensions that vary independently.
fn are_independent(problem: &Problem, pair: [usize; 2]) -> bool {
    let dependence = problem.dependence();
    let varies = |d: usize| problem.dimensions()[d].sigma() > 0.0;
    let [own, other] = pair.map(|c| &dependence[c]);
    let together = |d: usize| problem.correlation().is_some_and(|of| of.members().contains(&d));
    (0..own.len()).filter(|&d| varies(d)).all(|d| !(own[d] && other[d]) && !((own[d] || other[d]) && together(d)))
}
