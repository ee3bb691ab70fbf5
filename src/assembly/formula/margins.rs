//! Margins of switches, ready to run.

use crate::assembly::Switch;
use crate::assembly::formula::program::Program;

/// Switches of some formulas, with the program of their margins.
#[derive(Debug)]
pub(super) struct Margins {
    pub(super) switches: Vec<Switch>,
    pub(super) program: Program,
}
