//! Results of an analysis: figures of a characteristic, sensitivities, interactions, and their written form.

pub(in crate::analysis) mod characteristic;
pub(in crate::analysis) mod conclusion;
pub(in crate::analysis) mod contribution_figures;
pub(in crate::analysis) mod coverage_intervals;
pub(in crate::analysis) mod distribution_figures;
pub(in crate::analysis) mod evidence;
pub(in crate::analysis) mod figure_basis;
pub(in crate::analysis) mod interaction;
pub(in crate::analysis) mod interaction_listing;
pub(in crate::analysis) mod interaction_remainder;
pub(in crate::analysis) mod judged_figures;
pub(in crate::analysis) mod linear;
pub(in crate::analysis) mod points_to_decide;
pub(in crate::analysis) mod quantile_estimates;
pub(in crate::analysis) mod range_figures;
pub(in crate::analysis) mod sampled_model;
pub(in crate::analysis) mod sampled_tail;
pub(in crate::analysis) mod serialisation;
pub(in crate::analysis) mod sobol_indices;
pub(in crate::analysis) mod stage_figures;
pub(in crate::analysis) mod variance_share;
pub(in crate::analysis) mod verification;
pub(in crate::analysis) mod yield_error;
pub(in crate::analysis) mod yield_source;
