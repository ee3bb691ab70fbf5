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

pub mod choice;
mod cost;
mod requirement;
mod result;
mod search;
mod surface;
mod task;

pub use crate::allocation::cost::cost_curve::Curve;
pub use crate::allocation::cost::cost_curve::CurveKind;
pub use crate::allocation::cost::cost_error::CostError;
pub use crate::allocation::cost::default_costs::CostBasis;
pub use crate::allocation::cost::priced_group::{Offer, Priced};
pub use crate::allocation::cost::priced_group::{PricedZone, ZonePart};
pub use crate::allocation::cost::process_option::Made;
pub use crate::allocation::requirement::quality_loss::QualityLoss;
pub use crate::allocation::surface::joint_yield::JointYield;

pub use crate::allocation::cost::setup_cost::SetUp;
pub use crate::allocation::result::allocation::{
    Allocated, AllocatedZone, Allocation, AllocationSolver, Attainable, Bound, FrontPoint, JointKept, Kept, Moved,
    Proof, ShadowPrice, Status,
};
pub use crate::allocation::result::json::FrontRequirement;
pub use crate::allocation::search::entry::allocate_written;
pub use crate::allocation::search::entry::{allocate, allocate_with};
pub use task::{AllocateError, AllocationOptions, AllocationTask, Goal};
