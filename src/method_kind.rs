//! The names of the methods.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};

use sensitol_numeric::names::UnknownName;

/// A method by name.
///
/// ```
/// use sensitol::Method;
/// assert_eq!("six-n".parse(), Ok(Method::SixN));
/// let error = "six_m".parse::<Method>().unwrap_err();
/// assert_eq!(error.to_string(), "there is no method `six_m`; did you mean `six-n`?");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
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
    /// Every dimension by itself, integrated by its own Gauss rule.
    DimensionReduction,
    /// Every two dimensions together, integrated by products of their Gauss rules.
    BivariateDimensionReduction,
    /// All combinations of three levels of every dimension.
    ThreePoint,
    /// A quadratic fitted by least squares to a central composite design.
    ResponseSurface,
    /// As few evaluations as the wanted accuracy takes.
    Auto,
}

impl Method {
    /// Every method, in the order in which they are listed.
    pub const ALL: [Self; 11] = [
        Self::Auto,
        Self::Rss,
        Self::WorstCase,
        Self::SecondOrder,
        Self::SixN,
        Self::Full,
        Self::Classic,
        Self::DimensionReduction,
        Self::BivariateDimensionReduction,
        Self::ThreePoint,
        Self::ResponseSurface,
    ];

    /// Its name in study files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rss => "rss",
            Self::WorstCase => "worst-case",
            Self::SecondOrder => "second-order",
            Self::SixN => "six-n",
            Self::Full => "full",
            Self::Classic => "classic",
            Self::DimensionReduction => "dimension-reduction",
            Self::BivariateDimensionReduction => "bivariate-dimension-reduction",
            Self::ThreePoint => "three-point",
            Self::ResponseSurface => "response-surface",
            Self::Auto => "auto",
        }
    }

    /// Whether it has a surrogate that can stand beside the model, rather than integrals only.
    pub(crate) fn has_surrogate(self) -> bool {
        !matches!(self, Self::DimensionReduction | Self::BivariateDimensionReduction | Self::ThreePoint)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Method {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        UnknownName::find("method", name, &Self::ALL, |method| method.name())
    }
}

impl Serialize for Method {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}
