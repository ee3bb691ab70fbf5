//! Tests of the format of studies.

mod general;
mod measured;
mod scaling;
mod schema;
mod spatial;
mod spatial_zones;
mod studies;
mod texts;
mod tolerances;
mod warnings;
