//! Intervals of results that depend on measured samples.
//!
//! A sample that keeps the limits proves nothing about its process. Mean, sigma, skewness, kurtosis and Cpk have the intervals of resamples
//! ([`crate::analysis::sampling::bootstrap`]). The reject rate has the interval of counts ([`MeasuredBasis`]). If other inputs vary too, it is widened to that
//! of the resamples, which follow the surface.

use crate::analysis::result::stage_figures::SamplingFigures;
use crate::analysis::sampling::bootstrap::{ResampledIntervals, resampled_intervals};
use crate::analysis::{CharacteristicAnalysis, SamplingInterval};
use crate::method::Outcome;
use crate::problem::Problem;
use crate::verification::CONFIDENCE;
use sensitol_numeric::capability::Capability;
use sensitol_numeric::sampling::{MeasuredBasis, MeasuredSample};
use sensitol_numeric::verdict::{including, share, sides_with_samples};

/// Measured samples on which a characteristic depends.
pub(in crate::analysis) fn samples_of(problem: &Problem, outcome: &Outcome, c: usize) -> Vec<MeasuredSample> {
    let mut samples = MeasuredSample::all(problem.dimensions(), problem.correlation());
    samples.retain(|one| one.dimensions.iter().any(|&d| outcome.plan.depends(c, d)));
    samples
}

/// Intervals of the characteristics that depend on measured samples, by their places, and true if samples were drawn anew for them.
pub(in crate::analysis) fn sampling_intervals(
    problem: &Problem,
    outcome: &Outcome,
    characteristics: &[CharacteristicAnalysis],
    seed: u64,
) -> (Vec<(usize, SamplingFigures)>, bool) {
    let resampled = resampled_intervals(problem, outcome, characteristics, seed);
    let drawn = resampled.iter().any(Option::is_some);
    let mut found = Vec::new();
    for ((c, one), resampled) in characteristics.iter().enumerate().zip(resampled) {
        let samples = samples_of(problem, outcome, c);
        if samples.is_empty() || one.moments.is_none() {
            continue;
        }
        let measured = |d: usize| samples.iter().any(|sample| sample.dimensions.contains(&d));
        let depended = outcome.plan.varying().iter().filter(|&&d| outcome.plan.depends(c, d));
        let alone = samples.iter().all(|sample| sample.is_empirical) && depended.clone().all(|&d| measured(d));
        let interval = SamplingInterval {
            rejected: rejected(one, &samples, alone, resampled.as_ref()),
            samples: (samples.iter())
                .flat_map(|sample| sample.dimensions.iter().map(|&d| (d, sample.size)))
                .map(|(d, size)| (problem.dimensions()[d].name().to_owned(), size))
                .collect(),
            ..by_resamples(resampled)
        };
        let sides = one.distribution.capability.map_or([None; 2], |of| [of.below, of.above]);
        let reject_intervals = sides_with_samples(sides, one.distribution.reject_intervals, interval.rejected);
        found.push((c, SamplingFigures { sampling: interval, reject_intervals }));
    }
    (found, drawn)
}

/// Intervals of all figures except the reject rate.
fn by_resamples(found: Option<ResampledIntervals>) -> SamplingInterval {
    let resamples = found.as_ref().map_or(0, |found| found.resamples);
    let [mean, sigma, skewness, kurtosis, _, cpk] = found.map_or([None; 6], |found| found.intervals);
    let (rejected, samples) = (None, Vec::new());
    SamplingInterval { mean, sigma, skewness, kurtosis, rejected, cpk, level: CONFIDENCE, resamples, samples }
}

/// Interval of a characteristic's reject rate. Returns None if there are no limits, and if the reject rate is unknown.
fn rejected(
    one: &CharacteristicAnalysis,
    samples: &[MeasuredSample],
    alone: bool,
    resampled: Option<&ResampledIntervals>,
) -> Option<[f64; 2]> {
    let rejected = |of: Option<Capability>| of.and_then(|of| of.rejected());
    let reported = rejected(one.distribution.capability)?.clamp(0.0, 1.0);
    let distance = 3.0 * one.distribution.capability?.cpk.unwrap_or(0.0);
    let inputs = samples.iter().map(|sample| sample.with_share(variance_share(one, sample))).collect();
    let counted = MeasuredBasis { inputs, alone, distance }.interval(reported);
    if alone {
        return Some(counted);
    }
    let of_fit = resampled.and_then(|found| found.intervals[4]);
    // Ends of the interval of the fit, and the same ends scaled by the ratio of the reported reject rate to that of the fit.
    let by = rejected(one.evidence.pearson).map(|fit| reported / fit).filter(|by| by.is_finite() && *by > 0.0);
    let in_proportion = of_fit.zip(by).map(|(ends, by)| ends.map(|end| by * end));
    let ends = of_fit.into_iter().chain(in_proportion).flatten();
    Some(share(ends.fold(counted, including)))
}

/// Share of the variance of all dimensions of a sample together, with all interactions. Returns 1 if it is unknown.
fn variance_share(one: &CharacteristicAnalysis, sample: &MeasuredSample) -> f64 {
    if let Some(of_model) = one.evidence.verification.as_ref().and_then(|of| of.shares.as_ref()) {
        let name = |d: usize| one.sensitivities[d].dimension.as_str();
        let own = of_model.iter().filter(|of| sample.dimensions.iter().any(|&d| name(d) == of.dimension));
        return own.map(|of| of.total.value).sum::<f64>().clamp(0.0, 1.0);
    }
    let together = |dimensions: &mut dyn Iterator<Item = usize>| dimensions.map(|d| one.share(d)).sum::<Option<f64>>();
    let all = together(&mut (0..one.sensitivities.len()));
    let own = together(&mut sample.dimensions.iter().copied());
    own.zip(all).map_or(1.0, |(own, all)| own + (1.0 - all).max(0.0)).clamp(0.0, 1.0)
}
