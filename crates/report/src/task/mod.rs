//! Tasks on a study as JSON, and their answers. The Python package, the workbench and `serve` share them.

pub use crate::task::answer::{Shown, TaskReport};
pub use crate::task::location::TaskPlace;
pub use crate::task::question::{Asked, Counted, done};
pub use crate::task::request::{Task, models};
mod answer;
mod fault;
mod location;
mod question;
mod request;
