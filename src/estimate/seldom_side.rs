//! Points on the sides of switches that are seldom met.

use crate::assembly::{Points, Run};
use crate::estimate::cheap_model::CheapModel;
use crate::estimate::normal_space::Columns;
use crate::estimate::strata::{HalfSpace, outside_of};
use crate::estimate::switch_side::{BEFORE, FoundSwitch, sides};
use crate::problem::Problem;
use sensitol_numeric::sampling::Normals;

/// Likeliest points beyond the seldom switches of a cheap model, in independent normal variables of the dimensions at `varying`. Empty if
/// the model does not report its switches.
pub(crate) fn seldom_points(problem: &Problem, c: usize, varying: &[usize], seed: u64) -> Vec<Vec<f64>> {
    let model = CheapModel::over(problem, c, varying);
    let found = sides(&model, &Normals::new(varying.len(), seed), 1.0);
    let point = |space: HalfSpace| space.direction.iter().map(|part| part * (space.from + BEFORE)).collect();
    found.half_spaces.into_iter().map(point).collect()
}

/// Switches of a characteristic, and points beyond those that are seldom met.
pub(crate) struct RareSides {
    pub(crate) switches: Vec<FoundSwitch>,
    /// Points of the half-spaces that contain the seldom sides. Their `values` are NaN if the model has none.
    pub(crate) points: Points,
    pub(crate) values: Vec<f64>,
    /// Weights of the points, which sum to the probability of the half-spaces.
    pub(crate) weights: Vec<f64>,
}

/// Searches for the switches of a characteristic whose values have the spread `scale`. Returns None if the model is costly, does not report
/// its switches, or if the run was stopped.
///
/// Evaluations: 256 for every half-space, six at most. The margins of switches, and some values beside them, are evaluated in addition.
pub(crate) fn seldom_sides(problem: &Problem, c: usize, (seed, scale): (u64, f64), run: &Run<'_>) -> Option<RareSides> {
    /// Number of points of a half-space. Its part of a moment is known to about a tenth.
    const WITHIN: usize = 1 << 8;
    let function = problem.function();
    let told = function.switches(problem.outputs()[c]).filter(|told| !told.list.is_empty());
    told.filter(|_| !function.signature().costly)?;
    let model = CheapModel::new(problem, c).during(run);
    let normals = Normals::new(model.len(), seed);
    let found = sides(&model, &normals, if scale > 0.0 { scale } else { 1.0 });
    let mut all: Columns = vec![Vec::new(); model.len()];
    let mut weights = Vec::new();
    for (index, space) in found.half_spaces.iter().enumerate() {
        let mut z = normals.columns((1 << 34) + index as u64, WITHIN);
        let own = space.enter(&mut z);
        let first = outside_of(&found.half_spaces[..index], &z);
        let counted = |column: &[f64]| -> Vec<f64> {
            column.iter().zip(&first).filter(|(_, first)| **first).map(|(value, _)| *value).collect()
        };
        all.iter_mut().zip(&z).for_each(|(all, column)| all.extend(counted(column)));
        weights.extend(counted(&own).into_iter().map(|weight| weight / WITHIN as f64));
    }
    let (points, values) = model.points_and_values(&all);
    (!model.stopped()).then(|| RareSides { switches: found.switches.unwrap_or_default(), points, values, weights })
}
