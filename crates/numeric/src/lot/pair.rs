//! Correlation of two measured dimensions.

use crate::distribution::standard_normal;
use crate::lot::{LotFigure, LotTest, SIDE};

/// Smallest number of rows with an interval: the variance of Fisher's `z` is `1/(n - 3)`.
const FEWEST: usize = 5;
/// Largest magnitude of a correlation whose inverse hyperbolic tangent is used.
const LARGEST: f64 = 1.0 - 1e-12;

/// Correlation with its interval, and the test against an assumed one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CorrelationEstimate {
    /// Correlation of the rows.
    pub figure: LotFigure,
    /// Test against the assumed correlation.
    pub test: LotTest,
    /// Number of rows in which both are measured.
    pub rows: usize,
}

/// Correlation of rows of two dimensions by Fisher's transformation. Returns None of fewer than five rows, or if one of the dimensions
/// does not vary in them.
///
/// Source: R. A. Fisher, On the "probable error" of a coefficient of correlation deduced from a small sample, Metron 1 (1921).
///
/// ```
/// use sensitol_numeric::lot::correlation_estimate;
/// let rows = [[1.0, 2.0], [2.0, 1.0], [3.0, 4.0], [4.0, 3.0], [5.0, 5.0]];
/// let found = correlation_estimate(&rows, 0.0).unwrap();
/// assert!((found.figure.value - 0.8).abs() < 1e-12);
/// ```
pub fn correlation_estimate(rows: &[[f64; 2]], assumed: f64) -> Option<CorrelationEstimate> {
    if rows.len() < FEWEST {
        return None;
    }
    let n = rows.len() as f64;
    let mean = [0, 1].map(|side| rows[0][side] + rows.iter().map(|row| row[side] - rows[0][side]).sum::<f64>() / n);
    let product = |a: usize, b: usize| rows.iter().map(|row| (row[a] - mean[a]) * (row[b] - mean[b])).sum::<f64>();
    let squares = product(0, 0) * product(1, 1);
    if squares.is_nan() || squares <= 0.0 {
        return None;
    }
    let value = (product(0, 1) / squares.sqrt()).clamp(-LARGEST, LARGEST);
    let error = 1.0 / (n - 3.0).sqrt();
    let half = standard_normal::upper_quantile(SIDE) * error;
    let z = libm::atanh(value);
    let interval = [libm::tanh(z - half), libm::tanh(z + half)];
    let off = (z - libm::atanh(assumed.clamp(-LARGEST, LARGEST))).abs() / error;
    let test = LotTest::of(2.0 * standard_normal::cdf(-off));
    Some(CorrelationEstimate { figure: LotFigure { value, interval }, test, rows: rows.len() })
}
