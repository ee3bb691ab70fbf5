//! Statistical tolerance analysis of any assembly function.
//!
//! An [`AssemblyFunction`] computes the key characteristics of an assembly from its dimensions. It may be a formula, a closed-form model, a
//! Rust function, or an external program. [`analyze`] evaluates it at the points of a [`Method`] and returns an [`Analysis`]. For each
//! characteristic it contains the first four moments, yield and capability, sensitivities and contributions, each with an error estimate,
//! and the number of evaluations.
//!
//! ```
//! use sensitol::{Characteristic, Closure, Dimension, Method, Problem, SpecLimits, analyze};
//! // Nominal values with tolerances, by default normal with three sigma in half a band.
//! let dimensions = [Dimension::normal("bore", 25.02, 0.01)?, Dimension::normal("shaft", 24.98, 0.01)?];
//! let limits = SpecLimits::new(Some(0.025), Some(0.055))?;
//! let problem = Problem::new(dimensions, Closure::scalar("clearance", |x| x[0] - x[1]))?
//!     .asking([Characteristic::new("clearance").with_limits(limits)])?;
//! let found = analyze(&problem, &Method::SecondOrder.into())?;
//! let clearance = &found.characteristics[0];
//! // 2N + 1 evaluations; the variance of a difference is the sum of the variances.
//! assert_eq!(found.run.evaluations, 5);
//! assert!((clearance.moments.unwrap().sigma() - 0.01 * 2f64.sqrt() / 3.0).abs() < 1e-12);
//! // The share within the limits: 3.18 sigmas on either side.
//! assert!((clearance.distribution.capability.unwrap().yield_().unwrap() - 0.998537).abs() < 1e-6);
//! # Ok::<(), sensitol::Error>(())
//! ```
//!
//! # A model of your own
//!
//! Implement [`AssemblyFunction`] if a closure is not enough: if evaluations can fail, run in parallel, or are costly. Points come in
//! batches. A point without a result gets an [`EvaluationError`](assembly::EvaluationError), and the analysis continues without it.
//!
//! ```
//! use sensitol::assembly::{EvaluationError, Input, Output, Request, Responses, Run, Signature};
//! use sensitol::{AssemblyFunction, Dimension, Method, Problem, analyze};
//!
//! /// The height of a rod that leans by an offset.
//! struct Rod(Signature);
//!
//! impl AssemblyFunction for Rod {
//!     fn signature(&self) -> &Signature {
//!         &self.0
//!     }
//!
//!     fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
//!         for row in 0..request.points.rows() {
//!             if run.stopped() {
//!                 return; // The rest stays unanswered, which is no error.
//!             }
//!             let [length, offset] = [0, 1].map(|input| request.points.column(input)[row]);
//!             match offset.abs() <= length {
//!                 true => out.set(row, 0, (length * length - offset * offset).sqrt()),
//!                 false => out.fail(row, 0, EvaluationError::Refused { message: "the offset is longer than the rod".into() }),
//!             }
//!         }
//!     }
//! }
//!
//! let named = |name: &str| Input { name: name.into(), ..Input::default() };
//! let mut signature = Signature::default();
//! signature.inputs = vec![named("length"), named("offset")];
//! signature.outputs = vec![Output { name: "height".into(), ..Output::default() }];
//! let dimensions = [Dimension::normal("length", 10.0, 0.1)?, Dimension::normal("offset", 0.0, 0.6)?];
//! let found = analyze(&Problem::new(dimensions, Rod(signature))?, &Method::SecondOrder.into())?;
//! // The mean of 10 - offset^2/20 with a sigma of 0.2: 2e-3 below the nominal height.
//! assert!((found.characteristics[0].moments.unwrap().mean() - 9.998).abs() < 1e-5);
//! # Ok::<(), sensitol::Error>(())
//! ```
//!
//! # Reading a result
//!
//! Unknown values are `None`.
//!
//! - [`CharacteristicAnalysis::error_estimate`] holds the error of each figure.
//! - [`CharacteristicAnalysis::requirements`] holds the verdict on each requirement: met, missed or inconclusive.
//! - [`Analysis::warnings`] holds every assumption that fails, as data with advice.
//!
//! # Features
//!
//! The only feature is `schema`: JSON schemas of the results.
//!
//! This package computes. It builds for browsers too (`wasm32-unknown-unknown`), where it runs on one thread. Other packages add to it:
//!
//! - `sensitol-study` reads studies (TOML, JSON and tables).
//! - `sensitol-report` writes reports (text, JSON, CSV, Markdown, SVG, HTML and workbooks).
//! - `sensitol-external` runs external programs, and keeps a journal of their answers.
//! - `sensitol-models` holds the published models.
//! - `sensitol-spatial` writes rigid parts in space as closure equations.
//! - `sensitol-cli` is the command `sensitol`.

pub mod allocation;
pub mod analysis;
pub mod assembly;
pub mod compare;
pub mod error;
mod estimate;
pub mod evaluation;
pub mod extremes;
pub mod lot;
mod magnitude;
pub mod method;
pub mod method_kind;
pub mod plan;
pub mod probe;
pub mod problem;
pub mod rare;
pub mod simulation;
pub mod summary;
pub mod sweep;
pub mod verification;
pub mod warning;

pub use analysis::{Analysis, CharacteristicAnalysis, analyze, analyze_with};
pub use assembly::{AssemblyFunction, Closure};
pub use error::Error;
pub use method::{DerivativeSource, Method, MethodError, Options};
pub use problem::{Problem, ProblemError};
pub use sensitol_numeric::characteristic::{Characteristic, LimitsError, SpecLimits};
pub use sensitol_numeric::dimension::{Dimension, DimensionError, DimensionFault};
pub use sensitol_numeric::moments::Moments;
pub use sensitol_numeric::names::UnknownName;
pub use sensitol_numeric::requirement::{Requirement, RequirementError};
pub use sensitol_numeric::verdict::{Judged, Verdict};
pub use sensitol_numeric::{capability, correlation, distribution, fits, inspection, pearson};
pub use summary::{EvaluatorSummary, RunSummary, StopReason};
pub use warning::Warning;
