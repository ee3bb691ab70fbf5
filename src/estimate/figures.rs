//! Figures from weighted sums, and their errors from randomisations.

use sensitol_numeric::sampling::student_quantile;

/// Number of moments among the figures: mean, sigma, skewness, kurtosis. Shares follow them.
pub(crate) const MOMENTS: usize = 4;
/// Probability below three sigmas of a normal distribution.
const THREE_SIGMAS: f64 = 0.998_65;

/// Mean, sigma, skewness and kurtosis of weighted values. Skewness and kurtosis are NaN if nothing varies.
///
/// Shapes: as many weights as values. The weights need not sum to 1.
pub(crate) fn moments(values: &[f64], weights: &[f64]) -> [f64; MOMENTS] {
    let total: f64 = weights.iter().sum();
    let mean = |of: &dyn Fn(f64) -> f64| {
        values.iter().zip(weights).map(|(&value, weight)| weight * of(value)).sum::<f64>() / total
    };
    // About the first value, so that a large common part does not cause rounding errors.
    let origin = values.first().copied().unwrap_or(0.0);
    let centre = origin + mean(&|y| y - origin);
    let variance = mean(&|y| (y - centre).powi(2));
    let sigma = variance.sqrt();
    if sigma > 0.0 {
        let power = |order: i32| mean(&|y| ((y - centre) / sigma).powi(order));
        [centre, sigma, power(3), power(4)]
    } else {
        [centre, 0.0, f64::NAN, f64::NAN]
    }
}

/// Mean, sigma, skewness and kurtosis from raw moments 1 to 4 about an origin, in units of a scale. Further elements are appended
/// unchanged.
pub(crate) fn standard(raw: &[f64], origin: f64, scale: f64) -> Vec<f64> {
    let [m1, m2, m3, m4] = [raw[0], raw[1], raw[2], raw[3]];
    let second = m2 - m1 * m1;
    let third = m3 - 3.0 * m1 * m2 + 2.0 * m1.powi(3);
    let fourth = m4 - 4.0 * m1 * m3 + 6.0 * m1 * m1 * m2 - 3.0 * m1.powi(4);
    let mut figures = if second > 0.0 {
        let root = second.sqrt();
        vec![origin + scale * m1, scale * root, third / root.powi(3), fourth / (second * second)]
    } else {
        vec![origin + scale * m1, 0.0, f64::NAN, f64::NAN]
    };
    figures.extend(&raw[MOMENTS..]);
    figures
}

/// Standard errors of functions of sums by the jackknife over the randomisations: `sqrt((R - 1)/R sum (f_(r) - mean f_(r))^2)` with `f_(r)`
/// the figures without randomisation r (Tukey 1958). Ratios and roots need no derivative.
///
/// Shapes: `sums` has a row for every sum, with R columns.
pub(crate) fn jackknife(of: impl Fn(&[f64]) -> Vec<f64>, sums: &[Vec<f64>]) -> Vec<f64> {
    let replicates = sums.first().map_or(0, Vec::len);
    let totals = totals(sums);
    let left_out: Vec<Vec<f64>> = (0..replicates)
        .map(|r| of(&totals.iter().zip(sums).map(|(total, row)| total - row[r]).collect::<Vec<f64>>()))
        .collect();
    let figures = left_out.first().map_or(0, Vec::len);
    let n = replicates as f64;
    (0..figures)
        .map(|figure| {
            let mean = left_out.iter().map(|one| one[figure]).sum::<f64>() / n;
            let squares: f64 = left_out.iter().map(|one| (one[figure] - mean).powi(2)).sum();
            ((n - 1.0) / n * squares).sqrt()
        })
        .collect()
}

/// Sum of every row, over all randomisations.
pub(crate) fn totals(sums: &[Vec<f64>]) -> Vec<f64> {
    sums.iter().map(|row| row.iter().sum()).collect()
}

/// Number of terms that carry the variance of a sum, `(sum r^2)^2 / sum r^4` (Kish 1965), at least 1.
pub(crate) fn effective(terms: impl Iterator<Item = f64>) -> f64 {
    let (mut squares, mut fourths) = (0.0, 0.0);
    for term in terms {
        let square = term * term;
        squares += square;
        fourths += square * square;
    }
    if fourths > 0.0 { (squares * squares / fourths).max(1.0) } else { 1.0 }
}

/// Factor in the widening of standard errors, `1 + FEW/sqrt(n)`. Without it and with random tails the kurtosis of `exp(0.8 a + 0.3 b)` was
/// off by more than three standard errors in 4 of 20 runs, with it in none.
const FEW: f64 = 5.0;

/// Factor on the standard error of a sum whose variance is carried by `points` points.
pub(crate) fn carried_by(points: f64) -> f64 {
    1.0 + FEW / points.sqrt()
}

/// Factor on a standard error from `replicates` randomisations: the quantile of Student's distribution divided by the normal one, 1.2 for
/// 16 randomisations.
pub(crate) fn student(replicates: usize) -> f64 {
    let freedom = (replicates.max(2) - 1) as f64;
    student_quantile(THREE_SIGMAS, freedom) / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of 1, 2, 2, 5 by hand: mean 2.5, variance 2.25, third central moment 3, fourth 11.0625.
    #[test]
    fn raw_and_central_sums_make_the_same_figures() {
        let values = [1.0, 2.0, 2.0, 5.0];
        let expected = [2.5, 1.5, 3.0 / 1.5f64.powi(3), 11.0625 / 1.5f64.powi(4)];
        let direct = moments(&values, &[0.5; 4]);
        let raw: Vec<f64> =
            (1..=4).map(|order| values.iter().map(|y| ((y - 2.0) / 3.0f64).powi(order)).sum::<f64>() / 4.0).collect();
        for (found, expected) in direct.iter().chain(&standard(&raw, 2.0, 3.0)).zip(expected.iter().cycle()) {
            // A few roundings of numbers near 3.
            assert!((found - expected).abs() < 1e-13, "{found} for {expected}");
        }
    }

    /// The jackknife of a mean is its standard error: for 1, 2, 3, 4 it is sqrt(5/3/4) for the mean of four.
    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let sums = [vec![1.0; 4], vec![1.0, 2.0, 3.0, 4.0]];
        let error = jackknife(|total| vec![total[1] / total[0]], &sums);
        assert!((error[0] - (5.0f64 / 12.0).sqrt()).abs() < 1e-15);
    }

    /// Tables of Student's distribution: t(15) at 0.99865 is 3.586, t(7) is 4.530 (scipy 1.14: 3.58641, 4.52997).
    #[test]
    fn few_randomisations_widen_the_error() {
        assert!((student(16) - 3.586_4 / 3.0).abs() < 1e-4, "{}", student(16));
        assert!((student(8) - 4.530 / 3.0).abs() < 1e-3, "{}", student(8));
    }

    #[test]
    fn equal_terms_all_carry_the_sum() {
        assert_eq!(effective([2.0; 7].into_iter()), 7.0);
        assert_eq!(effective([0.0; 3].into_iter()), 1.0);
        assert!((effective([1.0, 1.0, 100.0].into_iter()) - 1.0).abs() < 1e-3);
    }
}
