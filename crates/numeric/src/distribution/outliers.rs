//! Outliers among measured values.

use crate::pearson::Pearson;
use crate::power::Power;

/// Share of clean normal samples in which a value is flagged nevertheless.
const FALSE_ALARMS: f64 = 0.01;
/// Greatest share of the values that is tested.
const SHARE: f64 = 0.1;
/// Greatest number of values that is tested.
const MOST: usize = 50;
/// Smallest number of values of a test. Student's distribution by its moments needs more than 4 degrees of freedom.
const LEAST: usize = 7;

/// Indices of values that lie farther out than those of a normal sample of this size, farthest first.
///
/// Method: the generalised extreme Studentised deviate test of [`extreme`], for up to a tenth of the values. The rate of false alarms is
/// 1 % for the whole sample at any size. Outliers that hide one another are found. A thousand clean values raise an alarm as rarely as
/// thirty do, which no fixed number of sigmas achieves. A distribution with long tails or strong skewness has values that a normal
/// distribution does not have. They are flagged too, and a person must judge them.
///
/// ```
/// use sensitol_numeric::distribution::outliers::outliers;
/// let mut values: Vec<f64> = (0..40).map(|i| 10.0 + 0.01 * f64::from(i % 7)).collect();
/// values[3] = 10.9; // a slip of the pen
/// assert_eq!(outliers(&values), [3]);
/// ```
pub fn outliers(values: &[f64]) -> Vec<usize> {
    let most = ((SHARE * values.len() as f64) as usize).clamp(1, MOST);
    extreme(values, FALSE_ALARMS, most)
}

/// Generalised extreme Studentised deviate test for up to `most` outliers at the significance `level`.
///
/// The value farthest from the mean is removed `most` times. Its distance `R` in sigmas (divisor `n - 1`) is compared with
/// `(m-1) t / sqrt((m - 2 + t^2) m)`. There `m` values are left, and `t` is the quantile `1 - level/2m` of Student's distribution with
/// `m - 2` degrees of freedom. All values up to the last that exceeds it are outliers. For one value this is Grubbs' test, which is exact.
/// For several values it is accurate from about 15 values on.
///
/// Source: Rosner, Percentage points for a generalized ESD many-outlier procedure, Technometrics 25 (1983).
pub fn extreme(values: &[f64], level: f64, most: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_unstable_by(|&a, &b| values[a].total_cmp(&values[b]));
    // Scale to a unit of their own, so that squares of extreme deviations do not overflow.
    let ends = [order.first(), order.last()].map(|end| end.map_or(0.0, |&i| values[i]));
    let unit = Power::of(ends[1] - ends[0]).inverse();
    let (mut found, mut taken) = (0, Vec::new());
    let mut left = &order[..];
    while taken.len() < most && left.len() >= LEAST {
        let m = left.len() as f64;
        let origin = values[left[left.len() / 2]];
        let mean = left.iter().map(|&i| values[i] - origin).sum::<f64>() / m;
        let off = |i: usize| unit.times(values[i] - origin - mean);
        let sigma = (left.iter().map(|&i| off(i) * off(i)).sum::<f64>() / (m - 1.0)).sqrt();
        let (first, last) = (left[0], left[left.len() - 1]);
        let low = off(first).abs() > off(last).abs();
        let farthest = if low { first } else { last };
        // Only equal values are left, or the scale of the values is beyond the range of a double.
        if !(sigma > 0.0 && sigma.is_finite()) {
            break;
        }
        taken.push(farthest);
        if off(farthest).abs() / sigma > critical(m, level) {
            found = taken.len();
        }
        left = if low { &left[1..] } else { &left[..left.len() - 1] };
    }
    taken.truncate(found);
    taken
}

/// Largest deviation, in sigmas, that the farthest of `m` values may have.
fn critical(m: f64, level: f64) -> f64 {
    let freedom = m - 2.0;
    // Student's distribution is the symmetric Pearson distribution with long tails.
    let student = Pearson::with_excess(0.0, (freedom / (freedom - 2.0)).sqrt(), 0.0, 6.0 / (freedom - 4.0))
        .expect("more than 4 degrees of freedom");
    let t = student.upper_quantile(0.5 * level / m);
    (m - 1.0) * t / ((freedom + t * t) * m).sqrt()
}
