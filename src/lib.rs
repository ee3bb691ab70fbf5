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
pub use summary::{RunSummary, StopReason};
pub use verdict::{Judged, Verdict};
pub use warning::Warning;

/// What the tests and the benchmarks of this repository reach inside: not part of the public interface, and no promise.
#[doc(hidden)]
pub mod internals {
    pub use crate::analysis::law_at::law_at;
    pub use crate::assembly::formula::interval::Interval;
    pub use crate::assembly::formula::jet::Jet;
    pub use crate::assembly::formula::parser::is_reserved;
    pub use crate::assembly::formula::set::{FormulaSet, Meaning};
    pub use crate::correlation::transform::Transform;
    pub use crate::distribution::outliers::{extreme, outliers};
    pub use crate::distribution::rule::Rule;
    pub use crate::distribution::sample::{Resample, Sample};
    pub use crate::law::{LawOptions, SurfaceLaw, joint_yield};
    pub use crate::method::procedure::Procedure;
    pub use crate::method::registry::{ALL, procedure};
    pub use crate::moments::{Interactions, Tables, Term, contributions, of_quadratic};
    pub use crate::plan::{Nodes, Plan, Spread, corners};
    pub use crate::sampling::{Draws, Fine, Portion, SOBOL_DIMENSIONS, Scale, Sobol, Summary, wilson};
    #[cfg(feature = "cli")]
    pub use crate::study::schema::schema;
    pub use crate::surrogate::{InputShape, Inputs, Surrogate, Univariate, shapes};
    pub use crate::verdict::of_cpk;
    pub use crate::verification::{
        SampledFigures, Target, unseen, variance_shares, verify_by_checks, verify_by_sampling,
    };
    pub use crate::warning::aggregate::aggregated;
}
