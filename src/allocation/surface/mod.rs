//! Moments, rejects and worst cases of a surface as functions of the tolerances.

pub(in crate::allocation) mod band;
pub(in crate::allocation) mod corners;
pub(in crate::allocation) mod joint_yield;
pub(in crate::allocation) mod pearson_slack;
pub(in crate::allocation) mod process_response;
pub(in crate::allocation) mod reject_fit;
pub(in crate::allocation) mod reject_rate;
pub(in crate::allocation) mod response;
pub(in crate::allocation) mod sampled_moments;
pub(in crate::allocation) mod surface_slack;
pub(in crate::allocation) mod uncertainty;
pub(in crate::allocation) mod worst_case;
pub(in crate::allocation) mod worst_case_slope;
