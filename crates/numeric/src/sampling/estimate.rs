//! Estimates with their standard errors, and confidence intervals of shares.

use crate::power::{Losable, Rescale, Rescaling};
use crate::sampling::Summary;
use crate::sampling::critical::beta_quantile;

/// Value that a sample estimates, with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Estimated value.
    pub value: f64,
    /// Standard error; None if the sample does not determine one.
    pub standard_error: Option<f64>,
}

impl Rescale for Estimate {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.value.rescale(by);
        self.standard_error.rescale(by);
    }
}

impl Losable for Estimate {
    fn is_unknown(&self) -> bool {
        self.value.is_nan()
    }
}

/// Smallest number of values of a sample for which moments have standard errors.
pub const FEWEST: u64 = 10;

/// Estimates of the four moments from a sample of independent values.
///
/// The standard errors are those of the asymptotic normal distribution of a smooth function of moments. They follow from its influence
/// function (Serfling 1980, section 6.3) with the sample's own moments. With `u = (y - mean)/sigma`, skewness `s` and kurtosis `k`, the
/// influence functions are
///
/// ```text
/// mean: sigma u                 sigma: sigma (u^2 - 1)/2
/// skewness: u^3 - s - 3 u - (3/2) s (u^2 - 1)        kurtosis: u^4 - k - 4 s u - 2 k (u^2 - 1)
/// ```
///
/// For a kurtosis of 10 or more the error depends on the eighth moment, which a sample of less than a million values hardly determines. The
/// standard error is then too small, and [`settled`](crate::sampling::settled) removes it.
pub fn of_moments(summary: &Summary) -> [Option<Estimate>; 4] {
    let n = summary.count() as f64;
    if summary.count() == 0 {
        return [None; 4];
    }
    let (mean, sigma) = (summary.mean(), summary.sigma());
    if !sigma.is_finite() {
        return [
            Some(Estimate { value: mean, standard_error: None }).filter(|mean| mean.value.is_finite()),
            None,
            None,
            None,
        ];
    }
    let Some(a) = summary.standardised() else {
        let exact = |value| Some(Estimate { value, standard_error: (summary.count() > 1).then_some(0.0) });
        return [exact(mean), exact(0.0), None, None];
    };
    let (s, k) = (a[3], a[4]);
    // Standard error of the mean of a polynomial in u: the root of E[p(u)^2] over n.
    let spread = |p: [f64; 5]| {
        let terms = (0..25).map(|i| p[i / 5] * p[i % 5] * a[i / 5 + i % 5]);
        (terms.sum::<f64>().max(0.0) / n).sqrt()
    };
    // The moments of a handful of values do not determine their own uncertainty.
    let known = summary.count() >= FEWEST;
    // Powers beyond the range of doubles are 0 or infinite. Figures that depend on them are unknown, not 0.
    let whole = |order: usize| summary.moment(order).is_normal();
    let estimate = |of: [usize; 2], value, error| {
        let error = Some(error).filter(|_| known && whole(of[1]));
        Some(Estimate { value, standard_error: error }).filter(|_| whole(of[0]))
    };
    [
        Some(Estimate {
            value: mean,
            standard_error: Some(sigma * spread([0.0, 1.0, 0.0, 0.0, 0.0])).filter(|_| known && whole(2)),
        }),
        estimate([2, 4], sigma, sigma * spread([-0.5, 0.0, 0.5, 0.0, 0.0])),
        estimate([4, 6], s, spread([0.5 * s, -3.0, -1.5 * s, 1.0, 0.0])),
        estimate([4, 8], k, spread([k, -4.0 * s, -2.0 * k, 0.0, 1.0])),
    ]
}

/// Standard error of a value with a 95 % interval: half of the distance to the farther end.
pub fn one_error(value: f64, [low, high]: [f64; 2]) -> f64 {
    0.5 * (high - value).max(value - low)
}

/// 95 % interval of a share from `hits` among `n` points (Wilson 1927). It is never empty and stays within 0 to 1.
///
/// ```
/// use sensitol_numeric::sampling::wilson;
/// let [low, high] = wilson(1000.0, 1000.0);
/// assert!(low < 0.9963 && low > 0.996 && high == 1.0); // all of a thousand is not all
/// ```
pub fn wilson(hits: f64, n: f64) -> [f64; 2] {
    /// 97.5 % quantile of the standard normal distribution.
    const Z: f64 = 1.959_963_984_540_054;
    if n <= 0.0 {
        return [0.0, 1.0];
    }
    let (share, square) = (hits / n, Z * Z / n);
    let middle = (share + 0.5 * square) / (1.0 + square);
    let half = Z * ((share * (1.0 - share) + 0.25 * square) / n).sqrt() / (1.0 + square);
    let low = if hits == 0.0 { 0.0 } else { (middle - half).max(0.0) };
    let high = if hits == n { 1.0 } else { (middle + half).min(1.0) };
    [low, high]
}

/// 95 % interval of a share from `hits` among `n` points, exact for every share. `hits` may be the mean of several counts and need not be a
/// whole number.
///
/// Source: Clopper and Pearson, Biometrika 26 (1934).
///
/// ```
/// use sensitol_numeric::sampling::clopper_pearson;
/// // None of 195 leaves 1 - 0.025^(1/195).
/// let [low, high] = clopper_pearson(0.0, 195.0);
/// assert!(low == 0.0 && (high - 0.018739).abs() < 1e-6);
/// // Of 1 of 10 tables have 0.25 % to 44.5 %.
/// let [low, high] = clopper_pearson(1.0, 10.0);
/// assert!((low - 0.00253).abs() < 1e-5 && (high - 0.44502).abs() < 1e-5);
/// ```
pub fn clopper_pearson(hits: f64, n: f64) -> [f64; 2] {
    /// Probability beyond either end.
    const SIDE: f64 = 0.025;
    /// Number of hits below which the lower end is 0 in double precision.
    const NONE: f64 = 1e-3;
    if n.is_nan() || n <= 0.0 {
        return [0.0, 1.0];
    }
    let hits = hits.clamp(0.0, n);
    // Closed form at the ends, where a shape would be 0. `expm1` keeps the digits of a small share.
    let unseen = -libm::expm1(libm::log(SIDE) / n);
    let low = match hits {
        none if none < NONE => 0.0,
        all if all >= n => 1.0 - unseen,
        _ => beta_quantile(hits, n - hits + 1.0, SIDE),
    };
    let high = match hits {
        0.0 => unseen,
        all if all >= n => 1.0,
        _ => beta_quantile(hits + 1.0, n - hits, 1.0 - SIDE),
    };
    [low, high]
}

/// 95 % interval of a share by weighted points: Clopper and Pearson for the number of plain points with the same scatter (Korn and Graubard
/// 1998). Points may all miss a share. That share is bounded by the upper end for no hit among `1/one` points, with `one` the weight of a
/// single point.
///
/// `scatter` is the standard error from the differences between the points; it is 0 if all of them agree.
///
/// ```text
/// n = p (1 - p)/scatter^2        high = p + hypot(high(n p of n) - p, high(0 of 1/one))
/// ```
pub fn weighted_interval(share: f64, scatter: f64, one: f64) -> [f64; 2] {
    let [_, unseen] = clopper_pearson(0.0, 1.0 / one);
    let points = share * (1.0 - share) / (scatter * scatter);
    let [low, high] = match scatter > 0.0 && points.is_finite() && points > 0.0 {
        true => clopper_pearson(share * points, points),
        false => [share; 2],
    };
    let less = if scatter > 0.0 { share - low } else { unseen };
    [(share - less).max(0.0), (share + libm::hypot(high - share, unseen)).min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Probability of at most `k` hits among `n` at this share, term by term.
    fn at_most(k: u32, n: u32, share: f64) -> f64 {
        let mut term = libm::exp(f64::from(n) * libm::log1p(-share));
        let mut sum = term;
        for i in 0..k {
            term *= f64::from(n - i) / f64::from(i + 1) * share / (1.0 - share);
            sum += term;
        }
        sum
    }

    /// At the upper end, at most `k` hits have a probability of 2.5 %, and at the lower end at least `k` hits have. Both follow from sums
    /// of the binomial distribution.
    #[test]
    fn the_ends_leave_a_fortieth_beyond() {
        for (k, n) in [(1, 10), (3, 40), (1, 100_000), (2, 100_000), (25, 100_000), (400, 1000)] {
            let [low, high] = clopper_pearson(f64::from(k), f64::from(n));
            assert!((at_most(k, n, high) - 0.025).abs() < 1e-8, "{k} of {n}: {high}");
            assert!((1.0 - at_most(k - 1, n, low) - 0.025).abs() < 1e-8, "{k} of {n}: {low}");
        }
    }

    /// No hit: 0.025 = (1 - p)^n. All hits: the mirror image.
    #[test]
    fn none_and_all_have_one_end() {
        let [low, high] = clopper_pearson(0.0, 1e5);
        assert_eq!(low, 0.0);
        assert!((high - 36.888e-6).abs() < 1e-9, "{high}");
        let [low, high] = clopper_pearson(1e5, 1e5);
        assert_eq!(high, 1.0);
        assert!((1.0 - low - 36.888e-6).abs() < 1e-9, "{low}");
    }

    /// Points of equal weight count as plain points, except for the share that all of them may have missed. Without a hit only that share
    /// is left.
    #[test]
    fn weights_that_are_equal_count_points() {
        let n = 1000.0;
        let share: f64 = 0.1;
        let scatter = (share * (1.0 - share) / n).sqrt();
        let [low, high] = weighted_interval(share, scatter, 1.0 / n);
        let [plain_low, plain_high] = clopper_pearson(100.0, n);
        let [_, unseen] = clopper_pearson(0.0, n);
        assert!((low - plain_low).abs() < 1e-12);
        assert!((high - share - libm::hypot(plain_high - share, unseen)).abs() < 1e-12);
        assert_eq!(weighted_interval(0.0, 0.0, 1.0 / n), [0.0, unseen]);
    }
}
