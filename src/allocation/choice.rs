//! The outcome of one search of tolerances.

use super::result::{Attainable, Proof};
use super::solved::Solved;

/// Outcome of one search at fixed derivatives.
pub(super) enum Choice {
    /// Tolerances that keep every requirement.
    Found { solved: Solved, offers: Vec<usize>, proof: Proof },
    /// There are none; with the half bands at which the best of it is to be had.
    Infeasible(Attainable, Vec<f64>),
    /// Stopped before any were found.
    Stopped,
}
