//! Jumps of a costly model along axes that have two nodes only.
//!
//! With answers `f+`, `f-` on either side of the centre's `f0`, slope `g = |f+ - f-|/2` and curvature `c = |f+ + f- - 2 f0|/2`: where the
//! change on one side is nothing beside that on the other, `c/g` is 1. So it is at a jump beside the means, at a kink, and at the foot of a
//! parabola. Halving the side of the larger change tells them apart: that of a jump stays in one half whole, however short it gets.
//!
//! Evaluations: three for an axis with `c > 0.5 g`, three more where these confirm it, of the three most curved axes at most: 18.

use crate::assembly::{NonRepeatable, Points, Request, Responses, Run};
use crate::method::{Basis, Outcome};
use crate::problem::Problem;
use crate::summary::RunSummary;
use crate::warning::Warning;
use sensitol_numeric::time::Instant;

use super::CharacteristicAnalysis;

/// Curvature below this part of the slope is none to look into.
const CURVED: f64 = 0.5;
/// Nor is curvature below this part of sigma.
const MATTERS: f64 = 0.1;
/// Axes that are looked into, the most curved ones.
const AXES: usize = 3;
/// Halvings before the first judgement, and in all.
const FIRST: usize = 3;
const ALL: usize = 6;
/// A smooth function has 24 % of its change in the last eighth of a side, and 3 % in the last of 64 parts.
const WHOLE: f64 = 0.5;

/// The jumps that were found, and the cost of finding them.
#[derive(Default)]
pub(super) struct FoundJumps {
    pub(super) warnings: Vec<Warning>,
    pub(super) run: RunSummary,
    pub(super) non_repeatable: Vec<NonRepeatable>,
}

/// A side of an axis along which a characteristic may jump.
struct Side {
    characteristic: usize,
    dimension: usize,
    /// The coordinate of the node.
    end: f64,
    /// The change from the centre to the node.
    change: f64,
    curvature: f64,
    /// The interval that has most of the change: parts of the way to the node, with the values there.
    ends: [(f64, f64); 2],
    /// Whether a value was missing.
    lost: bool,
}

impl Side {
    /// Whether the interval has nearly all of the change.
    fn is_jump(&self) -> bool {
        let [(_, from), (_, to)] = self.ends;
        !self.lost && (to - from).abs() > WHOLE * self.change.abs()
    }
}

/// Looks for jumps, where the method has two nodes an axis and the model is costly; with no more evaluations than are left.
pub(super) fn find(
    problem: &Problem,
    outcome: &Outcome,
    characteristics: &[CharacteristicAnalysis],
    left: Option<usize>,
    run: &Run<'_>,
) -> FoundJumps {
    let mut found = FoundJumps::default();
    if outcome.basis != Basis::Differences || outcome.climbed.is_some() || outcome.evaluated.stopped.is_some() {
        return found;
    }
    let mut sides: Vec<Side> =
        (0..characteristics.len()).flat_map(|c| suspicious(outcome, c, &characteristics[c])).collect();
    sides.sort_by(|a, b| b.curvature.total_cmp(&a.curvature).then(a.dimension.cmp(&b.dimension)));
    sides.truncate(AXES.min(left.unwrap_or(usize::MAX) / ALL));
    for step in 0..ALL {
        if step == FIRST {
            sides.retain(Side::is_jump);
        }
        if sides.is_empty() || run.stopped() {
            break;
        }
        found.halve(problem, outcome, &mut sides, run);
    }
    if !run.stopped() {
        found.warnings = sides
            .iter()
            .filter(|side| side.is_jump())
            .map(|side| warning(problem, outcome, side, characteristics))
            .collect();
    }
    found
}

/// The sides of axes on which nearly all of a change lies, with the curvature in sigmas.
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

impl FoundJumps {
    /// Evaluates the middle of every interval, and keeps the half with the larger change.
    fn halve(&mut self, problem: &Problem, outcome: &Outcome, sides: &mut [Side], run: &Run<'_>) {
        let centre = outcome.plan.centre();
        let middle = |side: &Side| 0.5 * (side.ends[0].0 + side.ends[1].0);
        let point = |side: &Side| {
            let mut point = centre.clone();
            point[side.dimension] += middle(side) * (side.end - centre[side.dimension]);
            point
        };
        let rows: Vec<Vec<f64>> = sides.iter().map(point).collect();
        let mut out = Responses::open(rows.len(), problem.outputs().len());
        let begun = Instant::now();
        problem.function().evaluate(&Request::values(&Points::from_rows(&rows), problem.outputs()), run, &mut out);
        self.run = self.run.and(&out.summary(begun.elapsed()));
        self.non_repeatable.extend(out.non_repeatable().iter().cloned());
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
}

fn warning(problem: &Problem, outcome: &Outcome, side: &Side, characteristics: &[CharacteristicAnalysis]) -> Warning {
    let axis = outcome.plan.axis(side.dimension);
    let [(from, before), (to, after)] = side.ends;
    let place = |part: f64| axis.mean + part * (side.end - axis.mean);
    let mut at = [place(from), place(to)];
    // From the mean outwards, and so downwards on the left.
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
