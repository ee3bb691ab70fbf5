//! Assemblies known only by their closure conditions.
//!
//! With dimensions `x`, unknowns `u` in `R^m` and as many conditions `F(x, u) = 0`, the unknowns are those of the assembled
//! state that the drawing shows: the branch of solutions on which the nominal one lies. A condition is an equation, or one
//! of the two directions of a loop of vectors: `sum of length cos(angle)` and `sum of length sin(angle)`.
//!
//! # Solution
//! A safeguarded Newton method with exact Jacobians, iterated until rounding stops it. It starts at every point from the
//! nominal solution and its exact sensitivities, so that a result depends neither on the order of the points nor on
//! threads. Where it fails, lands on another determinant's sign or far off its prediction, the solution is followed from
//! the nominal dimensions to the point in steps that adapt. A path that cannot be followed is an error.
//!
//! # Derivatives
//! `F_u u' = -F_x x'`, and once more with the second derivatives on the right: both exact, by jets of the conditions. First
//! order is the direct linearisation method (DLM): Chase, Gao, Magleby, "General 2-D tolerance analysis of mechanical
//! assemblies with small kinematic adjustments", Journal of Design and Manufacturing 5 (1995).

mod assembler;
mod conditions;
mod derivatives;
mod error;
mod linear;
mod newton;
mod system;

pub use conditions::{Condition, Conditions, ConditionsError, Link, Unknown};
pub use error::AssemblyFailure;

pub(super) use assembler::{Anchor, Assembler};
pub(super) use derivatives::Tangent;
