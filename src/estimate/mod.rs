//! Estimators of points of the model: figures with their errors, from values at points that are drawn.
//!
//! | file | content | used by |
//! |---|---|---|
//! | `normal_space` | independent normal variables, and the inputs as functions of them | verification, simulation, rare |
//! | `cheap_model` | one characteristic as a function of these variables | this folder, verification |
//! | `figures` | moments of weighted values, jackknife, Student's factor | everywhere |
//! | `replicate_sums` | sums by randomisation, and functions of them with their errors | this folder, simulation |
//! | `verified` | a figure with its error | everywhere |
//! | `strata`, `stratified_sample` | sample of a cheap model in half-spaces, tails and core | verification |
//! | `weighted_sample` | the same sample, stored for shares, density and tails | verification, analysis |
//! | `rank_quantile`, `tails` | quantiles and tails of a weighted sample | verification, analysis |
//! | `ordered_points` | shares, quantiles and density of points of equal weight, by counts | analysis |
//! | `switch_side`, `seldom_side` | sides of switches that are seldom met, and points on them | verification, simulation, rare |
//! | `variance_shares` | Sobol' indices by exchanging inputs | verification, analysis, simulation |
//! | `inspection` | risks of an inspection, from points of which the value is known | analysis, simulation |
//! | `conditional_yield` | yield of the assemblies that keep another characteristic's limits | analysis, simulation |
//! | `distribution_free_yield` | bounds of a yield over all distributions of some dimensions | analysis |
//! | `yield_at_values` | yield at given values of one dimension | analysis |
//! | `output_correlation` | correlation of characteristics, and their common rejects | analysis, simulation |
//!
//! Nothing here asks a costly model. An estimator takes a problem, or values with their weights. None depends on methods or results.

pub(crate) mod cheap_model;
mod conditional_yield;
mod distribution_free_yield;
pub(crate) mod figures;
mod inspection;
mod normal_space;
mod ordered_points;
mod output_correlation;
mod rank_quantile;
mod replicate_sums;
mod seldom_side;
pub(crate) mod strata;
pub(crate) mod stratified_sample;
pub(crate) mod switch_side;
mod tails;
pub(crate) mod variance_shares;
mod verified;
mod weighted_sample;
mod yield_at_values;

pub use crate::estimate::conditional_yield::ConditionalYield;
pub(crate) use crate::estimate::conditional_yield::conditions;
pub use crate::estimate::distribution_free_yield::DistributionFreeYield;
pub(crate) use crate::estimate::figures::{MOMENTS, carried_by, effective, jackknife, standard, student, totals};
pub(crate) use crate::estimate::inspection::{inspected_point, inspection_risks};
pub(crate) use crate::estimate::normal_space::{Columns, NormalSpace};
pub(crate) use crate::estimate::ordered_points::OrderedPoints;
pub use crate::estimate::output_correlation::OutputCorrelation;
pub(crate) use crate::estimate::output_correlation::{
    common_rejects, counted_condition, most_points_given, most_points_together, output_correlations, pairs,
};
pub(crate) use crate::estimate::rank_quantile::{SampleQuantile, reported_quantiles};
pub(crate) use crate::estimate::replicate_sums::ReplicateSums;
pub(crate) use crate::estimate::seldom_side::{RareSides, seldom_points, seldom_sides};
pub(crate) use crate::estimate::stratified_sample::REPLICATES;
pub use crate::estimate::switch_side::{Crossing, FoundSwitch};
pub use crate::estimate::tails::{SampleTails, TailPoint};
pub use crate::estimate::variance_shares::{Share, variance_shares};
pub(crate) use crate::estimate::variance_shares::{factor_shares, variance_shares_during};
pub use crate::estimate::verified::Verified;
pub(crate) use crate::estimate::weighted_sample::WeightedSample;
pub(crate) use crate::estimate::yield_at_values::{most_points_at, yields_at};
