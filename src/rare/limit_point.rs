//! Search of the model's limit, from a reject to the likeliest point of the limit near it.

use crate::estimate::Columns;
use crate::estimate::strata::{dot, length};
use crate::rare::design_point::FARTHEST;
use crate::rare::model::Model;
use crate::rare::target::Target;

/// Parts into which a way is cut at once. Their points are evaluated together.
const CUTS: usize = 8;
/// Rounds of cuts: three give the border to 1/512 of the way.
const ROUNDS: usize = 3;
/// Greatest number of steps of Hasofer and Lind.
pub(super) const STEPS: usize = 5;
/// Step of the differences for the slope of the model, in sigmas.
const STEP: f64 = 0.02;
/// Factors of the tangent point's distance at which the line through it is searched.
const LINE: [f64; 7] = [0.9, 0.94, 0.97, 1.0, 1.03, 1.06, 1.1];
/// Greatest number of coordinates of a corner.
const SIDES: usize = 6;
/// Halvings of a coordinate: four give it to a sixteenth, a quarter sigma at 4 sigma.
const HALVINGS: usize = 4;
/// Least relative gain in distance of a step that is followed by another.
const GAIN: f64 = 3e-3;

/// Greatest number of evaluations of [`bisected`], [`stepped`] and [`corner`] together, for a number of variables.
pub(super) fn cost(variables: usize) -> usize {
    STEPS * (variables + 1 + LINE.len() + CUTS - 1) + corner_cost(variables)
}

/// Border of the sought values on the way from the means to a reject, by bisection in eight parts.
pub(super) fn bisected(target: &Target<'_>, reject: &[f64], model: &mut Model<'_>) -> Vec<f64> {
    between(target, reject, [0.0, 1.0], ROUNDS, model)
}

/// Greatest number of evaluations of [`bisected`] and [`corner`] together, for a number of variables.
pub(super) fn corner_cost(variables: usize) -> usize {
    2 * ROUNDS * (CUTS - 1) + variables + 1 + SIDES * HALVINGS
}

/// Corner of the rejects near a point of the limit: each coordinate in turn goes as near to its mean as the point stays
/// a reject. Returns None if more than `SIDES` coordinates have a part in the reject.
pub(super) fn corner(target: &Target<'_>, border: Vec<f64>, model: &mut Model<'_>) -> Option<Vec<f64>> {
    let point = without_idle(target, border, model);
    let sides: Vec<usize> = (0..point.len()).filter(|&j| point[j] != 0.0).collect();
    if sides.len() > SIDES {
        return None;
    }
    // A point a little beyond the border, because on the border the smallest step ends the reject.
    let mut point = scaled(&point, 1.0 + 1e-3);
    for j in sides {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let mut moved = point.clone();
            moved[j] *= middle;
            if sought(target, std::slice::from_ref(&moved), model)[0] { high = middle } else { low = middle }
        }
        point[j] *= high;
    }
    Some(point)
}

/// Evaluations of one step, for a number of variables.
pub(super) fn step_cost(variables: usize) -> usize {
    variables + LINE.len() + CUTS
}

/// Steps of Hasofer and Lind (1974; Rackwitz and Fiessler 1978) from a point of the limit.
///
/// They use differences of the model and a search of the line about each tangent point. Returns None if they lead no
/// nearer.
pub(super) fn stepped(target: &Target<'_>, border: &[f64], steps: usize, model: &mut Model<'_>) -> Option<Vec<f64>> {
    let mut best: Option<Vec<f64>> = None;
    for _ in 0..steps {
        let from = best.as_deref().unwrap_or(border);
        let before = length(from);
        let Some(tangent) = tangent(target, from, model).filter(|point| length(point) < (1.0 - GAIN) * before) else {
            break;
        };
        let line = LINE.map(|part| scaled(&tangent, part)).to_vec();
        let sought = sought(target, &line, model);
        let reached = line.into_iter().zip(sought).find_map(|(point, sought)| sought.then_some(point));
        let Some(reached) = reached.filter(|point| length(point) < before) else { break };
        let point = between(target, &reached, [LINE[0], 1.0], 1, model);
        let done = length(&point) > (1.0 - GAIN) * before;
        best = Some(point);
        if done {
            break;
        }
    }
    best
}

/// Point of the tangent plane nearest to the means, from the model's slope at a point of the limit. Returns None if the
/// model has no slope there.
fn tangent(target: &Target<'_>, at: &[f64], model: &mut Model<'_>) -> Option<Vec<f64>> {
    let n = at.len();
    let column = |j: usize| (0..=n).map(|row| at[j] + if row == j + 1 { STEP } else { 0.0 }).collect();
    let answers = model.ask(&(0..n).map(column).collect());
    let margins: Option<Vec<f64>> =
        (0..=n).map(|row| answers.value(row, target.characteristic).map(|value| target.margin_of(value))).collect();
    let margins = margins?;
    let slopes: Vec<f64> = margins[1..].iter().map(|margin| (margin - margins[0]) / STEP).collect();
    let factor = (dot(&slopes, at) - margins[0]) / dot(&slopes, &slopes);
    let point: Vec<f64> = slopes.iter().map(|slope| factor * slope).collect();
    let distance = length(&point);
    (distance > 0.0 && distance < FARTHEST).then_some(point)
}

/// Reject point with all unneeded variables at their means. A variable is unneeded if a point without it is a reject no
/// farther out: the others may take its place.
fn without_idle(target: &Target<'_>, point: Vec<f64>, model: &mut Model<'_>) -> Vec<f64> {
    let n = point.len();
    let without = |j: usize| {
        let mut moved = point.clone();
        moved[j] = 0.0;
        moved
    };
    // A point a little beyond the border, because on the border the smallest step ends the reject.
    let far = (1.0 + 1e-3) * length(&point);
    let beyond = |point: Vec<f64>| {
        let size = length(&point);
        if size > 0.0 { scaled(&point, far / size) } else { point }
    };
    let idle = sought(target, &(0..n).map(|j| beyond(without(j))).collect::<Vec<_>>(), model);
    let kept: Vec<f64> = point.iter().zip(&idle).map(|(z, idle)| if *idle { 0.0 } else { *z }).collect();
    let all = beyond(kept);
    match idle.contains(&true) && sought(target, std::slice::from_ref(&all), model)[0] {
        true => between(target, &all, [0.0, 1.0], ROUNDS, model),
        false => point,
    }
}

/// First crossing between two parts of the way to a reject, to the resolution of the cuts.
fn between(
    target: &Target<'_>,
    reject: &[f64],
    [low, high]: [f64; 2],
    rounds: usize,
    model: &mut Model<'_>,
) -> Vec<f64> {
    let (mut low, mut high) = (low, high);
    for _ in 0..rounds {
        let part = |cut: usize| low + (high - low) * cut as f64 / CUTS as f64;
        let points: Vec<Vec<f64>> = (1..CUTS).map(|cut| scaled(reject, part(cut))).collect();
        let first = sought(target, &points, model).iter().position(|&sought| sought).map_or(CUTS, |at| at + 1);
        let (below, at) = (part(first - 1), part(first));
        (low, high) = (below, if first == CUTS { high } else { at });
    }
    scaled(reject, high)
}

/// True for each point that is a reject.
fn sought(target: &Target<'_>, points: &[Vec<f64>], model: &mut Model<'_>) -> Vec<bool> {
    let n = points.first().map_or(0, Vec::len);
    let columns: Columns = (0..n).map(|j| points.iter().map(|point| point[j]).collect()).collect();
    let answers = model.ask(&columns);
    let sought = |row: usize| answers.value(row, target.characteristic).is_some_and(|value| target.sought(value));
    (0..points.len()).map(sought).collect()
}

fn scaled(point: &[f64], by: f64) -> Vec<f64> {
    point.iter().map(|z| by * z).collect()
}
