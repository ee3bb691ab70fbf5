//! Intervals that hold a given share of assemblies: the coverage intervals of measurement uncertainty.

use std::cell::Cell;

use crate::analysis::distribution::law_guard::FaultyQuantiles;
use crate::analysis::distribution::surface_law::{GuardedLaw, QUANTILES};
use crate::analysis::result::characteristic::CharacteristicAnalysis;
use crate::analysis::result::coverage_intervals::CoverageIntervals;
use crate::analysis::result::yield_source::YieldSource;
use sensitol_numeric::capability::Law;
use sensitol_numeric::law::{LawFigure, LawTail};
use sensitol_numeric::pearson::Pearson;

/// Number of splits of the outside share that are compared in one round.
const SPLITS: usize = 24;
/// Number of rounds, each between the neighbours of the best split of the round before. The last step is 3e-5 of the outside share.
const ROUNDS: usize = 4;
/// Smallest relative gain in length that counts as shorter: quantiles are known to 1e-7 sigma.
const SHORTER: f64 = 1e-6;

/// Coverage intervals of a characteristic, without evaluations. Returns None if nothing is known of its distribution.
///
/// `law` is the distribution of the surface, if the moments follow from a surface.
///
/// # Errors
/// Returns an error if the quantiles of the surface distribution give no intervals. Points have to replace the distribution then.
pub(in crate::analysis) fn covered(
    one: &CharacteristicAnalysis,
    law: Option<&GuardedLaw>,
    probability: f64,
) -> Result<Option<CoverageIntervals>, FaultyQuantiles> {
    if !(0.5..1.0).contains(&probability) {
        return Ok(None);
    }
    let with = |source: YieldSource, [equal_tails, shortest]: [[f64; 2]; 2]| {
        Some(CoverageIntervals { probability, equal_tails, shortest, source })
    };
    let fit = one.law.as_ref().and_then(|law| law.as_ref().ok());
    if let Some(Law::Point { at }) = fit {
        return Ok(with(YieldSource::Proof, [[*at; 2]; 2]));
    }
    if let Some(law) = law {
        let found = match &law.points {
            Some(points) => of_points(points, probability),
            None => Some(by_law(law, fit, probability)?),
        };
        if let Some(found) = found {
            return Ok(with(YieldSource::SurfaceLaw, found));
        }
    }
    let sample = one.verification.as_ref().and_then(|of| of.sample.as_deref());
    if let Some(found) = sample.and_then(|sample| of_weighted(&sample.sorted(), probability)) {
        return Ok(with(YieldSource::Samples, found));
    }
    let Some(Law::Pearson(fit)) = fit else { return Ok(None) };
    let found = intervals(probability, |sought| Some(sought.iter().map(|&of| of_pearson(fit, of)).collect()));
    Ok(found.and_then(|found| with(YieldSource::Pearson, found)))
}

/// Intervals from a distribution whose quantiles rise. Returns an error if they fall or are unknown.
fn by_law(law: &GuardedLaw, fit: Option<&Law>, probability: f64) -> Result<[[f64; 2]; 2], FaultyQuantiles> {
    let fallen = Cell::new(None);
    let found = intervals(probability, |sought| {
        let found = law.quantiles(fit, sought)?;
        // Together with the quantiles that are tested by points.
        let tested = law.shares.quantiles.iter().flat_map(|all| QUANTILES.into_iter().zip(*all));
        let all = sought.iter().copied().zip(found.iter().copied()).chain(tested);
        fallen.set(fallen.get().or(falls(all.collect())));
        Some(found.iter().map(|figure| figure.value).collect())
    });
    match (fallen.get(), found) {
        (Some((p, y)), _) => Err(FaultyQuantiles::Fall(p, y)),
        (None, found) => found.ok_or(FaultyQuantiles::Unknown),
    }
}

/// First probability whose quantile lies below that of a smaller probability by more than the errors of both, with its quantile.
fn falls(quantiles: Vec<((LawTail, f64), LawFigure)>) -> Option<(f64, f64)> {
    let below = |((tail, p), figure): ((LawTail, f64), LawFigure)| match tail {
        LawTail::Lower => (p, figure),
        LawTail::Upper => (1.0 - p, figure),
    };
    let mut all: Vec<(f64, LawFigure)> = quantiles.into_iter().map(below).collect();
    all.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let falls = |pair: &&[(f64, LawFigure)]| {
        let [(_, low), (_, high)] = [pair[0], pair[1]];
        low.value > high.value + low.error + high.error
    };
    all.windows(2).find(falls).map(|pair| (pair[1].0, pair[1].1.value))
}

fn of_pearson(fit: &Pearson, (tail, p): (LawTail, f64)) -> f64 {
    match tail {
        LawTail::Lower => fit.quantile(p),
        LawTail::Upper => fit.upper_quantile(p),
    }
}

/// Interval with equal tails, and the shortest interval, from the quantiles of a distribution.
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
    // Each round narrows the splits of the outside share to the neighbours of the best.
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

/// Interval with equal tails, and the shortest interval, of values in ascending order.
fn of_points(values: &[f64], probability: f64) -> Option<[[f64; 2]; 2]> {
    let weighted: Vec<(f64, f64)> = values.iter().map(|&y| (y, 1.0)).collect();
    of_weighted(&weighted, probability)
}

/// Interval with equal tails, and the shortest interval, of values in ascending order with their weights.
fn of_weighted(values: &[(f64, f64)], probability: f64) -> Option<[[f64; 2]; 2]> {
    let total: f64 = values.iter().map(|(_, weight)| weight).sum();
    if total.is_nan() || total <= 0.0 {
        return None;
    }
    // Cumulative share of each value, inclusive.
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
