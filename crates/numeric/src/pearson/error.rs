//! Errors for moments that no distribution of the Pearson system has.

/// Distribution with two values: the least kurtosis of all distributions with its skewness. Mean 0, variance 1.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TwoPoint {
    /// Two values, in sigmas from the mean.
    pub values: [f64; 2],
    /// Probabilities of the two values.
    pub probabilities: [f64; 2],
}

impl TwoPoint {
    /// Distribution with the values `(s ± sqrt(s^2 + 4)) / 2`: their product is -1, and the mean fixes the probabilities.
    ///
    /// ```
    /// use sensitol_numeric::pearson::TwoPoint;
    /// let coin = TwoPoint::with_skewness(0.0);
    /// assert_eq!((coin.values, coin.probabilities), ([-1.0, 1.0], [0.5, 0.5]));
    /// ```
    pub fn with_skewness(skewness: f64) -> Self {
        let far = 0.5 * (skewness.abs() + libm::hypot(skewness.abs(), 2.0));
        let rare = 1.0 / (1.0 + far * far);
        let law = Self { values: [-1.0 / far, far], probabilities: [1.0 - rare, rare] };
        match skewness < 0.0 {
            true => Self { values: [-far, 1.0 / far], probabilities: [rare, 1.0 - rare] },
            false => law,
        }
    }
}

/// Error for moments that no member of the Pearson system has.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PearsonError {
    /// A moment is NaN or infinite.
    #[error("a moment is not a finite number")]
    NotFinite,
    /// Sigma is 0 or negative.
    #[error("sigma must be above 0, not {sigma}")]
    Sigma {
        /// Standard deviation as given.
        sigma: f64,
    },
    /// No distribution at all has this pair: the kurtosis must exceed 1 + skewness squared, which two-point distributions attain.
    #[error(
        "{}: it must be above 1 + skewness^2 = {bound}, which is attained only by two values, {:.4} and {:.4} sigma off \
         the mean with probabilities {:.4} and {:.4}",
        below(*skewness, *kurtosis, *bound), law.values[0], law.values[1], law.probabilities[0], law.probabilities[1]
    )]
    Infeasible {
        /// Third standardised moment as given.
        skewness: f64,
        /// Fourth standardised moment as given.
        kurtosis: f64,
        /// Bound that the kurtosis must exceed.
        bound: f64,
        /// Two-point distribution that attains the bound.
        law: TwoPoint,
    },
    /// The moments are possible, but too large for double precision.
    #[error("kurtosis {kurtosis:e} is beyond 1e100")]
    TooLarge {
        /// Fourth standardised moment as given.
        kurtosis: f64,
    },
}

impl PearsonError {
    pub(super) fn infeasible(skewness: f64, kurtosis: f64) -> Self {
        let bound = 1.0 + skewness * skewness;
        Self::Infeasible { skewness, kurtosis, bound, law: TwoPoint::with_skewness(skewness) }
    }
}

/// Text on the distance of a kurtosis below the bound.
fn below(skewness: f64, kurtosis: f64, bound: f64) -> String {
    match bound - kurtosis {
        0.0 => format!("with skewness {skewness} the kurtosis {kurtosis} is the least that there is"),
        far => format!(
            "with skewness {skewness} no distribution has the kurtosis {kurtosis}, which is {far:.3e} too small"
        ),
    }
}
