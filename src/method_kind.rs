//! Methods by name.

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use sensitol_numeric::names::UnknownName;

/// Analysis method by name.
///
/// ```
/// use sensitol::Method;
/// assert_eq!("six-n".parse(), Ok(Method::SixN));
/// let error = "six_m".parse::<Method>().unwrap_err();
/// assert_eq!(error.to_string(), "there is no method `six_m`; did you mean `six-n`?");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(inline))]
#[serde(into = "&'static str")]
#[non_exhaustive]
pub enum Method {
    /// First order: root of the sum of squares.
    Rss,
    /// First order: sum of absolute values.
    WorstCase,
    /// First and second derivatives, without mixed ones.
    SecondOrder,
    /// Five-point axes and the strongest interactions.
    SixN,
    /// Every second derivative.
    Full,
    /// Every second derivative by the published four-point stencil.
    Classic,
    /// Every dimension alone, integrated by its own Gauss rule.
    DimensionReduction,
    /// Every pair of dimensions, integrated by products of their Gauss rules.
    BivariateDimensionReduction,
    /// All combinations of three levels of every dimension.
    ThreePoint,
    /// A quadratic fitted by least squares to a central composite design.
    ResponseSurface,
    /// Fewest evaluations that reach the requested accuracy.
    Auto,
}

impl Method {
    /// Methods in the order in which they are listed.
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

    /// Name in study files and on the command line.
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

    /// True if the method fits a surrogate. Methods of integration only compute integrals.
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

impl From<Method> for &'static str {
    fn from(method: Method) -> Self {
        method.name()
    }
}
