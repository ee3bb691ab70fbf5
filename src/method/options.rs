//! The options of an analysis.

use std::fmt;

use std::str::FromStr;

use super::Method;
use crate::plan::Stencil;
use crate::warning::Figure;
use sensitol_numeric::names::UnknownName;

/// How a problem is to be analysed.
///
/// ```
/// use sensitol::{Method, Options};
/// let options = Options::from(Method::SixN).with_budget(100);
/// assert_eq!((options.budget, options.stencil), (Some(100), None));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The method.
    pub method: Method,
    /// The relative error of sigma that is wanted; for `auto`.
    pub accuracy: Option<f64>,
    /// The accuracies to reach of the other results; for `auto`.
    pub accuracies: Accuracies,
    /// The most evaluations that may be spent.
    pub budget: Option<usize>,
    /// A step in sigmas in place of the matched nodes.
    pub step: Option<f64>,
    /// Which pairs `six-n` examines; the strongest unless said otherwise.
    pub pairs: Option<Pairs>,
    /// How `six-n` evaluates a mixed derivative; by two points unless said otherwise.
    pub stencil: Option<Stencil>,
    /// How many nodes the quadrature rule of an input has: 3, 5 or 7, and 5 unless said otherwise; for
    /// `dimension-reduction` and `bivariate-dimension-reduction`.
    pub nodes: Option<usize>,
    /// Whether dimensions without tolerance get a sensitivity too, at two evaluations each.
    pub all_sensitivities: bool,
    /// Whether the true extremes in the box of the tolerance bands are searched, at further evaluations.
    pub extremes: bool,
    /// The seed of what draws random numbers: [`SEED`](Self::SEED) unless given.
    pub seed: Option<u64>,
    /// Where derivatives come from. Unless said otherwise the reported sensitivities are exact where the assembly function
    /// knows its derivatives, and moments come from differences at nodes that suit each distribution.
    pub derivatives: Option<DerivativeSource>,
    /// Whether the result is verified by the model itself: a cheap model is sampled unless this is 0, a
    /// costly one evaluated at no more check points than this, 18 at most. Unless said otherwise [`Options::VERIFY`] where the function
    /// says that it is cheap or costly ([`Signature`](crate::assembly::Signature)), and 0 where it says neither, as a closure.
    pub verify: Option<usize>,
    /// The share of assemblies that must keep the limits of all characteristics at once.
    pub target_joint_yield: Option<f64>,
    /// The share that coverage intervals hold, from 0.5 to below 1; without it there are none.
    pub coverage: Option<f64>,
    /// Whether the densities of surface laws are tabulated, for those who draw them.
    pub densities: bool,
    /// Whether figures of a cheap model take the place of those of a surface that it refutes, as `auto` has it.
    pub model_figures: bool,
}

/// The errors that are wanted beside that of sigma, absolute; None where nothing is.
///
/// They are reached by the same means: the wanted error of sigma is tightened until these estimates are small enough too.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Accuracies {
    /// Of the skewness.
    pub skewness: Option<f64>,
    /// Of the kurtosis.
    pub kurtosis: Option<f64>,
    /// Of the yield, as a share.
    pub yield_: Option<f64>,
}

impl Accuracies {
    /// With this absolute error of the skewness.
    #[must_use]
    pub fn with_skewness(mut self, error: f64) -> Self {
        self.skewness = Some(error);
        self
    }

    /// With this absolute error of the kurtosis.
    #[must_use]
    pub fn with_kurtosis(mut self, error: f64) -> Self {
        self.kurtosis = Some(error);
        self
    }

    /// With this absolute error of the yield, as a share.
    #[must_use]
    pub fn with_yield(mut self, error: f64) -> Self {
        self.yield_ = Some(error);
        self
    }

    /// Whether any is wanted.
    pub(crate) fn any(&self) -> bool {
        self.wanted().iter().any(|(_, wanted)| wanted.is_some())
    }

    /// Each with its figure.
    pub(crate) fn wanted(&self) -> [(Figure, Option<f64>); 3] {
        [(Figure::Skewness, self.skewness), (Figure::Kurtosis, self.kurtosis), (Figure::Yield, self.yield_)]
    }
}

/// Where derivatives come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DerivativeSource {
    /// Exact at the means, for sensitivities and moments alike: nothing is evaluated beside the means.
    Exact,
    /// Differences of evaluated points, for sensitivities and moments alike.
    Difference,
}

impl DerivativeSource {
    /// The names of the sources.
    pub const NAMES: [&str; 2] = ["exact", "difference"];

    /// Its name in study files and on the command line.
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

/// Which interactions are examined.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Pairs {
    /// Those with the largest product of univariate variance shares.
    Strongest,
    /// Neighbours in the order of the dimensions.
    Adjacent,
    /// These, by the names of their dimensions.
    Listed(Vec<(String, String)>),
}

impl Pairs {
    /// The choices that have a name.
    pub const NAMES: [&str; 2] = ["strongest", "adjacent"];
}

/// The choices that have a name; pairs are given by the names of their dimensions.
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
    /// Check points of a costly model where [`verify`](Self::verify) does not say; a cheap one is sampled.
    pub const VERIFY: usize = 12;

    /// How a result of such a function is verified: 0 for not at all.
    pub fn verification(&self, of: &crate::assembly::Signature) -> usize {
        self.verify.unwrap_or(if of.cheap || of.costly { Self::VERIFY } else { 0 })
    }

    /// The seed where none is given: the same study gives the same numbers.
    pub const SEED: u64 = 1;

    /// With this relative error of sigma as the aim of `auto`.
    #[must_use]
    pub fn with_accuracy(mut self, error: f64) -> Self {
        self.accuracy = Some(error);
        self
    }

    /// With these errors of the other results as the aim of `auto`.
    #[must_use]
    pub fn with_accuracies(mut self, errors: Accuracies) -> Self {
        self.accuracies = errors;
        self
    }

    /// With at most so many evaluations.
    #[must_use]
    pub fn with_budget(mut self, evaluations: usize) -> Self {
        self.budget = Some(evaluations);
        self
    }

    /// With this step in sigmas in place of the matched nodes.
    #[must_use]
    pub fn with_step(mut self, sigmas: f64) -> Self {
        self.step = Some(sigmas);
        self
    }

    /// With these pairs examined by `six-n`.
    #[must_use]
    pub fn with_pairs(mut self, pairs: Pairs) -> Self {
        self.pairs = Some(pairs);
        self
    }

    /// With mixed derivatives of `six-n` evaluated so.
    #[must_use]
    pub fn with_stencil(mut self, stencil: Stencil) -> Self {
        self.stencil = Some(stencil);
        self
    }

    /// With so many nodes in the quadrature rule of an input: 3, 5 or 7.
    #[must_use]
    pub fn with_nodes(mut self, nodes: usize) -> Self {
        self.nodes = Some(nodes);
        self
    }

    /// With a sensitivity for dimensions without tolerance, or without one.
    #[must_use]
    pub fn with_all_sensitivities(mut self, all: bool) -> Self {
        self.all_sensitivities = all;
        self
    }

    /// With a search of the true extremes in the box of the tolerance bands, or without one.
    #[must_use]
    pub fn with_extremes(mut self, search: bool) -> Self {
        self.extremes = search;
        self
    }

    /// With this seed of what draws random numbers.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = Some(seed);
        self
    }

    /// With derivatives from this source.
    #[must_use]
    pub fn with_derivatives(mut self, source: DerivativeSource) -> Self {
        self.derivatives = Some(source);
        self
    }

    /// With the intervals that hold this share of assemblies, from 0.5 to below 1.
    #[must_use]
    pub fn with_coverage(mut self, share: f64) -> Self {
        self.coverage = Some(share);
        self
    }

    /// With a table of the density of every surface law, or without one.
    #[must_use]
    pub fn with_densities(mut self, tabulated: bool) -> Self {
        self.densities = tabulated;
        self
    }

    /// Verified by the model itself at so many points; 0 for not at all.
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
        }
    }
}

impl From<Method> for Options {
    fn from(method: Method) -> Self {
        Self { method, ..Self::default() }
    }
}
