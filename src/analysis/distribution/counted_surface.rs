//! Shares beyond the limits, quantiles and density, counted at points of a surface whose distribution could not be computed or is refuted.

use crate::method::Outcome;
use crate::problem::Problem;
use sensitol_numeric::characteristic::{KeptLimits, SpecLimits};
use sensitol_numeric::law::{LawFigure, LawTail, QUANTILE};
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::{Draws, Normals, Portion, SOBOL_DIMENSIONS, Sampler};

/// Greatest number of surface points that are counted.
pub(in crate::analysis) const POINTS: usize = 1 << 16;
/// Greatest number of points in the test of a distribution: six standard errors of a share of a half are 3 %.
pub(in crate::analysis) const TESTED: usize = 1 << 13;
/// Points of the surface that are evaluated together, to limit memory.
const ROWS: usize = 1024;
/// Greatest number of products of points and surface terms in a test: some tenths of a second.
const EFFORT: usize = 1 << 28;
/// Random stream of the normal variable that represents the variance which the surface does not explain. It differs from the streams of the
/// inputs.
const STREAM: u64 = 1;
/// Greatest count of random numbers (points times inputs). With many inputs, fewer points are drawn.
const NUMBERS: usize = 4_000_000;
/// Fewest points that are drawn, with any number of inputs.
const FEWEST: usize = 1 << 13;
/// Points added on either side of a count for its error, so that a count of zero has an error too. Three errors then reach 5/n. With no hit
/// among `n` points, the share exceeds 4.6/n with a probability of 1 % only.
const UNSEEN: f64 = 3.0;

pub(in crate::analysis) struct Counted {
    /// Shares below and above the limits. None if that limit does not exist.
    pub(in crate::analysis) beyond: [Option<LawFigure>; 2],
    pub(in crate::analysis) quantiles: [LawFigure; 7],
    pub(in crate::analysis) points: usize,
}

/// Values of the surface of one characteristic in ascending order, at `most` points or fewer.
///
/// `unexplained` is the variance of a normal variable that is added to the surface. Returns None if inputs cannot be drawn, or a part of
/// the surface is unknown.
pub(in crate::analysis) fn points(
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
    // A test uses fewer points if each is a sum of half a million products.
    let affordable = if most < POINTS { (EFFORT / terms.max(1)).max(ROWS) } else { numbers };
    let blocks = numbers.min(affordable) / ROWS;
    // In blocks, so that a thousand inputs take no more memory than ten.
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

/// Counts beyond the limits of one characteristic, and its quantiles at the given probabilities, from values in ascending order.
pub(in crate::analysis) fn counted(
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

/// Density from values in ascending order: `[y, density, error]` at equal distances between far quantiles.
pub(in crate::analysis) fn density(values: &[f64], places: usize) -> Option<Vec<[f64; 3]>> {
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

/// Error of a count, in points.
fn error(count: f64, points: usize) -> f64 {
    let n = points as f64 + 2.0 * UNSEEN;
    let share = (count + UNSEEN) / n;
    QUANTILE * (n * share * (1.0 - share)).sqrt()
}

/// Value of the quantile at probability `p`. Its error comes from the values at the count plus and minus its error.
pub(in crate::analysis) fn quantile(values: &[f64], tail: LawTail, p: f64) -> LawFigure {
    let n = values.len();
    let at = |beyond: f64| {
        let rank = (beyond.max(0.0) as usize).min(n - 1);
        values[if tail == LawTail::Lower { rank } else { n - 1 - rank }]
    };
    let (count, off) = (p * n as f64, error(p * n as f64, n));
    let (value, inner, outer) = (at(count), at(count + off), at(count - off));
    LawFigure::counted(value, (value - inner).abs().max((value - outer).abs()))
}
