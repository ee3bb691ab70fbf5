//! The margins of switches, ready to run.

use super::program::Program;
use crate::assembly::Switch;

/// The switches of some formulas, and the program of their margins.
#[derive(Debug)]
pub(super) struct Margins {
    pub(super) switches: Vec<Switch>,
    pub(super) program: Program,
}
