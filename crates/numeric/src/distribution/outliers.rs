//! Values that do not belong to the others.

use crate::pearson::Pearson;
use crate::power::Power;

/// The share of clean normal samples in which some value is named all the same.
const FALSE_ALARMS: f64 = 0.01;
/// At most this share of the values is looked at, and
const SHARE: f64 = 0.1;
/// at most so many.
const MOST: usize = 50;
/// Fewer values tell nothing: Student's law, by its moments, needs more than 4 degrees of freedom.
const LEAST: usize = 7;

/// The indices of values that lie farther out than those of a normal sample of this size, farthest first.
///
/// The generalised extreme Studentised deviate test: as [`extreme`] has it, for up to a tenth of the values at 1 % of false
/// alarms for the sample as a whole, whatever its size. It is not fooled by outliers that hide one another, and a
/// thousand clean values raise it as rarely as thirty do, which no fixed number of sigmas does. A law with long tails or
/// a strong skewness has values that a normal law has not: they are named too, and it is for people to say what they are.
///
/// ```
/// use crate::distribution::outliers::outliers;
/// let mut values: Vec<f64> = (0..40).map(|i| 10.0 + 0.01 * f64::from(i % 7)).collect();
/// values[3] = 10.9; // a slip of the pen
/// assert_eq!(outliers(&values), [3]);
/// ```
pub fn outliers(values: &[f64]) -> Vec<usize> {
    let most = ((SHARE * values.len() as f64) as usize).clamp(1, MOST);
    extreme(values, FALSE_ALARMS, most)
}

/// The test itself, for up to `most` outliers at the significance `level`.
///
/// The value farthest from the mean is taken out `most` times, and its distance `R` in sigmas (divisor `n - 1`) compared
/// with `(m-1) t / sqrt((m - 2 + t^2) m)`, where `m` values are left and `t` is the quantile `1 - level/2m` of Student's
/// law with `m - 2` degrees of freedom. All up to the last that exceeds it are outliers. Of one value this is Grubbs'
/// test, which is exact; of several, accurate from about 15 values on.
///
/// Source: Rosner, Percentage points for a generalized ESD many-outlier procedure, Technometrics 25 (1983).
pub fn extreme(values: &[f64], level: f64, most: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_unstable_by(|&a, &b| values[a].total_cmp(&values[b]));
    // In a unit of their own, deviations of extreme size have squares.
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
        // Only equal values are left, or the scale of the values is beyond a double.
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

/// The largest deviation that the farthest of `m` values may have, in sigmas.
fn critical(m: f64, level: f64) -> f64 {
    let freedom = m - 2.0;
    // Student's law is the symmetric Pearson law with long tails.
    let student = Pearson::with_excess(0.0, (freedom / (freedom - 2.0)).sqrt(), 0.0, 6.0 / (freedom - 4.0))
        .expect("more than 4 degrees of freedom");
    let t = student.upper_quantile(0.5 * level / m);
    (m - 1.0) * t / ((freedom + t * t) * m).sqrt()
}
