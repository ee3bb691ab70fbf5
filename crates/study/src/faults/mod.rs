//! Faults of single sections of a study, in words.

pub(crate) mod compensator_fault;
pub(crate) mod zone_fault;
