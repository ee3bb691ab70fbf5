//! Errors of distributions, and the checks that all of them use.

use crate::pearson::PearsonError;

/// Invalid parameters of a distribution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DistributionError {
    /// A parameter is NaN or infinite.
    #[error("{parameter} must be a finite number, not {value}")]
    NotFinite {
        /// Name of the parameter.
        parameter: &'static str,
        /// Value as given.
        value: f64,
    },
    /// A spread is not above 0.
    #[error("{parameter} must be above 0, not {value}")]
    NotPositive {
        /// Name of the parameter.
        parameter: &'static str,
        /// Value as given.
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
    /// A parameter is outside its range.
    #[error("{parameter} must be {range}, not {value}")]
    OutOfRange {
        /// Name of the parameter.
        parameter: &'static str,
        /// Value as given.
        value: f64,
        /// Permitted range, in words.
        range: &'static str,
    },
    /// The mean of a distribution that begins at an origin does not lie above it.
    #[error("the mean {mean} must lie above the origin {origin}, where the distribution begins")]
    NotAboveOrigin {
        /// Mean as given.
        mean: f64,
        /// Least value of the distribution.
        origin: f64,
    },
    /// A tail is so long, or a spread so small, that doubles cannot describe it.
    #[error(
        "sigma {sigma} is {:.3e} times the distance {distance} of the mean from the origin: \
         {least:e} to {largest} times can be computed",
        sigma / distance
    )]
    SigmaToMean {
        /// Sigma as given.
        sigma: f64,
        /// Distance of the mean from the origin.
        distance: f64,
        /// Least ratio of sigma to the distance.
        least: f64,
        /// Largest ratio of sigma to the distance.
        largest: f64,
    },
    /// A Student distribution has so few degrees of freedom that its variance is infinite.
    #[error(
        "a student distribution of {degrees} degrees of freedom has no sigma, by which every method scales: it needs more than 2, as \
         four readings give; with fewer, state a sigma from experience, or give measured values"
    )]
    NoSigma {
        /// Degrees of freedom as given.
        degrees: f64,
    },
    /// The parameters are valid, but figures that follow from them are beyond the range of doubles.
    #[error("this distribution cannot be computed: {reason}")]
    NoLaw {
        /// Reason, as text.
        reason: String,
    },
    /// A mixture has no parts.
    #[error("a mixture needs at least one part")]
    NoParts,
    /// The weight of a part of a mixture is not a number above 0.
    #[error("the weight of part `{part}` must be a number above 0, not {weight}")]
    BadWeight {
        /// Name of the part.
        part: String,
        /// Weight as given.
        weight: f64,
    },
    /// A part of a mixture is known by moments alone.
    #[error("part `{part}` is known by moments alone: a mixture needs whole distributions")]
    NotWhole {
        /// Name of the part.
        part: String,
    },
    /// No distribution has these moments.
    #[error(
        "no distribution has these central moments: the moment matrix up to m{moment} is not positive \
         (its pivot is {pivot:.3e} after scaling by sigma)"
    )]
    ImpossibleMoments {
        /// Highest moment of the first leading matrix that fails: 4, 6 or 8.
        moment: usize,
        /// Negative pivot, of standardised moments.
        pivot: f64,
    },
    /// All measured values are equal, or there are none.
    #[error("{}", no_variation(*count, *value))]
    NoVariation {
        /// Number of values.
        count: usize,
        /// Common value of all; None if there are no values.
        value: Option<f64>,
    },
    /// No Pearson distribution has these moments.
    #[error("no Pearson law fits: {0}")]
    Pearson(PearsonError),
    /// The tails of a Pearson distribution are so long that a moment is infinite.
    #[error(
        "the Pearson law with skewness {skewness:.4} and kurtosis {kurtosis:.4} has tails so long that its moment of \
         order {order} is infinite, and moments up to 8 are needed"
    )]
    InfiniteMoment {
        /// Lowest order whose moment is infinite.
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

/// Middle and half-width of an interval.
pub(crate) fn interval(lower: f64, upper: f64) -> Result<[f64; 2], DistributionError> {
    finite("the lower limit", lower)?;
    finite("the upper limit", upper)?;
    if lower >= upper {
        return Err(DistributionError::EmptyInterval { lower, upper });
    }
    let half = 0.5 * upper - 0.5 * lower;
    Ok([lower + half, half])
}

/// Value if it lies between two others, an error otherwise. `range` is the permitted range in words.
pub(crate) fn between(
    parameter: &'static str,
    value: f64,
    [least, largest]: [f64; 2],
    range: &'static str,
) -> Result<f64, DistributionError> {
    if (least..=largest).contains(&finite(parameter, value)?) {
        Ok(value)
    } else {
        Err(DistributionError::OutOfRange { parameter, value, range })
    }
}
