//! The results of an allocation.

use serde::{Serialize, Serializer};

use super::basis::CostBasis;
use super::joint::JointYield;
use super::setup::SetUp;
use super::shape::RequiredOf;
use super::shape::Sampled;
use super::shape::{After, Before, FrontRequirement, required, sampled};
use super::task::Goal;
use crate::analysis::Analysis;
use crate::problem::Problem;
use crate::simulation::Simulation;
use crate::summary::RunSummary;
use crate::warning::Warning;
use sensitol_numeric::requirement::{Required, Requirement};
use sensitol_numeric::shape::through;
use sensitol_numeric::verdict::Judged;

/// How it ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Every requirement is kept, and nothing cheaper does: within rounding, and proven.
    Optimal,
    /// Every requirement is kept, and nothing cheaper nearby does, within rounding. That nothing cheaper does elsewhere is not proven: the best
    /// of several starts.
    LocalOptimum,
    /// Every requirement is kept; how much cheaper it could be is bounded, or not known.
    AlmostOptimal,
    /// No tolerances within the bounds keep every requirement.
    Infeasible,
    /// The search ended at tolerances that miss a requirement; that no others keep it is not proven.
    NoFeasiblePointFound,
    /// The search ended at tolerances of which it is not known whether they keep a requirement: its interval holds values on both sides.
    Inconclusive,
    /// Stopped before it was known.
    OutOfTime,
}

impl Status {
    /// Its name in reports.
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

/// Which bound a tolerance has met.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Bound {
    /// Its least.
    #[serde(rename = "min")]
    Least,
    /// Its greatest.
    #[serde(rename = "max")]
    Greatest,
}

/// One dimension with a cost.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Allocated {
    /// Index of the dimension in the problem; reports name it.
    #[serde(skip)]
    pub dimension: usize,
    /// Half band before.
    pub before: f64,
    /// Half band after.
    pub after: f64,
    /// Its cost before; None where no process holds that tolerance.
    pub cost_before: Option<f64>,
    /// Its cost.
    pub cost_after: Option<f64>,
    /// The process, where several compete.
    pub process: Option<String>,
    /// The bound that it has met.
    #[serde(rename = "at_bound")]
    pub bound: Option<Bound>,
    /// The saving per unit by which that bound gives way, all else unchanged; None within the bounds, and where it is not known.
    pub bound_price: Option<f64>,
}

/// A nominal value that has moved.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Moved {
    /// Index of the dimension in the problem; reports name it.
    #[serde(skip)]
    pub dimension: usize,
    /// The nominal value before.
    pub before: f64,
    /// The nominal value after.
    pub after: f64,
}

/// The requirement of a characteristic, and its values.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Kept {
    /// Index of the characteristic in the problem; reports name it.
    #[serde(skip)]
    pub characteristic: usize,
    /// The requirement.
    #[serde(flatten, serialize_with = "through::<Required, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Required"))]
    pub requirement: Requirement,
    /// The value by the analysis at the tolerances before.
    #[serde(flatten, serialize_with = "through::<Before, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Before"))]
    pub before: Judged,
    /// The value by the analysis at those found; None where none were.
    #[serde(flatten, serialize_with = "through::<After, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "After"))]
    pub after: Option<Judged>,
    /// The verdict of a sample of the model there, of a worst case by points in the box of the bands; None without one, and of rss, of which
    /// samples know nothing.
    #[serde(serialize_with = "sampled")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<Sampled>"))]
    pub sampled: Option<Judged>,
}

/// The joint yield that all characteristics with limits must keep, and what there is of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct JointKept {
    /// The requirement.
    #[serde(flatten, serialize_with = "through::<Required, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Required"))]
    pub requirement: Requirement,
    /// The value by the analysis at the tolerances before.
    #[serde(flatten, serialize_with = "through::<Before, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Before"))]
    pub before: Judged,
    /// The value by the analysis at those found; None where none were.
    #[serde(flatten, serialize_with = "through::<After, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "After"))]
    pub after: Option<Judged>,
    /// The verdict of a sample of the model there; None without one.
    #[serde(serialize_with = "sampled")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<Sampled>"))]
    pub sampled: Option<Judged>,
}

/// The price of a requirement: by how much the cost falls per unit by which something gives way.
///
/// Where both sides of a requirement hold the cost up, widening one of them alone saves nothing, and only `both` is known. Where requirements
/// of several characteristics hold it up in the same way, to widen one of them saves less than to narrow it costs, and there is no one price.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShadowPrice {
    /// Index of the characteristic in the problem; reports name it.
    #[serde(skip)]
    pub characteristic: usize,
    /// Per unit by which both limits go outwards, or the only one; None where that is not what they cost inwards.
    pub both: Option<f64>,
    /// The saving per unit by which the limits go outwards, or a required sigma grows, all else unchanged.
    pub widen: Option<f64>,
    /// The extra cost per unit by which they go inwards.
    pub narrow: Option<f64>,
    /// Per unit by which its lower limit goes down.
    pub lower: Option<f64>,
    /// Per unit by which its upper limit goes up.
    pub upper: Option<f64>,
    /// Per unit of a required sigma.
    pub sigma: Option<f64>,
}

/// A requirement that cannot be kept.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Attainable {
    /// Index of the characteristic in the problem; reports name it.
    #[serde(skip)]
    pub characteristic: usize,
    /// Its unit.
    pub unit: Option<String>,
    /// The requirement.
    #[serde(flatten, serialize_with = "through::<Required, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Required"))]
    pub requirement: Requirement,
    /// The best that the bounds of the tolerances allow, in the requirement's own measure.
    pub best: Option<f64>,
    /// Whether it is the joint yield of all characteristics with limits.
    pub joint: bool,
    /// Whether it could be kept if it were the only one.
    pub together: bool,
    /// The dimensions without cost that alone break the requirement, most harmful first; empty where the others are to blame too.
    pub because: Vec<String>,
}

/// The solver that an answer comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum AllocationSolver {
    /// Newton's method on the multipliers, where costs and requirements are sums over the tolerances.
    DualNewton,
    /// The same for sums that have the values and slopes of the requirements, again and again until they agree.
    Separable,
    /// Sequential quadratic programming, where such sums lead nowhere.
    SequentialQuadratic,
    /// L-BFGS in an augmented Lagrangian for nominal values and tolerances at once, and the tolerances polished by the others.
    AugmentedLagrangian,
    /// Branch and bound over lists of processes.
    BranchAndBound,
    /// The root of one unknown, by which tolerances in fixed proportions are multiplied.
    Root,
    /// Trials by the analysis itself, where derivatives do not follow the model.
    VerifiedSearch,
}

/// The evidence that nothing is cheaper.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
#[non_exhaustive]
pub struct Proof {
    /// The solver that found the tolerances; None where none were found.
    pub solver: Option<AllocationSolver>,
    /// The largest violation of the conditions of Karush, Kuhn and Tucker; None where everything is chosen from lists.
    #[serde(rename = "kkt_residual")]
    pub residual: Option<f64>,
    /// No choice of processes costs less; None without lists, or where no bound is known.
    pub bound: Option<f64>,
    /// Whether the bound is exact rather than resting on a sample of choices.
    #[serde(skip)]
    pub rigorous: bool,
    /// Nodes of the branch and bound.
    pub nodes: usize,
    /// Whether Lagrange's condition had the answer in closed form.
    pub closed_form: bool,
    /// Searches from different tolerances, where there may be several optima; None where one search is enough.
    pub starts: Option<usize>,
    /// How many of them ended at the tolerances found.
    pub reached: Option<usize>,
    /// The cost of the next cheapest optimum that one of them ended at; None where there was no other.
    pub other_optimum: Option<f64>,
    /// By what part of the cost it may be above the bound; None without one.
    #[serde(skip)]
    pub gap: Option<f64>,
}

/// The results of an allocation. Unknown values are None.
#[derive(Debug, Clone, Serialize)]
pub struct Allocation {
    /// How it ended.
    pub status: Status,
    /// The problem with the tolerances and nominal values found; as it was where none were.
    #[serde(skip)]
    pub problem: Problem,
    /// The analysis at the tolerances before.
    pub before: Analysis,
    /// The analysis by the model at the tolerances after; None where none were found.
    pub after: Option<Analysis>,
    /// Whether the model was evaluated at the tolerances after.
    pub confirmed: bool,
    /// All costs before; None where no process holds some tolerance.
    pub cost_before: Option<f64>,
    /// All costs after.
    pub cost_after: Option<f64>,
    /// The part of these costs that is quality loss and scrap, before and after; None without losses, and where it is unknown.
    #[serde(rename = "loss")]
    pub loss: [Option<f64>; 2],
    /// The cost of the cheapest tolerances that are not rounded to steps or standard grades, by the derivatives at those found;
    /// None where there is no such rounding.
    pub cost_unrounded: Option<f64>,
    /// The machines that the processes need, and what it costs to set them up.
    pub setups: Vec<SetUp>,
    /// The goal.
    pub goal: Goal,
    /// Where the costs come from.
    pub cost_basis: CostBasis,
    /// Every dimension with a cost.
    pub tolerances: Vec<Allocated>,
    /// Nominal values that have moved.
    #[serde(rename = "recentred")]
    pub moved: Vec<Moved>,
    /// Every requirement.
    pub requirements: Vec<Kept>,
    /// The joint yield, where one is required.
    pub joint_requirement: Option<JointKept>,
    /// The prices of the requirements that hold the cost up; empty where everything is chosen from lists.
    #[serde(rename = "shadow_prices")]
    pub prices: Vec<ShadowPrice>,
    /// The evidence that nothing is cheaper.
    pub proof: Proof,
    /// The requirement that cannot be kept.
    pub attainable: Option<Attainable>,
    /// By which one factor all tolerances may be multiplied, before, until some requirement is just kept; None where no factor does, or
    /// any.
    pub loosest_before: Option<f64>,
    /// The same after.
    pub loosest_after: Option<f64>,
    /// The share of assemblies that keep all limits, where there are several characteristics with limits: before and after.
    #[serde(rename = "joint_yield")]
    pub joint: [Option<JointYield>; 2],
    /// Cost against yield.
    pub front: Vec<FrontPoint>,
    /// The model itself at the tolerances after, where it was asked for.
    pub confirmation: Option<Simulation>,
    /// Its points and time, those of a confirmation by Monte Carlo included, and why it ended early.
    #[serde(flatten)]
    pub run: RunSummary,
    /// How often derivatives were taken.
    pub rounds: usize,
    /// Points of a cheap model by which moments were corrected, worst cases followed and tolerances tried, beside the evaluations.
    pub model_points: u64,
    /// Where what was found is in doubt: tolerances that the model was not asked at, requirements that a sample refutes.
    pub warnings: Vec<Warning>,
}

/// One point of the front: the cheapest tolerances for a requirement.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FrontPoint {
    /// The requirement of every characteristic that has one, in the order of the problem; of all together last.
    #[serde(serialize_with = "required")]
    #[cfg_attr(feature = "schema", schemars(with = "Vec<RequiredOf>"))]
    pub required: Vec<FrontRequirement>,
    /// The cost of that; None where it cannot be kept.
    pub cost: Option<f64>,
    /// Half bands, in the order of [`Allocation::tolerances`].
    pub tolerances: Option<Vec<f64>>,
}

/// A proof with the kind of its bound, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ProofShape<'r> {
    #[serde(flatten, serialize_with = "Proof::serialize")]
    #[cfg_attr(feature = "schema", schemars(with = "Proof"))]
    own: &'r Proof,
    /// Whether the bound is exact, rather than resting on a sample of choices; null without one.
    bound_is_exact: Option<bool>,
    /// By what part of the cost it may be above the bound.
    gap: Option<f64>,
}

impl Serialize for Proof {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        ProofShape { own: self, bound_is_exact: self.bound.map(|_| self.rigorous), gap: self.gap }.serialize(serializer)
    }
}
