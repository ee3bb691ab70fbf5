//! Likeliest point of a surface beyond a limit, found without an evaluation of the model.
//!
//! Steps of Hasofer and Lind (1974; Rackwitz and Fiessler 1978) on the surface, from the line that carries it.

use crate::estimate::Columns;
use crate::estimate::strata::{dot, length};
use crate::verification::checked_surface::CheckedSurface;

/// Greatest distance of a check point towards a limit, in sigmas.
pub(super) const FARTHEST: f64 = 4.5;
/// Greatest number of steps. A surface of second degree takes three to five.
const STEPS: usize = 8;
/// Step of the differences for the slope of the surface, in sigmas.
const STEP: f64 = 0.01;
/// Change of a step below which the search ends, in sigmas.
const NEAR: f64 = 0.01;
/// Start of the search on the line, in sigmas.
const START: f64 = 1.5;
/// Greatest number of variables with a search. With more, the point lies on the line.
const SEARCHED: usize = 128;

/// Likeliest point with a value beyond the limit, at most [`FARTHEST`] sigmas from the means.
///
/// Shapes: `line` has length 1 and one component for every variable. Returns None if the surface lies beyond the limit at the means.
pub(super) fn likeliest(surface: &CheckedSurface<'_>, line: &[f64], limit: f64, upper: bool) -> Option<Vec<f64>> {
    let sign = if upper { 1.0 } else { -1.0 };
    let [mean, sigma, ..] = surface.figures;
    let margin = |value: f64| sign * (value - limit) / sigma;
    if margin(mean) >= 0.0 || !limit.is_finite() {
        return None;
    }
    let mut point: Vec<f64> = line.iter().map(|part| sign * part * START).collect();
    if surface.variables() > SEARCHED {
        return Some(scaled(&point, -margin(mean) / START));
    }
    for _ in 0..STEPS {
        let Some(next) = tangent(surface, &point, margin) else { break };
        let moved = length(&point.iter().zip(&next).map(|(a, b)| a - b).collect::<Vec<f64>>());
        point = next;
        if moved < NEAR {
            break;
        }
    }
    Some(scaled(&point, 1.0))
}

/// Point of the tangent plane's limit nearest to the means. Returns None if the surface has no slope there.
fn tangent(surface: &CheckedSurface<'_>, at: &[f64], margin: impl Fn(f64) -> f64) -> Option<Vec<f64>> {
    let n = at.len();
    let column = |j: usize| (0..=n).map(|row| at[j] + if row == j + 1 { STEP } else { 0.0 }).collect();
    let values: Columns = (0..n).map(column).collect();
    let margins: Vec<f64> = surface.at(&values)?.into_iter().map(margin).collect();
    let slopes: Vec<f64> = margins[1..].iter().map(|one| (one - margins[0]) / STEP).collect();
    let square = dot(&slopes, &slopes);
    let factor = (dot(&slopes, at) - margins[0]) / square;
    (square > 0.0 && factor.is_finite()).then(|| scaled(&slopes.iter().map(|s| factor * s).collect::<Vec<f64>>(), 1.0))
}

/// Scales a point, to at most [`FARTHEST`] sigmas.
fn scaled(point: &[f64], by: f64) -> Vec<f64> {
    let factor = by.min(FARTHEST / length(point));
    point.iter().map(|z| factor * z).collect()
}
