//! Sobol' indices of the model itself, by exchanging inputs between two samples.
//!
//! ```text
//! first order  S_j = (E[b c] - m^2) / (E[(b^2 + c^2)/2] - m^2)     m = E[(b + c)/2]       Janon and others 2014
//! total        T_j = E[(a - c)^2] / (2 V)                                                  Jansen 1999
//! ```
//!
//! `a` and `b` are the model's values at two independent sets of Sobol' points, and `c` those at the points of the first set with input j
//! from the second. This takes n (N + 2) evaluations for N factors. A factor is a dimension, or dimensions that vary together. Standard
//! errors are those of the jackknife over 16 scramblings, intervals by Student's quantile. An estimate near 0 may be negative: it is
//! reported unchanged, because 0 is within its error.

use serde::Serialize;

use crate::estimate::variance_shares::exchange;
use crate::estimate::{Columns, NormalSpace, ReplicateSums};
use crate::evaluation::{Evaluator, Ledger};
use crate::problem::Problem;
use crate::simulation::{Pace, REPLICATES, SimulationError};
use crate::verification::CONFIDENCE;
use sensitol_numeric::correlation::factors;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::Normals;
use sensitol_numeric::sampling::student_quantile;
use sensitol_numeric::time::Instant;

/// Greatest number of evaluations of a costly model without a budget.
const UNASKED: u64 = 10_000;
/// Greatest number of random numbers of one scrambling: some 64 megabytes.
const NUMBERS: usize = 1 << 23;
/// First stream of the points, apart from those of other samples.
const STREAM: u64 = 1 << 36;

/// Estimate of an index with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct IndexEstimate {
    /// Estimate, which may be negative if the index is near 0.
    pub value: f64,
    /// Standard error of the estimate.
    pub standard_error: f64,
    /// 95 % interval of the index.
    pub interval: [f64; 2],
}

/// Sobol' indices of one factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct SampledFactor {
    /// Names of the dimension, or of those that vary together.
    pub dimensions: Vec<String>,
    /// Part of the variance that the factor explains alone.
    pub first_order: IndexEstimate,
    /// Part of the variance with all interactions of the factor.
    pub total: IndexEstimate,
}

/// Varying dimensions, the positions of every factor among them, and the number of base points in each scrambling.
fn design(problem: &Problem, points: u64) -> (Vec<usize>, Vec<Vec<usize>>, usize) {
    let varies = |&d: &usize| problem.dimensions()[d].sigma() > 0.0;
    let varying: Vec<usize> = (0..problem.dimensions().len()).filter(varies).collect();
    let places = factors(problem.correlation(), &varying);
    let most = (NUMBERS / (2 * varying.len()).max(1)).max(2);
    let rows = usize::try_from(points.div_ceil(REPLICATES)).unwrap_or(usize::MAX).clamp(2, most);
    let rows = if rows.is_power_of_two() { rows } else { (rows.next_power_of_two()).min(most.next_power_of_two() / 2) };
    (varying, places, rows)
}

/// Returns an error if more evaluations are needed than are allowed.
pub(super) fn affordable(problem: &Problem, points: u64, budget: Option<u64>) -> Result<(), SimulationError> {
    let (_, factors, rows) = design(problem, points);
    let base = REPLICATES * rows as u64;
    let evaluations = base.saturating_mul(factors.len() as u64 + 2);
    let costly = problem.function().signature().costly;
    let most = budget.unwrap_or(if costly { UNASKED } else { u64::MAX });
    match evaluations > most {
        true => Err(SimulationError::CostlyIndices { points: base, factors: factors.len(), evaluations, most }),
        false => Ok(()),
    }
}

/// Indices of every characteristic. None for a characteristic that does not vary, and for all of them if the run was stopped. Points
/// without a value are left out.
///
/// Shapes: `origins` has a value near the mean of every characteristic.
pub(super) fn indices(
    evaluator: &Evaluator<'_>,
    points: u64,
    origins: &[f64],
    pace: &dyn Fn(Pace),
) -> Vec<Option<Vec<SampledFactor>>> {
    let (problem, begun) = (evaluator.problem(), Instant::now());
    let (varying, factors, rows) = design(problem, points);
    let none = || vec![None; problem.characteristics().len()];
    if varying.is_empty() {
        return none();
    }
    let exchange = Exchange { evaluator, space: NormalSpace::new(problem, &varying), factors: &factors, rows, origins };
    let normals = Normals::new(2 * varying.len(), evaluator.seed());
    let expected = (REPLICATES as usize * rows * (factors.len() + 2)) as f64;
    let one = |replicate: u64| exchange.replicate(&normals, replicate);
    let mut replicates: Vec<Replicate> = match problem.function().signature().costly {
        false => (0..REPLICATES).into_par_iter().map(one).collect(),
        // One batch after the other: all workers of an external model share each.
        true => (0..REPLICATES)
            .map(|replicate| {
                let samples = replicate * (rows * (factors.len() + 2)) as u64;
                pace(Pace { samples, expected, elapsed: begun.elapsed() });
                one(replicate)
            })
            .collect(),
    };
    // In the order of the scramblings, so that the ledger does not depend on threads.
    replicates.iter_mut().for_each(|replicate| evaluator.merge(std::mem::take(&mut replicate.ledger)));
    if evaluator.stopped().is_some() {
        return none();
    }
    let of = |c: usize| {
        let sums: Vec<&[f64]> = replicates.iter().map(|replicate| replicate.sums[c].as_slice()).collect();
        estimated(problem, &varying, &factors, &sums)
    };
    (0..problem.characteristics().len()).map(of).collect()
}

struct Exchange<'p> {
    evaluator: &'p Evaluator<'p>,
    space: NormalSpace<'p>,
    factors: &'p [Vec<usize>],
    rows: usize,
    /// Values near the means of the characteristics. Sums are taken about them so that nothing large is squared.
    origins: &'p [f64],
}

/// Sums of one scrambling, with their cost.
struct Replicate {
    /// Sums by characteristic: number, sum and squares; then for every factor number, means, products, mean squares, and squared
    /// differences.
    sums: Vec<Vec<f64>>,
    ledger: Ledger,
}

/// Number of sums of the whole sample: points, sum, squares.
const WHOLE: usize = 3;
/// Number of sums of every factor: points, means, products, mean squares, squared differences.
const OF_FACTOR: usize = 5;

impl Exchange<'_> {
    fn replicate(&self, normals: &Normals, replicate: u64) -> Replicate {
        let mut first = normals.columns(STREAM + replicate, self.rows);
        let mut second = first.split_off(self.space.len());
        let part = self.evaluator.part();
        let evaluate = |z: &Columns| {
            let out = part.ask(&self.space.points(z));
            (0..out.outputs()).map(|output| out.column(output).to_vec()).collect::<Vec<_>>()
        };
        let (a, b) = (evaluate(&first), evaluate(&second));
        let of_whole = |c: usize| {
            let values = || a[c].iter().chain(&b[c]).filter(|y| y.is_finite()).map(|y| y - self.origins[c]);
            vec![values().count() as f64, values().sum(), values().map(|y| y * y).sum()]
        };
        let mut sums: Vec<Vec<f64>> = (0..a.len()).map(of_whole).collect();
        for factor in self.factors {
            exchange(factor, &mut first, &mut second);
            let exchanged = evaluate(&first);
            exchange(factor, &mut first, &mut second);
            for (c, sums) in sums.iter_mut().enumerate() {
                let mut own = [0.0; OF_FACTOR];
                for ((&a, &b), &y) in a[c].iter().zip(&b[c]).zip(&exchanged[c]) {
                    if a.is_finite() && b.is_finite() && y.is_finite() {
                        let (b, y, d) = (b - self.origins[c], y - self.origins[c], a - y);
                        let added = [1.0, 0.5 * (b + y), b * y, 0.5 * (b * b + y * y), d * d];
                        own.iter_mut().zip(added).for_each(|(sum, value)| *sum += value);
                    }
                }
                sums.extend(own);
            }
        }
        Replicate { sums, ledger: part.into_ledger() }
    }
}

/// Indices of all factors from the sums of all scramblings. Returns None if nothing varies.
fn estimated(
    problem: &Problem,
    varying: &[usize],
    factors: &[Vec<usize>],
    sums: &[&[f64]],
) -> Option<Vec<SampledFactor>> {
    let figures = |sums: &[f64]| -> Vec<f64> {
        let variance = sums[2] / sums[0] - (sums[1] / sums[0]).powi(2);
        let of = |own: &[f64]| {
            let [n, middle, product, square, difference] = [own[0], own[1], own[2], own[3], own[4]];
            let square_of_mean = (middle / n).powi(2);
            let first = (product / n - square_of_mean) / (square / n - square_of_mean);
            [first, 0.5 * difference / n / variance]
        };
        sums[WHOLE..].chunks_exact(OF_FACTOR).flat_map(of).collect()
    };
    let (values, errors) = ReplicateSums::by_replicate(sums).jackknifed(figures);
    let freedom = (REPLICATES - 1) as f64;
    let times = student_quantile(0.5 * (1.0 + CONFIDENCE), freedom);
    let estimate = |index: usize| {
        let (value, standard_error) = (values[index], errors[index]);
        let half = times * standard_error;
        IndexEstimate { value, standard_error, interval: [value - half, value + half] }
    };
    let name = |&place: &usize| problem.dimensions()[varying[place]].name().to_owned();
    let factor = |(j, places): (usize, &Vec<usize>)| SampledFactor {
        dimensions: places.iter().map(name).collect(),
        first_order: estimate(2 * j),
        total: estimate(2 * j + 1),
    };
    let known = values.iter().chain(&errors).all(|value| value.is_finite());
    known.then(|| factors.iter().enumerate().map(factor).collect())
}
