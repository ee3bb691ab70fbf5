//! Design: points that are all known in advance and are evaluated in one stage.

use std::ops::Deref;

use hashbrown::HashTable;

use super::axis::Axis;
use super::geometry::Geometry;
use super::nodes::Spread;
use super::point::{AtNode, Point, folded};
use super::stage::{Purpose, Stage};
use super::{KnownAnswers, Plan};
use sensitol_numeric::correlation::Correlation;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::surrogate::{Inputs, shapes};

/// Plan of a method that needs all of its points at once.
///
/// It starts with the nominal point and, if requested, the steps of dimensions without tolerance. A method adds its own points. Equal
/// points are stored once, and coordinates at the mean are left out.
#[derive(Debug, Clone)]
pub struct Design {
    geometry: Geometry,
    /// Nodes of dimensions, keyed by the hashes of their values.
    nodes: HashTable<AtNode>,
    points: Vec<(Point, Purpose)>,
    /// Indices of points, keyed by the hashes of the points.
    wanted: HashTable<u32>,
}

impl Design {
    /// Design for these dimensions. A row of `depends` flags the dimensions that a characteristic can depend on. Dimensions without
    /// tolerance are moved only if `fixed_too`.
    pub(crate) fn new(
        dimensions: &[Dimension],
        correlation: Option<&Correlation>,
        depends: Vec<Vec<bool>>,
        fixed_too: bool,
    ) -> Self {
        let matters = |&d: &usize| depends.iter().any(|row| row[d]);
        let (varying, fixed): (Vec<usize>, Vec<usize>) =
            (0..dimensions.len()).filter(matters).partition(|&d| dimensions[d].sigma() > 0.0);
        let fixed = if fixed_too { fixed } else { Vec::new() };
        let inputs = Inputs::new(
            shapes(varying.iter().filter_map(|&d| dimensions[d].distribution())),
            correlation.and_then(|correlation| correlation.among(&varying)),
        );
        let mut axes: Vec<Axis> = dimensions.iter().map(Axis::still).collect();
        varying.iter().for_each(|&d| axes[d].scale = dimensions[d].sigma());
        fixed.iter().for_each(|&d| axes[d] = Axis::fixed(&dimensions[d], Spread::Pair));
        let mut design = Self {
            geometry: Geometry { axes, nominal: Point::Centre, varying, fixed, inputs, depends },
            nodes: HashTable::new(),
            points: Vec::new(),
            wanted: HashTable::new(),
        };
        let nominal: Vec<(usize, f64)> = dimensions.iter().map(Dimension::nominal).enumerate().collect();
        design.geometry.nominal = design.point(&nominal);
        let purpose = if design.nominal == Point::Centre { Purpose::Centre } else { Purpose::Nominal };
        design.want(design.nominal.clone(), purpose);
        for d in design.fixed.clone() {
            for slot in design.axes[d].slots.clone() {
                design.want(Point::of(&[AtNode { dimension: d as u32, node: slot[0] }]), Purpose::Sensitivity);
            }
        }
        design
    }

    /// Point at which these dimensions have these values and all others their means. It is not added to the design.
    pub(crate) fn point(&mut self, at: &[(usize, f64)]) -> Point {
        let mut elsewhere = Vec::with_capacity(at.len());
        for &(dimension, x) in at {
            if let Some(node) = self.node(dimension, x) {
                elsewhere.push(AtNode { dimension: dimension as u32, node });
            }
        }
        Point::of(&elsewhere)
    }

    /// Reserves memory for this number of further points.
    pub(crate) fn reserve(&mut self, points: usize) {
        self.wanted.reserve(points, |&place| self.points[place as usize].0.mixed());
        self.points.reserve(points);
    }

    /// Adds a point to the design, unless it has the point already.
    pub(crate) fn want(&mut self, point: Point, purpose: Purpose) {
        let Self { points, wanted, .. } = self;
        let hash = point.mixed();
        if wanted.find(hash, |&place| points[place as usize].0 == point).is_none() {
            let place = u32::try_from(points.len()).expect("fewer than four billion points");
            wanted.insert_unique(hash, place, |&place| points[place as usize].0.mixed());
            points.push((point, purpose));
        }
    }

    /// Makes these values steps of a dimension, from which its derivatives are computed and which a plan shows. A value equal to the mean
    /// is not a step.
    pub(crate) fn steps(&mut self, dimension: usize, values: impl IntoIterator<Item = f64>) {
        for x in values {
            if let Some(node) = self.node(dimension, x) {
                self.geometry.axes[dimension].slots.push(vec![node]);
            }
        }
    }

    /// Pairs of positions that some characteristic can depend on.
    pub(crate) fn pairs(&self) -> Vec<(usize, usize)> {
        self.coupled_pairs()
    }

    /// Copies the notes of an axis of a difference plan: nodes moved into the support, and a tail.
    pub(crate) fn take_notes(&mut self, dimension: usize, axis: Axis) {
        let own = &mut self.geometry.axes[dimension];
        (own.moved, own.tail) = (axis.moved, axis.tail);
    }

    /// Index of the node of this value, which is added if it is new. Returns None for the mean.
    fn node(&mut self, dimension: usize, x: f64) -> Option<u32> {
        let axis = &mut self.geometry.axes[dimension];
        let x = axis.occurring(x);
        if x == axis.mean {
            return None;
        }
        let hash = |dimension: usize, x: f64| folded(folded(x.to_bits()) ^ dimension as u64);
        let known =
            |at: &AtNode| at.dimension as usize == dimension && axis.nodes[at.node as usize].x.to_bits() == x.to_bits();
        if let Some(at) = self.nodes.find(hash(dimension, x), known) {
            return Some(at.node);
        }
        let at = AtNode { dimension: dimension as u32, node: axis.open_node(x) };
        let axes = &self.geometry.axes;
        let again = |at: &AtNode| {
            let dimension = at.dimension as usize;
            hash(dimension, axes[dimension].nodes[at.node as usize].x)
        };
        self.nodes.insert_unique(hash(dimension, x), at, again);
        Some(at.node)
    }
}

impl Deref for Design {
    type Target = Geometry;

    fn deref(&self) -> &Geometry {
        &self.geometry
    }
}

impl Plan for Design {
    fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    fn cost(&self) -> (usize, usize) {
        (self.points.len(), 1)
    }

    fn next(&self, known: &KnownAnswers) -> Option<Stage> {
        let open = self.points.iter().filter(|(point, _)| !known.tried(point));
        let points: Vec<(Point, Purpose)> = open.cloned().collect();
        (!points.is_empty()).then_some(Stage { points })
    }
}
