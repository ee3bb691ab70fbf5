//! Requirements and costs of what is made, as functions of the tolerances.

pub(in crate::allocation) mod constraint;
pub(in crate::allocation) mod process_response;
pub(in crate::allocation) mod quality_loss;
