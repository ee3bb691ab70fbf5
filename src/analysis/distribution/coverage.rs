//! Intervals that hold a given share of assemblies: the coverage intervals of measurement uncertainty.

use std::cell::Cell;

use crate::analysis::distribution::law_guard::FaultyQuantiles;
use crate::analysis::distribution::quantile_selection::QuantileSelection;
use crate::analysis::result::coverage_intervals::CoverageIntervals;
use sensitol_numeric::capability::EstimatedQuantile;
use sensitol_numeric::law::{LawTail, REPORTED_QUANTILES};

/// Number of splits of the outside share that are compared in one round.
const SPLITS: usize = 24;
/// Number of rounds, each between the neighbours of the best split of the round before. The last step is 3e-5 of the outside share.
const ROUNDS: usize = 4;
/// Smallest relative gain in length that counts as shorter: quantiles are known to 1e-7 sigma.
const SHORTER: f64 = 1e-6;

/// Coverage intervals of a characteristic, without evaluations. Returns None for a probability outside of 0.5 to 1.
///
/// # Errors
/// Returns an error if the quantiles give no intervals. Points of the surface have to replace its distribution then.
pub(in crate::analysis) fn covered(
    selection: &QuantileSelection<'_>,
    probability: f64,
) -> Result<Option<CoverageIntervals>, FaultyQuantiles> {
    if !(0.5..1.0).contains(&probability) {
        return Ok(None);
    }
    // Together with the reported quantiles, which are tested by points.
    let reported: Vec<((LawTail, f64), EstimatedQuantile)> = (REPORTED_QUANTILES.into_iter())
        .zip(selection.reported().0)
        .filter_map(|(at, found)| Some((at, found?)))
        .collect();
    let fallen = Cell::new(None);
    let found = intervals(probability, |sought| {
        let found = selection.at(sought);
        let known = sought.iter().zip(&found).filter_map(|(at, found)| Some((*at, (*found)?)));
        fallen.set(fallen.get().or(falls(known.chain(reported.iter().copied()).collect())));
        found
    });
    match (fallen.get(), found) {
        (Some((p, y)), _) => Err(FaultyQuantiles::Fall(p, y)),
        (None, None) => Err(FaultyQuantiles::Unknown),
        (None, Some([equal, shortest])) => Ok(Some(CoverageIntervals {
            probability,
            equal_tails: equal.map(|end| end.value),
            equal_tails_errors: equal.map(|end| end.error),
            shortest: shortest.map(|end| end.value),
            shortest_errors: shortest.map(|end| end.error),
            source: selection.source(),
        })),
    }
}

/// First probability whose quantile lies below that of a smaller probability by more than the errors of both, with its quantile.
fn falls(quantiles: Vec<((LawTail, f64), EstimatedQuantile)>) -> Option<(f64, f64)> {
    let below = |((tail, p), figure): ((LawTail, f64), EstimatedQuantile)| match tail {
        LawTail::Lower => (p, figure),
        LawTail::Upper => (1.0 - p, figure),
    };
    let mut all: Vec<(f64, EstimatedQuantile)> = quantiles.into_iter().map(below).collect();
    all.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let falls = |pair: &&[(f64, EstimatedQuantile)]| {
        let [(_, low), (_, high)] = [pair[0], pair[1]];
        low.value > high.value + low.error.unwrap_or(0.0) + high.error.unwrap_or(0.0)
    };
    all.windows(2).find(falls).map(|pair| (pair[1].0, pair[1].1.value))
}

/// Interval with equal tails, and the shortest interval, from the quantiles of a distribution. Returns None if the equal tails are not
/// resolved.
fn intervals(
    probability: f64,
    quantiles: impl Fn(&[(LawTail, f64)]) -> Vec<Option<EstimatedQuantile>>,
) -> Option<[[EstimatedQuantile; 2]; 2]> {
    let outside = 1.0 - probability;
    let at = |splits: &[f64]| -> Vec<Option<[EstimatedQuantile; 2]>> {
        let lower = splits.iter().map(|split| (LawTail::Lower, outside * split));
        let upper = splits.iter().map(|split| (LawTail::Upper, outside * (1.0 - split)));
        let found = quantiles(&lower.chain(upper).collect::<Vec<_>>());
        let (low, high) = found.split_at(splits.len());
        low.iter().zip(high).map(|(low, high)| Some([(*low)?, (*high)?])).collect()
    };
    let equal = at(&[0.5])[0]?;
    let mut best = equal;
    // Each round narrows the splits of the outside share to the neighbours of the best. Splits with a tail that is not resolved are left
    // out.
    let [mut from, mut to] = [0.0, 1.0];
    for _ in 0..ROUNDS {
        let step = (to - from) / SPLITS as f64;
        let splits: Vec<f64> = (0..SPLITS).map(|i| from + step * (i as f64 + 0.5)).collect();
        let found = at(&splits).into_iter().enumerate().filter_map(|(i, interval)| Some((i, interval?)));
        let Some((i, shortest)) = found.min_by(|(_, a), (_, b)| width(a).total_cmp(&width(b))) else { break };
        if width(&shortest) < (1.0 - SHORTER) * width(&equal) && width(&shortest) < width(&best) {
            best = shortest;
        }
        [from, to] = [(splits[i] - step).max(0.0), (splits[i] + step).min(1.0)];
    }
    Some([equal, best])
}

fn width([low, high]: &[EstimatedQuantile; 2]) -> f64 {
    high.value - low.value
}
