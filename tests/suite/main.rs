//! Every test of the project, a module per theme; `cargo test --test suite moments::` runs one theme.

mod analysis;
mod architecture;
mod capability;
mod cli;
mod correlation;
mod derivatives;
mod distributions;
mod docs;
mod fits;
mod formulas;
mod implicit;
mod journal;
mod measured;
mod methods;
mod moments;
mod pearson;
mod plans;
mod probe;
mod process;
mod published;
mod sampling;
mod simulation;
mod stack;
mod studies;
mod support;
mod tolerances;
