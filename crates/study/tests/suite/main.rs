//! Tests of the format of studies.

mod any_distribution;
mod compensators;
mod completeness;
mod general;
mod matrix;
mod measured;
mod nominal_kink;
mod scaling;
mod scene;
mod schema;
mod spatial;
mod spatial_analyses;
mod spatial_datums;
mod spatial_examples;
mod spatial_faults;
mod spatial_mobility;
mod spatial_press;
mod spatial_zones;
mod studies;
mod texts;
mod tolerances;
mod warnings;
mod zone_costs;
