//! What a study can be asked for, as JSON, and what was found out: what the Python package and the page in the browser share.

mod asked;
mod found;

pub use asked::{Asked, Counted, done};
pub use found::{Found, Shown};
