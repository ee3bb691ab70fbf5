//! The methods and their registry. Each method has a file of its own: the points that it evaluates, and the figures that it derives from
//! them.
//!
//! # A new method
//! A new method is one file with a type that implements `Procedure`, one variant of [`Method`] and one line in `ALL`. `plan`, `compare` and
//! the documentation of the command line iterate the registry.

mod auto;
mod auto_account;
mod check_points;
mod cost;
mod derivative;
mod derivative_order;
mod error_estimate;
mod exact_derivatives;
mod hidden_terms;
mod integration;
mod interpolated_surface;
mod model_gradients;
mod options;
mod outcome;
mod polynomial_surface;
mod principal_axes;
pub(crate) mod procedure;
mod reduced_inputs;
pub mod registry;
mod response_surface;
mod surface_proof;

pub(crate) use crate::method::auto_account::AutoAccount;
pub use crate::method::auto_account::ClimbEnd;
pub use crate::method::derivative_order::Basis;
pub(crate) use crate::method::derivative_order::Order;
pub(crate) use crate::method::error_estimate::estimate;
pub use crate::method::error_estimate::{ErrorEstimate, ErrorSource};
pub(crate) use crate::method::exact_derivatives::ExactDerivatives;
pub(crate) use crate::method::interpolated_surface::interpolated;
pub use crate::method::reduced_inputs::{ReducedInputs, ReducedSurface};
pub use crate::method_kind::Method;
pub use crate::plan::Stencil;
pub use auto::{ACCURACY, climb_until};
pub use cost::Cost;
pub use options::{Accuracies, DerivativeSource, Options, Pairs};
pub use outcome::Residual;
pub(crate) use outcome::{Fitted, Integrated, InteractionEffect, Lacking, MainEffect, Outcome, SurfaceProof};
pub(crate) use procedure::Procedure;
pub use registry::ALL;

use crate::assembly::EvaluationError;
use crate::evaluation::{Restoration, Restore};
use crate::warning::{Advice, Figure};
use sensitol_numeric::power::Power;

/// Reason why a method cannot be run on a problem with the given options.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MethodError {
    /// The plan needs more evaluations than the budget allows.
    #[error("{method} needs {needed} evaluations, more than the budget of {budget}{}", instead(.fitting))]
    OverBudget {
        /// Name of the method that was requested.
        method: &'static str,
        /// Number of evaluations that the method needs.
        needed: usize,
        /// Greatest number of evaluations that the budget allows.
        budget: usize,
        /// Method with the most evaluations within the budget, and their number; None if no method fits.
        fitting: Option<(Method, usize)>,
    },
    /// The model cannot be used at all. Nothing was evaluated.
    #[error("{error}")]
    Model {
        /// Error of the model when it was prepared.
        error: EvaluationError,
    },
    /// Inputs that vary together as a whole, while the method integrates over each input by itself.
    #[error("{method} integrates over one input after the other, and {} vary together as a whole: use full or auto", dimensions.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "))]
    JointInputs {
        /// Name of the method that was requested.
        method: &'static str,
        /// Names of the dimensions of the first block.
        dimensions: Vec<String>,
    },
    /// An option that the method does not have.
    #[error("{method} has no choice of {option}; only {only} has one")]
    OptionDoesNotApply {
        /// Name of the method that was requested.
        method: &'static str,
        /// Name of the option that was given.
        option: &'static str,
        /// Names of the methods that have this option.
        only: &'static str,
    },
    /// Exact derivatives were requested, but the characteristic is known by its values only.
    #[error("`{characteristic}` has no exact derivatives: it depends on a model that returns values only")]
    DerivativesUnknown {
        /// Name of the characteristic without derivatives.
        characteristic: String,
    },
    /// A model that declares gradients sends none.
    #[error("the model says that it sends gradients, and its answers have none of `{characteristic}`")]
    NoGradient {
        /// Name of the characteristic without a gradient.
        characteristic: String,
    },
    /// Values of the model contradict the derivatives that it sends.
    #[error(
        "the gradients of `{characteristic}`{} that the model sends are wrong: by them it changes by {by_gradient}, by its values by {by_values}",
        along(dimension)
    )]
    GradientsDisagree {
        /// Name of the characteristic with the wrong derivative.
        characteristic: String,
        /// Dimension along which the derivative was checked; None if all dimensions were moved at once.
        dimension: Option<String>,
        /// Change between two points, computed from the derivatives.
        by_gradient: f64,
        /// Change between the same two points, computed from the values.
        by_values: f64,
    },
    /// A derivative that does not exist at the means.
    #[error("`{characteristic}` has no derivative by {} at the means: a kink, a jump or the edge of its domain", dimensions.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" and "))]
    NoDerivative {
        /// Name of the characteristic without this derivative.
        characteristic: String,
        /// The dimension, or the two dimensions of a mixed derivative.
        dimensions: Vec<String>,
    },
    /// An option of difference quotients was given together with exact derivatives.
    #[error("a choice of {option} means nothing with exact derivatives: nothing is evaluated beside the means")]
    NoDifferences {
        /// Name of the option that was given.
        option: &'static str,
    },
    /// A pair contains a name that is not a dimension.
    #[error("pair `{a}:{b}`: there is no dimension `{unknown}`{}", nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default())]
    UnknownPair {
        /// First name of the pair, as given.
        a: String,
        /// Second name of the pair, as given.
        b: String,
        /// Name in the pair that is not a dimension.
        unknown: String,
        /// Dimension with the most similar name, if one is similar.
        nearest: Option<String>,
    },
    /// A pair that has no interaction to examine.
    #[error("pair `{a}:{b}`: {}", if a == b { "a dimension does not interact with itself".to_owned() } else { format!("`{still}` does not vary, or no characteristic depends on it") })]
    IdlePair {
        /// First name of the pair, as given.
        a: String,
        /// Second name of the pair, as given.
        b: String,
        /// Dimension of the pair that does not vary, or on which no characteristic depends.
        still: String,
    },
    /// The method needs more evaluations than a limit allows.
    #[error("{method} needs {} evaluations for {dimensions} varying dimensions, {limit}{}", count(*.needed), instead(.fitting))]
    TooMany {
        /// Name of the method that was requested.
        method: &'static str,
        /// Number of dimensions that vary in the problem.
        dimensions: usize,
        /// Number of evaluations that the method needs; `u128::MAX` if the number exceeds that.
        needed: u128,
        /// Limit that the number of evaluations exceeds.
        limit: EvaluationLimit,
        /// Derivative method to use instead, and its number of evaluations; None if none fits.
        fitting: Option<(Method, usize)>,
    },
    /// More dimensions vary than the method can fit a surface to.
    #[error("{method} fits at most {most} varying dimensions, and {dimensions} vary{}", instead(.fitting))]
    TooManyDimensions {
        /// Name of the method that was requested.
        method: &'static str,
        /// Number of dimensions that vary in the problem.
        dimensions: usize,
        /// Greatest number of varying dimensions that the method allows.
        most: usize,
        /// Derivative method to use instead, and its number of evaluations; None if none fits.
        fitting: Option<(Method, usize)>,
    },
    /// A number of nodes for which there is no quadrature rule.
    #[error("a quadrature rule has 3, 5 or 7 nodes, not {nodes}")]
    BadNodes {
        /// Number of nodes that was given.
        nodes: usize,
    },
    /// An accuracy that is not a positive number.
    #[error("{}, a number above 0, not {accuracy}", accuracy_of(*figure))]
    BadAccuracy {
        /// Figure whose accuracy was given.
        figure: Figure,
        /// Accuracy that was given (not positive, or not finite).
        accuracy: f64,
    },
    /// A step that is not a positive number.
    #[error("the step must be a number of sigmas above 0, not {step}")]
    BadStep {
        /// Step in sigmas that was given (not positive, or not finite).
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

    /// Returns the actions that let the analysis run.
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

    /// Returns the number of evaluations that the method needs; None if the error is not about this number.
    pub fn needed(&self) -> Option<u64> {
        match self {
            Self::OverBudget { needed, .. } => u64::try_from(*needed).ok(),
            Self::TooMany { needed, .. } => u64::try_from(*needed).ok(),
            _ => None,
        }
    }
}

/// Greatest number of evaluations that a method may request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum EvaluationLimit {
    /// 1,000,000 evaluations, the limit if no budget is given.
    WithoutBudget,
    /// 100,000,000 evaluations, the limit with any budget: the points of a plan are listed in memory.
    Listed,
}

impl EvaluationLimit {
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

/// Names of the methods whose number of nodes can be chosen, as error messages list them.
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
