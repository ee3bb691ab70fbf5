//! One dimension's nodes as numbers that a model can be given.

use super::nodes::{MovedNode, Nodes, Reaches, Spread, Tail, nearest, values};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::power::Power;

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
    /// The slots on the left and on the right at which pairs stand: those next to the mean when the plan was made.
    pub inner: [Option<Vec<u32>>; 2],
    /// Nodes that would have lain outside the support.
    pub moved: Vec<MovedNode>,
    /// A tail that is too long for the nodes.
    pub tail: Option<Tail>,
    /// The values that occur, where each has a probability of its own.
    pub(super) values: Vec<f64>,
}

/// The replacements of a node at which the model failed: half its distance, then a quarter.
const REPLACEMENTS: [f64; 2] = [0.5, 0.25];
/// A node so near to a value that occurs, in sigmas, is that value but for rounding.
const SAME: f64 = 1e-9;
/// The step of a sensitivity without tolerance, relative to the larger of the nominal and 1; of a nominal of extreme size relative to itself.
const SENSITIVITY_STEP: f64 = 1e-4;

impl Axis {
    /// The axis of a dimension that varies.
    pub(crate) fn varying(dimension: &Dimension, spread: Spread, step: Option<f64>) -> Self {
        Self::varying_with(dimension, spread, step, &mut Reaches::default())
    }

    /// The same, with what is known of dimensions before.
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

    /// Two nodes more, so that the axis has five with the mean; whether there are such. Evaluated points stay, and pairs stand
    /// where they stood.
    ///
    /// On either side the one of the matched five-point nodes that lies farther from the node that there is. Where the
    /// tail is too long for a quartic, or the five do not lie two on either side, all four are new.
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

    /// The axis of a dimension that does not vary, for its sensitivity alone.
    pub(super) fn fixed(dimension: &Dimension, spread: Spread) -> Self {
        let nominal = dimension.nominal();
        // A nominal value of extreme size has a unit of its own.
        let scale = SENSITIVITY_STEP * nominal.abs().max(Power::of(nominal).times(1.0));
        let mut axis = Self { mean: nominal, scale, ..Self::still(dimension) };
        match spread {
            Spread::Bare => {}
            Spread::Upper => axis.open_slot(1.0),
            Spread::Pair | Spread::Five => [-1.0, 1.0].into_iter().for_each(|u| axis.open_slot(u)),
        }
        axis
    }

    /// A dimension that stays where it is.
    pub(super) fn still(dimension: &Dimension) -> Self {
        let mean = dimension.mean();
        let (nodes, slots, moved) = (Vec::new(), Vec::new(), Vec::new());
        let values = dimension.distribution().map_or_else(Vec::new, values);
        Self { mean, scale: 0.0, nodes, slots, inner: [None, None], moved, tail: None, values }
    }

    /// The value that occurs next to a place, on its side of the mean; the place itself at the mean, and of a dimension that may have any
    /// value.
    pub(crate) fn nearest_value(&self, x: f64) -> f64 {
        if x == self.mean {
            return x;
        }
        let off: Vec<f64> = self.values.iter().map(|value| (value - self.mean) / self.scale).collect();
        let found = nearest(&off, (x - self.mean) / self.scale);
        let place = found.and_then(|found| off.iter().position(|&u| u == found));
        place.map_or(x, |place| self.values[place])
    }

    /// A value that occurs for one that only rounding separates from it.
    pub(super) fn occurring(&self, x: f64) -> f64 {
        let after = self.values.partition_point(|&value| value < x);
        let beside = self.values[after.saturating_sub(1)..].iter().take(2);
        beside.copied().find(|value| (value - x).abs() <= SAME * self.scale).unwrap_or(x)
    }

    /// The distance of the nearest node from the mean, in the dimension's unit.
    pub(crate) fn nearest_step(&self) -> f64 {
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
        let x = self.occurring(x);
        match self.nodes.iter().position(|node| node.x == x) {
            Some(index) => u32::try_from(index).expect("few nodes on an axis"),
            None => self.open_node(x),
        }
    }

    /// A node of a value that is not a node yet.
    pub(super) fn open_node(&mut self, x: f64) -> u32 {
        let index = u32::try_from(self.nodes.len()).expect("fewer than four billion nodes on an axis");
        self.nodes.push(Node { x, u: (x - self.mean) / self.scale });
        index
    }
}

/// The one of two places that lies farther from a third on the same side, by their ratio.
fn farther(from: f64, of: [f64; 2]) -> f64 {
    let ratio = |u: f64| (u / from).max(from / u);
    if ratio(of[1]) > ratio(of[0]) { of[1] } else { of[0] }
}
