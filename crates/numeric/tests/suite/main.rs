//! Tests of distributions, moments, Pearson system, samples and surface distributions.

mod distribution_bounds;
mod distributions;
mod fits;
mod joint_yields;
mod law;
mod law_random;
mod lot;
mod moments;
mod pearson;
mod sampling;
mod solid_zones;
