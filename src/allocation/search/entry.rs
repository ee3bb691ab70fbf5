//! Entry points of an allocation.

use crate::allocation::result::allocation::Allocation;
use crate::allocation::search::driver::AsWritten;
use crate::allocation::search::refinement_search::RefinementSearch;
use crate::allocation::search::run::allocate_once;
use crate::allocation::task::{AllocateError, AllocationOptions, AllocationTask};
use crate::assembly::Run;
use crate::problem::Problem;

/// Allocates tolerances.
///
/// Cost: one analysis at the present tolerances, one at those found, and one for every time that the two disagree. With
/// [`Method::Auto`](crate::Method::Auto) one more analysis at those found gives the verdict. A confirmation takes
/// `confirm` more points by Monte Carlo.
///
/// # Errors
///
/// If task, options and problem do not fit. Nothing is evaluated then. Requirements that cannot be kept are no error
/// but a [`Status`](crate::allocation::Status).
///
/// ```
/// use sensitol::{Characteristic, Closure, Dimension, Problem, Requirement, SpecLimits};
/// use sensitol::allocation::{AllocationOptions, AllocationTask, Curve, Offer, Priced, Status, allocate};
/// let dimensions = [Dimension::normal("a", 10.0, 0.1)?, Dimension::normal("b", 6.0, 0.1)?];
/// let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(3.8), Some(4.2))?);
/// let problem = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1]))?.asking([gap])?;
/// let cost = |d, b| Priced::new(vec![d], vec![Offer::between(Curve::reciprocal(1.0, b)?, 0.01, 1.0)?]);
/// let task = AllocationTask::new(vec![cost(0, 0.1)?, cost(1, 0.4)?], vec![Some(Requirement::WorstCase)]);
/// let found = allocate(&problem, &task, &AllocationOptions::default())?;
/// assert_eq!(found.status, Status::Optimal);
/// // Lagrange: tolerances as the roots of the costs, 0.2 together.
/// let [a, b] = [0, 1].map(|g| found.tolerances[g].after);
/// assert!((a - 0.2 / 3.0).abs() < 1e-12 && (b - 0.4 / 3.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn allocate(
    problem: &Problem,
    task: &AllocationTask,
    options: &AllocationOptions,
) -> Result<Allocation, AllocateError> {
    allocate_with(problem, task, options, &Run::to_the_end())
}

/// Runs [`allocate`] with reports of finished points, and stops when `run` is stopped.
pub fn allocate_with(
    problem: &Problem,
    task: &AllocationTask,
    options: &AllocationOptions,
    run: &Run<'_>,
) -> Result<Allocation, AllocateError> {
    allocate_as(problem, task, options, run, None)
}

/// Runs [`allocate_with`] with the dimensions as they would stand in the file of the study. The result keeps every
/// requirement with these written digits too.
pub fn allocate_written(
    problem: &Problem,
    task: &AllocationTask,
    options: &AllocationOptions,
    run: &Run<'_>,
    written: AsWritten<'_>,
) -> Result<Allocation, AllocateError> {
    allocate_as(problem, task, options, run, Some(written))
}

fn allocate_as(
    problem: &Problem,
    task: &AllocationTask,
    options: &AllocationOptions,
    run: &Run<'_>,
    written: Option<AsWritten<'_>>,
) -> Result<Allocation, AllocateError> {
    task.check(problem, options)?;
    let found = allocate_once(problem, task, options, run, written)?;
    RefinementSearch::new(problem, task, (options, run), written).refined(found)
}
