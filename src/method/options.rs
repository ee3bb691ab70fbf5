//! What can be chosen about an analysis.

use super::Method;
use crate::plan::Stencil;

/// How a problem is to be analysed.
///
/// ```
/// use sensitol::{Method, Options};
/// let options = Options { budget: Some(100), ..Options::from(Method::SixN) };
/// assert_eq!(options.stencil, None);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The method.
    pub method: Method,
    /// The relative error of sigma that is wanted; for `auto`.
    pub accuracy: Option<f64>,
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
    pub fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Difference => "difference",
        }
    }

    /// The source of this name.
    pub fn by_name(name: &str) -> Option<Self> {
        match name {
            "exact" => Some(Self::Exact),
            "difference" => Some(Self::Difference),
            _ => None,
        }
    }
}

/// Which interactions are examined.
#[derive(Debug, Clone, PartialEq, Eq)]
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

    /// The choice of this name.
    pub fn by_name(name: &str) -> Option<Self> {
        match name {
            "strongest" => Some(Self::Strongest),
            "adjacent" => Some(Self::Adjacent),
            _ => None,
        }
    }
}

impl Options {
    /// The seed where none is given: the same study gives the same numbers.
    pub const SEED: u64 = 1;
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            accuracy: None,
            budget: None,
            step: None,
            pairs: None,
            stencil: None,
            nodes: None,
            all_sensitivities: false,
            extremes: false,
            seed: None,
            derivatives: None,
        }
    }
}

impl From<Method> for Options {
    fn from(method: Method) -> Self {
        Self { method, ..Self::default() }
    }
}
