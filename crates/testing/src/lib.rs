//! Shared files, assertions and problems for the tests of several packages.

mod assertions;
#[cfg(feature = "engine")]
mod box_points;
pub mod densities;
mod files;
#[cfg(feature = "engine")]
mod models;
mod processes;
#[cfg(feature = "engine")]
mod studies;

pub use assertions::{close, fields, normals, relative, standard};
#[cfg(feature = "engine")]
pub use box_points::{among, random_points, vertices};
pub use files::{INSTALLED, case, data, example_studies, generated, problem, read, repository, says};
#[cfg(feature = "engine")]
pub use models::{Asked, costly, counted, refusing};
pub use processes::{child_in_c, interrupt};
#[cfg(feature = "engine")]
pub use studies::{analysed, dimension, faults, parse};
