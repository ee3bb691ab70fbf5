//! Yields of the assemblies that keep the limits of another characteristic.
//!
//! ```text
//! P(own kept | other kept) = P(both kept) / P(other kept)
//! ```
//!
//! It is the own yield if both characteristics depend on different independent inputs.

use crate::analysis::CharacteristicAnalysis;
use crate::analysis::distribution::yield_selection::joint_of;
use crate::analysis::sampling::sample_budget::SampleBudget;
use crate::estimate::{ConditionalYield, Verified, conditions};
use crate::method::Options;
use crate::problem::Problem;
use sensitol_numeric::law::SurfaceLaw;
use sensitol_numeric::verdict;

/// Sets the conditional yield of every characteristic that is given another. It stays None if the yields or their errors are unknown.
pub(in crate::analysis) fn condition(
    problem: &Problem,
    options: &Options,
    left: &mut SampleBudget,
    characteristics: &mut [CharacteristicAnalysis],
    laws: &[Option<SurfaceLaw>],
) {
    for [c, given] in conditions(problem) {
        let found = of_pair(problem, options, left, characteristics, laws, [c, given]);
        characteristics[c].distribution.conditional = found;
    }
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
    let both = joint_of(problem, options, left, characteristics, laws, &[c, given])?;
    let kept = 1.0 - other;
    if kept <= 0.0 {
        return None;
    }
    let value = (both.value / kept).clamp(0.0, 1.0);
    let of_other = characteristics[given].error_estimate.as_ref().and_then(|of| of.yield_).unwrap_or(0.0);
    let error = libm::hypot(both.error, value * of_other) / kept;
    let interval = verdict::about(value, Some(Verified { value, error }.error))?;
    Some(ConditionalYield::new(name, value, verdict::share(interval), [measured(c, own), measured(given, other)]))
}

/// True if two characteristics depend on different dimensions that vary independently.
fn are_independent(problem: &Problem, pair: [usize; 2]) -> bool {
    let dependence = problem.dependence();
    let varies = |d: usize| problem.dimensions()[d].sigma() > 0.0;
    let [own, other] = pair.map(|c| &dependence[c]);
    let together = |d: usize| problem.correlation().is_some_and(|of| of.members().contains(&d));
    (0..own.len()).filter(|&d| varies(d)).all(|d| !(own[d] && other[d]) && !((own[d] || other[d]) && together(d)))
}
