//! One dimension's nodes as numbers that a model can be given.

use super::nodes::{Moved, Nodes, Spread, Tail};
use crate::dimension::Dimension;

/// A place on an axis: the value, and how many sigmas it really lies off the mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// The value that the assembly function is given.
    pub x: f64,
    /// `(x - mean)/sigma`, of the rounded `x`: differences are divided by the realised step.
    pub u: f64,
}

/// The nodes of one dimension, those that may be needed in place of others included.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The mean.
    pub mean: f64,
    /// Sigma; for a dimension that does not vary, the step of its sensitivity.
    pub scale: f64,
    /// All nodes, each value once.
    pub nodes: Vec<Node>,
    /// For every node of the plan, ascending: itself, then its replacements in the order in which they are tried.
    pub slots: Vec<Vec<u32>>,
    /// Nodes that would have lain outside the support.
    pub moved: Vec<Moved>,
    /// A tail that is too long for the nodes.
    pub tail: Option<Tail>,
}

/// What replaces a node at which the model failed: half its distance, then a quarter.
const REPLACEMENTS: [f64; 2] = [0.5, 0.25];
/// The step of a sensitivity without tolerance, relative to the larger of the nominal and 1.
const SENSITIVITY_STEP: f64 = 1e-4;

impl Axis {
    /// The axis of a dimension that varies.
    pub(crate) fn varying(dimension: &Dimension, spread: Spread, step: Option<f64>) -> Self {
        let distribution = dimension.distribution().expect("a dimension that varies");
        let nodes = match dimension.step().or(step) {
            Some(step) => Nodes::stepped(step, spread),
            None => Nodes::matched(distribution, spread),
        };
        let mut axis = Self {
            mean: dimension.mean(),
            scale: dimension.sigma(),
            nodes: Vec::new(),
            slots: Vec::new(),
            moved: nodes.moved,
            tail: nodes.tail,
        };
        for u in nodes.u {
            axis.open_slot(u);
        }
        axis
    }

    /// The axis of a dimension that does not vary, for its sensitivity alone.
    pub(super) fn fixed(dimension: &Dimension, spread: Spread) -> Self {
        let nominal = dimension.nominal();
        let scale = SENSITIVITY_STEP * nominal.abs().max(1.0);
        let mut axis =
            Self { mean: nominal, scale, nodes: Vec::new(), slots: Vec::new(), moved: Vec::new(), tail: None };
        if spread != Spread::Bare {
            axis.open_slot(-1.0);
            axis.open_slot(1.0);
        }
        axis
    }

    /// A dimension that stays where it is.
    pub(super) fn still(dimension: &Dimension) -> Self {
        let mean = dimension.mean();
        Self { mean, scale: 0.0, nodes: Vec::new(), slots: Vec::new(), moved: Vec::new(), tail: None }
    }

    /// The distance of the nearest node from the mean, in the dimension's unit.
    pub fn nearest_step(&self) -> f64 {
        let nodes = self.slots.iter().map(|slot| self.nodes[slot[0] as usize].u.abs());
        self.scale * nodes.fold(f64::INFINITY, f64::min)
    }

    fn open_slot(&mut self, u: f64) {
        let mut slot = vec![self.node(self.mean + u * self.scale)];
        slot.extend(REPLACEMENTS.map(|factor| self.node(self.mean + factor * u * self.scale)));
        self.slots.push(slot);
    }

    /// The node of this value, a new one if need be; None at the mean itself.
    pub(super) fn at_value(&mut self, x: f64) -> Option<u32> {
        (x != self.mean).then(|| self.node(x))
    }

    fn node(&mut self, x: f64) -> u32 {
        match self.nodes.iter().position(|node| node.x == x) {
            Some(index) => u32::try_from(index).expect("few nodes on an axis"),
            None => self.open_node(x),
        }
    }

    /// A node of a value that is no node yet.
    pub(super) fn open_node(&mut self, x: f64) -> u32 {
        let index = u32::try_from(self.nodes.len()).expect("fewer than four billion nodes on an axis");
        self.nodes.push(Node { x, u: (x - self.mean) / self.scale });
        index
    }
}
