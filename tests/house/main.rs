//! Structure of the sources: layers, names, words.

mod architecture;
mod circles;
mod constants;
mod errors;
mod sources;
mod stages;
mod style;
mod tuning;
mod type_names;
