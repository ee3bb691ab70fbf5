//! Yield of a characteristic of a cheap model at given values of one dimension.

use crate::assembly::Run;
use crate::estimate::normal_space::NormalSpace;
use crate::estimate::stratified_sample::REPLICATES;
use crate::evaluation::Evaluator;
use crate::problem::Problem;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::{Normals, clopper_pearson};

/// Number of points of one randomisation.
const ROWS: usize = 1 << 10;

/// Evaluations of [`yields_at`] for this number of values.
pub(crate) const fn most_points_at(values: usize) -> usize {
    values * ROWS * REPLICATES
}

/// 95 % interval of the yield at every value of dimension `d`, with all other dimensions as they vary. A point without a value is a reject
/// for the lower end, and may keep the limits for the upper one.
///
/// 16 randomisations of 1024 Sobol' points, the same ones at every value. The intervals are those of independent points (Clopper, Pearson
/// 1934), which are wider than those of Sobol' points. Pure in problem and seed.
pub(crate) fn yields_at(problem: &Problem, c: usize, d: usize, values: &[f64], seed: u64) -> Vec<[f64; 2]> {
    let dependence = problem.dependence().swap_remove(c);
    let varies = |&other: &usize| other != d && dependence[other] && problem.dimensions()[other].sigma() > 0.0;
    let others: Vec<usize> = (0..problem.dimensions().len()).filter(varies).collect();
    let (space, normals) = (NormalSpace::new(problem, &others), Normals::new(others.len().max(1), seed));
    let evaluator = Evaluator::new(problem, &Run::to_the_end());
    let (kept, output) = (problem.kept_limits(c), problem.outputs()[c]);
    // Points that keep the limits, and points without a value, at every value.
    let count = |replicate: usize| -> Vec<[u64; 2]> {
        let z = normals.columns((1 << 35) + replicate as u64, ROWS);
        let mut points = space.points(&z);
        let of_value = |&x: &f64| {
            points.column_mut(d).fill(x);
            let out = evaluator.ask_outputs(&points, &[output]);
            out.column(0).iter().fold([0, 0], |[within, missing], y| match y.is_finite() {
                true => [within + u64::from(kept.contains(*y)), missing],
                false => [within, missing + 1],
            })
        };
        values.iter().map(of_value).collect()
    };
    let counts: Vec<Vec<[u64; 2]>> = (0..REPLICATES).into_par_iter().map(count).collect();
    let total = (ROWS * REPLICATES) as f64;
    (0..values.len())
        .map(|at| {
            let [within, missing] =
                counts.iter().fold([0, 0], |sum: [u64; 2], of| [sum[0] + of[at][0], sum[1] + of[at][1]]);
            let [low, _] = clopper_pearson(within as f64, total);
            let [_, high] = clopper_pearson((within + missing) as f64, total);
            [low, high]
        })
        .collect()
}
