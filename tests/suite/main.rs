//! Every test of the project, a module per theme; `cargo test --test suite moments::` runs one theme.

mod analysis;
mod architecture;
mod capability;
mod cli;
mod derivatives;
mod distributions;
mod docs;
mod extremes;
mod formulas;
mod intervals;
mod journal;
mod methods;
mod moments;
mod pearson;
mod plans;
mod probe;
mod process;
mod published;
mod schema;
mod studies;
mod support;
