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
    /// Whether dimensions without tolerance get a sensitivity too, at two evaluations each.
    pub all_sensitivities: bool,
    /// Whether the true extremes in the box of the tolerance bands are searched, at further evaluations.
    pub extremes: bool,
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

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            accuracy: None,
            budget: None,
            step: None,
            pairs: None,
            stencil: None,
            all_sensitivities: false,
            extremes: false,
        }
    }
}

impl From<Method> for Options {
    fn from(method: Method) -> Self {
        Self { method, ..Self::default() }
    }
}
