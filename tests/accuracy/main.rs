//! Error estimates against right values: on these functions nothing is tuned.

mod accuracy;
mod comparison;
mod coverage;
mod published;
mod published_figures;
mod rare_coverage;
mod trust;
