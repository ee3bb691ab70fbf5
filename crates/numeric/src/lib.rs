//! Mathematics of tolerance analysis: distributions, moments, the Pearson system, correlation, samples, surface distributions and solvers.
//!
//! This crate evaluates no model and reads no file.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod capability;
pub mod characteristic;
pub mod correlation;
pub mod dimension;
pub mod distribution;
pub mod distribution_bounds;
pub mod elementary;
pub mod fits;
pub mod inspection;
pub mod json_form;
pub mod labels;
pub mod law;
pub mod lot;
pub mod moments;
pub mod names;
pub mod optimise;
pub mod parallel;
pub mod pearson;
pub mod points;
pub mod power;
pub mod requirement;
pub mod sampling;
pub mod surrogate;
pub mod time;
pub mod unit;
pub mod verdict;
