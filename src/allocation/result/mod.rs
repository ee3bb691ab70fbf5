//! Results of an allocation, and their written form.

pub(in crate::allocation) mod allocation;
pub(in crate::allocation) mod json;
pub(in crate::allocation) mod rescaling;
pub(in crate::allocation) mod solver_result;
