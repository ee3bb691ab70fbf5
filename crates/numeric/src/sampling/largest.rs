//! Largest points of a sample, and a test if moments that they dominate have settled.
//!
//! The standard error of a moment depends on sums of the second, fourth, sixth and eighth powers of deviations. A sample of a heavy tail
//! lacks the points that make up such a sum. Its moments are too small, and their standard errors even more so. With `s` the share of the
//! sum that belongs to the ten largest points, a standard error grows by
//!
//! ```text
//! max(1, 0.8/(1 - s))     s < 0.8          unknown from there on
//! ```
//!
//! The share of ten points is a better indicator than that of the largest one: without its rare large points a sample has a small largest
//! one.
//!
//! Measured over 23 distributions with closed moments (normal, uniform, Student, products, chi-squared, lognormal with sigma 0.15 to 1.5).
//! At 1000 to 100 000 points, three standard errors, where given, include the true value in 99.4 % of the figures. For each moment by
//! itself they do so in 96.6 % or more. Without the rule they do so in 36 % of the kurtoses of the heavy-tailed distributions at 1000
//! points. For a normal distribution every standard error is given from 10 000 points on, and those of mean, sigma and skewness from 1000.

use serde::{Deserialize, Serialize};

use crate::sampling::{Estimate, Summary};

/// Greatest number of largest points that are used.
const LARGEST: usize = 10;
/// Inverse of the fraction of a small sample that is used instead.
const PART: u64 = 5;
/// Share of a sum from which on a moment has not settled.
const UNSETTLED: f64 = 0.8;
/// Share up to which a standard error is not widened.
const COMMON: f64 = 0.2;

/// Shares between which the standard error of independent points becomes a lower bound.
const SPREAD: [f64; 2] = [0.25, 0.5];

/// Ends of a sample: its ten least and its ten greatest values.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LargestPoints {
    /// Least values, ascending.
    least: Vec<f64>,
    /// Greatest values, descending.
    greatest: Vec<f64>,
}

impl LargestPoints {
    /// Ends of these values, which must not be NaN.
    pub fn of(values: &[f64]) -> Self {
        let mut ends = Self::default();
        for &value in values {
            ends.add(value);
        }
        ends
    }

    fn add(&mut self, value: f64) {
        keep(&mut self.least, value, |a, b| a < b);
        keep(&mut self.greatest, value, |a, b| a > b);
    }

    /// Adds the ends of another sample.
    pub fn merge(&mut self, other: &Self) {
        for &value in &other.least {
            keep(&mut self.least, value, |a, b| a < b);
        }
        for &value in &other.greatest {
            keep(&mut self.greatest, value, |a, b| a > b);
        }
    }

    /// Share of the largest points in the sums of powers on which mean, sigma, skewness and kurtosis depend. `summary` belongs to the same
    /// sample. All shares are 0 if the sample does not vary.
    pub fn shares(&self, summary: &Summary) -> [LargestShare; 4] {
        let (mean, sigma, n) = (summary.mean(), summary.moment(2).sqrt(), summary.count());
        let Some(moments) = summary.standardised() else { return [LargestShare::default(); 4] };
        let mut apart: Vec<f64> =
            self.least.iter().chain(&self.greatest).map(|value| (value - mean).abs() / sigma).collect();
        apart.sort_unstable_by(|a, b| b.total_cmp(a));
        apart.truncate(watched(n));
        std::array::from_fn(|moment| {
            let order = 2 * (moment + 1);
            let sum = n as f64 * moments[order];
            let part = |u: &f64| u.powi(order as i32) / sum;
            LargestShare::new(apart.first().map_or(0.0, part), apart.iter().map(part).sum())
        })
    }
}

/// Inserts a value that precedes the last of those kept.
fn keep(kept: &mut Vec<f64>, value: f64, before: fn(f64, f64) -> bool) {
    if kept.len() == LARGEST && !kept.last().is_some_and(|&last| before(value, last)) {
        return;
    }
    let place = kept.partition_point(|&other| !before(value, other));
    kept.insert(place, value);
    kept.truncate(LARGEST);
}

/// Number of largest points that are used for a sample of size `n`.
fn watched(n: u64) -> usize {
    ((n / PART) as usize).clamp(1, LARGEST)
}

/// Largest terms of a sum of squares, and the sum.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LargestTerms {
    /// Squares, descending.
    squares: Vec<f64>,
    sum: f64,
    count: u64,
}

impl LargestTerms {
    /// Adds a term, which is squared.
    pub fn add(&mut self, term: f64) {
        let square = term * term;
        keep(&mut self.squares, square, |a, b| a > b);
        self.sum += square;
        self.count += 1;
    }

    /// Adds the terms of another sum.
    pub fn merge(&mut self, other: &Self) {
        for &square in &other.squares {
            keep(&mut self.squares, square, |a, b| a > b);
        }
        self.sum += other.sum;
        self.count += other.count;
    }

    /// Mean square.
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }

    /// Share of the largest terms in the sum.
    pub fn share(&self) -> LargestShare {
        if self.sum.is_nan() || self.sum <= 0.0 {
            return LargestShare::default();
        }
        let largest = self.squares.first().copied().unwrap_or(0.0);
        let watched: f64 = self.squares.iter().take(watched(self.count)).sum();
        LargestShare::new(largest / self.sum, watched / self.sum)
    }
}

/// Share of the largest points in a sum.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LargestShare {
    /// Share of the largest one.
    pub largest: f64,
    /// Share of all that are used, at most ten.
    pub watched: f64,
}

impl LargestShare {
    fn new(largest: f64, watched: f64) -> Self {
        Self { largest: largest.min(1.0), watched: watched.min(1.0) }
    }

    /// Weight of the standard error of independent points as lower bound of that of a better design: 0 up to 0.25, 1 from 0.5 on. Where a
    /// few points decide, strata and regressions fit just these points. Their errors then are too small, and the points that the sample
    /// lacks are in none.
    pub fn independence(self) -> f64 {
        ((self.watched - SPREAD[0]) / (SPREAD[1] - SPREAD[0])).clamp(0.0, 1.0)
    }

    /// Factor by which a standard error that depends on the sum grows. Returns None if the sum has not settled, as for a sum without a
    /// value.
    pub fn widening(self) -> Option<f64> {
        (self.watched < UNSETTLED).then(|| ((1.0 - COMMON) / (1.0 - self.watched)).max(1.0))
    }
}

/// Estimate with its standard error widened by the share of the largest points, or removed if the sum has not settled.
pub fn settled(estimate: Estimate, share: LargestShare) -> Estimate {
    let standard_error = estimate.standard_error.zip(share.widening()).map(|(error, by)| error * by);
    Estimate { standard_error, ..estimate }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For 99 zeros and a one, the largest point has all of every sum. For a hundred values of 1 or -1, each has a hundredth.
    #[test]
    fn a_single_point_has_all_of_its_sum() {
        let mut values = vec![0.0; 99];
        values.push(1.0);
        let (ends, summary) = (LargestPoints::of(&values), Summary::of(&values));
        let [mean, .., kurtosis] = ends.shares(&summary);
        // About the mean 0.01 the one contributes 0.99^2, and the others 0.01^2 each.
        assert!((mean.largest - 0.9801 / (0.9801 + 99.0 * 1e-4)).abs() < 1e-12, "{mean:?}");
        assert!(kurtosis.largest > 1.0 - 1e-13 && kurtosis.widening().is_none());
        let even: Vec<f64> = (0..100).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let shares = LargestPoints::of(&even).shares(&Summary::of(&even));
        for share in shares {
            assert!((share.largest - 0.01).abs() < 1e-14 && (share.watched - 0.1).abs() < 1e-14, "{share:?}");
            assert_eq!(share.widening(), Some(1.0));
        }
    }

    /// Merged parts equal the whole sample.
    #[test]
    fn parts_merge_to_the_whole() {
        let values: Vec<f64> = (0..500).map(|i| ((i * 7919) % 503) as f64 - 200.0).collect();
        let mut merged = LargestPoints::default();
        values.chunks(33).for_each(|part| merged.merge(&LargestPoints::of(part)));
        assert_eq!(merged, LargestPoints::of(&values));
        let terms = |values: &[f64]| {
            let mut terms = LargestTerms::default();
            values.iter().for_each(|&value| terms.add(value));
            terms
        };
        let mut merged = LargestTerms::default();
        values.chunks(33).for_each(|part| merged.merge(&terms(part)));
        assert_eq!(merged, terms(&values));
    }

    #[test]
    fn a_share_widens_until_nothing_is_known() {
        let widening = |watched: f64| LargestShare { largest: 0.0, watched }.widening();
        assert_eq!((widening(0.0), widening(0.2)), (Some(1.0), Some(1.0)));
        assert!((widening(0.6).unwrap() - 2.0).abs() < 1e-12);
        assert_eq!((widening(0.8), widening(f64::NAN)), (None, None));
        let independence = |watched: f64| LargestShare { largest: 0.0, watched }.independence();
        assert_eq!((independence(0.25), independence(0.5), independence(1.0)), (0.0, 1.0, 1.0));
        assert!((independence(0.375) - 0.5).abs() < 1e-12);
    }
}
