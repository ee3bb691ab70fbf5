//! Drift over a lot: the straight line through the values in their order, or over a time.

use crate::lot::reference_law::student_two_sided;
use crate::lot::{LotFigure, LotTest, SIDE};
use crate::sampling::student_quantile;

/// Straight line through measured values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LotTrend {
    /// Change of the mean from the first part to the last.
    pub change: LotFigure,
    /// Test against no change.
    pub test: LotTest,
}

/// Least-squares line of the values over `at`, with Student's interval and test of its slope. Returns None of fewer than four values, of
/// places that do not differ, or if the values lie on a line.
///
/// ```
/// use sensitol_numeric::lot::linear_trend;
/// let trend = linear_trend(&[0.0, 1.0, 2.0, 3.0], &[1.0, 2.1, 2.9, 4.0]).unwrap();
/// assert!((trend.change.value - 2.94).abs() < 1e-12);
/// ```
pub fn linear_trend(at: &[f64], values: &[f64]) -> Option<LotTrend> {
    let n = values.len() as f64;
    if values.len() < 4 || at.len() != values.len() {
        return None;
    }
    let mean = |all: &[f64]| all[0] + all.iter().map(|one| one - all[0]).sum::<f64>() / n;
    let (x, y) = (mean(at), mean(values));
    let pairs = || at.iter().zip(values).map(|(a, b)| (a - x, b - y));
    let squares: f64 = pairs().map(|(a, _)| a * a).sum();
    let slope = pairs().map(|(a, b)| a * b).sum::<f64>() / squares;
    let residual: f64 = pairs().map(|(a, b)| (b - slope * a).powi(2)).sum();
    let error = (residual / (n - 2.0) / squares).sqrt();
    if !(squares > 0.0 && error > 0.0) {
        return None;
    }
    let length = at.iter().copied().fold(f64::MIN, f64::max) - at.iter().copied().fold(f64::MAX, f64::min);
    let half = student_quantile(1.0 - SIDE, n - 2.0) * error;
    let interval = [(slope - half) * length, (slope + half) * length];
    let change = LotFigure { value: slope * length, interval };
    Some(LotTrend { change, test: LotTest::of(student_two_sided(slope / error, n - 2.0)) })
}
