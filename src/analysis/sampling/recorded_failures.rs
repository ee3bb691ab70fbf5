//! Failed points of earlier runs, which the journal of an external model holds.

use crate::analysis::CharacteristicAnalysis;
use crate::assembly::RecordedFailure;
use crate::problem::Problem;
use crate::warning::Warning;

/// Adds the recorded failures within all tolerance bands to the points without a value of each characteristic, and returns a warning for
/// each that has some. Points that this run evaluated itself are counted already. Call it after the last evaluation.
pub(in crate::analysis) fn add(problem: &Problem, characteristics: &mut [CharacteristicAnalysis]) -> Vec<Warning> {
    let mut recorded = problem.function().recorded_failures(problem.outputs());
    recorded.retain(|failure| failure.is_within(problem.dimensions()));
    let mut warnings = Vec::new();
    for (one, &output) in characteristics.iter_mut().zip(problem.outputs()) {
        let own: Vec<&RecordedFailure> = recorded.iter().filter(|failure| failure.output == output).collect();
        let Some(first) = own.first() else { continue };
        one.missing.without_value += own.len();
        warnings.push(Warning::RecordedFailures {
            characteristic: one.characteristic.name().to_owned(),
            failed: own.len(),
            point: described(problem, first),
        });
    }
    warnings
}

/// Description of a point in words: the dimensions that are not at their nominal values.
fn described(problem: &Problem, failure: &RecordedFailure) -> String {
    let at = problem.dimensions().iter().zip(&failure.point).filter_map(|(dimension, x)| {
        x.filter(|&x| x != dimension.nominal()).map(|x| format!("{} = {x}", dimension.name()))
    });
    let words: Vec<String> = at.collect();
    if words.is_empty() { "the nominal dimensions".to_owned() } else { words.join(", ") }
}
