//! Geometry of a plan: the dimensions that are moved, their nodes, and the characteristics that depend on them.

use super::axis::Axis;
use super::known_answers::KnownAnswers;
use super::point::{AtNode, Point};
use sensitol_numeric::surrogate::Inputs;

/// Common part of plans of every kind. Positions count the dimensions that vary and matter.
#[derive(Debug, Clone)]
pub struct Geometry {
    pub(super) axes: Vec<Axis>,
    pub(super) nominal: Point,
    pub(super) varying: Vec<usize>,
    pub(super) fixed: Vec<usize>,
    pub(super) inputs: Inputs,
    /// Row per characteristic: true for each dimension that it can depend on.
    pub(super) depends: Vec<Vec<bool>>,
}

impl Geometry {
    /// Dimensions that vary and that some characteristic can depend on: N of them.
    pub fn varying(&self) -> &[usize] {
        &self.varying
    }

    /// Dimensions with derivatives: those that vary, and those without tolerance if they were requested.
    pub fn moved(&self) -> Vec<usize> {
        self.varying.iter().chain(&self.fixed).copied().collect()
    }

    /// Shapes of the varying dimensions for the moments, and their correlation.
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// Axis of a dimension.
    pub fn axis(&self, dimension: usize) -> &Axis {
        &self.axes[dimension]
    }

    /// Point at which every dimension has its nominal value.
    pub fn nominal(&self) -> &Point {
        &self.nominal
    }

    /// Coordinates of the means.
    pub fn centre(&self) -> Vec<f64> {
        self.axes.iter().map(|axis| axis.mean).collect()
    }

    /// True if a characteristic can depend on a dimension.
    pub fn depends(&self, characteristic: usize, dimension: usize) -> bool {
        self.depends[characteristic][dimension]
    }

    /// True if a characteristic can depend on both dimensions at these positions.
    pub fn joint(&self, characteristic: usize, j: usize, k: usize) -> bool {
        let row = &self.depends[characteristic];
        row[self.varying[j]] && row[self.varying[k]]
    }

    /// True if some characteristic can depend on both dimensions at these positions.
    pub(super) fn matters(&self, j: usize, k: usize) -> bool {
        (0..self.depends.len()).any(|c| self.joint(c, j, k))
    }

    /// Number of pairs of varying dimensions that a characteristic can depend on.
    pub(crate) fn pairs_of(&self, characteristic: usize) -> usize {
        let row = &self.depends[characteristic];
        let own = self.varying.iter().filter(|&&d| row[d]).count();
        own * own.saturating_sub(1) / 2
    }

    /// Number of pairs of varying dimensions that some characteristic can depend on.
    pub fn possible_pairs(&self) -> usize {
        let n = self.varying.len();
        if self.depends.iter().any(|row| self.varying.iter().all(|&d| row[d])) {
            return n * n.saturating_sub(1) / 2;
        }
        let mut pairs = 0;
        self.visit_partners(|_, later| pairs += later.len());
        pairs
    }

    /// Pairs of varying dimensions that some characteristic can depend on, in ascending order.
    pub(super) fn coupled_pairs(&self) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        self.visit_partners(|j, later| pairs.extend(later.iter().map(|&k| (j, k))));
        pairs
    }

    /// Visits every position with the later ones that some characteristic can depend on together with it, in ascending order. Cost: the
    /// square of the number of dimensions of every characteristic.
    fn visit_partners(&self, mut visit: impl FnMut(usize, &[usize])) {
        let n = self.varying.len();
        let own = |row: &Vec<bool>| -> Vec<usize> { (0..n).filter(|&j| row[self.varying[j]]).collect() };
        let positions: Vec<Vec<usize>> = self.depends.iter().map(own).collect();
        let mut asking: Vec<Vec<usize>> = vec![Vec::new(); n];
        for (c, positions) in positions.iter().enumerate() {
            positions.iter().for_each(|&j| asking[j].push(c));
        }
        // The last position for which each one was counted as a later one.
        let mut counted_for = vec![usize::MAX; n];
        let mut later = Vec::new();
        for (j, asking) in asking.iter().enumerate() {
            later.clear();
            for &k in asking.iter().flat_map(|&c| &positions[c]).filter(|&&k| k > j) {
                if std::mem::replace(&mut counted_for[k], j) != j {
                    later.push(k);
                }
            }
            later.sort_unstable();
            visit(j, &later);
        }
    }

    /// Point at which one dimension is at a node, and every other one at its mean.
    pub(super) fn on_axis(&self, dimension: usize, node: u32) -> Point {
        Point::One([AtNode { dimension: dimension as u32, node }])
    }

    /// Values of a characteristic at the nodes of one dimension minus its centre, with their places in sigmas, ascending. Returns None if there
    /// is no value at the means.
    pub fn samples(&self, known: &KnownAnswers, characteristic: usize, dimension: usize) -> Option<Vec<(f64, f64)>> {
        let centre = known.value(&Point::Centre, characteristic)?;
        let axis = self.axis(dimension);
        let fresh = |samples: &[(u32, f64)], node: u32| samples.iter().all(|&(used, _)| used != node);
        let mut samples: Vec<(u32, f64)> = Vec::new();
        for slot in &axis.slots {
            let value = |node: u32| Some((node, known.value(&self.on_axis(dimension, node), characteristic)? - centre));
            if let Some(answered) = slot.iter().find_map(|&node| value(node)).filter(|(node, _)| fresh(&samples, *node))
            {
                samples.push(answered);
            }
        }
        Some(samples.into_iter().map(|(node, rise)| (axis.nodes[node as usize].u, rise)).collect())
    }
}
