//! Failed points of a run, so that the journal's record of them is not counted twice.

use std::sync::{Mutex, PoisonError};

use crate::assembly::{RecordedFailure, Request, Responses};

/// Points and outputs of a costly function that have no value in this run.
#[derive(Debug, Default)]
pub(super) struct FailureLog {
    failed: Mutex<Vec<(usize, Vec<f64>)>>,
}

impl FailureLog {
    /// Notes the failed points of a request.
    pub(super) fn note(&self, request: &Request<'_>, answers: &Responses) {
        let failed = answers.errors().map(|(row, column, _)| (request.outputs[column], request.points.row(row)));
        self.failed.lock().unwrap_or_else(PoisonError::into_inner).extend(failed);
    }

    /// Removes the failures of points that failed in this run too.
    pub(super) fn without_own(&self, mut recorded: Vec<RecordedFailure>) -> Vec<RecordedFailure> {
        let own = self.failed.lock().unwrap_or_else(PoisonError::into_inner);
        let is_own =
            |one: &RecordedFailure| own.iter().any(|(output, point)| *output == one.output && one.is_at(point));
        recorded.retain(|one| !is_own(one));
        recorded
    }
}
