//! Distribution of which only moments are known.

use crate::distribution::{Distribution, DistributionError, Jacobi, Probability, StandardMoments, finite, positive};

/// Distribution known only by its mean and its central moments 2 to 8, as a quality system exports them.
///
/// The derivative methods need only these. Sampling needs the whole distribution and rejects such a dimension.
///
/// ```
/// use sensitol_numeric::distribution::{CentralMoments, Distribution};
/// // An exponential distribution with mean 10 and sigma 1.
/// let wear = CentralMoments::new(10.0, [1.0, 2.0, 9.0, 44.0, 265.0, 1854.0, 14833.0])?;
/// assert_eq!(wear.standard_moments().skewness, 2.0);
/// // A kurtosis must exceed the squared skewness by 1 at least.
/// assert!(CentralMoments::new(10.0, [1.0, 2.0, 4.5, 44.0, 265.0, 1854.0, 14833.0]).is_err());
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct CentralMoments {
    mean: f64,
    sigma: f64,
    standard: StandardMoments,
    jacobi: Jacobi,
}

impl CentralMoments {
    /// Distribution with the central moments `m2 ..= m8`, in powers of the dimension's unit.
    ///
    /// # Errors
    /// Returns an error if a value is not finite, `m2` is not above 0, or no distribution has these moments.
    pub fn new(mean: f64, central: [f64; 7]) -> Result<Self, DistributionError> {
        const NAMES: [&str; 7] = ["m2", "m3", "m4", "m5", "m6", "m7", "m8"];
        finite("mean", mean)?;
        for (name, value) in NAMES.into_iter().zip(central) {
            finite(name, value)?;
        }
        positive("m2", central[0])?;
        let standard = StandardMoments::from_central(&central);
        for (name, value) in NAMES.into_iter().zip(&standard.raw()[2..]) {
            // Sigma may be so small that the moments scaled by it leave the range of a double.
            finite(name, *value)?;
        }
        Ok(Self { mean, sigma: central[0].sqrt(), jacobi: Jacobi::from_moments(&standard)?, standard })
    }
}

impl Distribution for CentralMoments {
    fn name(&self) -> &'static str {
        "moments"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    fn standard_moments(&self) -> StandardMoments {
        self.standard
    }

    /// Unbounded interval, because the support is unknown.
    fn support(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    fn jacobi(&self, order: usize) -> Jacobi {
        self.jacobi.truncated(order)
    }

    fn probability(&self) -> Option<&dyn Probability> {
        None
    }
}
