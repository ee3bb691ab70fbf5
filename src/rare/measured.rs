//! Error of a yield from the size of measured samples, in addition to that of the points of the model.
//!
//! Importance sampling gives the reject rate of the measured rows to a few percent. The reject rate of the process is
//! known only as far as the rows represent it ([`MeasuredBasis`]). The shares of the samples in the variance come from
//! the surrogate.

use crate::method::Outcome;
use crate::problem::Problem;
use crate::rare::RareCharacteristic;
use crate::verification::CONFIDENCE;
use sensitol_numeric::capability::cpk;
use sensitol_numeric::sampling::{MeasuredBasis, MeasuredSample, SamplingInterval};
use sensitol_numeric::verdict;

/// Adds the errors of measured samples to the intervals of the yields.
pub(super) fn with_sampling(
    problem: &Problem,
    outcome: &Outcome,
    characteristics: Vec<RareCharacteristic>,
) -> Vec<RareCharacteristic> {
    let samples = MeasuredSample::all(problem.dimensions(), problem.correlation());
    let one = |(c, mut one): (usize, RareCharacteristic)| {
        one.sampling = sampling(problem, outcome, (c, &samples), &one);
        let measured = one.sampling.as_ref().and_then(|of| of.rejected);
        if let (Some(interval), Some([low, high])) = (one.yield_interval, measured) {
            let value = one.yield_.unwrap_or(interval[1]);
            one.yield_interval = Some(verdict::share(verdict::joined(value, interval, [1.0 - high, 1.0 - low])));
        }
        one
    };
    characteristics.into_iter().enumerate().map(one).collect()
}

/// Interval of the joint yield with the errors of the samples.
///
/// Its bounds: no fewer assemblies are rejected than by any one characteristic, and no more than by the sum of all.
pub(super) fn joint(value: Option<f64>, interval: [f64; 2], characteristics: &[RareCharacteristic]) -> [f64; 2] {
    let value = value.unwrap_or(interval[1]);
    let (mut most, mut least, mut measured) = (1.0 - value, 0.0f64, false);
    for one in characteristics {
        let Some([low, high]) = one.sampling.as_ref().and_then(|of| of.rejected) else { continue };
        most += (high - one.yield_.map_or(0.0, |own| 1.0 - own)).max(0.0);
        (least, measured) = (least.max(low), true);
    }
    match measured {
        true => verdict::share(verdict::joined(value, interval, [1.0 - most, 1.0 - least.min(1.0 - value)])),
        false => interval,
    }
}

/// Error of a yield from the measured samples. Returns None if the characteristic depends on no sample, or has no
/// yield.
fn sampling(
    problem: &Problem,
    outcome: &Outcome,
    (c, samples): (usize, &[MeasuredSample]),
    one: &RareCharacteristic,
) -> Option<SamplingInterval> {
    let plan = &outcome.plan;
    let depends = |d: &usize| plan.depends(c, *d);
    let own: Vec<&MeasuredSample> = samples.iter().filter(|of| of.dimensions.iter().any(&depends)).collect();
    if own.is_empty() || one.yield_interval.is_none() {
        return None;
    }
    let contributions = outcome.fitted[c].surrogate.as_ref()?.contributions(plan.inputs())?;
    let part = |position: usize| contributions.linear[position] + contributions.curvature[position];
    let all: f64 = (0..plan.varying().len()).map(part).sum();
    let input = |sample: &&MeasuredSample| {
        let positions =
            (0..plan.varying().len()).filter(|&position| sample.dimensions.contains(&plan.varying()[position]));
        sample.with_share(positions.map(part).sum::<f64>() + (1.0 - all).max(0.0))
    };
    let measured = |d: &usize| own.iter().any(|sample| sample.dimensions.contains(d));
    let alone =
        own.iter().all(|sample| sample.is_empirical) && plan.varying().iter().filter(|d| depends(d)).all(measured);
    let moments = contributions.moments;
    let distance = 3.0 * cpk(moments.mean(), moments.sigma(), one.characteristic.limits()).unwrap_or(0.0);
    let basis = MeasuredBasis { inputs: own.iter().map(input).collect(), alone, distance };
    let rejected = one.yield_.map_or(0.0, |value| 1.0 - value);
    let names = own.iter().flat_map(|sample| sample.dimensions.iter().map(|&d| (d, sample.size)));
    Some(SamplingInterval {
        mean: None,
        sigma: None,
        skewness: None,
        kurtosis: None,
        rejected: Some(basis.interval(rejected)),
        cpk: None,
        level: CONFIDENCE,
        resamples: 0,
        samples: names.map(|(d, size)| (problem.dimensions()[d].name().to_owned(), size)).collect(),
    })
}
