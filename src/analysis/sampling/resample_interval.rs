//! Confidence intervals from resamples.

use sensitol_numeric::distribution::standard_normal;

/// Interval that covers the true value with probability `level`, from the estimate, the same statistic of resamples, and its acceleration.
/// Returns None if the statistic is unknown for the sample or for any resample.
///
/// Bias-corrected and accelerated (BCa): quantiles of the resamples at `Phi(z0 + (z0 + z)/(1 - a (z0 + z)))`. `z0` is the normal quantile
/// of the share of resamples below the estimate, and `a` the rate at which the scatter changes with the true value. The interval transforms
/// with any monotone function of the statistic, so that yields need no transformation. It stays between the least and the greatest
/// resample.
///
/// Source: Efron, Better bootstrap confidence intervals, J. Am. Stat. Assoc. 82 (1987).
pub(in crate::analysis) fn bca(
    estimate: f64,
    resampled: &mut [f64],
    acceleration: f64,
    level: f64,
) -> Option<[f64; 2]> {
    let known = resampled.iter().chain([&estimate, &acceleration]).all(|value| value.is_finite());
    if !known || resampled.is_empty() {
        return None;
    }
    resampled.sort_unstable_by(f64::total_cmp);
    let count = resampled.len() as f64;
    let below = resampled.partition_point(|&value| value < estimate);
    let equal = resampled.partition_point(|&value| value <= estimate) - below;
    // An estimate beyond all resamples counts as half a resample inside them.
    let share = ((below as f64 + 0.5 * equal as f64) / count).clamp(0.5 / count, 1.0 - 0.5 / count);
    let z0 = standard_normal::quantile(share);
    let tail = standard_normal::upper_quantile(0.5 * (1.0 - level));
    let end = |z: f64| {
        let moved = z0 + z;
        let room = 1.0 - acceleration * moved;
        // Beyond this the correction has no meaning. The end is that of all resamples.
        let p = if room > 0.0 { standard_normal::cdf(z0 + moved / room) } else { f64::from(z > 0.0) };
        quantile(resampled, p)
    };
    Some([end(-tail), end(tail)])
}

/// Quantile by linear interpolation between the ordered values, the i-th of which is at `i/(count + 1)`.
fn quantile(sorted: &[f64], p: f64) -> f64 {
    let place = (p * (sorted.len() + 1) as f64 - 1.0).clamp(0.0, (sorted.len() - 1) as f64);
    let (index, part) = (place.floor() as usize, place.fract());
    let next = sorted[(index + 1).min(sorted.len() - 1)];
    sorted[index] + part * (next - sorted[index])
}

/// One sixth of the skewness of a statistic's influence: the rate at which its scatter changes with the true value.
///
/// Every row of `influences` belongs to one sample and contains the influence of each of its groups of values on the statistic, found by
/// leaving the group out. Returns 0 if nothing has an influence.
pub(in crate::analysis) fn acceleration(influences: &[Vec<f64>]) -> f64 {
    let (mut squares, mut cubes) = (0.0, 0.0);
    for row in influences {
        let mean = row.iter().sum::<f64>() / row.len() as f64;
        for influence in row {
            squares += (influence - mean).powi(2);
            cubes += (influence - mean).powi(3);
        }
    }
    if squares > 0.0 { cubes / (6.0 * libm::pow(squares, 1.5)) } else { 0.0 }
}
