//! Reader of Part 21 files (ISO 10303-21), which has no notion of tolerances.
//!
//! [`EntityTable::read`] scans the text once and keeps the place of every entity. [`Entity`] parses the arguments of one entity when they
//! are requested. So a large file costs one pass and 16 bytes an entity.

mod entity;
mod error;
mod scan;
mod table;
mod value;

pub use entity::Entity;
pub use error::{Part21Error, Part21Fault};
pub use table::EntityTable;
pub use value::StepValue;
