//! The shares beyond the limits, the quantiles and the density counted at points of a surface, whose law could not be computed or is refuted.

use crate::method::Outcome;
use crate::problem::Problem;
use sensitol_numeric::characteristic::{KeptLimits, SpecLimits};
use sensitol_numeric::law::{LawFigure, LawTail, QUANTILE};
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::{Draws, Normals, Portion, SOBOL_DIMENSIONS, Sampler};

/// Points of the surface that are counted.
pub(super) const POINTS: usize = 1 << 16;
/// Points by which a law is tested: six standard errors of a share of a half are 3 %.
pub(super) const TESTED: usize = 1 << 13;
/// Points of a block.
const ROWS: usize = 1024;
/// Products of points and terms of the surface that are summed at most for a test: some tenths of a second.
const EFFORT: usize = 1 << 28;
/// Streams of the normal variable that stands for what a surface leaves out, beside those of the inputs.
const STREAM: u64 = 1;
/// Of which fewer are drawn where all of them would take more numbers than this.
const NUMBERS: usize = 4_000_000;
const FEWEST: usize = 1 << 13;
/// Points on either side that a count has been off at least, so that none that was seen is not none: three errors then reach 5/n, where
/// no point of `n` leaves 1 % beyond 4.6/n.
const UNSEEN: f64 = 3.0;

/// The counts of one characteristic.
pub(super) struct Counted {
    /// Shares below and above the limits; None without that limit.
    pub(super) beyond: [Option<LawFigure>; 2],
    pub(super) quantiles: [LawFigure; 7],
    pub(super) points: usize,
}

/// Values of the surface of one characteristic in ascending order, at as many points as are asked for or fewer.
///
/// `unexplained` is the variance of a normal variable beside the surface. Returns None if inputs cannot be drawn, or a part of the surface is
/// unknown.
pub(super) fn points(
    problem: &Problem,
    outcome: &Outcome,
    (c, seed): (usize, u64),
    (most, unexplained): (usize, Option<f64>),
) -> Option<Vec<f64>> {
    let surrogate = outcome.fitted[c].surrogate.as_ref()?;
    let varying = outcome.plan.varying();
    let sampler = if varying.len() <= SOBOL_DIMENSIONS { Sampler::Sobol } else { Sampler::Random };
    let draws = Draws::new(problem.dimensions(), problem.correlation(), sampler, seed).ok()?;
    let numbers = (NUMBERS / varying.len().max(1)).clamp(FEWEST, POINTS).next_power_of_two().min(most);
    let terms = surrogate.parts.len() + surrogate.interactions.each_pair().count();
    // The points of a test are fewer where every one of them is a sum of half a million products.
    let affordable = if most < POINTS { (EFFORT / terms.max(1)).max(ROWS) } else { numbers };
    let blocks = numbers.min(affordable) / ROWS;
    // Block by block, so that the inputs of a thousand dimensions take no more memory than those of ten.
    let values = |block: usize| -> Option<Vec<f64>> {
        let points = draws.points(Portion { replicate: 0, first: (block * ROWS) as u64, rows: ROWS });
        let rises = surrogate.rises(&problem.standardised(&points, varying))?;
        Some(rises.iter().map(|rise| surrogate.centre + rise).collect())
    };
    let mut values = (0..blocks).into_par_iter().map(values).collect::<Option<Vec<_>>>()?.concat();
    if let Some(variance) = unexplained {
        let beside = Normals::random(1, seed).columns(STREAM, values.len());
        let sigma = variance.sqrt();
        values.iter_mut().zip(beside.first()?).for_each(|(y, z)| *y += sigma * z);
    }
    values.sort_unstable_by(f64::total_cmp);
    Some(values)
}

/// Counts of one characteristic beyond its limits, and its quantiles at these probabilities, by values in ascending order.
pub(super) fn counted(
    values: &[f64],
    (limits, kept): (SpecLimits, KeptLimits),
    quantiles: [(LawTail, f64); 7],
) -> Counted {
    let below = limits.lower().map(|_| values.partition_point(|&y| kept.broken(y)[0]));
    let above = limits.upper().map(|_| values.len() - values.partition_point(|&y| !kept.broken(y)[1]));
    let share = |count: usize| {
        LawFigure::counted(count as f64 / values.len() as f64, error(count as f64, values.len()) / values.len() as f64)
    };
    Counted {
        beyond: [below, above].map(|count| count.map(share)),
        quantiles: quantiles.map(|(tail, p)| quantile(values, tail, p)),
        points: values.len(),
    }
}

/// The density by values in ascending order, `[y, density, error]` at equal distances between far quantiles.
pub(super) fn density(values: &[f64], places: usize) -> Option<Vec<[f64; 3]>> {
    /// Share of the values that is left out on either side.
    const OUTSIDE: f64 = 1e-3;
    let n = values.len();
    let cut = (OUTSIDE * n as f64) as usize;
    let (from, to) = (*values.get(cut)?, *values.get(n.checked_sub(cut + 1)?)?);
    let step = (to - from) / places as f64;
    let at = |place: usize| {
        let y = from + step * place as f64;
        let count =
            values.partition_point(|&own| own < y + 0.5 * step) - values.partition_point(|&own| own < y - 0.5 * step);
        let of = |count: f64| count / (n as f64 * step);
        [y, of(count as f64), of(error(count as f64, n))]
    };
    (step > 0.0).then(|| (0..=places).map(at).collect())
}

/// By how many points a count may be off.
fn error(count: f64, points: usize) -> f64 {
    let n = points as f64 + 2.0 * UNSEEN;
    let share = (count + UNSEEN) / n;
    QUANTILE * (n * share * (1.0 - share)).sqrt()
}

/// The value in the middle of those that a count of this probability may have been off.
fn quantile(values: &[f64], tail: LawTail, p: f64) -> LawFigure {
    let n = values.len();
    let at = |beyond: f64| {
        let rank = (beyond.max(0.0) as usize).min(n - 1);
        values[if tail == LawTail::Lower { rank } else { n - 1 - rank }]
    };
    let (count, off) = (p * n as f64, error(p * n as f64, n));
    let (value, inner, outer) = (at(count), at(count + off), at(count - off));
    LawFigure::counted(value, (value - inner).abs().max((value - outer).abs()))
}
