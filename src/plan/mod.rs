//! What to evaluate next, and why: pure functions from what is known to the next stage of points.
//!
//! A plan evaluates nothing. It names points by dimension and node, so that a point that serves two purposes is one
//! point, and says at every step which points it still lacks; a point that failed is simply not known, and the plan
//! asks for what can replace it.

mod axis;
mod checks;
mod difference;
mod known;
mod nodes;
mod pairs;
mod point;
mod stage;

pub use axis::{Axis, Node};
pub use checks::scattered;
pub use difference::{Corner, DifferencePlan, Layout, Mixed};
pub use known::Known;
pub use nodes::{Moved, Nodes, Spread, Tail};
pub use pairs::{PairChoice, Stencil};
pub use point::{At, Point};
pub use stage::{Purpose, Stage};
