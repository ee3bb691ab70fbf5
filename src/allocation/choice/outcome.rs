//! Outcome of one search of tolerances.

use crate::allocation::result::allocation::{Attainable, Proof};
use crate::allocation::result::solver_result::Solved;

/// Outcome of one search of tolerances at fixed derivatives.
pub(in crate::allocation) enum Choice {
    /// Tolerances that keep every requirement, with the offers and the proof.
    Found { solved: Solved, offers: Vec<usize>, proof: Proof },
    /// No tolerances keep every requirement. The half bands are those of the best attainable value.
    Infeasible(Attainable, Vec<f64>),
    /// Stopped before tolerances were found.
    Stopped,
}
