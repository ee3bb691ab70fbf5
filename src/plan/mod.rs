//! The next points to evaluate, and why: pure functions from what is known to the next stage of points.
//!
//! A plan evaluates nothing. It names points by dimension and node, so that a point that serves two purposes is one
//! point, and says at every step which points it still lacks; a point that failed is simply not known, and the plan
//! asks for what can replace it.

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

/// The evaluations that a method asks for: points named by dimension and node, stage after stage.
///
/// A `DifferencePlan` is one, and so is a `Design`, whose points are all known beforehand. Everything that is known without a point
/// is its `Geometry`.
pub trait Plan: Debug + Send + Sync {
    /// Where its points can stand.
    fn geometry(&self) -> &Geometry;

    /// How many points there are in all, and in how many stages, if none fails.
    fn cost(&self) -> (usize, usize);

    /// The next points, or None when nothing is left that could help.
    fn next(&self, known: &KnownAnswers) -> Option<Stage>;

    /// How many points the first stage has for each purpose.
    fn first(&self) -> BTreeMap<Purpose, usize> {
        let mut counts = BTreeMap::new();
        let stage = self.next(&KnownAnswers::nothing(self.geometry().depends.len())).unwrap_or_default();
        stage.points.iter().for_each(|(_, purpose)| *counts.entry(*purpose).or_default() += 1);
        counts
    }
}

/// A plan is read as its geometry, whatever its kind.
impl Deref for dyn Plan + '_ {
    type Target = Geometry;

    fn deref(&self) -> &Geometry {
        self.geometry()
    }
}
