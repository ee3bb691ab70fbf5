//! Performance indices of a measured lot with intervals.

use crate::distribution::standard_normal;
use crate::lot::reference_law::chi_squared_quantile;
use crate::lot::{LotFigure, LotSample, SIDE};

/// Performance indices of measured parts against a tolerance band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProcessPerformance {
    /// Band width over six standard deviations. None if the band has one end only.
    pub pp: Option<LotFigure>,
    /// Distance of the mean from the nearer end over three standard deviations.
    pub ppk: LotFigure,
}

/// Indices Pp and Ppk of normal parts, with 95 % intervals: exact for Pp, an approximation for Ppk. Returns None without a limit.
///
/// Source: ISO 22514-2; A. F. Bissell, How reliable is your capability index?, Applied Statistics 39 (1990).
pub fn performance(column: &LotSample, limits: [Option<f64>; 2]) -> Option<ProcessPerformance> {
    let (mean, sigma, n) = (column.mean(), column.sigma(), column.count() as f64);
    let pp = match limits {
        [Some(lower), Some(upper)] => {
            let value = (upper - lower) / (6.0 * sigma);
            let end = |p: f64| value * (chi_squared_quantile(p, n - 1.0) / (n - 1.0)).sqrt();
            Some(LotFigure { value, interval: [end(SIDE), end(1.0 - SIDE)] })
        }
        _ => None,
    };
    let rooms = [limits[0].map(|lower| mean - lower), limits[1].map(|upper| upper - mean)];
    let room = rooms.into_iter().flatten().reduce(f64::min)?;
    let value = room / (3.0 * sigma);
    let error = (1.0 / (9.0 * n) + value * value / (2.0 * (n - 1.0))).sqrt();
    let half = standard_normal::upper_quantile(SIDE) * error;
    Some(ProcessPerformance { pp, ppk: LotFigure { value, interval: [value - half, value + half] } })
}
