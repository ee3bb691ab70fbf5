//! Tolerance allocation: the cheapest tolerances that keep every requirement.
//!
//! ```text
//! min  sum_g parts_g C_g(T_g) + sum_c [k_c (sigma_c^2 + (mean_c - target_c)^2) + price_c (share beyond limits)]
//!                                  over half bands T_g of G groups of dimensions
//! subject to, for every characteristic with a requirement,
//!      yield >= Y      four moments of the second-order surface at T, and the Pearson distribution that has them
//!      Cpk >= c        min(U - mean, mean - L) / 3 sigma
//!      sigma <= s
//!      mean ± rss within [L, U]
//!      joint yield >= J     of all characteristics with limits
//!      worst case within [L, U]: linear, and where the surface is curved that of the surface, corrected by the true one
//! and  min_g <= T_g <= max_g,  or T_g one of a list of processes
//! ```
//!
//! Derivatives come from an ordinary analysis at the present tolerances. They give the moments at any other tolerances
//! ([`Surrogate::relocated`](sensitol_numeric::surrogate::Surrogate::relocated)), so that the search costs no
//! evaluation. The model is then analysed at the result. If the analysis disagrees, tolerances are chosen anew from the
//! derivatives there, until both agree. Nominal values that may move are unknowns of the same problem.
//!
//! Every result has evidence: the residual of the conditions of Karush, Kuhn and Tucker for free tolerances, a lower
//! bound of the cost for processes, and the shadow price of every limit.

mod augmented;
mod bands;
mod basis;
mod best_trial;
mod box_sample;
mod branch;
mod choice;
mod choose;
mod choose_made;
mod closed_form;
mod conclude;
mod constraint;
mod corners;
mod correction;
mod cost;
mod cost_error;
mod driver;
mod finisher;
mod front;
mod goal;
mod joint;
pub mod knapsack;
pub mod lists;
mod loss;
mod machines;
mod made;
mod minimise;
mod one_row;
mod proportion;
mod quadratic;
mod recentre;
mod reject_fit;
mod rejects;
mod remade;
mod response;
mod restore;
mod result;
mod root;
mod run;
mod sampled;
mod scaling;
mod separable;
mod setup;
mod several_rows;
mod shape;
mod solve;
mod solved;
mod sqp;
mod station;
mod steps;
mod task;
mod together;
mod trial;
mod unknown;
mod vector;
mod verified_search;
mod worst;
mod worst_reach;
mod written_cost;
mod yield_room;

pub use basis::CostBasis;
pub use cost::CurveKind;
pub use cost::{Curve, Offer, Priced};
pub use cost_error::CostError;
pub use joint::JointYield;
pub use loss::QualityLoss;
pub use made::Made;
pub use result::ProofShape;

pub use result::{
    Allocated, Allocation, AllocationSolver, Attainable, Bound, FrontPoint, JointKept, Kept, Moved, Proof, ShadowPrice,
    Status,
};
pub use run::allocate_written;
pub use run::{allocate, allocate_with};
pub use setup::SetUp;
pub use shape::FrontRequirement;
pub use task::{AllocateError, AllocationOptions, AllocationTask, Goal};
