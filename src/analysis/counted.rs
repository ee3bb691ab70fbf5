//! The shares beyond the limits counted at points of a surface whose law could not be computed.

use rayon::prelude::*;

use crate::law::LawFigure;
use crate::method::Outcome;
use crate::problem::Problem;
use crate::sampling::{Draws, Portion, SOBOL_DIMENSIONS, Sampler};

/// Points of the surface, in blocks of so many.
const POINTS: usize = 1 << 16;
const ROWS: usize = 1024;
/// Of which fewer are drawn where all of them would take more numbers than this.
const NUMBERS: usize = 4_000_000;
const FEWEST: usize = 1 << 13;
/// Rule of three: of a share that no point shows, 3/n is the 95 % bound.
const UNSEEN: f64 = 3.0;

/// Below and above the limits of one characteristic; None where its inputs cannot be drawn, or a part of its surface is unknown.
pub(super) fn counted(problem: &Problem, outcome: &Outcome, c: usize, seed: u64) -> Option<[Option<LawFigure>; 2]> {
    let surrogate = outcome.fitted[c].surrogate.as_ref()?;
    let varying = outcome.plan.varying();
    let sampler = if varying.len() <= SOBOL_DIMENSIONS { Sampler::Sobol } else { Sampler::Random };
    let draws = Draws::new(problem.dimensions(), problem.correlation(), sampler, seed).ok()?;
    let limits = problem.characteristics()[c].limits();
    let blocks = (NUMBERS / varying.len().max(1)).clamp(FEWEST, POINTS).next_power_of_two().min(POINTS) / ROWS;
    // Block by block, so that a thousand dimensions take no more memory than ten.
    let beyond = |block: usize| -> Option<[usize; 2]> {
        let points = draws.points(Portion { replicate: 0, first: (block * ROWS) as u64, rows: ROWS });
        let rises = surrogate.rises(&problem.standardised(&points, varying))?;
        let values = || rises.iter().map(|rise| surrogate.centre + rise);
        let below = limits.lower().map_or(0, |lower| values().filter(|&y| y < lower).count());
        let above = limits.upper().map_or(0, |upper| values().filter(|&y| y > upper).count());
        Some([below, above])
    };
    let found: Vec<[usize; 2]> = (0..blocks).into_par_iter().map(beyond).collect::<Option<_>>()?;
    let n = (blocks * ROWS) as f64;
    let share = |side: usize| {
        let value = found.iter().map(|one| one[side]).sum::<usize>() as f64 / n;
        LawFigure { value, error: (value * (1.0 - value) / n).sqrt().max(UNSEEN / n), proven: false }
    };
    Some([limits.lower().map(|_| share(0)), limits.upper().map(|_| share(1))])
}
