#![doc = include_str!("../README.md")]

pub mod allocation;
pub mod analysis;
pub mod assembly;
pub mod capability;
pub mod characteristic;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
pub mod compare;
pub mod correlation;
pub mod dimension;
pub mod distribution;
#[cfg(feature = "report")]
pub mod document;
mod elementary;
pub mod error;
mod evaluation;
pub mod extremes;
pub mod fits;
#[cfg(feature = "journal")]
pub mod journal;
pub mod law;
pub mod method;
mod method_kind;
pub mod models;
pub mod moments;
mod names;
pub mod pearson;
mod plan;
pub mod probe;
pub mod problem;
pub mod rare;
#[cfg(feature = "report")]
pub mod report;
pub mod requirement;
pub mod sampling;
pub mod simulation;
#[cfg(feature = "study")]
pub mod study;
pub mod summary;
pub mod surrogate;
pub mod sweep;
mod time;
pub mod verdict;
pub mod verification;
pub mod warning;

pub use analysis::{Analysis, CharacteristicAnalysis, analyze, analyze_within};
pub use assembly::{AssemblyFunction, Closure};
pub use characteristic::{Characteristic, LimitsError, SpecLimits};
pub use dimension::{Dimension, DimensionError};
pub use error::Error;
pub use method::{DerivativeSource, Method, MethodError, Options};
pub use moments::Moments;
pub use names::UnknownName;
pub use problem::{Problem, ProblemError};
pub use requirement::{Requirement, RequirementError};
#[cfg(feature = "study")]
pub use study::{Study, StudyError};
pub use summary::{RunSummary, StopReason};
pub use verdict::Verdict;
pub use warning::Warning;
