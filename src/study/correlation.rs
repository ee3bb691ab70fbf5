//! From `[[correlation]]` to pairs of dimensions that vary together.

use super::error::{Fault, StudyFault, fault};
use super::file::CorrelationEntry;
use super::spanned::Spanned;
use crate::correlation::{Pair, Refusal};
use crate::problem::Problem;

/// The problem with its dimensions correlated.
pub(super) fn correlated(problem: Problem, entries: &[Spanned<CorrelationEntry>]) -> Result<Problem, Fault> {
    let pair = |entry: &Spanned<CorrelationEntry>| {
        let entry = entry.get_ref();
        let (a, b) = entry.between.get_ref().clone();
        Pair { between: [a, b], value: *entry.value.get_ref() }
    };
    let pairs: Vec<Pair> = entries.iter().map(pair).collect();
    problem.correlated(&pairs).map_err(|error| {
        let Some(index) = error.pair else {
            // All pairs together: the first of them has to stand for the whole.
            return fault(entries[0].span(), "correlation", StudyFault::Correlation(error.refusal));
        };
        let entry = entries[index].get_ref();
        let (span, key) = match &error.refusal {
            Refusal::NoCoefficient { .. } | Refusal::Unreachable { .. } => (entry.value.span(), "value"),
            _ => (entry.between.span(), "between"),
        };
        fault(span, format!("correlation[{}].{key}", index + 1), StudyFault::Correlation(error.refusal))
    })
}
