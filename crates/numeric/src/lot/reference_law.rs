//! Tails and quantiles of the chi-squared, Fisher and Student distributions with any degrees of freedom.

use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};
use statrs::function::beta::beta_reg;

use crate::sampling::beta_quantile;

/// Quantile of the chi-squared distribution. NaN if the degrees of freedom are not above 0.
pub fn chi_squared_quantile(p: f64, freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::NAN, |law| law.inverse_cdf(p))
}

/// Two-sided p-value of a chi-squared statistic: twice the smaller tail, at most 1.
pub(crate) fn chi_squared_two_sided(statistic: f64, freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::NAN, |law| (2.0 * law.cdf(statistic).min(law.sf(statistic))).min(1.0))
}

/// Two-sided p-value of Student's `t`. NaN if the degrees of freedom are not above 0.
pub fn student_two_sided(t: f64, freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |law| 2.0 * law.sf(t.abs()))
}

/// Probability that Fisher's `F` with these degrees of freedom is above a value.
pub fn fisher_sf(f: f64, [above, below]: [f64; 2]) -> f64 {
    if f.is_nan() || f <= 0.0 {
        return 1.0;
    }
    if f.is_infinite() {
        return 0.0;
    }
    beta_reg(0.5 * below, 0.5 * above, below / (below + above * f))
}

/// Quantile of Fisher's distribution with these degrees of freedom.
pub fn fisher_quantile(p: f64, [above, below]: [f64; 2]) -> f64 {
    let x = beta_quantile(0.5 * above, 0.5 * below, p);
    below * x / (above * (1.0 - x))
}
