//! Solvers of smooth and separable problems under rows and bounds, and roots of one unknown.

pub mod augmented_lagrangian;
pub mod minimise;
pub(crate) mod quadratic_program;
pub mod root;
pub mod separable;
pub mod sqp;
pub(crate) mod vector;
