//! Requirements and costs as functions of the tolerances.
//!
//! A new kind of requirement is a variant of [`Requirement`](sensitol_numeric::requirement::Requirement), a file
//! `required_*.rs` that implements [`RequirementForm`](form::RequirementForm), and a line in
//! [`form_of`](registry::form_of).

pub(in crate::allocation) mod constraint;
pub(in crate::allocation) mod constraint_figures;
pub(in crate::allocation) mod form;
pub(in crate::allocation) mod linearised;
pub(in crate::allocation) mod process_options;
pub(in crate::allocation) mod quality_loss;
pub(in crate::allocation) mod registry;
pub(in crate::allocation) mod required_cpk;
pub(in crate::allocation) mod required_joint_yield;
pub(in crate::allocation) mod required_rss;
pub(in crate::allocation) mod required_sigma;
pub(in crate::allocation) mod required_worst_case;
pub(in crate::allocation) mod required_yield;
pub(in crate::allocation) mod slack;
