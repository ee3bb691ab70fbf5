//! Failed points of earlier runs, which the journal of an external model holds.

use crate::assembly::RecordedFailure;
use crate::problem::Problem;
use crate::warning::Warning;

/// Number of recorded failures of a characteristic, and a warning of them.
pub(in crate::analysis) struct RecordedFailures {
    pub(in crate::analysis) failed: usize,
    pub(in crate::analysis) warning: Warning,
}

/// Recorded failures within all tolerance bands, by the places of the characteristics that have some. Points that this run evaluated itself
/// are counted already. Call it after the last evaluation.
pub(in crate::analysis) fn recorded_failures(problem: &Problem) -> Vec<(usize, RecordedFailures)> {
    let mut recorded = problem.function().recorded_failures(problem.outputs());
    recorded.retain(|failure| failure.is_within(problem.dimensions()));
    let mut found = Vec::new();
    for (c, (one, &output)) in problem.characteristics().iter().zip(problem.outputs()).enumerate() {
        let own: Vec<&RecordedFailure> = recorded.iter().filter(|failure| failure.output == output).collect();
        let Some(first) = own.first() else { continue };
        let warning = Warning::RecordedFailures {
            characteristic: one.name().to_owned(),
            failed: own.len(),
            point: described(problem, first),
        };
        found.push((c, RecordedFailures { failed: own.len(), warning }));
    }
    found
}

/// Description of a point in words: the dimensions that are not at their nominal values.
fn described(problem: &Problem, failure: &RecordedFailure) -> String {
    let at = problem.dimensions().iter().zip(&failure.point).filter_map(|(dimension, x)| {
        x.filter(|&x| x != dimension.nominal()).map(|x| format!("{} = {x}", dimension.name()))
    });
    let words: Vec<String> = at.collect();
    if words.is_empty() { "the nominal dimensions".to_owned() } else { words.join(", ") }
}
