//! Importance samples of tails whose surface check points have refuted.
//!
//! An analysis knows places beyond a limit that its check points show: where the surface with the residual that was met crosses it. Points
//! there and all around decide the yield in place of the surface. The estimate is that of a search for rare events, for which the places are
//! a further hint.

use crate::estimate::strata::length;
use crate::estimate::{Columns, NormalSpace};
use crate::evaluation::{Evaluator, Ledger};
use crate::method::Outcome;
use crate::rare::design_point::{Place, places};
use crate::rare::exploration::Explored;
use crate::rare::model::Model;
use crate::rare::search::Search;
use crate::rare::target::Target;
use crate::rare::{LEAST, RareCharacteristic, RareOptions, SampledStages, correct, targets};
use crate::simulation::Surrogates;
use sensitol_numeric::time::Instant;

/// Greatest number of points in refuted tails without a budget: as many as give a contact or a step at three sigmas to a factor of two.
pub const MOST_TAIL_POINTS: usize = 400;
/// Smallest number of points for each limit: fewer leave an interval that is wider than that of the check points.
const FEWEST: u64 = 100;
/// Relative standard error of every probability at which the points end.
const ENOUGH: f64 = 0.1;
/// Divisor of the number of points for those that find places: of the surface, and of the refuted tails.
const PLACING: usize = 4;
/// Divisor of the rest for the places that explored points show.
const LEARNING: usize = 3;
/// Factors of the distance of a place at which the model is evaluated.
const BEYOND: [f64; 3] = [1.0, 1.1, 1.25];

/// Tail of a characteristic in which check points refute its surface.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RefutedTail {
    /// Position of the characteristic.
    pub(crate) characteristic: usize,
    /// Points in normal space that the model probably rejects, by the residuals at the check points.
    pub(crate) points: Vec<Vec<f64>>,
}

/// Results of the points in refuted tails.
pub(crate) struct SampledTails {
    /// Position and results of every characteristic that was sampled.
    pub(crate) characteristics: Vec<(usize, RareCharacteristic)>,
    /// Number of evaluated points, those that found places included.
    pub(crate) points: u64,
    pub(crate) ledger: Ledger,
}

/// Estimates the probabilities beyond the limits of characteristics with refuted tails, by at most `most` points of the model.
///
/// Returns None, without an evaluation, if `most` is too small for an estimate or no surface of them varies. There are no characteristics if
/// the run was stopped.
pub(crate) fn sample_refuted(
    evaluator: &Evaluator<'_>,
    outcome: &Outcome,
    refuted: &[RefutedTail],
    most: u64,
) -> Option<SampledTails> {
    let (problem, run, begun) = (evaluator.problem(), evaluator.run(), Instant::now());
    if refuted.is_empty() {
        return None;
    }
    let known = Surrogates::known_of(problem, outcome);
    let space = NormalSpace::with_far_tails(problem, outcome.plan.varying()).ok()?;
    let mut targets = targets(problem, &known, &space);
    let tail_of = |target: &Target<'_>| refuted.iter().find(|tail| tail.characteristic == target.characteristic);
    targets.retain(|target| tail_of(target).is_some());
    if targets.is_empty() || most < FEWEST * targets.len() as u64 {
        return None;
    }
    let options = RareOptions::default().with_samples(most).with_seed(evaluator.seed()).with_until(ENOUGH);
    let part = Evaluator::new(problem, run).with_seed(evaluator.seed());
    let mut model = Model::new(part, &space);
    let places: Vec<Place> = targets.iter().enumerate().flat_map(|(index, target)| places(index, target)).collect();
    let budget = most as usize / PLACING;
    let places = correct(places, &targets, budget / 2, &mut model);
    let mut search = Search::new(&targets, places, (options.samples, options.seed));
    for (index, target) in targets.iter().enumerate() {
        let shown = tail_of(target).map_or(&[][..], |tail| &tail.points);
        let room = budget / targets.len();
        let rejects = rejected(target, &shown[..shown.len().min(room / BEYOND.len())], &mut model);
        search.place(index, &rejects, room, &mut model);
    }
    let explored = Explored::new(&targets, &search.reached(), options.samples, !options.seed, &mut model);
    let left = most.saturating_sub(model.answered);
    if left < LEAST || run.stopped() {
        let points = model.answered;
        return Some(SampledTails { characteristics: Vec::new(), points, ledger: model.evaluator.into_ledger() });
    }
    let left = left as usize;
    search.learn(&explored, left / LEARNING, &mut model);
    let mut sampled = SampledStages { problem, options: &options, run, begun, model, search, reached: None };
    sampled.draw(&|_| {});
    let SampledStages { model, search, .. } = sampled;
    let sampled: Vec<usize> = targets.iter().filter(|_| !run.stopped()).map(|target| target.characteristic).collect();
    let characteristics = search.characteristics(&model, false).into_iter().enumerate();
    let characteristics = characteristics.filter(|(c, _)| sampled.contains(c)).collect();
    Some(SampledTails { characteristics, points: model.answered, ledger: model.evaluator.into_ledger() })
}

/// Points that the model rejects, at or a little beyond the given ones, the nearest to the means first.
fn rejected(target: &Target<'_>, shown: &[Vec<f64>], model: &mut Model<'_>) -> Vec<Vec<f64>> {
    let points: Vec<Vec<f64>> =
        (shown.iter()).flat_map(|point| BEYOND.map(|by| point.iter().map(|z| by * z).collect::<Vec<f64>>())).collect();
    if points.is_empty() {
        return points;
    }
    let column = |j: usize| points.iter().map(|point| point[j]).collect();
    let columns: Columns = (0..model.space.len()).map(column).collect();
    let answers = model.ask(&columns);
    let is_sought = |row: usize| answers.value(row, target.characteristic).is_some_and(|value| target.sought(value));
    // The nearest reject on each way.
    let ways = (0..shown.len()).map(|way| BEYOND.len() * way..BEYOND.len() * (way + 1));
    let mut found: Vec<Vec<f64>> =
        ways.filter_map(|mut way| way.find(|&row| is_sought(row))).map(|row| points[row].clone()).collect();
    found.sort_by(|a, b| length(a).total_cmp(&length(b)));
    found
}
