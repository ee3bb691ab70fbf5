//! Types of a study file as it is written, for TOML, JSON and the JSON Schema.

pub(crate) mod about;
pub(crate) mod adjust_entry;
pub(crate) mod analysis_entry;
#[cfg(feature = "schema")]
pub(crate) mod assembly_schema;
pub(crate) mod correlation_entry;
pub(crate) mod cost_entry;
pub(crate) mod distribution_entry;
pub(crate) mod file;
#[cfg(feature = "schema")]
pub(crate) mod general_schema;
pub(crate) mod guard;
pub(crate) mod named_entries;
pub(crate) mod named_values;
#[cfg(feature = "schema")]
pub(crate) mod schema_parts;
pub(crate) mod spanned;
pub(crate) mod values;
pub(crate) mod vocabulary;
