//! Smooth problems under rows and bounds, and roots: solvers that know no characteristic.

pub(in crate::allocation) mod augmented_lagrangian;
pub(in crate::allocation) mod minimise;
pub(in crate::allocation) mod quadratic_program;
pub(in crate::allocation) mod root;
pub(in crate::allocation) mod separable;
pub(in crate::allocation) mod sqp;
pub(in crate::allocation) mod vector;
