//! Uncertainty of a sample's figures that comes from measured inputs, whose own samples are small.
//!
//! Points of a simulation repeat the rows of a measured sample: a million of them contain no more information about the process than the
//! rows. The points are divided into groups of equal rows, or of neighbouring values. With `m` and `q` the means of `y` and of `(y -
//! mean)^2` within a group, a sample of `n` rows leaves the uncertainty
//!
//! ```text
//! var(mean) = Var(m)/n        var(sigma) = Var(q)/(4 sigma^2 n)        var(Cpk) = Var(-+ m/(3 sigma) - Cpk q/(2 sigma^2))/n
//! ```
//!
//! The variances are over the groups, weighted by their shares of the points. Those of independent samples add up. These are the first
//! terms of Hoeffding's decomposition (1948), by which a mean over several samples is asymptotically normal. The noise of a group's own
//! mean adds at most a fiftieth of the variance, because a group has fifty points or more.

use crate::simulation::SimulatedCharacteristic;
use crate::simulation::sample_groups::{Group, GroupSums, Grouped, MeasuredGroups};
use crate::verification::CONFIDENCE;
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::sampling::{MeasuredBasis, SamplingInterval, student_quantile};
use sensitol_numeric::verdict::{including, share};

/// Variance over groups, weighted by their shares of the points, of a function of the group.
fn variance(groups: &[Group], of: impl Fn(&Group) -> f64) -> f64 {
    let known = || groups.iter().filter(|group| group.count > 0.0);
    let total: f64 = known().map(|group| group.count).sum();
    let mean = known().map(|group| group.count * of(group)).sum::<f64>() / total;
    known().map(|group| group.count * (of(group) - mean).powi(2)).sum::<f64>() / total
}

/// Error of a figure that is the mean of a function of the group. Returns None if it is unknown.
type GroupError<'a> = &'a dyn Fn(&dyn Fn(&Group) -> f64) -> Option<f64>;

impl MeasuredGroups<'_> {
    /// Intervals of a characteristic by the uncertainty of measured samples. Returns None if it depends on none.
    pub(super) fn interval(
        &self,
        c: usize,
        found: &SimulatedCharacteristic,
        sums: &GroupSums,
    ) -> Option<SamplingInterval> {
        let depends = |one: &Grouped<'_>| one.sample.dimensions.iter().any(|&d| self.dependence[c][d]);
        let own: Vec<(&Grouped<'_>, &Vec<Group>)> =
            self.samples.iter().zip(&sums.0).filter(|(one, _)| depends(one)).collect();
        let fewest = own.iter().map(|(one, _)| one.sample.size).min()?;
        let (mean, sigma) = (found.mean?.value, found.sigma?.value);
        // Student's quantile of the smallest sample, because two standard errors of few values are too narrow.
        let wide = student_quantile(0.5 * (1.0 + CONFIDENCE), (fewest.max(2) - 1) as f64);
        let correlated = own.iter().any(|(one, _)| one.sample.is_correlated);
        let error = |of: &dyn Fn(&Group) -> f64| {
            let variance = own.iter().map(|(one, groups)| variance(groups, of) / one.divisor).sum::<f64>();
            Some(wide * variance.sqrt()).filter(|error| error.is_finite() && !correlated)
        };
        // Mean square about the mean of all points.
        let square = |group: &Group| group.square / group.count + (group.mean - mean).powi(2);
        let about = |value: f64, error: Option<f64>| error.map(|error| [value - error, value + error]);
        let part = error(&square).map(|error| error / (2.0 * sigma * sigma));
        let limits = found.characteristic.limits();
        let cpk = found.cpk.and_then(|cpk| {
            let side = nearer(limits, mean);
            about(cpk, error(&|group| side * group.mean / (3.0 * sigma) - cpk * square(group) / (2.0 * sigma * sigma)))
        });
        let names = |one: &Grouped<'_>| {
            let size = one.sample.size;
            let name = |d: usize| (self.problem.dimensions()[d].name().to_owned(), size);
            one.sample.dimensions.iter().map(|&d| name(d)).collect::<Vec<_>>()
        };
        Some(SamplingInterval {
            mean: about(mean, error(&|group| group.mean)),
            // Symmetric in the logarithm, because sigma is positive.
            sigma: part.filter(|part| part.is_finite()).map(|part| [-part, part].map(|by| sigma * libm::exp(by))),
            skewness: None,
            kurtosis: None,
            rejected: self.rejected(c, found, &own, &error),
            cpk,
            level: CONFIDENCE,
            resamples: 0,
            samples: own.iter().flat_map(|(one, _)| names(one)).collect(),
        })
    }

    /// Interval of a characteristic's reject rate. Returns None if there are no limits.
    fn rejected(
        &self,
        c: usize,
        found: &SimulatedCharacteristic,
        own: &[(&Grouped<'_>, &Vec<Group>)],
        error: GroupError<'_>,
    ) -> Option<[f64; 2]> {
        let rejected = 1.0 - found.yield_?.value;
        let (mean, square) = (found.mean?.value, found.sigma?.value.powi(2));
        let input = |(one, groups): &(&Grouped<'_>, &Vec<Group>)| {
            // The mean of a group of rows in turn has a variance that is smaller by the number of rows.
            let rows = one.sample.size as f64 / one.divisor;
            let first = variance(groups, |group| group.mean) * rows / square;
            let spread = |group: &Group| group.square / group.count + (group.mean - mean).powi(2);
            // A linear effect of a normal variable changes the mean square by twice the square of its share. The rest comes from
            // interactions.
            let second = 0.5 * variance(groups, spread) * rows / (square * square) - first * first;
            one.sample.with_share(first + second.max(0.0))
        };
        let varies = |&d: &usize| self.dependence[c][d] && self.problem.dimensions()[d].sigma() > 0.0;
        let measured = |d: usize| own.iter().any(|(one, _)| one.sample.dimensions.contains(&d));
        let alone = own.iter().all(|(one, _)| one.sample.is_empirical)
            && (0..self.problem.dimensions().len()).filter(varies).all(measured);
        let distance = 3.0 * found.cpk.unwrap_or(0.0);
        let counted = MeasuredBasis { inputs: own.iter().map(input).collect(), alone, distance }.interval(rejected);
        if alone {
            return Some(counted);
        }
        let scatter = error(&|group| group.rejects / group.count).unwrap_or(0.0);
        Some(share([rejected - scatter, rejected + scatter].into_iter().fold(counted, including)))
    }
}

/// Sign of the change of the distance to the nearer limit with the mean.
fn nearer(limits: SpecLimits, mean: f64) -> f64 {
    let room = |limit: Option<f64>| limit.map_or(f64::INFINITY, |limit| (limit - mean).abs());
    if room(limits.lower()) < room(limits.upper()) { 1.0 } else { -1.0 }
}
