//! The shares beyond the limits and the quantiles counted at points of a surface whose law could not be computed.

use crate::law::{LawFigure, LawTail, QUANTILE};
use crate::method::Outcome;
use crate::parallel::prelude::*;
use crate::problem::Problem;
use crate::sampling::{Draws, Portion, SOBOL_DIMENSIONS, Sampler};

/// Points of the surface, in blocks of so many.
const POINTS: usize = 1 << 16;
const ROWS: usize = 1024;
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

/// Values of the surface of one characteristic in order; None where its inputs cannot be drawn, or a part of its surface is unknown.
pub(super) fn points(problem: &Problem, outcome: &Outcome, (c, seed): (usize, u64)) -> Option<Vec<f64>> {
    let surrogate = outcome.fitted[c].surrogate.as_ref()?;
    let varying = outcome.plan.varying();
    let sampler = if varying.len() <= SOBOL_DIMENSIONS { Sampler::Sobol } else { Sampler::Random };
    let draws = Draws::new(problem.dimensions(), problem.correlation(), sampler, seed).ok()?;
    let blocks = (NUMBERS / varying.len().max(1)).clamp(FEWEST, POINTS).next_power_of_two().min(POINTS) / ROWS;
    // Block by block, so that the inputs of a thousand dimensions take no more memory than those of ten.
    let values = |block: usize| -> Option<Vec<f64>> {
        let points = draws.points(Portion { replicate: 0, first: (block * ROWS) as u64, rows: ROWS });
        let rises = surrogate.rises(&problem.standardised(&points, varying))?;
        Some(rises.iter().map(|rise| surrogate.centre + rise).collect())
    };
    let mut values = (0..blocks).into_par_iter().map(values).collect::<Option<Vec<_>>>()?.concat();
    values.sort_unstable_by(f64::total_cmp);
    Some(values)
}

/// Of one characteristic, with its quantiles at these probabilities; None without [`points`].
pub(super) fn counted(
    problem: &Problem,
    outcome: &Outcome,
    (c, seed): (usize, u64),
    quantiles: [(LawTail, f64); 7],
) -> Option<Counted> {
    let values = points(problem, outcome, (c, seed))?;
    let limits = problem.characteristics()[c].limits();
    let kept = problem.kept_limits(c);
    let below = limits.lower().map(|_| values.partition_point(|&y| kept.broken(y)[0]));
    let above = limits.upper().map(|_| values.len() - values.partition_point(|&y| !kept.broken(y)[1]));
    let share = |count: usize| {
        LawFigure::counted(count as f64 / values.len() as f64, error(count as f64, values.len()) / values.len() as f64)
    };
    Some(Counted {
        beyond: [below, above].map(|count| count.map(share)),
        quantiles: quantiles.map(|(tail, p)| quantile(&values, tail, p)),
        points: values.len(),
    })
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
