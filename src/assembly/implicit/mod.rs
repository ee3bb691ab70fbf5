//! Assemblies that are defined by closure conditions.
//!
//! Given dimensions `x`, unknowns `u` in `R^m` and as many conditions `F(x, u) = 0`, the unknowns are those of the assembled state on the
//! drawing. This is the branch of solutions that contains the nominal one. A condition is an equation, or one of the two directions of a
//! loop of vectors: `sum of length cos(angle)` and `sum of length sin(angle)`.
//!
//! # Solution
//! A safeguarded Newton method with exact Jacobians is iterated until rounding stops it. At every point it starts from the nominal solution
//! and its exact sensitivities, so that a result depends neither on the order of the points nor on threads.
//!
//! The search may fail, end on another sign of the determinant, or end far from its prediction. Then the solution is followed from the
//! nominal dimensions to the point in adaptive steps. A path that cannot be followed is an error.
//!
//! Greatest number of points need no safeguards. They are solved side by side by full steps, in blocks of equations that depend on each
//! other. A point whose steps do not become shorter at once takes the safeguarded search.
//!
//! # Derivatives
//! The first derivatives solve `F_u u' = -F_x x'`, and the second ones the same system with second derivatives on the right. Both are
//! exact, by jets of the conditions. First order is the direct linearisation method (DLM): Chase, Gao, Magleby, "General 2-D tolerance
//! analysis of mechanical assemblies with small kinematic adjustments", Journal of Design and Manufacturing 5 (1995).

mod anchor;
mod assembler;
mod batch;
mod conditioning;
mod conditions;
mod derivatives;
mod elimination;
mod error;
mod linear;
mod newton;
mod order;
mod rows;
mod subject;
mod system;

#[cfg(test)]
mod tests;

pub use conditions::{Condition, Conditions, ConditionsError, Link, Unknown};
pub use error::AssemblyFailure;
pub use subject::{EquationSubject, OpenJoint, PressedJoint};

pub(super) use anchor::Anchor;
pub(super) use assembler::Assembler;
pub(super) use derivatives::{ImplicitOutput, Tangent};
pub(super) use rows::RowSolution;
