//! Errors of correlations that no inputs can have.

use faer::Mat;

use crate::dimension::Dimension;
use crate::names::nearest;

/// Error of a refused correlation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{refusal}")]
#[non_exhaustive]
pub struct CorrelationError {
    /// Index of the pair at fault. None if the fault is in all pairs together.
    pub pair: Option<usize>,
    /// Reason of the refusal.
    pub refusal: Refusal,
}

/// Fault of a correlation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// A pair names an unknown dimension.
    #[error("there is no dimension `{name}`{}", nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default())]
    UnknownDimension {
        /// Unknown name as given.
        name: String,
        /// Most similar name of a dimension, if any.
        nearest: Option<String>,
    },
    /// A dimension of the pair does not vary.
    #[error("`{name}` does not vary, so nothing is correlated with it: give it a tolerance, or remove the pair")]
    DoesNotVary {
        /// Name of the fixed dimension.
        name: String,
    },
    /// A dimension of the pair is known by its moments only.
    #[error("`{name}` is known by its moments only; a correlation needs its distribution")]
    MomentsOnly {
        /// Name of the dimension without a distribution.
        name: String,
    },
    /// A dimension of the pair may have any distribution.
    #[error("`{name}` may have any distribution; a correlation needs a known one")]
    AnyDistribution {
        /// Name of the dimension.
        name: String,
    },
    /// The pair names one dimension twice.
    #[error("`{name}` stands at both ends; a correlation is between two dimensions")]
    WithItself {
        /// Name of the dimension at both ends.
        name: String,
    },
    /// The pair appears twice.
    #[error("the correlation between `{}` and `{}` is given twice", between[0], between[1])]
    Twice {
        /// Names of the two dimensions.
        between: [String; 2],
    },
    /// The value is not a coefficient of correlation.
    #[error("a correlation lies between -1 and 1, but is {value}")]
    NoCoefficient {
        /// Value given, outside -1 to 1.
        value: f64,
    },
    /// The value is outside the range that the two distributions allow.
    #[error(
        "`{}` and `{}` cannot be correlated by {value}: their distributions allow {:.4} to {:.4}",
        between[0], between[1], range[0], range[1]
    )]
    Unreachable {
        /// Names of the two dimensions.
        between: [String; 2],
        /// Coefficient of correlation as given.
        value: f64,
        /// Least and greatest coefficient that the two distributions allow.
        range: [f64; 2],
    },
    /// The pairs contradict each other.
    #[error("no distribution has these correlations together; the nearest that one has: {}", words(nearest))]
    NoSuchMatrix {
        /// Nearest correlation matrix, by pairs.
        nearest: Vec<([String; 2], f64)>,
    },
    /// The pairs together exceed the range that the distributions allow.
    #[error(
        "these correlations together are more than the distributions of the dimensions allow; near what they do: {}",
        words(nearest)
    )]
    NotForTheseDistributions {
        /// Correlations near the nearest possible ones, by pairs.
        nearest: Vec<([String; 2], f64)>,
    },
}

/// Greatest number of pairs of a large matrix in a message.
const SHOWN: usize = 12;

fn words(pairs: &[([String; 2], f64)]) -> String {
    let pair = |(between, value): &([String; 2], f64)| format!("{}-{} {value:.4}", between[0], between[1]);
    let mut text = pairs.iter().take(SHOWN).map(pair).collect::<Vec<_>>().join(", ");
    if pairs.len() > SHOWN {
        text += &format!(" and {} more", pairs.len() - SHOWN);
    }
    text
}

impl Refusal {
    pub(super) fn unknown(name: &str, dimensions: &[Dimension]) -> Self {
        let nearest = nearest(name, dimensions.iter().map(Dimension::name)).map(str::to_owned);
        Self::UnknownDimension { name: name.to_owned(), nearest }
    }
}

impl CorrelationError {
    pub(super) fn indefinite(
        refusal: impl FnOnce(Vec<([String; 2], f64)>) -> Refusal,
        names: &[String],
        nearest: &Mat<f64>,
    ) -> Self {
        let pair = |j: usize, k: usize| ([names[j].clone(), names[k].clone()], nearest[(j, k)]);
        let pairs = (0..names.len()).flat_map(|j| (j + 1..names.len()).map(move |k| (j, k)));
        Self { pair: None, refusal: refusal(pairs.map(|(j, k)| pair(j, k)).collect()) }
    }
}
