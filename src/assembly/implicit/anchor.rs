//! Nominal state of an assembly, and the conditions under which a state elsewhere belongs to its branch.

use faer::Mat;

use crate::assembly::implicit::system::Scales;

/// Nominal state, from which every other state is found.
pub(in crate::assembly) struct Anchor {
    pub(super) given: Vec<f64>,
    pub(super) u: Vec<f64>,
    pub(super) scales: Scales,
    pub(super) sign: f64,
    /// Derivatives of the unknowns by the variables that the conditions use, 0 if one does not exist. They serve predictions only.
    pub(super) slopes: Mat<f64>,
    /// Condition number of the worst block of the scaled Jacobian.
    pub(super) condition: f64,
    /// Index of the unknown that is determined least.
    pub(super) weakest: usize,
    /// True if conditions choose between expressions, so that nominal slopes predict nothing beyond the next change. The first Newton step
    /// at the point is the prediction then.
    pub(super) bends: bool,
}

/// Greatest distance of a root from its prediction, as part of the distance moved, at which it is accepted without following it.
pub(super) const OFF: f64 = 0.25;
/// Greatest number of steps after which a root is accepted without following it.
pub(super) const STEPS: usize = 12;
/// Distance of a root from its prediction that rounding may cause, in scales of the unknowns.
pub(super) const SLACK: f64 = 1e-9;
