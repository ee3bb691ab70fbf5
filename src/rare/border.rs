//! From a reject to the likeliest point of the limit near it, on the model itself.

use super::model::Model;
use super::place::{FARTHEST, dot, length};
use super::space::Columns;
use super::target::Target;

/// Parts into which a way is cut at once: points that can be evaluated together.
const CUTS: usize = 8;
/// Rounds of that: the border is known to 1/512 of the way.
const ROUNDS: usize = 3;
/// Steps of Hasofer and Lind, and the step of their differences in sigmas.
const STEPS: usize = 5;
const STEP: f64 = 0.02;
/// Where the line is searched about each.
const LINE: [f64; 7] = [0.9, 0.94, 0.97, 1.0, 1.03, 1.06, 1.1];
/// A step that brings the point nearer by less than this part of its distance is the last.
const GAIN: f64 = 3e-3;

/// Evaluations of [`nearest`] at most, for so many variables.
pub(super) fn cost(variables: usize) -> usize {
    3 * ROUNDS * (CUTS - 1) + STEPS * (variables + 1 + LINE.len() + CUTS - 1) + variables + 1
}

/// The border of what is sought, on the way from the means to a reject: bisection in eight parts.
pub(super) fn bisected(target: &Target<'_>, reject: &[f64], model: &mut Model<'_>) -> Vec<f64> {
    between(target, reject, [0.0, 1.0], ROUNDS, model)
}

/// The likeliest point of the limit near a point of it: [`stepped`], and where that leads nowhere, as beside a jump, the variables that have
/// no part in the reject go back to their means.
pub(super) fn nearest(target: &Target<'_>, border: Vec<f64>, model: &mut Model<'_>) -> Vec<f64> {
    match stepped(target, &border, STEPS, model) {
        Some(point) => point,
        None => without_idle(target, border, model),
    }
}

/// Evaluations of one step, for so many variables.
pub(super) fn step_cost(variables: usize) -> usize {
    variables + LINE.len() + CUTS
}

/// Steps of Hasofer and Lind (1974; Rackwitz and Fiessler 1978) from a point of the limit, with differences of the model and a search of the
/// line about each; None where they lead no nearer.
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

/// Where the tangent plane at a point of the limit is nearest to the means; None where the model has no slope there.
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

/// The point with those variables at their means without which it is a reject still.
fn without_idle(target: &Target<'_>, point: Vec<f64>, model: &mut Model<'_>) -> Vec<f64> {
    let n = point.len();
    let without = |j: usize| {
        let mut moved = point.clone();
        moved[j] = 0.0;
        moved
    };
    // A little beyond the border, on which a reject is none by the smallest step.
    let beyond = |point: Vec<f64>| scaled(&point, 1.0 + 1e-3);
    let idle = sought(target, &(0..n).map(|j| beyond(without(j))).collect::<Vec<_>>(), model);
    let kept: Vec<f64> = point.iter().zip(&idle).map(|(z, idle)| if *idle { 0.0 } else { *z }).collect();
    let all = beyond(kept);
    match idle.contains(&true) && sought(target, std::slice::from_ref(&all), model)[0] {
        true => between(target, &all, [0.0, 1.0], ROUNDS, model),
        false => point,
    }
}

/// The first crossing, as eighths show it, between two parts of the way to a reject.
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

/// Whether each point is a reject.
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
