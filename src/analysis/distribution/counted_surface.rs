//! Points of a surface whose distribution could not be computed, is refuted or is tested.

use crate::estimate::OrderedPoints;
use crate::method::Outcome;
use crate::problem::Problem;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::{Draws, Normals, Portion, SOBOL_DIMENSIONS, Sampler};

/// Greatest number of surface points that are counted.
pub(in crate::analysis) const POINTS: usize = 1 << 16;
/// Greatest number of points in the test of a distribution: six standard errors of a share of a half are 3 %.
pub(in crate::analysis) const TESTED: usize = 1 << 13;
/// Points of the surface whose number is a multiple of this one, and which are evaluated together where inputs are few.
const ROWS: usize = 1024;
/// Greatest count of random numbers that are drawn together by one thread: 2 MB.
const TOGETHER: usize = 1 << 18;
/// Fewest points that are evaluated together. With fewer, the time of a block without its points counts.
const FEWEST_TOGETHER: usize = 32;
/// Greatest number of products of points and surface terms in a test: some tenths of a second, with their random numbers.
const EFFORT: usize = 1 << 25;
/// Random stream of the normal variable that represents the variance which the surface does not explain. It differs from the streams of the
/// inputs.
const STREAM: u64 = 1;
/// Greatest count of random numbers (points times inputs). With many inputs, fewer points are drawn.
const NUMBERS: usize = 4_000_000;
/// Smallest number of points that are drawn, with any number of inputs.
const FEWEST: usize = 1 << 13;

/// Values of the surface of one characteristic in ascending order, at `most` points or fewer.
///
/// `unexplained` is the variance of a normal variable that is added to the surface. Returns None if inputs cannot be drawn, or a part of
/// the surface is unknown.
pub(in crate::analysis) fn points(
    problem: &Problem,
    outcome: &Outcome,
    (c, seed): (usize, u64),
    (most, unexplained): (usize, Option<f64>),
) -> Option<OrderedPoints> {
    let surrogate = outcome.fitted[c].surrogate.as_ref()?;
    let varying = outcome.plan.varying();
    let sampler = if varying.len() <= SOBOL_DIMENSIONS { Sampler::Sobol } else { Sampler::Random };
    let draws = Draws::new(problem.dimensions(), problem.correlation(), sampler, seed).ok()?;
    let numbers = (NUMBERS / varying.len().max(1)).clamp(FEWEST, POINTS).next_power_of_two().min(most);
    let terms = surrogate.parts.len() + surrogate.interactions.each_pair().count();
    // A test uses fewer points if each is a sum of half a million products.
    let affordable = if most < POINTS { (EFFORT / terms.max(1)).max(ROWS) } else { numbers };
    let count = numbers.min(affordable) / ROWS * ROWS;
    // In blocks, so that ten thousand inputs take no more memory than ten.
    let rows = block_rows(varying.len());
    let values = |block: usize| -> Option<Vec<f64>> {
        let first = block * rows;
        let points = draws.points(Portion { replicate: 0, first: first as u64, rows: rows.min(count - first) });
        let rises = surrogate.rises(&problem.standardised(&points, varying))?;
        Some(rises.iter().map(|rise| surrogate.centre + rise).collect())
    };
    let mut values = (0..count.div_ceil(rows)).into_par_iter().map(values).collect::<Option<Vec<_>>>()?.concat();
    if let Some(variance) = unexplained {
        let beside = Normals::random(1, seed).columns(STREAM, values.len());
        let sigma = variance.sqrt();
        values.iter_mut().zip(beside.first()?).for_each(|(y, z)| *y += sigma * z);
    }
    Some(OrderedPoints::new(values))
}

/// Number of points of a block: a power of two, as blocks of a Sobol' sequence need it.
fn block_rows(inputs: usize) -> usize {
    1 << (TOGETHER / inputs.max(1)).clamp(FEWEST_TOGETHER, ROWS).ilog2()
}

#[cfg(test)]
mod tests {
    use super::{FEWEST_TOGETHER, ROWS, block_rows};

    #[test]
    fn blocks_are_powers_of_two_at_any_number_of_inputs() {
        for inputs in (0..20_000).chain([1 << 20, usize::MAX]) {
            let rows = block_rows(inputs);
            assert!(rows.is_power_of_two() && (FEWEST_TOGETHER..=ROWS).contains(&rows), "{inputs}: {rows}");
        }
    }
}
