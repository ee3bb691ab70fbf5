//! Points within the tolerance bands, and the extremes of a model at them.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::Problem;
use sensitol::assembly::{Points, Request, Responses, Run};

/// Band of every dimension.
pub fn bands(problem: &Problem) -> Vec<[f64; 2]> {
    problem.dimensions().iter().map(|d| d.reach().map(|reach| d.nominal() + reach)).collect()
}

/// Extremes of every characteristic at these points.
pub fn among(problem: &Problem, points: &[Vec<f64>]) -> Vec<[f64; 2]> {
    let mut out = Responses::open(points.len(), problem.outputs().len());
    let points = Points::from_rows(points);
    problem.function().evaluate(&Request::values(&points, problem.outputs()), &Run::to_the_end(), &mut out);
    let ends = |c: usize| {
        let column = out.column(c).iter().copied();
        [column.clone().fold(f64::INFINITY, f64::min), column.fold(f64::NEG_INFINITY, f64::max)]
    };
    (0..problem.outputs().len()).map(ends).collect()
}

/// All `2^N` vertices of the varying dimensions.
pub fn vertices(problem: &Problem) -> Vec<Vec<f64>> {
    let bands = bands(problem);
    let varying: Vec<usize> = (0..bands.len()).filter(|&d| bands[d][0] < bands[d][1]).collect();
    let vertex = |number: usize| {
        let mut point: Vec<f64> = bands.iter().map(|band| band[0]).collect();
        varying.iter().enumerate().for_each(|(bit, &d)| point[d] = bands[d][number >> bit & 1]);
        point
    };
    (0..1 << varying.len()).map(vertex).collect()
}

/// Random points, uniform within the bands.
pub fn random_points(problem: &Problem, count: usize) -> Vec<Vec<f64>> {
    let (bands, mut rng) = (bands(problem), Xoshiro256PlusPlus::seed_from_u64(11));
    let point = |_| bands.iter().map(|[a, b]| a + (b - a) * rng.random::<f64>()).collect();
    (0..count).map(point).collect()
}
