//! Worst case checked at points of the model: corners of the box of the tolerance bands, and points within it.
//!
//! A point beyond a limit refutes a worst case. Points within the limits prove nothing.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::analysis::CharacteristicAnalysis;
use crate::assembly::{Points, Request, Responses, Run};
use crate::problem::Problem;
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::verdict::Judged;

/// Number of points. Half of them are corners.
const POINTS: usize = 1 << 13;
/// Rounding of a value relative to the greatest of its terms, a dimension times its slope: some additions.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Verdict of the points on the worst case of every characteristic that was analysed at these tolerances. Its interval
/// begins at the greatest part of the distance from nominal to limit that a point uses. None if no point has a value,
/// if dimensions share a zone, which is not a box, and if the nominal value lies beyond a limit.
pub(in crate::allocation) fn worst_in_box(
    problem: &Problem,
    analysed: &[CharacteristicAnalysis],
    seed: u64,
    run: &Run<'_>,
) -> Vec<Option<Judged>> {
    let dimensions = problem.dimensions();
    let nothing = vec![None; analysed.len()];
    let blocks = problem.correlation().is_some_and(|of| !of.blocks().is_empty());
    if blocks || dimensions.iter().any(|dimension| dimension.zone().is_some()) {
        return nothing;
    }
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let points = Points::written(POINTS, dimensions.len(), |d, column| {
        let [lower, upper] = dimensions[d].reach().map(|deviation| dimensions[d].nominal() + deviation);
        for (row, to) in column.iter_mut().enumerate() {
            let part: f64 = rng.random();
            *to = match row % 2 {
                0 if part < 0.5 => lower,
                0 => upper,
                _ => lower + part * (upper - lower),
            };
        }
    });
    let outputs = problem.outputs();
    let mut answers = Responses::open(POINTS, outputs.len());
    problem.function().evaluate(&Request::values(&points, outputs), run, &mut answers);
    let of = |(c, one): (usize, &CharacteristicAnalysis)| {
        let nominal = one.nominal?;
        let slopes: Vec<f64> = one.sensitivities.iter().map(|of| of.first.unwrap_or(0.0)).collect();
        let limits = problem.characteristics()[c].limits();
        let part = |(row, value): (usize, f64)| {
            // The value of a sum is rounded as its greatest term is. A corner on a limit must not count as beyond it.
            let term = |(d, slope): (usize, &f64)| (slope * points.column(d)[row]).abs();
            let size = slopes.iter().enumerate().map(term).fold(value.abs(), f64::max);
            let rise = (value - nominal).signum() * ((value - nominal).abs() - ROUNDING * size).max(0.0);
            let above = limits.upper().map(|upper| rise / (upper - nominal));
            let below = limits.lower().map(|lower| rise / (lower - nominal));
            above.into_iter().chain(below).fold(0.0, f64::max)
        };
        let values = (0..POINTS).filter_map(|row| Some((row, answers.value(row, c)?)));
        let most = values.map(part).reduce(f64::max).filter(|most| most.is_finite())?;
        let inside =
            limits.lower().is_none_or(|lower| lower < nominal) && limits.upper().is_none_or(|upper| upper > nominal);
        inside.then(|| Judged::of(Requirement::WorstCase, Some(most), Some([most, f64::INFINITY])))
    };
    analysed.iter().enumerate().map(of).collect()
}
