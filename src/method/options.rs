//! The options of an analysis.

use std::fmt;

use std::str::FromStr;

use serde::Serialize;

use crate::method::Method;
use crate::plan::Stencil;
use crate::problem::Problem;
use crate::warning::Figure;
use sensitol_numeric::names::UnknownName;

/// Options of an analysis: method, accuracy, budget and verification.
///
/// ```
/// use sensitol::{Method, Options};
/// let options = Options::from(Method::SixN).with_budget(100);
/// assert_eq!((options.budget, options.stencil), (Some(100), None));
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Method that is run.
    pub method: Method,
    /// Target relative error of sigma, for `auto`; None for `ACCURACY`.
    pub accuracy: Option<f64>,
    /// Requested accuracies of the other results, for `auto`.
    pub accuracies: Accuracies,
    /// Budget: greatest number of evaluations; None for no budget.
    pub budget: Option<usize>,
    /// Step in sigmas that replaces the matched nodes; None to use the matched nodes.
    pub step: Option<f64>,
    /// Pairs that `six-n` examines; None for the strongest.
    pub pairs: Option<Pairs>,
    /// Stencil of a mixed derivative in `six-n`; None for two points.
    pub stencil: Option<Stencil>,
    /// Number of nodes of the quadrature rule of an input: 3, 5 or 7; None for 5. For `dimension-reduction` and
    /// `bivariate-dimension-reduction`.
    pub nodes: Option<usize>,
    /// True if dimensions without tolerance get a sensitivity too, at two evaluations each.
    pub all_sensitivities: bool,
    /// True if the true extremes in the box of the tolerance bands are searched, at further evaluations.
    pub extremes: bool,
    /// Seed of the random numbers; None for [`SEED`](Self::SEED).
    pub seed: Option<u64>,
    /// Source of the derivatives. If None, the reported sensitivities are exact if the assembly function returns derivatives, and the
    /// moments come from differences at nodes that suit each distribution.
    pub derivatives: Option<DerivativeSource>,
    /// Greatest number of check points of the model that verify the result; 0 for no verification. A cheap model is sampled instead, unless
    /// this is 0. If None, [`check_points`](crate::verification::check_points) for a function that declares itself costly
    /// ([`Signature`](crate::assembly::Signature)), and 0 for one that declares neither costly nor cheap, such as a closure.
    pub verify: Option<usize>,
    /// Share of assemblies that must keep the limits of all characteristics at once.
    pub target_joint_yield: Option<f64>,
    /// Share of assemblies that a coverage interval holds, from 0.5 to below 1; None for no coverage intervals.
    pub coverage: Option<f64>,
    /// True if the densities of surface distributions are tabulated, for drawings.
    pub densities: bool,
    /// True if figures of a cheap model replace those of a surface that the model refutes, as in `auto`.
    pub model_figures: bool,
    /// True if `auto` evaluates points of a costly model in tails at whose limits check points refute the surface.
    pub sample_tails: bool,
}

/// Target absolute errors of results other than sigma; None if no accuracy is requested.
///
/// `auto` reaches them by tightening the target error of sigma until the estimates of these errors are small enough too.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Accuracies {
    /// Target absolute error of the skewness.
    pub skewness: Option<f64>,
    /// Target absolute error of the kurtosis.
    pub kurtosis: Option<f64>,
    /// Target absolute error of the yield, as a share.
    pub yield_: Option<f64>,
}

impl Accuracies {
    /// Sets the target absolute error of the skewness.
    #[must_use]
    pub fn with_skewness(mut self, error: f64) -> Self {
        self.skewness = Some(error);
        self
    }

    /// Sets the target absolute error of the kurtosis.
    #[must_use]
    pub fn with_kurtosis(mut self, error: f64) -> Self {
        self.kurtosis = Some(error);
        self
    }

    /// Sets the target absolute error of the yield, as a share.
    #[must_use]
    pub fn with_yield(mut self, error: f64) -> Self {
        self.yield_ = Some(error);
        self
    }

    /// True if the accuracy of any of these figures is requested.
    pub(crate) fn any(&self) -> bool {
        self.wanted().iter().any(|(_, wanted)| wanted.is_some())
    }

    /// Returns each figure with its target error.
    pub(crate) fn wanted(&self) -> [(Figure, Option<f64>); 3] {
        [(Figure::Skewness, self.skewness), (Figure::Kurtosis, self.kurtosis), (Figure::Yield, self.yield_)]
    }
}

/// Source of the derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum DerivativeSource {
    /// Exact at the means, for sensitivities and moments alike. Nothing is evaluated beside the means.
    Exact,
    /// Differences of evaluated points, for sensitivities and moments alike.
    Difference,
}

impl DerivativeSource {
    /// Names of the sources in study files and on the command line.
    pub const NAMES: [&str; 2] = ["exact", "difference"];

    /// Returns the name in study files and on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Difference => "difference",
        }
    }
}

impl fmt::Display for DerivativeSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for DerivativeSource {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        UnknownName::find("source of derivatives", name, &[Self::Exact, Self::Difference], |source| source.name())
    }
}

/// Choice of the interactions that are examined.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Pairs {
    /// Pairs with the largest product of univariate variance shares.
    Strongest,
    /// Neighbours in the order of the dimensions.
    Adjacent,
    /// Listed pairs, by the names of their dimensions.
    Listed(Vec<(String, String)>),
}

impl Pairs {
    /// Names of the choices; listed pairs have no name.
    pub const NAMES: [&str; 2] = ["strongest", "adjacent"];
}

/// Parses a choice that has a name. Listed pairs are given by the names of their dimensions instead.
impl FromStr for Pairs {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        match name {
            "strongest" => Ok(Self::Strongest),
            "adjacent" => Ok(Self::Adjacent),
            _ => Err(UnknownName::of("choice of pairs", name, Self::NAMES.to_vec())),
        }
    }
}

impl Options {
    /// Number of points that the budget allows; None without one. A point may take several evaluations.
    pub(crate) fn points(&self, problem: &Problem) -> Option<usize> {
        self.budget.map(|budget| budget / problem.evaluations_per_point())
    }

    /// Returns true if the results for a function with this signature are verified by points of the model.
    pub fn verifies(&self, of: &crate::assembly::Signature) -> bool {
        self.verify.map_or(of.cheap || of.costly, |points| points > 0)
    }

    /// Seed if none is given, so that the same study gives the same numbers.
    pub const SEED: u64 = 1;

    /// Sets the relative error of sigma that `auto` aims at.
    #[must_use]
    pub fn with_accuracy(mut self, error: f64) -> Self {
        self.accuracy = Some(error);
        self
    }

    /// Sets the errors of the other results that `auto` aims at.
    #[must_use]
    pub fn with_accuracies(mut self, errors: Accuracies) -> Self {
        self.accuracies = errors;
        self
    }

    /// Sets the greatest number of evaluations.
    #[must_use]
    pub fn with_budget(mut self, evaluations: usize) -> Self {
        self.budget = Some(evaluations);
        self
    }

    /// Sets a step in sigmas that replaces the matched nodes.
    #[must_use]
    pub fn with_step(mut self, sigmas: f64) -> Self {
        self.step = Some(sigmas);
        self
    }

    /// Sets the pairs that `six-n` examines.
    #[must_use]
    pub fn with_pairs(mut self, pairs: Pairs) -> Self {
        self.pairs = Some(pairs);
        self
    }

    /// Sets the stencil of the mixed derivatives of `six-n`.
    #[must_use]
    pub fn with_stencil(mut self, stencil: Stencil) -> Self {
        self.stencil = Some(stencil);
        self
    }

    /// Sets the number of nodes in the quadrature rule of an input: 3, 5 or 7.
    #[must_use]
    pub fn with_nodes(mut self, nodes: usize) -> Self {
        self.nodes = Some(nodes);
        self
    }

    /// Adds or omits a sensitivity for dimensions without tolerance.
    #[must_use]
    pub fn with_all_sensitivities(mut self, all: bool) -> Self {
        self.all_sensitivities = all;
        self
    }

    /// Enables or disables the search of the true extremes in the box of the tolerance bands.
    #[must_use]
    pub fn with_extremes(mut self, search: bool) -> Self {
        self.extremes = search;
        self
    }

    /// Sets the seed of the random numbers.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = Some(seed);
        self
    }

    /// Sets the source of the derivatives.
    #[must_use]
    pub fn with_derivatives(mut self, source: DerivativeSource) -> Self {
        self.derivatives = Some(source);
        self
    }

    /// Requests coverage intervals that hold this share of assemblies, from 0.5 to below 1.
    #[must_use]
    pub fn with_coverage(mut self, share: f64) -> Self {
        self.coverage = Some(share);
        self
    }

    /// Enables or disables a table of the density of every surface distribution.
    #[must_use]
    pub fn with_densities(mut self, tabulated: bool) -> Self {
        self.densities = tabulated;
        self
    }

    /// Sets the number of model points that verify the result; 0 for no verification.
    #[must_use]
    pub fn with_verify(mut self, points: usize) -> Self {
        self.verify = Some(points);
        self
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            accuracy: None,
            accuracies: Accuracies::default(),
            budget: None,
            step: None,
            pairs: None,
            stencil: None,
            nodes: None,
            all_sensitivities: false,
            extremes: false,
            seed: None,
            derivatives: None,
            verify: None,
            target_joint_yield: None,
            coverage: None,
            densities: false,
            model_figures: false,
            sample_tails: true,
        }
    }
}

impl From<Method> for Options {
    fn from(method: Method) -> Self {
        Self { method, ..Self::default() }
    }
}
