//! The methods: what each evaluates and what it makes of it, a file each, and their registry.
//!
//! # A new method
//! One new file with a type that implements `Procedure`, one variant of [`Method`] and one line in `ALL`; `plan`,
//! `compare` and the documentation of the command line iterate the registry.

mod auto;
mod bivariate_dimension_reduction;
mod check;
mod classic;
mod climbed;
mod cost;
mod dimension_reduction;
mod estimate;
mod exact;
mod full;
mod gradients;
mod hidden;
mod interpolated;
mod ladder;
mod narrow;
mod options;
mod order;
mod outcome;
mod polynomial_surface;
mod principal;
pub(crate) mod procedure;
mod quadrature;
pub mod registry;
mod response_surface;
mod rss;
mod second_order;
mod six_n;
mod surface_proof;
mod three_point;
mod worst_case;

pub use crate::method_kind::Method;
pub use crate::plan::Stencil;
pub use auto::{ACCURACY, climb_until};
pub use climbed::ClimbEnd;
pub(crate) use climbed::Climbed;
pub use cost::Cost;
pub(crate) use estimate::estimate;
pub use estimate::{ErrorEstimate, ErrorSource};
pub(crate) use exact::ExactDerivatives;
pub(crate) use interpolated::interpolated;
pub use narrow::{Narrow, Narrowed};
pub use options::{Accuracies, DerivativeSource, Options, Pairs};
pub use order::Basis;
pub(crate) use order::Order;
pub use outcome::Residual;
pub(crate) use outcome::{Fitted, Integrated, InteractionEffect, Lacking, MainEffect, Outcome, SurfaceProof};
pub(crate) use procedure::Procedure;
pub use registry::ALL;

use crate::assembly::EvaluationError;
use crate::evaluation::{Restoration, Restore};
use crate::warning::{Advice, Figure};
use sensitol_numeric::power::Power;

/// Why a method cannot be run on a problem as asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MethodError {
    /// The plan needs more evaluations than allowed.
    #[error("{method} needs {needed} evaluations, more than the budget of {budget}{}", instead(.fitting))]
    OverBudget {
        /// The method's name.
        method: &'static str,
        /// How many it needs.
        needed: usize,
        /// How many are allowed.
        budget: usize,
        /// The best method that fits the budget, and what it needs.
        fitting: Option<(Method, usize)>,
    },
    /// The model cannot be used at all; nothing was evaluated.
    #[error("{error}")]
    Model {
        /// Why not.
        error: EvaluationError,
    },
    /// Inputs that vary together as a whole, where the method integrates over each by itself.
    #[error("{method} integrates over one input after the other, and {} vary together as a whole: use full or auto", dimensions.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "))]
    JointInputs {
        /// The method's name.
        method: &'static str,
        /// The dimensions of the first block.
        dimensions: Vec<String>,
    },
    /// An option that the method does not have.
    #[error("{method} has no choice of {option}; only {only} has one")]
    OptionDoesNotApply {
        /// The method's name.
        method: &'static str,
        /// The option.
        option: &'static str,
        /// The methods that have it.
        only: &'static str,
    },
    /// Exact derivatives of something that is known by its values only.
    #[error("`{characteristic}` has no exact derivatives: it depends on a model that returns values only")]
    DerivativesUnknown {
        /// The characteristic.
        characteristic: String,
    },
    /// A model that declares derivatives and sends none.
    #[error("the model says that it sends gradients, and its answers have none of `{characteristic}`")]
    NoGradient {
        /// The characteristic.
        characteristic: String,
    },
    /// Derivatives that a model sends and its own values refute.
    #[error(
        "the gradients of `{characteristic}`{} that the model sends are wrong: by them it changes by {by_gradient}, by its values by {by_values}",
        along(dimension)
    )]
    GradientsDisagree {
        /// The characteristic.
        characteristic: String,
        /// The dimension along which it was checked; None where all were moved at once.
        dimension: Option<String>,
        /// The change between two points by the derivatives.
        by_gradient: f64,
        /// The change of the values.
        by_values: f64,
    },
    /// A derivative that does not exist at the means.
    #[error("`{characteristic}` has no derivative by {} at the means: a kink, a jump or the edge of its domain", dimensions.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" and "))]
    NoDerivative {
        /// The characteristic.
        characteristic: String,
        /// The dimension, or the two of a mixed derivative.
        dimensions: Vec<String>,
    },
    /// An option of differences, where derivatives are exact.
    #[error("a choice of {option} means nothing with exact derivatives: nothing is evaluated beside the means")]
    NoDifferences {
        /// The option.
        option: &'static str,
    },
    /// A pair names something that is not a dimension.
    #[error("pair `{a}:{b}`: there is no dimension `{unknown}`{}", nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default())]
    UnknownPair {
        /// The first of the pair.
        a: String,
        /// The second of the pair.
        b: String,
        /// The one that is not a dimension.
        unknown: String,
        /// The most similar dimension.
        nearest: Option<String>,
    },
    /// A pair that has no interaction to examine.
    #[error("pair `{a}:{b}`: {}", if a == b { "a dimension does not interact with itself".to_owned() } else { format!("`{still}` does not vary, or no characteristic depends on it") })]
    IdlePair {
        /// The first of the pair.
        a: String,
        /// The second of the pair.
        b: String,
        /// The one that does not vary.
        still: String,
    },
    /// More evaluations than a limit allows.
    #[error("{method} needs {} evaluations for {dimensions} varying dimensions, {limit}{}", count(*.needed), instead(.fitting))]
    TooMany {
        /// The method's name.
        method: &'static str,
        /// How many dimensions vary.
        dimensions: usize,
        /// How many evaluations it needs, `u128::MAX` where there are more than that.
        needed: u128,
        /// Which limit.
        limit: EvaluationLimit,
        /// The derivative method to use instead, and what it needs.
        fitting: Option<(Method, usize)>,
    },
    /// More dimensions than the method can fit a surface to.
    #[error("{method} fits at most {most} varying dimensions, and {dimensions} vary{}", instead(.fitting))]
    TooManyDimensions {
        /// The method's name.
        method: &'static str,
        /// How many dimensions vary.
        dimensions: usize,
        /// How many may.
        most: usize,
        /// The derivative method to use instead, and what it needs.
        fitting: Option<(Method, usize)>,
    },
    /// A number of nodes of which there is no rule.
    #[error("a quadrature rule has 3, 5 or 7 nodes, not {nodes}")]
    BadNodes {
        /// The number given.
        nodes: usize,
    },
    /// An accuracy that is not a positive number.
    #[error("{}, a number above 0, not {accuracy}", accuracy_of(*figure))]
    BadAccuracy {
        /// Of what.
        figure: Figure,
        /// The accuracy given.
        accuracy: f64,
    },
    /// A step that is not a positive number.
    #[error("the step must be a number of sigmas above 0, not {step}")]
    BadStep {
        /// The step given.
        step: f64,
    },
}

impl Restore for MethodError {
    fn restore(&mut self, back: &Restoration<'_>) {
        self.rescale(|name| back.power_of(name));
    }
}

impl MethodError {
    /// Multiplies figures in the unit of a characteristic by the power of two that belongs to its name.
    pub(crate) fn rescale(&mut self, power_of: impl Fn(&str) -> Power) {
        if let Self::GradientsDisagree { characteristic, by_gradient, by_values, .. } = self {
            [by_gradient, by_values].into_iter().for_each(|change| *change = power_of(characteristic).times(*change));
        }
    }

    /// The actions to take.
    pub fn advice(&self) -> Vec<Advice> {
        match self {
            Self::OverBudget { fitting, .. } => {
                let method = fitting.map(|(method, _)| Advice::UseMethod { methods: vec![method] });
                method.into_iter().chain([Advice::RaiseBudget]).collect()
            }
            Self::TooMany { limit, fitting, .. } => {
                let method = fitting.map(|(method, _)| Advice::UseMethod { methods: vec![method] });
                let budget = (*limit == EvaluationLimit::WithoutBudget).then_some(Advice::SetBudget);
                method.into_iter().chain(budget).collect()
            }
            Self::TooManyDimensions { fitting: Some((method, _)), .. } => {
                vec![Advice::UseMethod { methods: vec![*method] }]
            }
            Self::DerivativesUnknown { .. }
            | Self::NoDerivative { .. }
            | Self::NoGradient { .. }
            | Self::GradientsDisagree { .. } => vec![Advice::UseDifferences],
            _ => Vec::new(),
        }
    }

    /// How many evaluations it would have taken, where that is why it cannot be run.
    pub fn needed(&self) -> Option<u64> {
        match self {
            Self::OverBudget { needed, .. } => u64::try_from(*needed).ok(),
            Self::TooMany { needed, .. } => u64::try_from(*needed).ok(),
            _ => None,
        }
    }
}

/// The most evaluations that a method may ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum EvaluationLimit {
    /// 1,000,000, unless a budget is given.
    WithoutBudget,
    /// 100,000,000, whatever the budget: the points of a plan are listed in memory.
    Listed,
}

impl EvaluationLimit {
    /// The number.
    pub(crate) fn most(self) -> usize {
        match self {
            Self::WithoutBudget => 1_000_000,
            Self::Listed => 100_000_000,
        }
    }
}

impl std::fmt::Display for EvaluationLimit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::WithoutBudget => write!(f, "more than the {} that are allowed without a budget", self.most()),
            Self::Listed => write!(f, "more than the {} that a plan may have", self.most()),
        }
    }
}

/// The methods that have a choice of nodes.
const NODES: &str = "dimension-reduction, univariate or bivariate,";

fn along(dimension: &Option<String>) -> String {
    dimension.as_ref().map(|name| format!(" by `{name}`")).unwrap_or_default()
}

fn count(needed: u128) -> String {
    if needed == u128::MAX { "more than 10^38".to_owned() } else { needed.to_string() }
}

fn instead(fitting: &Option<(Method, usize)>) -> String {
    match fitting {
        Some((method, evaluations)) => format!("; {method} needs {evaluations}"),
        None => "; no method does with so few".to_owned(),
    }
}

fn accuracy_of(figure: Figure) -> &'static str {
    match figure {
        Figure::Sigma => "the accuracy is the relative error of sigma that is wanted",
        Figure::Skewness => "the accuracy of the skewness is the error of it that is wanted",
        Figure::Kurtosis => "the accuracy of the kurtosis is the error of it that is wanted",
        Figure::Yield => "the accuracy of the yield is the share that it may be off",
    }
}
