//! Rounds of a search: tolerances, the model's answer there, and the next tolerances.

pub(in crate::allocation) mod best_trial;
pub(in crate::allocation) mod box_sample;
pub(in crate::allocation) mod common_factor;
pub(in crate::allocation) mod conclusion;
pub(in crate::allocation) mod cost_limit;
pub(in crate::allocation) mod derivative_search;
pub(in crate::allocation) mod driver;
pub(in crate::allocation) mod end_choice;
pub(in crate::allocation) mod entry;
pub(in crate::allocation) mod linearization_point;
pub(in crate::allocation) mod nominal;
pub(in crate::allocation) mod nominal_and_tolerance;
pub(in crate::allocation) mod pareto_front;
pub(in crate::allocation) mod proportional;
pub(in crate::allocation) mod refinement;
pub(in crate::allocation) mod refinement_search;
pub(in crate::allocation) mod run;
pub(in crate::allocation) mod search_state;
pub(in crate::allocation) mod step;
pub(in crate::allocation) mod trial;
pub(in crate::allocation) mod trial_search;
