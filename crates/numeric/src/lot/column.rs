//! Measured values of one dimension, with mean and standard deviation.

use crate::lot::reference_law::chi_squared_quantile;
use crate::lot::{LotFigure, SIDE};
use crate::sampling::student_quantile;

/// Measured values of one dimension with their mean and standard deviation.
#[derive(Debug, Clone, PartialEq)]
pub struct LotSample {
    values: Vec<f64>,
    mean: f64,
    sigma: f64,
}

impl LotSample {
    /// Returns the column of these values. Returns None of fewer than two different values.
    ///
    /// ```
    /// use sensitol_numeric::lot::LotSample;
    /// let column = LotSample::new(&[9.0, 10.0, 11.0]).unwrap();
    /// assert_eq!((column.mean(), column.sigma()), (10.0, 1.0));
    /// assert!(LotSample::new(&[9.0, 9.0]).is_none());
    /// ```
    pub fn new(values: &[f64]) -> Option<Self> {
        let origin = *values.first()?;
        let n = values.len() as f64;
        let off = values.iter().map(|value| value - origin).sum::<f64>() / n;
        let squares: f64 = values.iter().map(|value| (value - origin - off).powi(2)).sum();
        let sigma = (squares / (n - 1.0)).sqrt();
        let column = Self { values: values.to_vec(), mean: origin + off, sigma };
        (sigma > 0.0 && sigma.is_finite()).then_some(column)
    }

    /// Values in the order of measurement.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Number of values.
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// Arithmetic mean.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation with the divisor `n - 1`.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Degrees of freedom of the variance if the values have this excess kurtosis: those of a chi-squared variable with the variance
    /// `sigma^4 (2/(n-1) + excess/n)`. They are `n - 1` of normal values.
    ///
    /// Source: G. E. P. Box, Non-normality and tests on variances, Biometrika 40 (1953).
    pub fn freedom(&self, excess: f64) -> f64 {
        box_freedom(self.count() as f64, excess)
    }

    /// Mean with its 95 % interval by Student's distribution.
    pub fn mean_figure(&self) -> LotFigure {
        let n = self.count() as f64;
        let half = student_quantile(1.0 - SIDE, n - 1.0) * self.sigma / n.sqrt();
        LotFigure { value: self.mean, interval: [self.mean - half, self.mean + half] }
    }

    /// Standard deviation with its 95 % interval: exact for normal values, and with the [degrees of freedom](Self::freedom) of an excess
    /// kurtosis otherwise.
    pub fn sigma_figure(&self, excess: f64) -> LotFigure {
        let freedom = self.freedom(excess);
        let end = |p: f64| self.sigma * (freedom / chi_squared_quantile(p, freedom)).sqrt();
        LotFigure { value: self.sigma, interval: [end(1.0 - SIDE), end(SIDE)] }
    }
}

/// Degrees of freedom of the variance of `n` values with this excess kurtosis.
pub(super) fn box_freedom(n: f64, excess: f64) -> f64 {
    // A kurtosis is at least 1, so the excess is at least -2, for which the sum would be below 0.
    let part = 2.0 / (n - 1.0) + excess.max(-1.9) / n;
    if excess.is_finite() && part > 0.0 { 2.0 / part } else { n - 1.0 }
}
