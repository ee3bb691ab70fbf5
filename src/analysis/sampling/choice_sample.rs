//! Points of a costly model for characteristics that follow a choice from stock.
//!
//! Such a characteristic jumps wherever another value of the stock comes nearer to the target. No derivative, surface or check point of a
//! surface describes it, so its figures are those of plain points of the model.

use std::sync::Arc;

use crate::analysis::CharacteristicAnalysis;
use crate::analysis::result::stage_figures::ModelSampleFigures;
use crate::analysis::sampling::model_sample::{FEWEST, of_simulation};
use crate::analysis::sampling::recorded_points::RecordingModel;
use crate::evaluation::{Evaluator, Ledger};
use crate::method::{Method, Options, Outcome};
use crate::problem::Problem;
use crate::simulation::{SimulationOptions, simulate_with};
use sensitol_numeric::sampling::Sampler;

/// Number of points without a budget. They give a yield of 99 % to 0.4 %, and the sigma of a normal value to 3 %.
const POINTS: usize = 512;

/// Greatest number of plain points that `auto` evaluates after `spent` points, because a characteristic of a costly model follows a
/// choice from stock: 512, or what is left of a budget. Each point takes an evaluation for every value of the stock that is tried. Returns 0
/// for all other models and methods, without verification, if no dimension varies, and if the budget allows too few to say anything.
///
/// ```
/// use sensitol::analysis::choice_points;
/// use sensitol::{Closure, Dimension, Method, Problem};
/// let dimensions = [Dimension::normal("a", 10.0, 0.1)?];
/// let problem = Problem::new(dimensions, Closure::scalar("y", |x| x[0]))?;
/// assert_eq!(choice_points(&problem, &Method::Auto.into(), 0), 0);
/// # Ok::<(), sensitol::Error>(())
/// ```
pub fn choice_points(problem: &Problem, options: &Options, spent: usize) -> usize {
    points_within(problem, options, options.points(problem).map(|points| points.saturating_sub(spent)))
}

/// Number of plain points if so many points are left of a budget.
fn points_within(problem: &Problem, options: &Options, left: Option<usize>) -> usize {
    let varies = problem.dimensions().iter().any(|dimension| dimension.sigma() > 0.0);
    let follows = varies && (0..problem.characteristics().len()).any(|c| problem.follows_costly_choice(c));
    if !follows || options.method != Method::Auto || !options.verifies(problem.function().signature()) {
        return 0;
    }
    let points = left.unwrap_or(POINTS);
    if points < FEWEST as usize { 0 } else { points }
}

/// Figures of the characteristics that follow a choice from stock, by their places. Empty for other models and methods, if the run was stopped,
/// and if the budget allows too few points.
pub(in crate::analysis) fn choice_samples(
    evaluator: &Evaluator<'_>,
    outcome: &Outcome,
    options: &Options,
    characteristics: &[CharacteristicAnalysis],
) -> Vec<(usize, ModelSampleFigures)> {
    let (problem, run) = (evaluator.problem(), evaluator.run());
    let points = points_within(problem, options, evaluator.remaining());
    if points == 0 || outcome.evaluated.stopped().is_some() || run.stopped() {
        return Vec::new();
    }
    let recorded = Arc::new(RecordingModel::new(problem));
    let recording = problem.with_function(recorded.clone());
    let wish = SimulationOptions {
        samples: points as u64,
        sampler: Sampler::Random,
        seed: evaluator.seed(),
        ..SimulationOptions::default()
    };
    let Ok(found) = simulate_with(&recording, &wish, run, &|_| {}) else { return Vec::new() };
    evaluator.merge(Ledger { run: found.run, non_repeatable: found.non_repeatable.clone() });
    if found.run.unfinished() {
        return Vec::new();
    }
    let sampled =
        (0..characteristics.len()).filter(|&c| problem.follows_costly_choice(c) && !characteristics[c].constant);
    let figures = |c: usize| {
        let ranks = recorded.ranks(c, &*outcome.plan);
        Some((c, of_simulation(&characteristics[c], None, (&found.characteristics[c], 1.0), ranks)?))
    };
    sampled.filter_map(figures).collect()
}
