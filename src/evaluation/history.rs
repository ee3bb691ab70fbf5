//! External models that do not answer as they did, or not at first.

use crate::assembly::NonRepeatable;
use crate::assembly::OutdatedJournal;
use crate::problem::Problem;
use crate::warning::Warning;

/// A change of the nominal value by more than this part of what a characteristic varies by is another solution of the model.
const FLIP: f64 = 0.01;
/// Points in doubt that are named.
const SUSPECTS: usize = 3;

/// One warning for each output, and what the model's processes went through.
pub fn history(problem: &Problem, non_repeatable: &[NonRepeatable]) -> Vec<Warning> {
    let first =
        |index: &usize| !non_repeatable[..*index].iter().any(|earlier| earlier.output == non_repeatable[*index].output);
    let warning = |index: usize| {
        let doubt = &non_repeatable[index];
        let same = || non_repeatable.iter().filter(|other| other.output == doubt.output);
        let far = |a: f64, b: f64| (a - b).abs() > FLIP * doubt.spread;
        let (output, expected, found) = (doubt.output.clone(), doubt.expected, doubt.found);
        let (times, points) = (same().count(), same().map(|doubt| doubt.suspects.len()).sum());
        let suspects = same().flat_map(|doubt| &doubt.suspects).take(SUSPECTS);
        let suspects = suspects.map(|point| words(problem, point)).collect();
        match expected.zip(found).is_some_and(|(a, b)| far(a, b)) {
            true => Warning::BranchFlip { output, expected, found, times, points, suspects },
            false => Warning::NotRepeatable { output, expected, found, times, points, suspects },
        }
    };
    (0..non_repeatable.len()).filter(first).map(warning).chain(processes(problem)).collect()
}

/// A point by the dimensions that are not at their nominal value.
fn words(problem: &Problem, point: &[f64]) -> String {
    let moved = problem.dimensions().iter().zip(point).filter(|(dimension, x)| dimension.nominal() != **x);
    moved.map(|(dimension, x)| format!("{} = {x}", dimension.name())).collect::<Vec<_>>().join(", ")
}

/// The events of a model's processes: what was lost and sent again, answers that nothing confirmed, a journal of another model.
fn processes(problem: &Problem) -> Vec<Warning> {
    let Some(account) = problem.function().account() else { return Vec::new() };
    let mut warnings = Vec::new();
    if account.has_failures() {
        let last = account.last.as_ref();
        warnings.push(Warning::Restarts {
            starts: account.counts.starts,
            crashes: account.counts.crashes,
            timeouts: account.counts.timeouts,
            garbage: account.counts.garbage,
            retried: account.counts.retried,
            lost_s: account.counts.lost_s,
            cause: last.map(|error| error.fault.to_string()).unwrap_or_default(),
            stderr: last.map(|error| error.stderr.0.clone()).unwrap_or_default(),
        });
    }
    if let Some(OutdatedJournal { output, expected, found, answers, .. }) = account.outdated {
        warnings.push(Warning::OutdatedJournal { output, expected, found, answers });
    }
    if account.counts.unconfirmed > 0 {
        warnings.push(Warning::Unconfirmed { answers: account.counts.unconfirmed });
    }
    warnings
}
