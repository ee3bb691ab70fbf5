//! Costs of holding tolerances, and the process options that a cost may name.

pub(in crate::allocation) mod cost_curve;
pub(in crate::allocation) mod cost_error;
pub(in crate::allocation) mod default_costs;
pub(in crate::allocation) mod offered_dimension;
pub(in crate::allocation) mod priced_group;
pub(in crate::allocation) mod process_option;
pub(in crate::allocation) mod separable_cost;
pub(in crate::allocation) mod setup_cost;
