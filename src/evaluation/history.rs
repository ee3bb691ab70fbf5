//! Warnings about external models that are not repeatable, or whose processes failed.

use crate::assembly::NonRepeatable;
use crate::assembly::{DamagedJournal, OutdatedJournal};
use crate::problem::Problem;
use crate::warning::Warning;

/// Change of the nominal value, relative to the spread of the characteristic, beyond which it is another solution of the model.
const FLIP: f64 = 0.01;
/// Greatest number of suspect points that a warning names.
const SUSPECTS: usize = 3;

/// Warnings about changed answers, one for each output, and about the model's processes.
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
    (0..non_repeatable.len()).filter(first).map(warning).chain(processes(problem, !non_repeatable.is_empty())).collect()
}

/// Text of a point: the dimensions that are not at their nominal value.
fn words(problem: &Problem, point: &[f64]) -> String {
    let moved = problem.dimensions().iter().zip(point).filter(|(dimension, x)| dimension.nominal() != **x);
    moved.map(|(dimension, x)| format!("{} = {x}", dimension.name())).collect::<Vec<_>>().join(", ")
}

/// Warnings about processes: lost and repeated evaluations, unconfirmed answers, and a journal of another model. `changed` is true if an
/// answer is not repeatable.
fn processes(problem: &Problem, changed: bool) -> Vec<Warning> {
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
    if let Some(DamagedJournal { file, answers, .. }) = account.damaged {
        warnings.push(Warning::DamagedJournal { file: file.display().to_string(), answers });
    }
    if account.counts.unconfirmed > 0 {
        warnings.push(Warning::Unconfirmed { answers: account.counts.unconfirmed, changed });
    }
    warnings
}
