//! Files, assertions and problems that the tests of several packages share.

mod assertions;
pub mod densities;
mod files;
#[cfg(feature = "engine")]
mod models;
mod processes;
#[cfg(feature = "engine")]
mod studies;

pub use assertions::{close, fields, normals, relative, standard};
pub use files::{INSTALLED, case, data, example_studies, generated, problem, read, repository, says};
#[cfg(feature = "engine")]
pub use models::{Asked, costly, counted, refusing};
pub use processes::{child_in_c, interrupt};
#[cfg(feature = "engine")]
pub use studies::{analysed, dimension, faults, parse};
