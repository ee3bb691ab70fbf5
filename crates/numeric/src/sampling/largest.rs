//! The largest points of a sample, and whether moments that they decide have settled.
//!
//! The standard error of a moment rests on sums of the second, fourth, sixth and eighth powers of deviations. A sample of a heavy tail
//! has not seen the points that make up such a sum: its moments are too small, and their standard errors more so. With `s` the share
//! of the sum that the ten largest points have, a standard error grows by
//!
//! ```text
//! max(1, 0.8/(1 - s))     s < 0.8          unknown from there on
//! ```
//!
//! The share of ten points says more than that of the largest: a sample without its rare large points has a small largest one.
//! Measured over 23 distributions with closed moments (normal, uniform, Student, products, chi-squared, lognormal with sigma 0.15
//! to 1.5), three standard errors that are told reach the truth in 99.4 % of the figures at 1000 to 100 000 points, and in 96.6 % or more of
//! each moment by itself; without the rule in 36 % of the kurtoses of the heavy-tailed ones at 1000 points. Of a normal
//! distribution every standard error is told from 10 000 points on, and those of mean, sigma and skewness from 1000.

use super::{Estimate, Summary};

/// The largest points that are watched, and the part of a small sample that they are.
const LARGEST: usize = 10;
const PART: u64 = 5;
/// From this share of a sum on a moment has not settled.
const UNSETTLED: f64 = 0.8;
/// Up to this share a standard error is what it is.
const COMMON: f64 = 0.2;

/// The ends of a sample: its least and its greatest values, ten of each.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LargestPoints {
    /// Ascending.
    least: Vec<f64>,
    /// Descending.
    greatest: Vec<f64>,
}

impl LargestPoints {
    /// Of values that are numbers.
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

    /// Takes in those of another sample.
    pub fn merge(&mut self, other: &Self) {
        for &value in &other.least {
            keep(&mut self.least, value, |a, b| a < b);
        }
        for &value in &other.greatest {
            keep(&mut self.greatest, value, |a, b| a > b);
        }
    }

    /// The share of the largest points in the sums of powers on which mean, sigma, skewness and kurtosis rest, of the sample that this
    /// summary is of. Nothing of a sample that does not vary.
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

/// Keeps a value that comes before the last of those kept.
fn keep(kept: &mut Vec<f64>, value: f64, before: fn(f64, f64) -> bool) {
    if kept.len() == LARGEST && !kept.last().is_some_and(|&last| before(value, last)) {
        return;
    }
    let place = kept.partition_point(|&other| !before(value, other));
    kept.insert(place, value);
    kept.truncate(LARGEST);
}

/// How many points are watched of so many.
fn watched(n: u64) -> usize {
    ((n / PART) as usize).clamp(1, LARGEST)
}

/// The largest terms of a sum of squares, and the sum.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LargestTerms {
    /// Squares, descending.
    squares: Vec<f64>,
    sum: f64,
    count: u64,
}

impl LargestTerms {
    pub fn add(&mut self, term: f64) {
        let square = term * term;
        keep(&mut self.squares, square, |a, b| a > b);
        self.sum += square;
        self.count += 1;
    }

    pub fn merge(&mut self, other: &Self) {
        for &square in &other.squares {
            keep(&mut self.squares, square, |a, b| a > b);
        }
        self.sum += other.sum;
        self.count += other.count;
    }

    /// The mean square.
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }

    pub fn share(&self) -> LargestShare {
        if self.sum.is_nan() || self.sum <= 0.0 {
            return LargestShare::default();
        }
        let largest = self.squares.first().copied().unwrap_or(0.0);
        let watched: f64 = self.squares.iter().take(watched(self.count)).sum();
        LargestShare::new(largest / self.sum, watched / self.sum)
    }
}

/// The share of the largest points in a sum.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LargestShare {
    /// That of the largest one.
    pub largest: f64,
    /// That of all that are watched.
    pub watched: f64,
}

impl LargestShare {
    fn new(largest: f64, watched: f64) -> Self {
        Self { largest: largest.min(1.0), watched: watched.min(1.0) }
    }

    /// By how much a standard error that rests on the sum grows; None where it has not settled. A sum without a value has not.
    pub fn widening(self) -> Option<f64> {
        (self.watched < UNSETTLED).then(|| ((1.0 - COMMON) / (1.0 - self.watched)).max(1.0))
    }
}

/// An estimate whose standard error rests on such a sum.
pub fn settled(estimate: Estimate, share: LargestShare) -> Estimate {
    let standard_error = estimate.standard_error.zip(share.widening()).map(|(error, by)| error * by);
    Estimate { standard_error, ..estimate }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 99 zeros and a one, all of every sum is the largest point's; of a hundred ones of either sign each has a hundredth.
    #[test]
    fn a_single_point_has_all_of_its_sum() {
        let mut values = vec![0.0; 99];
        values.push(1.0);
        let (ends, summary) = (LargestPoints::of(&values), Summary::of(&values));
        let [mean, .., kurtosis] = ends.shares(&summary);
        // About the mean 0.01 the one has 0.99^2, and the others 0.01^2 each.
        assert!((mean.largest - 0.9801 / (0.9801 + 99.0 * 1e-4)).abs() < 1e-12, "{mean:?}");
        assert!(kurtosis.largest > 1.0 - 1e-13 && kurtosis.widening().is_none());
        let even: Vec<f64> = (0..100).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let shares = LargestPoints::of(&even).shares(&Summary::of(&even));
        for share in shares {
            assert!((share.largest - 0.01).abs() < 1e-14 && (share.watched - 0.1).abs() < 1e-14, "{share:?}");
            assert_eq!(share.widening(), Some(1.0));
        }
    }

    /// In parts as in one piece.
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
    }
}
