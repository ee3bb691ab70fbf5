//! Margins of switches, ready to run.

use super::program::Program;
use crate::assembly::Switch;

/// Switches of some formulas, with the program of their margins.
#[derive(Debug)]
pub(super) struct Margins {
    pub(super) switches: Vec<Switch>,
    pub(super) program: Program,
}
