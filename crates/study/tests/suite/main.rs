//! Studies as they are written.

mod measured;
mod scaling;
mod schema;
mod studies;
mod texts;
mod tolerances;
mod warnings;
