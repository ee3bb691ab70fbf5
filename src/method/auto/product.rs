//! Test for a product of functions of one dimension each, whose logarithm is a sum of such functions.
//!
//! All pairs of such a function interact, and all triples too, so that examining interactions is a waste. A regression of the logarithm has
//! one term or two for every dimension instead (Box and Cox 1964).

use crate::method::auto::characteristic_state::View;
use crate::method::auto::chosen_points::ChosenPoints;
use crate::plan::{DifferencePlan, KnownAnswers, Point};

/// Greatest residual of a product at the check points, as part of the surface's residual and of the target error: it is negligible beside
/// both.
const PART: f64 = 0.1;

/// True if `f(m) prod_j exp(a_j u_j + b_j u_j^2)` through the values on the axes explains the check points, while the surface of `view`
/// does not. All values must have one sign.
pub(super) fn is_product(
    plan: &DifferencePlan,
    known: &KnownAnswers,
    bought: &ChosenPoints,
    view: &View,
    accuracy: f64,
) -> bool {
    let (Some(left), Some(factors)) = (view.left(), factors(plan, known, view.characteristic)) else { return false };
    let Some(centre) = known.value(&Point::Centre, view.characteristic) else { return false };
    let off = |point: &Point| {
        let value = known.value(point, view.characteristic)?;
        let place = plan.standardised(point);
        let rise: f64 = place.iter().zip(&factors).map(|(u, [slope, bend])| u * (slope + u * bend)).sum();
        Some(value - centre * libm::exp(rise))
    };
    let Some(off) = bought.checks.iter().flatten().map(off).collect::<Option<Vec<f64>>>() else { return false };
    let remains = view.share(off.iter().map(|d| d * d).sum::<f64>() / off.len().max(1) as f64);
    !off.is_empty() && remains < PART * left.min(accuracy)
}

/// Returns slope and bend of the logarithm along every axis, from its innermost nodes. Returns None if the values there do not have the
/// sign of the centre.
fn factors(plan: &DifferencePlan, known: &KnownAnswers, c: usize) -> Option<Vec<[f64; 2]>> {
    let centre = known.value(&Point::Centre, c)?;
    let factor = |&d: &usize| {
        if !plan.depends(c, d) {
            return Some([0.0; 2]);
        }
        let samples = plan.samples(known, c, d)?;
        let logarithm = |&(u, rise): &(f64, f64)| {
            let ratio = 1.0 + rise / centre;
            (ratio > 0.0).then(|| (u, libm::log(ratio) / u))
        };
        let below = samples.iter().rev().find(|(u, _)| *u < 0.0).map(logarithm);
        let above = samples.iter().find(|(u, _)| *u > 0.0).map(logarithm);
        let (Some(below), Some(above)) = (below, above) else { return None };
        let ((left, at_left), (right, at_right)) = (below?, above?);
        let bend = (at_right - at_left) / (right - left);
        Some([at_left - bend * left, bend])
    };
    plan.varying().iter().map(factor).collect()
}
