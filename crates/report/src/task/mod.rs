//! Tasks on a study as JSON, and their answers. The Python package, the workbench and `serve` share them.

mod asked;
mod faults;
mod found;
mod place;
mod told;

pub use asked::{Asked, Counted, done};
pub use found::{Shown, TaskReport};
pub use place::TaskPlace;
pub use told::{Task, models};
