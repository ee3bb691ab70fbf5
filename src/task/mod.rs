//! What a study is asked for as JSON, and what was found: what the Python package, the workbench and `serve` share.

mod asked;
mod faults;
mod found;
mod place;
mod told;

pub use asked::{Asked, Counted, done};
pub use found::{Found, Shown};
pub use place::Place;
pub use told::{Task, models};
