//! Evaluation plans: pure functions from known answers to the next stage of points.
//!
//! A plan evaluates nothing. It names points by dimension and node, so that a point with two purposes is one point. At every step it
//! returns the points that are still missing. A failed point has no known value, and the plan adds points that can replace it.

mod axis;
mod checks;
mod design;
mod difference;
pub(crate) mod factorial;
mod geometry;
mod known_answers;
mod nodes;
mod pairs;
mod point;
mod stage;

pub use axis::Axis;
pub(crate) use checks::scattered;
pub use design::Design;
pub use difference::{Corner, DifferencePlan, Layout, Mixed};
pub use factorial::corners;
pub use geometry::Geometry;
pub use known_answers::KnownAnswers;
pub use nodes::{MovedNode, Nodes, Spread};
pub use pairs::{PairChoice, Stencil};
pub use point::{AtNode, Point};
pub use stage::{Purpose, Stage};

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ops::Deref;

/// Evaluations that a method needs: points named by dimension and node, stage after stage.
///
/// Implementations are `DifferencePlan` and `Design`, whose points are all known in advance. The `Geometry` of a plan holds everything that
/// needs no evaluated point.
pub trait Plan: Debug + Send + Sync {
    /// Places that the points of the plan can have.
    fn geometry(&self) -> &Geometry;

    /// Number of all points and of stages, if no point fails.
    fn cost(&self) -> (usize, usize);

    /// Next points. Returns None if no further point could help.
    fn next(&self, known: &KnownAnswers) -> Option<Stage>;

    /// Number of points of the first stage for each purpose.
    fn first(&self) -> BTreeMap<Purpose, usize> {
        let mut counts = BTreeMap::new();
        let stage = self.next(&KnownAnswers::nothing(self.geometry().depends.len())).unwrap_or_default();
        stage.points.iter().for_each(|(_, purpose)| *counts.entry(*purpose).or_default() += 1);
        counts
    }
}

/// Dereferences a plan of any kind to its geometry.
impl Deref for dyn Plan + '_ {
    type Target = Geometry;

    fn deref(&self) -> &Geometry {
        self.geometry()
    }
}
