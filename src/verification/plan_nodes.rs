//! Points of a method's plan without a value, as places that bound the share of the assemblies without one.
//!
//! A method leaves out the points of its plan at which the model fails, and goes on with nearer ones. On the axis of one input, the last node
//! with a value and the first one without enclose the edge, as check points do. A failed point of several inputs belongs to a region of an
//! unknown shape.

use crate::estimate::NormalSpace;
use crate::verification::check_ray::CheckRay;

/// Point of a plan, by the inputs that deviate from their means.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PlanNode {
    /// Variables with their places in sigmas about the mean.
    pub at: Vec<(usize, f64)>,
    /// True if the characteristic has a value there.
    pub has_value: bool,
}

impl PlanNode {
    /// Creates a point of a plan.
    pub fn new(at: Vec<(usize, f64)>, has_value: bool) -> Self {
        Self { at, has_value }
    }
}

/// Nodes of plans on the rays of check points.
pub(super) struct NodesOnRays {
    /// Further rows of every characteristic: 0 at nodes with a value, NaN at others.
    pub(super) residuals: Vec<Vec<f64>>,
    /// Failed points of several inputs in normal space, of every characteristic.
    pub(super) beside: Vec<Vec<Vec<f64>>>,
}

impl NodesOnRays {
    /// Adds the nodes of axes with a failed one to the rays along them, in rows from `row` on. An axis without a ray gets one. `plans` has the
    /// nodes of every characteristic.
    pub(super) fn add(space: &NormalSpace<'_>, plans: &[&[PlanNode]], rays: &mut Vec<CheckRay>, row: usize) -> Self {
        let mut found = Self { residuals: vec![Vec::new(); plans.len()], beside: vec![Vec::new(); plans.len()] };
        let nodes = || plans.iter().flat_map(|nodes| nodes.iter());
        for (j, upward) in (0..space.len()).flat_map(|j| [(j, true), (j, false)]) {
            let on = |node: &PlanNode| match *node.at {
                [(variable, u)] if variable == j && u != 0.0 && (u > 0.0) == upward => Some(u),
                _ => None,
            };
            if !nodes().any(|node| !node.has_value && on(node).is_some()) {
                continue;
            }
            let mut places: Vec<f64> = nodes().filter_map(on).collect();
            places.sort_by(f64::total_cmp);
            places.dedup();
            let direction: Vec<f64> =
                (0..space.len()).map(|k| if k == j { if upward { 1.0 } else { -1.0 } } else { 0.0 }).collect();
            let index = rays.iter().position(|ray| ray.is_along(&direction));
            let index = index.unwrap_or_else(|| {
                rays.push(CheckRay::towards(direction));
                rays.len() - 1
            });
            for u in places {
                let Some(z) = space.behind(j, u) else { continue };
                rays[index].add(z.abs(), row + found.residuals[0].len());
                for (nodes, residuals) in plans.iter().zip(&mut found.residuals) {
                    let fails = nodes.iter().any(|node| on(node) == Some(u) && !node.has_value);
                    residuals.push(if fails { f64::NAN } else { 0.0 });
                }
            }
        }
        rays.retain(|ray| !ray.is_empty());
        for (nodes, beside) in plans.iter().zip(&mut found.beside) {
            let failed = nodes.iter().filter(|node| !node.has_value && node.at.len() > 1);
            beside.extend(failed.filter_map(|node| point(space, node)));
        }
        found
    }
}

/// Point in normal space. Returns None if inputs are correlated.
fn point(space: &NormalSpace<'_>, node: &PlanNode) -> Option<Vec<f64>> {
    let mut point = vec![0.0; space.len()];
    for &(j, u) in &node.at {
        point[j] = space.behind(j, u)?;
    }
    Some(point)
}
