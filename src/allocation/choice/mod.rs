//! Choices from lists: processes, machines, and free tolerances beside them.

pub(in crate::allocation) mod branch_and_bound;
pub(in crate::allocation) mod closed_form;
pub mod knapsack;
pub(in crate::allocation) mod machine;
pub mod option_list;
pub(in crate::allocation) mod outcome;
pub(in crate::allocation) mod process_selection;
pub(in crate::allocation) mod selection;
pub(in crate::allocation) mod several_rows;
pub(in crate::allocation) mod single_offer;
pub(in crate::allocation) mod single_row;
pub(in crate::allocation) mod sqp_finish;
