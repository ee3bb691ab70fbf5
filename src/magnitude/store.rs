//! Answers of a costly function that were held back, until the run that begins anew asks for them.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::assembly::Points;
use crate::assembly::{Request, Responses};

/// Requests with their answers, each to be taken once.
#[derive(Debug, Default)]
pub(crate) struct Store {
    kept: Mutex<Vec<Kept>>,
    took: Mutex<Duration>,
}

#[derive(Debug)]
struct Kept {
    points: Points,
    outputs: Vec<usize>,
    answers: Responses,
}

impl Store {
    /// Keeps the answers of a request, and the time that they took.
    pub(super) fn keep(&self, request: &Request<'_>, answers: &Responses, took: Duration) {
        let kept = Kept { points: request.points.clone(), outputs: request.outputs.to_vec(), answers: answers.clone() };
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).push(kept);
        *self.took.lock().unwrap_or_else(PoisonError::into_inner) += took;
    }

    /// The answers of this very request; None where it was not asked before, or they were taken.
    pub(super) fn take(&self, request: &Request<'_>) -> Option<Responses> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |one: &Kept| one.outputs == request.outputs && one.points == *request.points;
        let place = kept.iter().position(same)?;
        Some(kept.remove(place).answers)
    }

    /// The time that all answers took.
    pub(super) fn took(&self) -> Duration {
        *self.took.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
