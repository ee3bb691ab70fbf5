//! Kinks of a costly model at the nominal point, as a length or an angle that is 0 there has them.
//!
//! A norm of smooth components that vanish at the means rises alike on both sides of an axis: `f(h) - f0 = f(-h) - f0 = s h`. The first
//! derivative is 0 and the second difference goes like `2 s/h`, so two nodes on an axis cannot tell it from a parabola. A node at half the
//! distance can: there a kink has half of the rise, and a parabola a quarter. Axes with four nodes have it already.
//!
//! Evaluations: one for the steepest axis without such a node of each characteristic, three at most.

use crate::analysis::CharacteristicAnalysis;
use crate::analysis::sampling::jump::{AXES, MATTERS};
use crate::assembly::Points;
use crate::evaluation::Evaluator;
use crate::method::Outcome;
use crate::warning::Warning;

/// Greatest slope of a symmetric axis, as a part of its rise. Truncation of a smooth component leaves some per cent.
const SYMMETRIC: f64 = 0.1;
/// Parts of the rise at half the distance that belong to a kink. A parabola has 1/4, and components with curvature move 1/2 a little.
const HALF: [f64; 2] = [0.42, 0.58];

/// Axis along which a characteristic rises alike on both sides.
struct SymmetricAxis {
    dimension: usize,
    /// Rise at the inner node.
    rise: f64,
    /// Coordinate of the inner node above the mean, in the unit of the dimension.
    node: f64,
    /// Part of the rise at half the distance, if further nodes show it.
    half: Option<f64>,
}

/// Characteristic with a kink at the nominal point, and the warning of it.
pub(in crate::analysis) struct NominalKink {
    pub(in crate::analysis) characteristic: usize,
    pub(in crate::analysis) warning: Warning,
}

/// Searches for kinks at the nominal point. Uses no more evaluations than are left.
pub(in crate::analysis) fn find(
    evaluator: &Evaluator<'_>,
    outcome: &Outcome,
    characteristics: &[CharacteristicAnalysis],
) -> Vec<NominalKink> {
    let run = evaluator.run();
    if outcome.evaluated.stopped().is_some() || run.stopped() {
        return Vec::new();
    }
    let mut all: Vec<Vec<SymmetricAxis>> =
        (0..characteristics.len()).map(|c| symmetric(outcome, c, &characteristics[c])).collect();
    ask_halves(evaluator, outcome, &mut all);
    let problem = evaluator.problem();
    let mut kinks = Vec::new();
    for (c, axes) in all.iter().enumerate() {
        let is_kink = |half: f64| (HALF[0]..=HALF[1]).contains(&half);
        let known: Vec<bool> = axes.iter().filter_map(|axis| axis.half).map(is_kink).collect();
        // One axis that is a parabola says nothing on the others, so that only those without a refutation are named.
        if !known.contains(&true) {
            continue;
        }
        let named = axes.iter().filter(|axis| axis.half.is_none_or(is_kink));
        let dimensions = named.map(|axis| problem.dimensions()[axis.dimension].name().to_owned()).collect();
        let characteristic = problem.characteristics()[c].name().to_owned();
        kinks.push(NominalKink { characteristic: c, warning: Warning::KinkAtNominal { characteristic, dimensions } });
    }
    kinks
}

/// Axes of a characteristic with a rise alike on both sides, the steepest first.
fn symmetric(outcome: &Outcome, c: usize, one: &CharacteristicAnalysis) -> Vec<SymmetricAxis> {
    let plan = &outcome.plan;
    // Figures of points need no surface, and its kinks are no finding then.
    let by_surface = one.evidence.model_sampled.is_none();
    let Some(sigma) = one.moments.map(|moments| moments.sigma()).filter(|&sigma| by_surface && sigma > 0.0) else {
        return Vec::new();
    };
    let axis = |&d: &usize| {
        let samples = plan.samples(&outcome.evaluated.known, c, d).filter(|_| plan.depends(c, d))?;
        let below = samples.iter().filter(|(u, _)| *u < 0.0).max_by(|a, b| a.0.total_cmp(&b.0))?;
        let above = samples.iter().filter(|(u, _)| *u > 0.0).min_by(|a, b| a.0.total_cmp(&b.0))?;
        let slopes = [below.1 / below.0, above.1 / above.0];
        let (slope, steep) = ((slopes[0] + slopes[1]).abs() / 2.0, (slopes[1] - slopes[0]).abs() / 2.0);
        if slope > SYMMETRIC * steep || steep * above.0 <= MATTERS * sigma {
            return None;
        }
        // From an outer node the part at half its distance follows: by powers, the logarithm of the rise is linear.
        let outer = samples.iter().filter(|(u, _)| *u > above.0).min_by(|a, b| a.0.total_cmp(&b.0));
        let half = outer.and_then(|outer| {
            let (ratio, way) = (outer.1 / above.1, outer.0 / above.0);
            (ratio > 0.0).then(|| libm::exp2(-libm::log(ratio) / libm::log(way)))
        });
        let node = plan.axis(d).nodes.iter().find(|node| node.u == above.0)?.x;
        Some(SymmetricAxis { dimension: d, rise: above.1, node, half })
    };
    let mut axes: Vec<SymmetricAxis> = plan.varying().iter().filter_map(axis).collect();
    axes.sort_by(|a, b| b.rise.abs().total_cmp(&a.rise.abs()).then(a.dimension.cmp(&b.dimension)));
    axes
}

/// Evaluates the steepest axis of every characteristic at half the distance of its node, if no node shows its shape.
fn ask_halves(evaluator: &Evaluator<'_>, outcome: &Outcome, all: &mut [Vec<SymmetricAxis>]) {
    let most = AXES.min(evaluator.remaining().unwrap_or(usize::MAX));
    let open = |axes: &Vec<SymmetricAxis>| axes.iter().all(|axis| axis.half.is_none()) && !axes.is_empty();
    let asked: Vec<usize> = (0..all.len()).filter(|&c| open(&all[c])).take(most).collect();
    if asked.is_empty() {
        return;
    }
    let centre = outcome.plan.centre();
    let point = |&c: &usize| {
        let (axis, mut point) = (&all[c][0], centre.clone());
        point[axis.dimension] += 0.5 * (axis.node - centre[axis.dimension]);
        point
    };
    let rows: Vec<Vec<f64>> = asked.iter().map(point).collect();
    let out = evaluator.ask(&Points::from_rows(&rows));
    for (row, c) in asked.into_iter().enumerate() {
        let value = out.value(row, c).zip(outcome.fitted[c].centre);
        let axis = &mut all[c][0];
        axis.half = value.map(|(value, centre)| (value - centre) / axis.rise);
    }
}
