//! Structure of the sources: layers, names, words.

mod architecture;
mod circles;
mod errors;
mod public_items;
mod tuning;
mod type_names;
