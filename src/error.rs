//! Single error type for all errors of the library.

use crate::allocation::{AllocateError, CostError};
use crate::analysis::NoFit;
use crate::assembly::ProcessError;
use crate::assembly::formula::FormulaError;
use crate::assembly::implicit::ConditionsError;
use crate::assembly::{CompositeError, EvaluationError, NoColumn};
use crate::compare::CompareError;
use crate::lot::LotError;
use crate::method::MethodError;
use crate::problem::ProblemError;
use crate::rare::RareError;
use crate::simulation::{ShardError, SimulationError};
use crate::sweep::SweepError;
use crate::warning::Advice;
use sensitol_numeric::characteristic::LimitsError;
use sensitol_numeric::correlation::CorrelationError;
use sensitol_numeric::dimension::DimensionError;
use sensitol_numeric::distribution::DistributionError;
use sensitol_numeric::fits::FitError;
use sensitol_numeric::inspection::InspectionError;
use sensitol_numeric::law::LawError;
use sensitol_numeric::names::UnknownName;
use sensitol_numeric::pearson::PearsonError;
use sensitol_numeric::requirement::RequirementError;
use sensitol_numeric::sampling::SamplingError;

/// Error of the library.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The parameters of a distribution are impossible.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// A dimension is impossible.
    #[error(transparent)]
    Dimension(#[from] DimensionError),
    /// Limits or a target are impossible.
    #[error(transparent)]
    Limits(#[from] LimitsError),
    /// A gauge or a guard band is impossible.
    #[error(transparent)]
    Inspection(#[from] InspectionError),
    /// A formula has an error.
    #[error(transparent)]
    Formula(#[from] FormulaError),
    /// The distribution of a surface cannot be computed.
    #[error(transparent)]
    Law(#[from] LawError),
    /// Formulas do not fit together.
    #[error(transparent)]
    Composite(#[from] CompositeError),
    /// Dimensions, function and characteristics do not fit together.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// The correlations of dimensions are impossible.
    #[error(transparent)]
    Correlation(#[from] CorrelationError),
    /// No distribution has these moments.
    #[error(transparent)]
    Pearson(#[from] PearsonError),
    /// The problem cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A lot cannot be compared with the study.
    #[error(transparent)]
    Lot(#[from] LotError),
    /// A sample cannot be divided or merged.
    #[error(transparent)]
    Shard(#[from] ShardError),
    /// A cost is impossible.
    #[error(transparent)]
    Cost(#[from] CostError),
    /// A requirement is impossible.
    #[error(transparent)]
    Requirement(#[from] RequirementError),
    /// Tolerances cannot be allocated.
    #[error(transparent)]
    Allocate(#[from] AllocateError),
    /// A method does not fit the problem.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// A model has no value at a point.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// An external program cannot be used.
    #[error(transparent)]
    Process(#[from] ProcessError),
    /// A table of answers has no column for an input or output.
    #[error(transparent)]
    NoColumn(#[from] NoColumn),
    /// Closure conditions do not determine an assembly.
    #[error(transparent)]
    Conditions(#[from] ConditionsError),
    /// A fit of ISO 286 does not exist.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A problem cannot be sampled.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// No surface can be fitted.
    #[error(transparent)]
    NoFit(#[from] NoFit),
    /// Rare events cannot be estimated.
    #[error(transparent)]
    Rare(#[from] RareError),
    /// Methods cannot be compared.
    #[error(transparent)]
    Compare(#[from] CompareError),
    /// A parameter cannot be swept.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// A name is unknown.
    #[error(transparent)]
    UnknownName(#[from] UnknownName),
}

impl Error {
    /// Advice on the text to write instead. Returns None if there is none.
    ///
    /// ```
    /// use sensitol::{Error, fits};
    /// let error = Error::from(fits::deviations(25.0, "H77").unwrap_err());
    /// assert!(error.help().is_some());
    /// ```
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Formula(error) => error.fault.help(),
            Self::Fit(error) => error.help(),
            Self::UnknownName(error) => Some(error.help()),
            _ => None,
        }
    }

    /// Actions to take other than changes of the text, the most promising first.
    pub fn advice(&self) -> Vec<Advice> {
        match self {
            Self::Method(error) => error.advice(),
            Self::Simulation(error) => error.advice(),
            Self::Allocate(error) => error.advice(),
            _ => Vec::new(),
        }
    }
}
