//! Derivatives that an external model sends with its answers, which save further evaluations.
//!
//! `rss` needs the slopes at the means: one evaluation, and one more that checks them. `full` needs no corners. The mixed second derivative
//! of dimensions j and k is the difference of the slope by k over the two nodes of j, and vice versa. The mean of both is taken. The 2N + 1
//! points of `full` are then those of `second-order` without derivatives. `second-order` itself takes one node an axis, N + 1 points: value
//! and slope at the means and at the node determine a cubic (Hermite's interpolation).
//!
//! All derivatives are checked. Between two points the difference of the values is the mean of the slopes times the step, except for a term
//! of third order. Each axis therefore checks the derivatives by its dimension without further evaluations.

use crate::assembly::Points;
use crate::evaluation::{Evaluated, Evaluator};
use crate::method::exact_derivatives::ExactDerivatives;
use crate::method::{MethodError, Options};
use crate::plan::{AtNode, DifferencePlan, Mixed, Point};
use crate::problem::Problem;
use sensitol_numeric::power::Power;
use sensitol_numeric::surrogate::{DerivativeOrigin, Univariate};

/// Greatest difference between derivatives and difference quotients, as part of the change. Derivatives beyond it are wrong: third
/// derivatives of a function that a parabola describes cause less.
const APART: f64 = 0.1;
/// Changes below this part of the largest one along any axis are not checked: rounding and noise dominate them.
const SMALL: f64 = 1e-3;
/// Greatest difference at the check point beside the means, as part of the change. So near to the means, third derivatives cause a
/// thousandth of their effect on the axes.
const NEAR: f64 = 3e-3;
/// Distance of the check point from the means, in sigmas. It checks the slopes at the means.
const STEP: f64 = 0.1;

/// Node in sigmas, and the derivatives there; None if the model sent none.
type Place<'e> = (f64, Option<&'e Vec<f64>>);

/// True if derivatives from the model can replace evaluations with these options.
pub(super) fn serve(options: &Options) -> bool {
    options.derivatives.is_none() && options.step.is_none() && !options.all_sensitivities
}

/// Returns the mixed derivatives of a characteristic for these pairs of positions, in sigmas; None if a gradient is missing.
pub(super) fn mixed(
    plan: &DifferencePlan,
    evaluated: &Evaluated,
    c: usize,
    pairs: &[(usize, usize)],
) -> Vec<Option<Mixed>> {
    // For every position: its nodes in sigmas, and the gradients there.
    let ends: Vec<Vec<Place<'_>>> = (plan.varying().iter())
        .map(|&d| nodes(plan, d).into_iter().map(|(point, u)| (u, evaluated.gradients.get(&(point, c)))).collect())
        .collect();
    // Change of the slope by the dimension at position k, in sigmas, over the nodes of the dimension at position j.
    let half = |j: usize, k: usize| {
        let of = plan.varying()[k];
        let [(below, left), (above, right)] = ends[j][..] else { return None };
        Some(plan.axis(of).scale * (right?.get(of)? - left?.get(of)?) / (above - below))
    };
    let both = |&(j, k): &(usize, usize)| {
        if !plan.joint(c, j, k) {
            return Some(Mixed::exact(0.0));
        }
        Some(Mixed::evaluated(0.5 * (half(j, k)? + half(k, j)?)))
    };
    pairs.iter().map(both).collect()
}

/// Returns the univariate part of a dimension with one node, in sigmas, or None if a value or a slope is missing.
///
/// With the rise `r` at the node `u`, the slope `a` at the means and `b` at the node, the part is `a u + c u^2 + d u^3` with `c = (3 r/u -
/// 2 a - b)/u` and `d = (a + b - 2 r/u)/u^2`. Accuracy: exact for polynomials up to the third degree.
pub(super) fn part(plan: &DifferencePlan, evaluated: &Evaluated, c: usize, d: usize) -> Option<Univariate> {
    if !plan.depends(c, d) {
        return Some(Univariate::of_coefficients(&[0.0, 0.0]));
    }
    let axis = plan.axis(d);
    let slope = |point: &Point| Some(axis.scale * evaluated.gradients.get(&(point.clone(), c))?.get(d)?);
    let centre = evaluated.known.value(&Point::Centre, c)?;
    let a = slope(&Point::Centre)?;
    let at = |&node: &u32| {
        let point = Point::of(&[AtNode { dimension: d as u32, node }]);
        let chord = (evaluated.known.value(&point, c)? - centre) / axis.nodes[node as usize].u;
        Some((axis.nodes[node as usize].u, chord, slope(&point)?))
    };
    // If the model has no value at the node, one of the replacements of the node may have one.
    let (u, chord, b) = axis.slots.first()?.iter().find_map(at)?;
    let part = Univariate::of_coefficients(&[a, (3.0 * chord - 2.0 * a - b) / u, (a + b - 2.0 * chord) / (u * u)]);
    Some(part.with_origin(DerivativeOrigin::Evaluated))
}

/// Returns the nodes of an axis with their places in sigmas, in ascending order. Replacements of nodes without a value are omitted.
fn nodes(plan: &DifferencePlan, d: usize) -> Vec<(Point, f64)> {
    let axis = plan.axis(d);
    let node = |slot: &Vec<u32>| {
        let node = *slot.first()?;
        Some((Point::of(&[AtNode { dimension: d as u32, node }]), axis.nodes[node as usize].u))
    };
    let mut nodes: Vec<(Point, f64)> = axis.slots.iter().filter_map(node).collect();
    nodes.sort_by(|a, b| a.1.total_cmp(&b.1));
    nodes
}

/// Compares the derivatives by every dimension with the differences along its axis.
pub(super) fn checked(problem: &Problem, plan: &DifferencePlan, evaluated: &Evaluated) -> Result<(), MethodError> {
    for c in 0..problem.characteristics().len() {
        let Some(centre) = evaluated.known.value(&Point::Centre, c) else { continue };
        let gradient = |point: &Point, d: usize| evaluated.gradients.get(&(point.clone(), c))?.get(d).copied();
        let mut found: Vec<(usize, f64, f64)> = Vec::new();
        for &d in plan.varying().iter().filter(|&&d| plan.depends(c, d)) {
            for (point, u) in nodes(plan, d) {
                let step = u * plan.axis(d).scale;
                let Some(value) = evaluated.known.value(&point, c) else { continue };
                let slopes = gradient(&Point::Centre, d).zip(gradient(&point, d));
                let Some((at_centre, there)) = slopes else { return Err(none(problem, c)) };
                found.push((d, value - centre, 0.5 * step * (at_centre + there)));
            }
        }
        let largest = found.iter().fold(0.0f64, |largest, (_, rise, _)| largest.max(rise.abs()));
        for (d, rise, by_slopes) in found {
            let scale = rise.abs().max(by_slopes.abs());
            if (rise - by_slopes).abs() > APART * scale + SMALL * largest {
                return Err(apart(problem, c, Some(d), by_slopes, rise));
            }
        }
    }
    Ok(())
}

/// Returns the slopes at the means that the model sent, after a further evaluation has checked them.
pub(super) fn slopes(
    problem: &Problem,
    plan: &DifferencePlan,
    evaluated: &mut Evaluated,
    evaluator: &Evaluator<'_>,
) -> Result<Vec<Option<ExactDerivatives>>, MethodError> {
    let centre = plan.centre();
    let mut point = centre.clone();
    for (position, &d) in plan.varying().iter().enumerate() {
        // Alternating signs of different size, so that equal errors of two derivatives do not cancel.
        point[d] += if position % 2 == 0 { STEP } else { -0.7 * STEP } * plan.axis(d).scale;
    }
    let out = evaluator.ask(&Points::from_rows(&[&point]));
    evaluated.ledger = evaluator.ledger();
    let n = centre.len();
    let of = |c: usize| {
        let Some(value) = evaluated.known.value(&Point::Centre, c) else { return Ok(None) };
        let slopes = evaluated.gradients.get(&(Point::Centre, c)).ok_or_else(|| none(problem, c))?;
        if let Some((there, gradient)) = out.value(0, c).zip(out.gradient(0, c)) {
            let parts = (0..n).map(|d| 0.5 * (point[d] - centre[d]) * (slopes[d] + gradient[d]));
            let (by_slopes, scale) = parts.fold((0.0, 0.0f64), |(sum, scale), part| (sum + part, scale + part.abs()));
            let rise = there - value;
            if (rise - by_slopes).abs() > NEAR * scale.max(rise.abs()) + 1e-9 * value.abs() {
                return Err(apart(problem, c, None, by_slopes, rise));
            }
        }
        let first = slopes.iter().map(|&slope| Some(slope)).collect();
        let units = vec![Power::ONE; n];
        Ok(Some(ExactDerivatives { first, second: vec![None; n], mixed: Vec::new(), units }))
    };
    (0..problem.characteristics().len()).map(of).collect()
}

fn none(problem: &Problem, c: usize) -> MethodError {
    MethodError::NoGradient { characteristic: problem.characteristics()[c].name().to_owned() }
}

fn apart(problem: &Problem, c: usize, d: Option<usize>, by_gradient: f64, by_values: f64) -> MethodError {
    MethodError::GradientsDisagree {
        characteristic: problem.characteristics()[c].name().to_owned(),
        dimension: d.map(|d| problem.dimensions()[d].name().to_owned()),
        by_gradient,
        by_values,
    }
}
