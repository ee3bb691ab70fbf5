//! The report of an analysis: its document, tables and sections.

pub(crate) mod analysis_document;
mod brief;
pub(crate) mod budget;
mod feature_table;
pub(crate) mod interactions;
pub(crate) mod range_bars;
pub(crate) mod stack;
pub(crate) mod statistics;
pub(crate) mod tables;
pub(crate) mod worst_case;
pub(crate) mod yield_source;
