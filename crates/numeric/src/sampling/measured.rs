//! Measured samples among the inputs, and the uncertainty of the reject rate that follows from their size.
//!
//! A process that is known by measured parts has an uncertain yield if the samples are small, even if the yield follows exactly from them.
//! [`MeasuredBasis::interval`] is the 95 % interval of the rejected share `p` from this uncertainty alone. It is based on counts, and on
//! one assumption if other inputs vary too.
//!
//! **All inputs that vary are measured.** Let `n` be the size of the smallest sample. Row `i` of every sample, for `i = 1 .. n`, makes one
//! assembly. These `n` assemblies share no row, so they are independent assemblies of the process and their rejects are binomial. Without a
//! reject the process rejects at most `1 - 0.025^(1/n)` of its assemblies (Clopper and Pearson 1934), for any distribution. More
//! combinations of the same rows do not lower this bound: the smallest sample decides.
//!
//! For several samples `p` is the mean share of rejects over all pairings of their rows, a U-statistic. Its deviations are no larger than
//! those of the `n` independent assemblies of one pairing (Hoeffding 1963, section 5). The interval is therefore that of `p n` rejects
//! among `n`, where `p n` need not be a whole number.
//!
//! **Other inputs vary too.** A row then decides only partly if an assembly is rejected. Let `S` be a sample's share of the variance, and
//! let values be normal for a given row. The share of rejects for a given row then has the variance
//!
//! ```text
//! V(S) = P(a > t, b > t) - p^2 = integral over r from 0 to S of exp(-t^2/(1 + r))/(2 pi sqrt(1 - r^2)),   P(a > t) = p
//! ```
//!
//! where `a` and `b` are normal with correlation `S`. It is `p (1 - p)` for `S = 1`, as for a count, and 0 for `S = 0`. The variance of `p`
//! is the sum of `V/n` over the samples.
//!
//! One further part that was not measured may lie beyond all others. It is taken to lie `K` sigmas from the mean. For a limit at `d` sigmas
//! it is rejected with the probability `h = Phi((K sqrt S - d)/sqrt(1 - S))`, and has the weight `w = h/n`. The interval is that of a
//! weighted count (Fay and Feuer 1997). The lower end follows from mean `p` and variance `sum V/n`, the upper end from `p + sum w` and
//! `sum V/n + sum w^2`. The upper end is never above that of the same rows paired to one sample, as above.
//!
//! The assumption is `K`: five sigmas, or one and a half times the distance of the farthest value of the sample.

use std::f64::consts::TAU;

use statrs::distribution::{ContinuousCDF, Gamma};

use crate::correlation::{Correlation, JointLaw};
use crate::dimension::Dimension;
use crate::distribution::{Distribution, standard_normal};
use crate::sampling::estimate::clopper_pearson;

/// Probability beyond either end of a 95 % interval.
const SIDE: f64 = 0.025;
/// Least distance from the mean, in sigmas, at which a part that was not measured is taken to lie. Tested on 14 studies with normal,
/// uniform, skewed, heavy-tailed and two-peaked samples of 30 to 1000 values. The intervals contain the true share in at least 93 % of
/// cases with 5, in at least 73 % with 4.
const REACH: f64 = 5.0;
/// Distance of a part that was not measured, relative to the farthest value of the sample. More parts of a skewed process lie farther out.
const FARTHER: f64 = 1.5;
/// Share of the variance below which a sample does not limit the number of independent assemblies.
const IDLE: f64 = 0.01;
/// Shape above which a gamma distribution is normal to 1e-3 of its sigma.
const NEARLY_NORMAL: f64 = 1e6;

/// Sample of measured parts among the inputs: one dimension, or several by rows.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSample {
    /// Indices of the dimensions, ascending.
    pub dimensions: Vec<usize>,
    /// Number of values, or of rows.
    pub size: usize,
    /// True if the values themselves are the distribution, false if a smooth one was fitted to them.
    pub is_empirical: bool,
    /// True if the sample is correlated with dimensions outside its own rows.
    pub is_correlated: bool,
    /// Distance from the mean at which a part that was not measured may lie, in sigmas of the sample.
    reach: f64,
}

impl MeasuredSample {
    /// Measured samples among these dimensions.
    pub fn all(dimensions: &[Dimension], correlation: Option<&Correlation>) -> Vec<Self> {
        let mut samples: Vec<Self> = Vec::new();
        for block in correlation.iter().flat_map(|of| of.blocks()) {
            let JointLaw::Rows(rows) = &block.law else { continue };
            let mut members = block.members.clone();
            members.sort_unstable();
            let reach = members.iter().map(|&d| reach(&dimensions[d])).fold(REACH, f64::max);
            let (is_empirical, is_correlated) = (true, false);
            samples.push(Self { dimensions: members, size: rows.len(), is_empirical, is_correlated, reach });
        }
        for (d, dimension) in dimensions.iter().enumerate() {
            let Some(law) = dimension.distribution() else { continue };
            let Some(measured) = law.measured().filter(|_| !samples.iter().any(|one| one.dimensions.contains(&d)))
            else {
                continue;
            };
            let is_empirical = law.probability().is_some_and(|of| !of.atoms().is_empty());
            let is_correlated = correlation.is_some_and(|of| of.members().contains(&d) && of.block_of(d).is_none());
            let (dimensions, size) = (vec![d], measured.sample().len());
            samples.push(Self { dimensions, size, is_empirical, is_correlated, reach: reach(dimension) });
        }
        samples
    }

    /// Sample as an input of a characteristic, with this share of the variance. The share counts as 1 if it is NaN or if the sample is
    /// correlated with other dimensions. A correlated sample gives the interval of a count.
    pub fn with_share(&self, share: f64) -> MeasuredInput {
        let share = if share.is_nan() || self.is_correlated { 1.0 } else { share.clamp(0.0, 1.0) };
        // A part that was not measured then has an unknown distance from the mean and counts as rejected.
        let reach = if self.is_correlated { f64::INFINITY } else { self.reach };
        MeasuredInput { size: self.size, share, reach }
    }
}

fn reach(dimension: &Dimension) -> f64 {
    let measured = dimension.distribution().and_then(Distribution::measured);
    let standard = measured.map_or(&[][..], |of| of.sample().standard());
    standard.iter().fold(REACH, |farthest, u| farthest.max(FARTHER * u.abs()))
}

/// Measured sample as an input of one characteristic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredInput {
    size: usize,
    /// Share of the variance of the characteristic, interactions included.
    share: f64,
    reach: f64,
}

/// Measured samples on which a characteristic depends.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredBasis {
    /// Measured samples, at least one.
    pub inputs: Vec<MeasuredInput>,
    /// True if no other input of the characteristic varies, and every sample is its own distribution.
    pub alone: bool,
    /// Distance of the nearer limit from the mean, in sigmas of the characteristic; negative if the mean is beyond the limit.
    pub distance: f64,
}

impl MeasuredBasis {
    /// 95 % interval of a rejected share from the size of the samples alone.
    ///
    /// Source: Clopper and Pearson, Biometrika 26 (1934); Hoeffding, J. Am. Stat. Assoc. 58 (1963), section 5; Fay and Feuer,
    /// Statistics in Medicine 16 (1997).
    pub fn interval(&self, rejected: f64) -> [f64; 2] {
        let size = self.fewest() as f64;
        if self.alone {
            return clopper_pearson(rejected * size, size);
        }
        // Weighted counts: the explained variance and the weight of an unmeasured part, for each sample by itself.
        let each = |of: fn(&Self, &MeasuredInput, f64) -> f64| -> Vec<f64> {
            self.inputs.iter().map(|input| of(self, input, rejected) / input.size as f64).collect()
        };
        let (variances, weights) = (each(|_, input, p| explained(input.share, p)), each(Self::unseen));
        let variance: f64 = variances.iter().sum();
        let low = weighted_count(rejected, variance, SIDE);
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        let by_samples = weighted_count(rejected + weights.iter().sum::<f64>(), variance + squares, 1.0 - SIDE);
        // All samples paired to one, whose rows no two assemblies share.
        let share = self.inputs.iter().map(|input| input.share).sum::<f64>().min(1.0);
        let reach = self.inputs.iter().map(|input| input.reach).fold(0.0, f64::max);
        let paired = MeasuredInput { size: self.fewest(), share, reach };
        let weight = self.unseen(&paired, rejected) / size;
        let variance = explained(share, rejected) / size + weight * weight;
        let by_pairs = weighted_count(rejected + weight, variance, 1.0 - SIDE);
        [low.min(rejected), by_samples.min(by_pairs).clamp(rejected, 1.0)]
    }

    /// Size of the smallest sample that matters.
    fn fewest(&self) -> usize {
        let sizes = |least: f64| self.inputs.iter().filter(move |input| input.share >= least).map(|input| input.size);
        sizes(IDLE).min().or_else(|| sizes(0.0).min()).unwrap_or(1)
    }

    /// Excess of the reject probability of an assembly with a part beyond the sample over the rejected share.
    fn unseen(&self, input: &MeasuredInput, rejected: f64) -> f64 {
        let rest = (1.0 - input.share).max(f64::EPSILON).sqrt();
        (standard_normal::cdf((input.reach * input.share.sqrt() - self.distance) / rest) - rejected).max(0.0)
    }
}

/// Variance of the reject probability for a given value of an input with this share of the variance: `V(S)` of the module documentation.
fn explained(share: f64, rejected: f64) -> f64 {
    /// Intervals of Simpson's rule over the arc sine of the correlation. The integrand is smooth, and 64 intervals have an error of 1e-9.
    const STEPS: usize = 64;
    if rejected <= 0.0 || rejected >= 1.0 {
        return 0.0;
    }
    let square = standard_normal::upper_quantile(rejected).powi(2);
    let end = libm::asin(share.clamp(0.0, 1.0));
    let density = |step: usize| {
        let sine = libm::sin(end * step as f64 / STEPS as f64);
        libm::exp(-square / (1.0 + sine)) / TAU
    };
    let inner: f64 = (1..STEPS).map(|step| density(step) * if step % 2 == 0 { 2.0 } else { 4.0 }).sum();
    (density(0) + inner + density(STEPS)) * end / (3.0 * STEPS as f64)
}

/// Quantile of a weighted count with this mean and variance, by the gamma distribution with the same moments.
fn weighted_count(mean: f64, variance: f64, p: f64) -> f64 {
    if mean <= 0.0 || variance <= 0.0 {
        return mean.max(0.0);
    }
    let shape = mean * mean / variance;
    if shape > NEARLY_NORMAL {
        return mean + variance.sqrt() * standard_normal::quantile(p);
    }
    Gamma::new(shape, mean / variance).map_or(mean, |law| law.inverse_cdf(p))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn basis(inputs: &[(usize, f64)], alone: bool, distance: f64) -> MeasuredBasis {
        let input = |&(size, share): &(usize, f64)| MeasuredInput { size, share, reach: REACH };
        MeasuredBasis { inputs: inputs.iter().map(input).collect(), alone, distance }
    }

    /// 195 rows without a reject give an upper end of `1 - 0.025^(1/195)` = 1.874 %. A second sample of 400 does not change it.
    #[test]
    fn rows_without_a_reject_leave_what_a_count_leaves() {
        let most = 1.0 - 0.025_f64.powf(1.0 / 195.0);
        for inputs in [&[(195, 1.0)][..], &[(400, 0.5), (195, 0.5)]] {
            let [low, high] = basis(inputs, true, 9.0).interval(0.0);
            assert!(low == 0.0 && (high - most).abs() < 1e-12, "{low} {high}");
        }
        // A sample of five with a negligible share is ignored.
        let [_, high] = basis(&[(5, 1e-4), (195, 0.9999)], true, 9.0).interval(0.0);
        assert!((high - most).abs() < 1e-12, "{high}");
    }

    /// Limits of the explained variance. With the whole variance it is that of a count. With nearly none it is that of a slope: the reject
    /// probability changes by the density `phi(t)` for each sigma.
    #[test]
    fn the_explained_variance_has_its_limits() {
        for p in [1e-6, 1e-3, 0.02, 0.5, 0.9] {
            assert!((explained(1.0, p) / (p * (1.0 - p)) - 1.0).abs() < 1e-7, "{p} {}", explained(1.0, p));
            let slope = standard_normal::density(standard_normal::upper_quantile(p));
            assert!((explained(1e-6, p) / (1e-6 * slope * slope) - 1.0).abs() < 1e-4, "{p}");
        }
        // Orthant probabilities (Sheppard 1898): P(a > 0, b > 0) = 1/4 + asin(r)/(2 pi).
        let half = explained(0.5, 0.5);
        assert!((half - 0.5_f64.asin() / TAU).abs() < 1e-12, "{half}");
    }

    /// A sample with a tiny share leaves a tiny interval, and the interval grows with the share.
    #[test]
    fn what_is_left_open_grows_with_the_share() {
        let mut last = 0.0;
        for share in [1e-3, 0.01, 0.1, 0.3, 0.6, 0.9, 0.99] {
            let [low, high] = basis(&[(100, share)], false, 3.0).interval(0.002);
            assert!(low <= 0.002 && high > last, "{share}: {low} {high}");
            last = high;
        }
        let [low, high] = basis(&[(100, 1e-3)], false, 3.0).interval(0.002);
        assert!(low > 0.0019 && high < 0.0022, "{low} {high}");
    }
}
