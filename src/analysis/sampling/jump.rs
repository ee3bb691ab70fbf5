//! Jumps of a costly model along axes that have two nodes only.
//!
//! Answers `f+`, `f-` on either side of the centre's `f0` give slope `g = |f+ - f-|/2` and curvature `c = |f+ + f- - 2 f0|/2`. If the
//! change on one side is negligible beside that on the other, `c/g` is 1. This holds at a jump beside the means, at a kink, and at the foot
//! of a parabola. Halving the side of the larger change distinguishes them: a jump stays in one half completely, for any length.
//!
//! Evaluations: three for an axis with `c > 0.5 g`, three more if these confirm it, for the three most curved axes at most: 18.

use crate::assembly::Points;
use crate::evaluation::Evaluator;
use crate::method::{Basis, Outcome};
use crate::problem::Problem;
use crate::warning::Warning;

use crate::analysis::CharacteristicAnalysis;

/// Ratio of curvature to slope below which an axis is not searched.
const CURVED: f64 = 0.5;
/// Curvature, as a part of sigma, below which an axis is not searched.
pub(super) const MATTERS: f64 = 0.1;
/// Greatest number of axes that are searched, the most curved ones.
pub(super) const AXES: usize = 3;
/// Halvings after which a side without a jump is dropped.
const FIRST: usize = 3;
/// Halvings in all, for the sides that remain.
const ALL: usize = 6;
/// Part of the change that a jump has in the last interval. A smooth function has 24 % of its change in the last eighth of a side, and 3 %
/// in the last of 64 parts.
const WHOLE: f64 = 0.5;

/// A side of an axis along which a characteristic may jump.
struct Side {
    characteristic: usize,
    dimension: usize,
    /// Coordinate of the node, in the unit of the dimension.
    end: f64,
    /// Change from the centre to the node.
    change: f64,
    curvature: f64,
    /// Ends of the interval with most of the change: the part of the way to the node, and the value there.
    ends: [(f64, f64); 2],
    /// True if a value was missing.
    lost: bool,
}

impl Side {
    /// True if the interval has nearly all of the change.
    fn is_jump(&self) -> bool {
        let [(_, from), (_, to)] = self.ends;
        !self.lost && (to - from).abs() > WHOLE * self.change.abs()
    }
}

/// Searches for jumps if the method has two nodes an axis and the model is costly. Uses no more evaluations than are left.
pub(in crate::analysis) fn find(
    evaluator: &Evaluator<'_>,
    outcome: &Outcome,
    characteristics: &[CharacteristicAnalysis],
) -> Vec<Warning> {
    if outcome.basis != Basis::Differences || outcome.climbed.is_some() || outcome.evaluated.stopped().is_some() {
        return Vec::new();
    }
    let run = evaluator.run();
    let mut sides: Vec<Side> =
        (0..characteristics.len()).flat_map(|c| suspicious(outcome, c, &characteristics[c])).collect();
    sides.sort_by(|a, b| b.curvature.total_cmp(&a.curvature).then(a.dimension.cmp(&b.dimension)));
    sides.truncate(AXES.min(evaluator.remaining().unwrap_or(usize::MAX) / ALL));
    for step in 0..ALL {
        if step == FIRST {
            sides.retain(Side::is_jump);
        }
        if sides.is_empty() || run.stopped() {
            break;
        }
        halve(evaluator, outcome, &mut sides);
    }
    if run.stopped() {
        return Vec::new();
    }
    let jumps = sides.iter().filter(|side| side.is_jump());
    jumps.map(|side| warning(evaluator.problem(), outcome, side, characteristics)).collect()
}

/// Sides of axes with nearly all of a change, with the curvature in sigmas.
fn suspicious(outcome: &Outcome, c: usize, one: &CharacteristicAnalysis) -> Vec<Side> {
    let plan = &outcome.plan;
    let Some(sigma) = one.moments.map(|moments| moments.sigma()).filter(|&sigma| sigma > 0.0) else {
        return Vec::new();
    };
    let side = |&d: &usize| {
        let samples = plan.samples(&outcome.evaluated.known, c, d).filter(|_| plan.depends(c, d))?;
        let [(below, left), (above, right)] = samples[..] else { return None };
        if below >= 0.0 || above <= 0.0 {
            return None;
        }
        let (slope, curvature) = ((right - left).abs() / 2.0, (right + left).abs() / 2.0);
        if curvature <= CURVED * slope || curvature <= MATTERS * sigma {
            return None;
        }
        let (u, change) = if right.abs() > left.abs() { (above, right) } else { (below, left) };
        let node = plan.axis(d).nodes.iter().find(|node| node.u == u)?;
        let ends = [(0.0, 0.0), (1.0, change)];
        let (dimension, end) = (d, node.x);
        Some(Side { characteristic: c, dimension, end, change, curvature: curvature / sigma, ends, lost: false })
    };
    plan.varying().iter().filter_map(side).collect()
}

/// Evaluates the middle of every interval, all in one batch, and keeps the half with the larger change.
fn halve(evaluator: &Evaluator<'_>, outcome: &Outcome, sides: &mut [Side]) {
    let centre = outcome.plan.centre();
    let middle = |side: &Side| 0.5 * (side.ends[0].0 + side.ends[1].0);
    let point = |side: &Side| {
        let mut point = centre.clone();
        point[side.dimension] += middle(side) * (side.end - centre[side.dimension]);
        point
    };
    let rows: Vec<Vec<f64>> = sides.iter().map(point).collect();
    let out = evaluator.ask(&Points::from_rows(&rows));
    for (row, side) in sides.iter_mut().enumerate() {
        let value = out.value(row, side.characteristic).zip(outcome.fitted[side.characteristic].centre);
        let Some((value, centre)) = value else {
            side.lost = true;
            continue;
        };
        let between = (middle(side), value - centre);
        let [from, to] = side.ends;
        let first = (between.1 - from.1).abs() > (to.1 - between.1).abs();
        side.ends = if first { [from, between] } else { [between, to] };
    }
}

fn warning(problem: &Problem, outcome: &Outcome, side: &Side, characteristics: &[CharacteristicAnalysis]) -> Warning {
    let axis = outcome.plan.axis(side.dimension);
    let [(from, before), (to, after)] = side.ends;
    let place = |part: f64| axis.mean + part * (side.end - axis.mean);
    let mut at = [place(from), place(to)];
    // The interval goes from the mean outwards, and so downwards on the left.
    let by = if at[0] > at[1] { before - after } else { after - before };
    at.sort_unstable_by(f64::total_cmp);
    let sigma = characteristics[side.characteristic].moments.map_or(f64::NAN, |moments| moments.sigma());
    Warning::Discontinuity {
        characteristic: problem.characteristics()[side.characteristic].name().to_owned(),
        dimension: problem.dimensions()[side.dimension].name().to_owned(),
        by: by / sigma,
        between: at.map(|x| (x - axis.mean) / axis.scale),
        at: Some(at),
        others: Vec::new(),
    }
}
