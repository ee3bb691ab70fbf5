//! Mean and sigma of a dimension after a lot, with the study as prior: the normal-inverse-gamma distribution.
//!
//! ```text
//! mean | variance ~ normal(m, variance/k),   variance ~ inverse gamma(v/2, v s^2/2)
//! ```
//!
//! A prior of the weight `w` stands for `w` parts with the assumed mean and sigma: `k = w`, `v = w - 1`. A lot of `n` parts with mean `x`
//! and sum of squares `S` about it gives `k' = k + n`, `m' = (k m + n x)/k'`, `v' = v + n` and
//! `v' s'^2 = v s^2 + S + k n (x - m)^2/k'`. Without a prior the figures are those of the lot.
//!
//! Source: A. Gelman et al., Bayesian Data Analysis, 3rd edition (2013), section 3.3.

use crate::lot::reference_law::chi_squared_quantile;
use crate::lot::{LotFigure, LotSample, SIDE};
use crate::sampling::student_quantile;

/// Assumed mean and sigma of a dimension, with their weight in parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalPrior {
    /// Assumed mean.
    pub mean: f64,
    /// Assumed standard deviation.
    pub sigma: f64,
    /// Number of parts that the assumption is worth; 0 for none, else above 1.
    pub parts: f64,
}

/// Mean and sigma of a dimension after a lot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posterior {
    /// Mean with its 95 % interval.
    pub mean: LotFigure,
    /// Standard deviation with its 95 % interval. The value is that of the posterior's expected precision.
    pub sigma: LotFigure,
    /// Standard deviation of the next part, with the uncertainty of mean and sigma. None of fewer than three degrees of freedom.
    pub predictive_sigma: Option<f64>,
    /// Weight of the lot in the posterior mean.
    pub weight: f64,
}

impl NormalPrior {
    /// Posterior after a lot.
    ///
    /// ```
    /// use sensitol_numeric::lot::{LotSample, NormalPrior};
    /// let column = LotSample::new(&[1.0, 2.0, 3.0]).unwrap();
    /// let alone = NormalPrior { mean: 0.0, sigma: 1.0, parts: 0.0 }.updated(&column);
    /// assert_eq!((alone.mean.value, alone.sigma.value, alone.weight), (2.0, 1.0, 1.0));
    /// let heavy = NormalPrior { mean: 0.0, sigma: 1.0, parts: 3.0 }.updated(&column);
    /// assert_eq!(heavy.mean.value, 1.0);
    /// ```
    pub fn updated(&self, column: &LotSample) -> Posterior {
        let n = column.count() as f64;
        let squares = (n - 1.0) * column.sigma().powi(2);
        let weight = n / (n + self.parts);
        let mean = self.mean + weight * (column.mean() - self.mean);
        let (freedom, scale) = if self.parts > 1.0 {
            let freedom = self.parts - 1.0 + n;
            let apart = self.parts * weight * (column.mean() - self.mean).powi(2);
            (freedom, (self.parts - 1.0) * self.sigma.powi(2) + squares + apart)
        } else {
            (n - 1.0, squares)
        };
        let variance = scale / freedom;
        let parts = n + self.parts;
        let half = student_quantile(1.0 - SIDE, freedom) * (variance / parts).sqrt();
        let end = |p: f64| (scale / chi_squared_quantile(p, freedom)).sqrt();
        let predictive = (freedom > 2.0).then(|| (variance * (1.0 + 1.0 / parts) * freedom / (freedom - 2.0)).sqrt());
        Posterior {
            mean: LotFigure { value: mean, interval: [mean - half, mean + half] },
            sigma: LotFigure { value: variance.sqrt(), interval: [end(1.0 - SIDE), end(SIDE)] },
            predictive_sigma: predictive,
            weight,
        }
    }
}
