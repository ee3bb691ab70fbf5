//! Error estimates against right values, on functions that no constant is tuned with.

mod accuracy;
mod comparison;
mod coverage;
mod external_models;
mod published;
mod published_figures;
mod quantiles;
mod rare_coverage;
mod rare_judges;
mod rare_unmet;
mod trust;
