//! Distributions, moments, Pearson system, samples and laws.

mod distributions;
mod fits;
mod joint_yields;
mod law;
mod law_random;
mod moments;
mod pearson;
mod sampling;
