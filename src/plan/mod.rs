//! What to evaluate next, and why: pure functions from what is known to the next stage of points.
//!
//! A plan evaluates nothing. It names points by dimension and node, so that a point that serves two purposes is one
//! point, and says at every step which points it still lacks; a point that failed is simply not known, and the plan
//! asks for what can replace it.

mod axis;
mod checks;
mod design;
mod difference;
mod factorial;
mod known;
mod nodes;
mod pairs;
mod point;
mod stage;

pub use axis::Axis;
pub(crate) use checks::scattered;
pub use design::Design;
pub use difference::{Corner, DifferencePlan, Layout, Mixed};
pub use factorial::corners;
pub use known::Known;
pub use nodes::{MovedNode, Nodes, Spread};
pub use pairs::{PairChoice, Stencil};
pub use point::{At, Point};
pub use stage::{Purpose, Stage};

use std::fmt::Debug;

use crate::surrogate::Inputs;

/// What a method wants to be evaluated: points named by dimension and node, stage after stage.
///
/// A [`DifferencePlan`] is one, and so is a [`Design`], whose points are all known beforehand.
pub trait Plan: Debug + Send + Sync {
    /// The dimensions that vary and on which some characteristic can depend: N of them.
    fn varying(&self) -> &[usize];

    /// The dimensions of which derivatives are wanted: those that vary, and those without tolerance if they were asked for.
    fn moved(&self) -> Vec<usize>;

    /// The distributions of those that vary, as far as moments need them, and how they vary together.
    fn inputs(&self) -> &Inputs;

    /// One dimension's nodes.
    fn axis(&self, dimension: usize) -> &Axis;

    /// The point at which every dimension has its nominal value.
    fn nominal(&self) -> &Point;

    /// The coordinates of the means.
    fn centre(&self) -> Vec<f64>;

    /// Whether a characteristic can depend on a dimension.
    fn depends(&self, characteristic: usize, dimension: usize) -> bool;

    /// How many pairs of varying dimensions matter to some characteristic.
    fn possible_pairs(&self) -> usize;

    /// How many points there are in all, and in how many stages, if none fails.
    fn cost(&self) -> (usize, usize);

    /// The next points, or None when nothing is left that could help.
    fn next(&self, known: &Known) -> Option<Stage>;

    /// How far a characteristic lies above its centre at the nodes of one dimension, by their places in sigmas, ascending;
    /// None without a value at the means.
    fn samples(&self, known: &Known, characteristic: usize, dimension: usize) -> Option<Vec<(f64, f64)>> {
        let centre = known.value(&Point::Centre, characteristic)?;
        let axis = self.axis(dimension);
        let on_axis = |node: u32| Point::of(&[At { dimension: dimension as u32, node }]);
        let fresh = |samples: &[(u32, f64)], node: u32| samples.iter().all(|&(used, _)| used != node);
        let mut samples: Vec<(u32, f64)> = Vec::new();
        for slot in &axis.slots {
            let value = |node: u32| Some((node, known.value(&on_axis(node), characteristic)? - centre));
            if let Some(answered) = slot.iter().find_map(|&node| value(node)).filter(|(node, _)| fresh(&samples, *node))
            {
                samples.push(answered);
            }
        }
        Some(samples.into_iter().map(|(node, rise)| (axis.nodes[node as usize].u, rise)).collect())
    }

    /// Whether a characteristic can depend on the pair of dimensions at these positions.
    fn joint(&self, characteristic: usize, j: usize, k: usize) -> bool {
        [j, k].iter().all(|&position| self.depends(characteristic, self.varying()[position]))
    }
}

impl Plan for DifferencePlan {
    fn varying(&self) -> &[usize] {
        self.varying()
    }

    fn moved(&self) -> Vec<usize> {
        self.moved()
    }

    fn inputs(&self) -> &Inputs {
        self.inputs()
    }

    fn axis(&self, dimension: usize) -> &Axis {
        self.axis(dimension)
    }

    fn nominal(&self) -> &Point {
        self.nominal()
    }

    fn centre(&self) -> Vec<f64> {
        self.centre()
    }

    fn depends(&self, characteristic: usize, dimension: usize) -> bool {
        self.depends(characteristic, dimension)
    }

    fn possible_pairs(&self) -> usize {
        self.possible_pairs()
    }

    fn cost(&self) -> (usize, usize) {
        self.cost()
    }

    fn next(&self, known: &Known) -> Option<Stage> {
        self.next(known)
    }
}
