#![doc = include_str!("../README.md")]
// What the command line and the reports alone use is dead without them; with all features the compiler looks again.
#![cfg_attr(not(feature = "cli"), allow(dead_code, unused_imports))]

pub mod allocation;
pub mod analysis;
pub mod assembly;
pub mod capability;
mod characteristic;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
pub mod compare;
pub mod correlation;
mod dimension;
pub mod distribution;
#[cfg(feature = "report")]
mod document;
mod elementary;
mod error;
mod evaluation;
mod extremes;
pub mod fits;
#[doc(hidden)]
pub mod internals;
#[cfg(feature = "journal")]
pub mod journal;
mod law;
pub mod method;
mod method_kind;
pub mod models;
mod moments;
mod names;
pub mod pearson;
mod plan;
pub mod probe;
mod problem;
pub mod rare;
#[cfg(feature = "report")]
pub mod report;
mod requirement;
mod sampling;
mod shape;
pub mod simulation;
#[cfg(feature = "study")]
pub mod study;
mod summary;
mod surrogate;
pub mod sweep;
mod time;
#[cfg_attr(not(feature = "study"), allow(dead_code))]
mod unit;
mod verdict;
mod verification;
pub mod warning;

pub use analysis::{Analysis, CharacteristicAnalysis, analyze, analyze_with};
pub use assembly::{AssemblyFunction, Closure};
pub use characteristic::{Characteristic, LimitsError, SpecLimits};
pub use dimension::{Dimension, DimensionError, DimensionFault};
pub use error::Error;
pub use method::{DerivativeSource, Method, MethodError, Options};
pub use moments::Moments;
pub use names::UnknownName;
pub use problem::{Problem, ProblemError};
pub use requirement::{Requirement, RequirementError};
#[cfg(feature = "study")]
pub use study::{Study, StudyError};
pub use summary::{EvaluatorSummary, RunSummary, StopReason};
pub use verdict::{Judged, Verdict};
pub use warning::Warning;
