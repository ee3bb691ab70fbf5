//! Axis of one dimension: its nodes as values for the model.

use super::nodes::{MovedNode, Nodes, Reaches, Spread, Tail, nearest, values};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::power::Power;

/// Place on an axis: the value, and its actual distance from the mean in sigmas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Value passed to the assembly function.
    pub x: f64,
    /// Place `(x - mean)/sigma` of the rounded `x`: differences are divided by the realised step.
    pub u: f64,
}

/// Nodes of one dimension, including replacements for nodes at which the model fails.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Mean of the dimension.
    pub mean: f64,
    /// Sigma of the dimension. Without variation, the step of its sensitivity.
    pub scale: f64,
    /// Nodes of the axis, each value once.
    pub nodes: Vec<Node>,
    /// Slots: for every node of the plan, ascending, the node itself and its replacements in the order in which they are tried.
    pub slots: Vec<Vec<u32>>,
    /// Slots on the left and on the right at which pairs are evaluated: those next to the mean when the plan was made.
    pub inner: [Option<Vec<u32>>; 2],
    /// Nodes that would have been outside the support.
    pub moved: Vec<MovedNode>,
    /// Tail that is too long for the nodes. None if it is not.
    pub tail: Option<Tail>,
    /// Values of a discrete distribution. Empty if the distribution has a density.
    pub(super) values: Vec<f64>,
}

/// Distances of the replacements of a failed node, as parts of its own distance.
const REPLACEMENTS: [f64; 2] = [0.5, 0.25];
/// Greatest distance, in sigmas, of a node from a value of a discrete distribution that is taken as rounding.
const SAME: f64 = 1e-9;
/// Step of a sensitivity without tolerance, relative to the larger of the nominal and 1, or to the nominal itself if its size is extreme.
const SENSITIVITY_STEP: f64 = 1e-4;

impl Axis {
    /// Axis of a dimension that varies.
    pub(crate) fn varying(dimension: &Dimension, spread: Spread, step: Option<f64>) -> Self {
        Self::varying_with(dimension, spread, step, &mut Reaches::default())
    }

    /// Axis of a dimension that varies, with the reaches computed for earlier dimensions.
    pub(super) fn varying_with(
        dimension: &Dimension,
        spread: Spread,
        step: Option<f64>,
        reaches: &mut Reaches,
    ) -> Self {
        let distribution = dimension.distribution().expect("a dimension that varies");
        let nodes = match dimension.step().or(step) {
            Some(step) => Nodes::stepped(step, spread),
            None => Nodes::matched_with(distribution, spread, reaches),
        };
        let mut axis = Self {
            mean: dimension.mean(),
            scale: dimension.sigma(),
            nodes: Vec::new(),
            slots: Vec::new(),
            inner: [None, None],
            moved: nodes.moved,
            tail: nodes.tail,
            values: values(distribution),
        };
        for u in nodes.u {
            axis.open_slot(u);
        }
        axis.with_inner()
    }

    /// Adds two nodes, so that the axis has five with the mean. Returns false if there are no suitable nodes. Evaluated points remain in
    /// use, and pairs keep their nodes.
    ///
    /// On either side, the added node is the one of the matched five-point nodes that lies farther from the present node. If the tail is
    /// too long for a quartic, or the matched nodes are not two on either side, all four are new.
    pub(super) fn refine(&mut self, dimension: &Dimension, step: Option<f64>) -> bool {
        let Some(distribution) = dimension.distribution().filter(|_| self.slots.len() == 2) else { return false };
        let five = match dimension.step().or(step) {
            Some(step) => Nodes::stepped(step, Spread::Five),
            None => Nodes::matched(distribution, Spread::Five),
        };
        let [left, right] = [0, 1].map(|i| self.nodes[self.slots[i][0] as usize].u);
        let added = match *five.u {
            [a, b, c, d] if five.tail.is_none() && b < 0.0 && c > 0.0 && left < 0.0 && right > 0.0 => {
                vec![farther(left, [a, b]), farther(right, [c, d])]
            }
            [_, _, _, _] => {
                self.slots.clear();
                five.u
            }
            _ => return false,
        };
        self.tail = five.tail;
        for u in added {
            self.open_slot(u);
        }
        let nodes = &self.nodes;
        self.slots.sort_by(|a, b| nodes[a[0] as usize].u.total_cmp(&nodes[b[0] as usize].u));
        true
    }

    fn with_inner(mut self) -> Self {
        let side = |slot: &&Vec<u32>, right: bool| (self.nodes[slot[0] as usize].u > 0.0) == right;
        let left = self.slots.iter().rfind(|slot| side(slot, false)).cloned();
        let right = self.slots.iter().find(|slot| side(slot, true)).cloned();
        self.inner = [left, right];
        self
    }

    /// Axis of a dimension that does not vary, used for its sensitivity only.
    pub(super) fn fixed(dimension: &Dimension, spread: Spread) -> Self {
        let nominal = dimension.nominal();
        // Use a nominal value of extreme size as its own scale.
        let scale = SENSITIVITY_STEP * nominal.abs().max(Power::of(nominal).times(1.0));
        let mut axis = Self { mean: nominal, scale, ..Self::still(dimension) };
        match spread {
            Spread::Bare => {}
            Spread::Upper => axis.open_slot(1.0),
            Spread::Pair | Spread::Five => [-1.0, 1.0].into_iter().for_each(|u| axis.open_slot(u)),
        }
        axis
    }

    /// Axis of a dimension that is not moved.
    pub(super) fn still(dimension: &Dimension) -> Self {
        let mean = dimension.mean();
        let (nodes, slots, moved) = (Vec::new(), Vec::new(), Vec::new());
        let values = dimension.distribution().map_or_else(Vec::new, values);
        Self { mean, scale: 0.0, nodes, slots, inner: [None, None], moved, tail: None, values }
    }

    /// Value of a discrete distribution that is nearest to `x`, on the same side of the mean. Returns `x` itself if it is the mean, or if
    /// the distribution has a density.
    pub(crate) fn nearest_value(&self, x: f64) -> f64 {
        if x == self.mean {
            return x;
        }
        let off: Vec<f64> = self.values.iter().map(|value| (value - self.mean) / self.scale).collect();
        let found = nearest(&off, (x - self.mean) / self.scale);
        let place = found.and_then(|found| off.iter().position(|&u| u == found));
        place.map_or(x, |place| self.values[place])
    }

    /// Replaces `x` by the value of a discrete distribution that it differs from by rounding only.
    pub(super) fn occurring(&self, x: f64) -> f64 {
        let after = self.values.partition_point(|&value| value < x);
        let beside = self.values[after.saturating_sub(1)..].iter().take(2);
        beside.copied().find(|value| (value - x).abs() <= SAME * self.scale).unwrap_or(x)
    }

    /// Distance of the nearest node from the mean, in the dimension's unit.
    pub(crate) fn nearest_step(&self) -> f64 {
        let nodes = self.slots.iter().map(|slot| self.nodes[slot[0] as usize].u.abs());
        self.scale * nodes.fold(f64::INFINITY, f64::min)
    }

    fn open_slot(&mut self, u: f64) {
        let mut slot = vec![self.node(self.mean + u * self.scale)];
        slot.extend(REPLACEMENTS.map(|factor| self.node(self.mean + factor * u * self.scale)));
        self.slots.push(slot);
    }

    /// Index of the node of this value, which is added if it is new. Returns None for the mean.
    pub(super) fn at_value(&mut self, x: f64) -> Option<u32> {
        (x != self.mean).then(|| self.node(x))
    }

    fn node(&mut self, x: f64) -> u32 {
        let x = self.occurring(x);
        match self.nodes.iter().position(|node| node.x == x) {
            Some(index) => u32::try_from(index).expect("few nodes on an axis"),
            None => self.open_node(x),
        }
    }

    /// Adds a node of a value that has none yet, and returns its index.
    pub(super) fn open_node(&mut self, x: f64) -> u32 {
        let index = u32::try_from(self.nodes.len()).expect("fewer than four billion nodes on an axis");
        self.nodes.push(Node { x, u: (x - self.mean) / self.scale });
        index
    }
}

/// Place of two that lies farther from a third on the same side, by their ratio.
fn farther(from: f64, of: [f64; 2]) -> f64 {
    let ratio = |u: f64| (u / from).max(from / u);
    if ratio(of[1]) > ratio(of[0]) { of[1] } else { of[0] }
}
