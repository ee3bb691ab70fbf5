//! Every error of the library in one type, for who passes them on.

use crate::allocation::{AllocateError, CostError, RequirementError};
use crate::assembly::CompositeError;
use crate::assembly::formula::FormulaError;
use crate::characteristic::LimitsError;
use crate::correlation::CorrelationError;
use crate::dimension::DimensionError;
use crate::distribution::DistributionError;
use crate::method::MethodError;
use crate::pearson::PearsonError;
use crate::problem::ProblemError;
use crate::simulation::SimulationError;
use crate::study::{RewriteError, StudyError};

/// Any error of the library.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A distribution's parameters are impossible.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// A dimension is impossible.
    #[error(transparent)]
    Dimension(#[from] DimensionError),
    /// Limits or a target are impossible.
    #[error(transparent)]
    Limits(#[from] LimitsError),
    /// A formula cannot be read.
    #[error(transparent)]
    Formula(#[from] FormulaError),
    /// Formulas do not fit together.
    #[error(transparent)]
    Composite(#[from] CompositeError),
    /// Dimensions, function and characteristics do not fit together.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// Dimensions cannot vary together so.
    #[error(transparent)]
    Correlation(#[from] CorrelationError),
    /// A study file is wrong.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// No distribution has the moments.
    #[error(transparent)]
    Pearson(#[from] PearsonError),
    /// The problem cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A cost is impossible.
    #[error(transparent)]
    Cost(#[from] CostError),
    /// A requirement is impossible.
    #[error(transparent)]
    Requirement(#[from] RequirementError),
    /// Tolerances cannot be allocated.
    #[error(transparent)]
    Allocate(#[from] AllocateError),
    /// A study cannot be written anew.
    #[error(transparent)]
    Rewrite(#[from] RewriteError),
    /// A method does not fit the problem.
    #[error(transparent)]
    Method(#[from] MethodError),
}
