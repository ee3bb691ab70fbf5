//! Input distributions, one file each, behind one trait.
//!
//! Everything that the derivative methods need of a distribution is its mean, its sigma, its standardised
//! moments and its support; a [`Jacobi`] matrix gives Gauss rules, from which evaluation nodes and quadrature come.
//!
//! # A new distribution
//! One new file with a type that implements [`Distribution`], one line in the list below, one arm where study files
//! name distributions (`study/dimension/spread.rs`), and one row in `tests/suite/distributions.rs`.

mod central_moments;
mod measured;
mod normal;
mod outliers;
mod pearson;
mod probability;
mod rule;
mod sample;
mod standard_moments;
pub(crate) mod standard_normal;
mod uniform;

pub use central_moments::CentralMoments;
pub use measured::Measured;
pub use normal::Normal;
pub use outliers::{extreme, outliers};
pub use pearson::PearsonLaw;
pub use probability::Probability;
pub use rule::{Jacobi, Rule};
pub use sample::{Resample, Reweighted, Sample};
pub use standard_moments::StandardMoments;
pub use uniform::Uniform;

use std::fmt::Debug;

use crate::pearson::PearsonError;

/// A probability distribution of one dimension, with sigma above 0.
///
/// A dimension that does not vary has no distribution at all, so an implementation never divides by zero.
pub trait Distribution: Debug + Send + Sync {
    /// The name that study files use, such as `normal`.
    fn name(&self) -> &'static str;

    /// Mean, in the dimension's own unit.
    fn mean(&self) -> f64;

    /// Standard deviation, in the dimension's own unit; finite and above 0.
    fn sigma(&self) -> f64;

    /// Moments 3 to 8 of `u = (x - mean)/sigma`, analytic wherever a closed form exists.
    fn standard_moments(&self) -> StandardMoments;

    /// Smallest and largest possible value, in the dimension's own unit; infinite where there is no bound or where
    /// it is unknown.
    fn support(&self) -> [f64; 2];

    /// The recurrence coefficients of the orthogonal polynomials of `u = (x - mean)/sigma` up to `order`, or as far
    /// as they are known: a distribution known by eight moments ends at order 4, one with `m` atoms at order `m`.
    fn jacobi(&self, order: usize) -> Jacobi;

    /// Density, probabilities, quantiles and samples; None where only moments are known.
    fn probability(&self) -> Option<&dyn Probability>;

    /// The measured values that the law follows from; None where it was given by parameters.
    fn measured(&self) -> Option<&dyn Resample> {
        None
    }
}

/// What is wrong with a distribution's parameters.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DistributionError {
    /// A parameter is NaN or infinite.
    #[error("{parameter} must be a finite number, not {value}")]
    NotFinite {
        /// Name of the parameter.
        parameter: &'static str,
        /// The value given.
        value: f64,
    },
    /// A spread that must be above 0 is not.
    #[error("{parameter} must be above 0, not {value}")]
    NotPositive {
        /// Name of the parameter.
        parameter: &'static str,
        /// The value given.
        value: f64,
    },
    /// The upper end of an interval is not above its lower end.
    #[error("the lower end {lower} must be below the upper end {upper}")]
    EmptyInterval {
        /// Lower end as given.
        lower: f64,
        /// Upper end as given.
        upper: f64,
    },
    /// No distribution has these moments.
    #[error(
        "no distribution has these central moments: the moment matrix up to m{moment} is not positive \
         (its pivot is {pivot:.3e} after scaling by sigma)"
    )]
    ImpossibleMoments {
        /// The highest moment of the first leading matrix that fails: 4, 6 or 8.
        moment: usize,
        /// The negative pivot, of standardised moments.
        pivot: f64,
    },
    /// Measured values that are all the same, or none at all.
    #[error("{}", no_variation(*count, *value))]
    NoVariation {
        /// How many there are.
        count: usize,
        /// What they are.
        value: Option<f64>,
    },
    /// No Pearson law has these moments.
    #[error("no Pearson law fits: {0}")]
    Pearson(PearsonError),
    /// A Pearson law with tails so long that a moment is infinite.
    #[error(
        "the Pearson law with skewness {skewness:.4} and kurtosis {kurtosis:.4} has tails so long that its moment of \
         order {order} is infinite, and moments up to 8 are needed"
    )]
    InfiniteMoment {
        /// The lowest order whose moment is infinite.
        order: usize,
        /// Third standardised moment.
        skewness: f64,
        /// Fourth standardised moment.
        kurtosis: f64,
    },
}

fn no_variation(count: usize, value: Option<f64>) -> String {
    match (count, value) {
        (1, Some(value)) => format!("one value, {value}, does not vary"),
        (count, Some(value)) => format!("all {count} values are {value}: nothing varies"),
        (_, None) => "there are no values".to_owned(),
    }
}

pub(crate) fn finite(parameter: &'static str, value: f64) -> Result<f64, DistributionError> {
    if value.is_finite() { Ok(value) } else { Err(DistributionError::NotFinite { parameter, value }) }
}

pub(crate) fn positive(parameter: &'static str, value: f64) -> Result<f64, DistributionError> {
    if finite(parameter, value)? > 0.0 { Ok(value) } else { Err(DistributionError::NotPositive { parameter, value }) }
}
