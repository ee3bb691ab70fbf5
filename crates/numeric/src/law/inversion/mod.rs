//! Inversion of the transform of a sum of independent components, along a contour through the saddle point.

pub(in crate::law) mod complex;
pub(in crate::law) mod contour;
mod node_sums;
pub(in crate::law) mod perturbed_form;
pub(in crate::law) mod product_tree;
pub(in crate::law) mod quadratic_form;
pub(in crate::law) mod single_input;
pub(in crate::law) mod sinh_transform;
pub(in crate::law) mod tail_inversion;
pub(in crate::law) mod transform;
