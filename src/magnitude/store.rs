//! Store for answers of a costly function that were held back, until the restarted run requests them.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::assembly::Points;
use crate::assembly::{Request, Responses};

/// Requests with their answers, each for one use.
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
    /// Stores the answers of a request, and the time that they needed.
    pub(super) fn keep(&self, request: &Request<'_>, answers: &Responses, took: Duration) {
        let kept = Kept { points: request.points.clone(), outputs: request.outputs.to_vec(), answers: answers.clone() };
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).push(kept);
        *self.took.lock().unwrap_or_else(PoisonError::into_inner) += took;
    }

    /// Removes and returns the answers of this very request. Returns None if they were never stored, or are already taken.
    pub(super) fn take(&self, request: &Request<'_>) -> Option<Responses> {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |one: &Kept| one.outputs == request.outputs && one.points == *request.points;
        let place = kept.iter().position(same)?;
        Some(kept.remove(place).answers)
    }

    /// Time that all answers needed.
    pub(super) fn took(&self) -> Duration {
        *self.took.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
