//! Intervals that hold a given share of assemblies: the coverage intervals of measurement uncertainty.

use super::characteristic::CharacteristicAnalysis;
use super::counted::points;
use super::coverage_intervals::CoverageIntervals;
use super::surface_law::{full_law, quantiles_at};
use super::yield_source::YieldSource;
use crate::method::Outcome;
use crate::problem::Problem;
use sensitol_numeric::capability::Law;
use sensitol_numeric::law::LawTail;
use sensitol_numeric::pearson::Pearson;

/// Splits of the share outside that are compared in one round,
const SPLITS: usize = 24;
/// and rounds, each between the neighbours of the best split of the one before: the last step is 3e-5 of the share outside.
const ROUNDS: usize = 4;
/// An interval that is shorter by less than this part is not: quantiles are known to 1e-7 sigma.
const SHORTER: f64 = 1e-6;

/// The intervals of a characteristic, at no evaluation; `surface` where its moments follow from one. None where nothing is known of its distribution.
pub(super) fn covered(
    problem: &Problem,
    outcome: &Outcome,
    (c, seed): (usize, u64),
    one: &CharacteristicAnalysis,
    (probability, surface): (f64, bool),
) -> Option<CoverageIntervals> {
    if !(0.5..1.0).contains(&probability) {
        return None;
    }
    let with = |source: YieldSource, [equal_tails, shortest]: [[f64; 2]; 2]| CoverageIntervals {
        probability,
        equal_tails,
        shortest,
        source,
    };
    let fit = one.law.as_ref().and_then(|law| law.as_ref().ok());
    if let Some(Law::Point { at }) = fit {
        return Some(with(YieldSource::Proof, [[*at; 2]; 2]));
    }
    if surface {
        let law = full_law(problem, outcome, c).and_then(Result::ok);
        let by_law = law.and_then(|law| intervals(probability, |sought| quantiles_at(&law, fit, sought)));
        let found = by_law.or_else(|| of_points(&points(problem, outcome, (c, seed))?, probability));
        if let Some(found) = found {
            return Some(with(YieldSource::SurfaceLaw, found));
        }
    }
    let sample = one.verification.as_ref().and_then(|of| of.sample.as_deref());
    if let Some(found) = sample.and_then(|sample| of_weighted(&sample.sorted(), probability)) {
        return Some(with(YieldSource::Samples, found));
    }
    let Some(Law::Pearson(fit)) = fit else { return None };
    intervals(probability, |sought| Some(sought.iter().map(|&of| of_pearson(fit, of)).collect()))
        .map(|found| with(YieldSource::Pearson, found))
}

fn of_pearson(fit: &Pearson, (tail, p): (LawTail, f64)) -> f64 {
    match tail {
        LawTail::Lower => fit.quantile(p),
        LawTail::Upper => fit.upper_quantile(p),
    }
}

/// With equal tails, and the shortest, by the quantiles of a law.
fn intervals(probability: f64, quantiles: impl Fn(&[(LawTail, f64)]) -> Option<Vec<f64>>) -> Option<[[f64; 2]; 2]> {
    let outside = 1.0 - probability;
    let at = |splits: &[f64]| -> Option<Vec<[f64; 2]>> {
        let lower = splits.iter().map(|split| (LawTail::Lower, outside * split));
        let upper = splits.iter().map(|split| (LawTail::Upper, outside * (1.0 - split)));
        let found = quantiles(&lower.chain(upper).collect::<Vec<_>>())?;
        let (low, high) = found.split_at(splits.len());
        Some(low.iter().zip(high).map(|(low, high)| [*low, *high]).collect())
    };
    let equal = *at(&[0.5])?.first()?;
    let mut best = equal;
    let [mut from, mut to] = [0.0, 1.0];
    for _ in 0..ROUNDS {
        let step = (to - from) / SPLITS as f64;
        let splits: Vec<f64> = (0..SPLITS).map(|i| from + step * (i as f64 + 0.5)).collect();
        let found = at(&splits)?;
        let (i, shortest) = found.iter().enumerate().min_by(|(_, a), (_, b)| width(a).total_cmp(&width(b)))?;
        if width(shortest) < (1.0 - SHORTER) * width(&equal) && width(shortest) < width(&best) {
            best = *shortest;
        }
        [from, to] = [(splits[i] - step).max(0.0), (splits[i] + step).min(1.0)];
    }
    Some([equal, best])
}

fn width([low, high]: &[f64; 2]) -> f64 {
    high - low
}

/// The same of values in order.
fn of_points(values: &[f64], probability: f64) -> Option<[[f64; 2]; 2]> {
    let weighted: Vec<(f64, f64)> = values.iter().map(|&y| (y, 1.0)).collect();
    of_weighted(&weighted, probability)
}

/// The same of values in order with their weights.
fn of_weighted(values: &[(f64, f64)], probability: f64) -> Option<[[f64; 2]; 2]> {
    let total: f64 = values.iter().map(|(_, weight)| weight).sum();
    if total.is_nan() || total <= 0.0 {
        return None;
    }
    // The share up to and with each value.
    let shares: Vec<f64> = values
        .iter()
        .scan(0.0, |sum, (_, weight)| {
            *sum += weight / total;
            Some(*sum)
        })
        .collect();
    let last = values.len() - 1;
    let place = |share: f64| shares.partition_point(|&own| own < share).min(last);
    let equal = [0.5 * (1.0 - probability), 0.5 * (1.0 + probability)].map(|share| values[place(share)].0);
    let mut best = equal;
    for (i, (low, _)) in values.iter().enumerate() {
        let before = if i == 0 { 0.0 } else { shares[i - 1] };
        if before + probability > shares[last] {
            break;
        }
        let interval = [*low, values[place(before + probability)].0];
        if width(&interval) < (1.0 - SHORTER) * width(&best) {
            best = interval;
        }
    }
    Some([equal, best])
}
