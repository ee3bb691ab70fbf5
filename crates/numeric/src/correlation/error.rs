//! Correlations that no inputs have.

use faer::Mat;

use crate::dimension::Dimension;
use crate::names::nearest;

/// Why a correlation is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{refusal}")]
#[non_exhaustive]
pub struct CorrelationError {
    /// Which of the pairs, where it is one of them.
    pub pair: Option<usize>,
    /// Why.
    pub refusal: Refusal,
}

/// The faults of a correlation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// A pair names something that is not a dimension.
    #[error("there is no dimension `{name}`{}", nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default())]
    UnknownDimension {
        /// The name.
        name: String,
        /// The most similar dimension.
        nearest: Option<String>,
    },
    /// An end that has no tolerance.
    #[error("`{name}` does not vary, so nothing is correlated with it: give it a tolerance, or remove the pair")]
    DoesNotVary {
        /// The dimension.
        name: String,
    },
    /// An end of which only moments are known.
    #[error("`{name}` is known by its moments only; a correlation needs its distribution")]
    MomentsOnly {
        /// The dimension.
        name: String,
    },
    /// Both ends are one dimension.
    #[error("`{name}` stands at both ends; a correlation is between two dimensions")]
    WithItself {
        /// The dimension.
        name: String,
    },
    /// A pair that stands twice.
    #[error("the correlation between `{}` and `{}` is given twice", between[0], between[1])]
    Twice {
        /// The dimensions.
        between: [String; 2],
    },
    /// A value that is not a coefficient.
    #[error("a correlation lies between -1 and 1, but is {value}")]
    NoCoefficient {
        /// The value.
        value: f64,
    },
    /// More than the two distributions can have.
    #[error(
        "`{}` and `{}` cannot be correlated by {value}: their distributions allow {:.4} to {:.4}",
        between[0], between[1], range[0], range[1]
    )]
    Unreachable {
        /// The dimensions.
        between: [String; 2],
        /// The value.
        value: f64,
        /// The least and the greatest that they can have.
        range: [f64; 2],
    },
    /// Pairs that contradict each other.
    #[error("no distribution has these correlations together; the nearest that one has: {}", words(nearest))]
    NoSuchMatrix {
        /// The nearest correlation matrix, by pairs.
        nearest: Vec<([String; 2], f64)>,
    },
    /// Pairs that together are too much for these distributions.
    #[error(
        "these correlations together are more than the distributions of the dimensions allow; near what they do: {}",
        words(nearest)
    )]
    NotForTheseDistributions {
        /// Near what they allow, by pairs.
        nearest: Vec<([String; 2], f64)>,
    },
}

/// Pairs that are shown of a large matrix.
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
