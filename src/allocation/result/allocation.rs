//! Results of an allocation.

use serde::Serialize;

use crate::allocation::cost::default_costs::CostBasis;
use crate::allocation::cost::setup_cost::SetUp;
#[cfg(feature = "schema")]
use crate::allocation::result::json::RequiredOf;
#[cfg(feature = "schema")]
use crate::allocation::result::json::Sampled;
use crate::allocation::result::json::{After, Before, FrontRequirement, required, sampled};
use crate::allocation::surface::joint_yield::JointYield;
use crate::allocation::task::Goal;
use crate::analysis::Analysis;
use crate::problem::Problem;
use crate::simulation::Simulation;
use crate::summary::RunSummary;
use crate::warning::Warning;
use sensitol_numeric::json_form::through;
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::verdict::Judged;

/// Outcome of an allocation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Every requirement is kept, and nothing is cheaper. This is proven within rounding.
    Optimal,
    /// Every requirement is kept, and nothing nearby is cheaper within rounding. The result is the best of several
    /// starts. A cheaper one elsewhere is not excluded.
    LocalOptimum,
    /// Every requirement is kept. The possible saving is bounded, or not known.
    AlmostOptimal,
    /// No tolerances within the bounds keep every requirement.
    Infeasible,
    /// The search ended at tolerances that miss a requirement. That no others keep it is not proven.
    NoFeasiblePointFound,
    /// The search ended at tolerances for which a requirement is inconclusive: its interval holds values on both sides.
    Inconclusive,
    /// The search was stopped before it reached a result.
    OutOfTime,
}

impl Status {
    /// Name of the status in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Optimal => "optimal",
            Self::LocalOptimum => "local-optimum",
            Self::AlmostOptimal => "almost-optimal",
            Self::Infeasible => "infeasible",
            Self::NoFeasiblePointFound => "no-feasible-point-found",
            Self::Inconclusive => "inconclusive",
            Self::OutOfTime => "out-of-time",
        }
    }
}

/// Bound that a tolerance has met.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Bound {
    /// Least half band.
    #[serde(rename = "min")]
    Least,
    /// Greatest half band.
    #[serde(rename = "max")]
    Greatest,
}

/// Result for one dimension with a cost.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Allocated {
    /// Index of the dimension in the problem; reports name it.
    #[serde(skip)]
    pub dimension: usize,
    /// Zone whose half width is the tolerance. The dimension is then its first one.
    #[serde(skip)]
    pub zone: Option<AllocatedZone>,
    /// Half band before.
    pub before: f64,
    /// Half band after.
    pub after: f64,
    /// Cost before. None if no process holds the tolerance.
    pub cost_before: Option<f64>,
    /// Cost after.
    pub cost_after: Option<f64>,
    /// Name of the process, if several compete.
    pub process: Option<String>,
    /// Bound that the tolerance has met.
    #[serde(rename = "at_bound")]
    pub bound: Option<Bound>,
    /// Saving per unit by which that bound is widened, with all else unchanged. None within the bounds, and if it is
    /// not known.
    pub bound_price: Option<f64>,
}

/// Zone of a feature with a cost.
#[derive(Debug, Clone, PartialEq)]
pub struct AllocatedZone {
    /// Name of the zone in the study.
    pub name: String,
    /// Unit of the width.
    pub unit: Option<String>,
    /// Indices of all its dimensions in the problem.
    pub members: Vec<usize>,
}

/// Nominal value that has moved.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Moved {
    /// Index of the dimension in the problem; reports name it.
    #[serde(skip)]
    pub dimension: usize,
    /// Nominal value before.
    pub before: f64,
    /// Nominal value after.
    pub after: f64,
}

/// Requirement of a characteristic, and its values.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Kept {
    /// Index of the characteristic in the problem; reports name it.
    #[serde(skip)]
    pub characteristic: usize,
    /// Requirement.
    #[serde(flatten)]
    pub requirement: Requirement,
    /// Value by the analysis at the tolerances before.
    #[serde(flatten, serialize_with = "through::<Before, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Before"))]
    pub before: Judged,
    /// Value by the analysis at the tolerances found. None if none were found.
    #[serde(flatten, serialize_with = "through::<After, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "After"))]
    pub after: Option<Judged>,
    /// Verdict from a sample of the model at the tolerances found; for a worst case from points in the box of the
    /// bands. None if there is no sample, and for rss, which samples cannot judge.
    #[serde(serialize_with = "sampled")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<Sampled>"))]
    pub sampled: Option<Judged>,
}

/// Required joint yield, and its values.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct JointKept {
    /// Requirement.
    #[serde(flatten)]
    pub requirement: Requirement,
    /// Value by the analysis at the tolerances before.
    #[serde(flatten, serialize_with = "through::<Before, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Before"))]
    pub before: Judged,
    /// Value by the analysis at the tolerances found. None if none were found.
    #[serde(flatten, serialize_with = "through::<After, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "After"))]
    pub after: Option<Judged>,
    /// Verdict from a sample of the model at the tolerances found. None if there is no sample.
    #[serde(serialize_with = "sampled")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<Sampled>"))]
    pub sampled: Option<Judged>,
}

/// Shadow price of a requirement: the saving per unit by which a limit is widened.
///
/// If both sides of a requirement are active, widening one of them alone saves nothing, and only `both` is known. If
/// requirements of several characteristics are active in the same way, widening one saves less than narrowing it costs.
/// There is no single price then.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShadowPrice {
    /// Index of the characteristic in the problem; reports name it.
    #[serde(skip)]
    pub characteristic: usize,
    /// Saving per unit by which both limits, or the only one, are widened. None if it differs from the cost of
    /// narrowing them.
    pub both: Option<f64>,
    /// Saving per unit by which the limits are widened or a required sigma grows, with all else unchanged.
    pub widen: Option<f64>,
    /// Extra cost per unit by which the limits are narrowed.
    pub narrow: Option<f64>,
    /// Saving per unit by which the lower limit goes down.
    pub lower: Option<f64>,
    /// Saving per unit by which the upper limit goes up.
    pub upper: Option<f64>,
    /// Saving per unit by which a required sigma grows.
    pub sigma: Option<f64>,
}

/// Requirement that cannot be kept.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Attainable {
    /// Index of the characteristic in the problem; reports name it.
    #[serde(skip)]
    pub characteristic: usize,
    /// Unit of the characteristic.
    pub unit: Option<String>,
    /// Requirement.
    #[serde(flatten)]
    pub requirement: Requirement,
    /// Best value within the bounds of the tolerances, in the measure of the requirement.
    pub best: Option<f64>,
    /// True if it is the joint yield of all characteristics with limits.
    pub joint: bool,
    /// True if it could be kept as the only requirement.
    pub together: bool,
    /// Dimensions without cost that alone break the requirement, most harmful first. The list is empty if the others
    /// contribute too.
    pub because: Vec<String>,
}

/// Solver that found the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum AllocationSolver {
    /// Newton's method on the multipliers, for costs and requirements that are sums over the tolerances.
    DualNewton,
    /// Newton's method on the multipliers for sums with the values and slopes of the requirements, repeated until they
    /// agree.
    Separable,
    /// Sequential quadratic programming, if such sums do not converge.
    SequentialQuadratic,
    /// L-BFGS in an augmented Lagrangian for nominal values and tolerances at once. The other solvers refine the
    /// tolerances.
    AugmentedLagrangian,
    /// Branch and bound over lists of processes.
    BranchAndBound,
    /// Root of one unknown: the common factor of tolerances in fixed proportions.
    Root,
    /// Trials by the analysis itself, if derivatives do not follow the model.
    VerifiedSearch,
}

/// Evidence that nothing is cheaper.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Proof {
    /// Solver that found the tolerances. None if none were found.
    pub solver: Option<AllocationSolver>,
    /// Largest violation of the conditions of Karush, Kuhn and Tucker. None if everything is chosen from lists.
    #[serde(rename = "kkt_residual")]
    pub residual: Option<f64>,
    /// Lower bound of the cost of every choice of processes. None if there are no lists, and if no bound is known.
    pub bound: Option<f64>,
    /// True if the bound is exact, false if it rests on a sample of choices. None if there is no bound.
    pub bound_is_exact: Option<bool>,
    /// Number of nodes of the branch and bound.
    pub nodes: usize,
    /// True if Lagrange's condition gave the result in closed form.
    pub closed_form: bool,
    /// Number of searches from different tolerances, if there may be several optima. None if one search is enough.
    pub starts: Option<usize>,
    /// Number of them that ended at the tolerances found.
    pub reached: Option<usize>,
    /// Cost of the next cheapest optimum among them. None if there was no other.
    pub other_optimum: Option<f64>,
    /// Greatest possible excess of the cost over the bound, as a part of the cost. None if there is no bound.
    pub gap: Option<f64>,
}

/// Results of an allocation. Unknown values are None.
#[derive(Debug, Clone, Serialize)]
pub struct Allocation {
    /// Outcome.
    pub status: Status,
    /// Problem with the tolerances and nominal values found. It is the given problem if none were found.
    #[serde(skip)]
    pub problem: Problem,
    /// Analysis at the tolerances before.
    pub before: Analysis,
    /// Analysis of the model at the tolerances after. None if none were found.
    pub after: Option<Analysis>,
    /// True if the model was evaluated at the tolerances after.
    pub confirmed: bool,
    /// Total cost before. None if no process holds some tolerance.
    pub cost_before: Option<f64>,
    /// Total cost after.
    pub cost_after: Option<f64>,
    /// Quality loss and scrap within these costs, before and after. None if there are no losses, and if it is unknown.
    #[serde(rename = "loss")]
    pub loss: [Option<f64>; 2],
    /// Cost of the cheapest tolerances without rounding to steps or standard grades, by the derivatives at those found.
    /// None if there is no such rounding.
    pub cost_unrounded: Option<f64>,
    /// Machines that the processes need, with their set-up costs.
    pub setups: Vec<SetUp>,
    /// Objective.
    pub goal: Goal,
    /// Origin of the costs.
    pub cost_basis: CostBasis,
    /// Every dimension with a cost.
    pub tolerances: Vec<Allocated>,
    /// Nominal values that have moved.
    #[serde(rename = "recentred")]
    pub moved: Vec<Moved>,
    /// Every requirement.
    pub requirements: Vec<Kept>,
    /// Joint yield, if one is required.
    pub joint_requirement: Option<JointKept>,
    /// Prices of the active requirements. The list is empty if everything is chosen from lists.
    #[serde(rename = "shadow_prices")]
    pub prices: Vec<ShadowPrice>,
    /// Evidence that nothing is cheaper.
    pub proof: Proof,
    /// Requirement that cannot be kept.
    pub attainable: Option<Attainable>,
    /// Largest common factor of all tolerances before that keeps every requirement. None if no factor does, or every
    /// one.
    pub loosest_before: Option<f64>,
    /// Largest common factor of all tolerances after that keeps every requirement. None if no factor does, or every
    /// one.
    pub loosest_after: Option<f64>,
    /// Share of assemblies that keep all limits, before and after. None if fewer than two characteristics have limits.
    #[serde(rename = "joint_yield")]
    pub joint: [Option<JointYield>; 2],
    /// Front of cost against yield.
    pub front: Vec<FrontPoint>,
    /// Sample of the model at the tolerances after, if a confirmation was requested.
    pub confirmation: Option<Simulation>,
    /// Evaluations and time, including those of a confirmation by Monte Carlo, and the reason for an early end.
    #[serde(flatten)]
    pub run: RunSummary,
    /// Number of analyses that gave derivatives.
    pub rounds: usize,
    /// Points of a cheap model in addition to the evaluations. They correct moments, follow worst cases and try
    /// tolerances.
    pub model_points: u64,
    /// Doubts about the result: tolerances at which the model was not evaluated, requirements that a sample refutes.
    pub warnings: Vec<Warning>,
}

/// Point of the front: the cheapest tolerances for a requirement.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FrontPoint {
    /// Required amount of every characteristic with a requirement, in the order of the problem. The joint yield comes
    /// last.
    #[serde(serialize_with = "required")]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<RequiredOf>"))]
    pub required: Vec<FrontRequirement>,
    /// Cost of the tolerances. None if the requirement cannot be kept.
    pub cost: Option<f64>,
    /// Half bands, in the order of [`Allocation::tolerances`].
    pub tolerances: Option<Vec<f64>>,
}
