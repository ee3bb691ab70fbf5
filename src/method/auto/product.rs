//! Whether a characteristic is a product of functions of one dimension each, so that its logarithm is their sum.
//!
//! All pairs of such a function interact, and three at a time too: interactions are the wrong thing to buy. A regression of the
//! logarithm has one term or two for every dimension instead (Box and Cox 1964).

use super::chosen::ChosenPoints;
use super::view::View;
use crate::plan::{DifferencePlan, KnownAnswers, Point};

/// The share of the variance that the product leaves at the points that check is less than this part of what the surface leaves, and of
/// the wanted error: neither counts beside it.
const PART: f64 = 0.1;

/// Whether `f(m) prod_j exp(a_j u_j + b_j u_j^2)` through the values on the axes explains the points that check, where the surface of
/// `view` does not. All values must have one sign.
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

/// Slope and bend of the logarithm along every axis, from its innermost nodes; None without values of the centre's sign there.
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
