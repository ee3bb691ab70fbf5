//! The methods: what each evaluates and what it makes of it, a file each, and their registry.
//!
//! # A new method
//! One new file with a type that implements [`Procedure`], one variant of [`Method`] and one line in [`ALL`]; `plan` and
//! the documentation of the command line iterate the registry.

mod auto;
mod check;
mod classic;
mod estimate;
mod exact;
mod full;
mod hidden;
mod ladder;
mod options;
mod rss;
mod second_order;
mod six_n;
mod worst_case;

pub use auto::{ACCURACY, Climbed, Rest};
pub use check::Check;
pub use estimate::{ErrorEstimate, Source, estimate};
pub use exact::ExactDerivatives;
pub use ladder::{Fitted, Order, Outcome};
pub use options::{DerivativeSource, Options, Pairs};

use crate::assembly::{EvaluationError, Run};
use crate::plan::DifferencePlan;
use crate::problem::Problem;

/// A method by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Method {
    /// Root of the sum of squares: first order.
    Rss,
    /// Sum of absolute values: first order.
    WorstCase,
    /// First and second derivatives, no mixed ones.
    SecondOrder,
    /// Five-point axes and the strongest interactions.
    SixN,
    /// Every second derivative.
    Full,
    /// Every second derivative by the published four-point stencil.
    Classic,
    /// As few evaluations as the wanted accuracy takes.
    Auto,
}

/// Every method, in the order in which they are listed.
pub static ALL: &[&dyn Procedure] = &[
    &auto::AUTO,
    &rss::RSS,
    &worst_case::WORST_CASE,
    &second_order::SECOND_ORDER,
    &six_n::SIX_N,
    &full::FULL,
    &classic::CLASSIC,
];

/// What a method does.
pub trait Procedure: Sync {
    /// Its place in the enumeration.
    fn method(&self) -> Method;

    /// Its name in study files and on the command line.
    fn name(&self) -> &'static str;

    /// What it does, in one line.
    fn about(&self) -> &'static str;

    /// How many evaluations it takes for N dimensions, as a formula.
    fn count(&self) -> &'static str;

    /// The plan that it would follow.
    ///
    /// # Errors
    /// When an option means nothing to this method, or names something that the problem does not have.
    fn plan(&self, problem: &Problem, options: &Options) -> Result<DifferencePlan, MethodError>;

    /// Evaluates the problem.
    ///
    /// # Errors
    /// As [`Procedure::plan`], and when the plan needs more evaluations than the budget allows; nothing is evaluated then.
    fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError>;
}

impl Method {
    /// What it does.
    pub fn procedure(self) -> &'static dyn Procedure {
        *ALL.iter().find(|procedure| procedure.method() == self).expect("every method is registered")
    }

    /// Its name in study files and on the command line.
    pub fn name(self) -> &'static str {
        self.procedure().name()
    }

    /// The method of this name.
    ///
    /// ```
    /// use sensitol::Method;
    /// assert_eq!(Method::by_name("six-n"), Some(Method::SixN));
    /// ```
    pub fn by_name(name: &str) -> Option<Self> {
        ALL.iter().find(|procedure| procedure.name() == name).map(|procedure| procedure.method())
    }
}

/// Why a method cannot be run on a problem as asked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MethodError {
    /// The plan needs more evaluations than allowed.
    #[error("{method} needs {needed} evaluations, more than the budget of {budget}{}", advice(.fitting))]
    OverBudget {
        /// The method's name.
        method: &'static str,
        /// How many it needs.
        needed: usize,
        /// How many are allowed.
        budget: usize,
        /// The best method that fits the budget, and what it needs.
        fitting: Option<(&'static str, usize)>,
    },
    /// The model cannot be used at all; nothing was evaluated.
    #[error("{error}")]
    Model {
        /// Why not.
        error: EvaluationError,
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
    #[error(
        "`{characteristic}` has no exact derivatives: it depends on a model that is known by its values only; \
         do without derivatives = exact (--derivatives exact)"
    )]
    DerivativesUnknown {
        /// The characteristic.
        characteristic: String,
    },
    /// A derivative that does not exist at the means.
    #[error("`{characteristic}` has no derivative by {} at the means: a kink, a jump or the edge of its domain; --derivatives difference steps over it", dimensions.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" and "))]
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
    /// A pair names something that is no dimension.
    #[error("pair `{a}:{b}`: there is no dimension `{unknown}`{}", nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default())]
    UnknownPair {
        /// The first of the pair.
        a: String,
        /// The second of the pair.
        b: String,
        /// The one that is no dimension.
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
    /// A step that is no positive number.
    #[error("the step must be a number of sigmas above 0, not {step}")]
    BadStep {
        /// The step given.
        step: f64,
    },
}

fn advice(fitting: &Option<(&'static str, usize)>) -> String {
    match fitting {
        Some((name, evaluations)) => format!("; --method {name} needs {evaluations}"),
        None => "; no method does with so few".to_owned(),
    }
}
