//! Runs over outputs of any size. Outputs of extreme size are divided by powers of two, and the results multiplied again.

use std::time::Duration;

use crate::assembly::{Points, Run};
use crate::evaluation::Evaluator;
use crate::problem::Problem;
use crate::summary::{RunSummary, StopReason};
use sensitol_numeric::power::Power;

/// Greatest number of axes on which the size of an output is searched.
const AXES: usize = 64;

/// Outcome of a run: results, or an error.
pub(crate) trait Restore {
    /// Converts figures to the units of the problem as it was given.
    fn restore(&mut self, back: &Restoration<'_>);
}

/// Conversion of results back to the units of a problem.
pub(crate) struct Restoration<'a> {
    /// Problem as it was given.
    pub(crate) problem: &'a Problem,
    /// Power of two by which each characteristic was divided.
    powers: Vec<Power>,
    /// Time within the model for answers that were held back.
    held_back: Duration,
}

impl Restoration<'_> {
    /// Power of two by which a characteristic was divided.
    pub(crate) fn power(&self, characteristic: usize) -> Power {
        self.powers[characteristic]
    }

    /// Power of two of the characteristic with this name, 1 if there is none.
    pub(crate) fn power_of(&self, name: &str) -> Power {
        let place = self.problem.characteristics().iter().position(|one| one.name() == name);
        place.map_or(Power::ONE, |place| self.power(place))
    }

    /// True if nothing was divided.
    pub(crate) fn is_nothing(&self) -> bool {
        self.powers.iter().all(|power| power.is_one())
    }

    /// Adds the time for answers that were held back.
    pub(crate) fn add_time(&self, run: &mut RunSummary) {
        run.wall += self.held_back;
        run.in_model += self.held_back;
    }
}

/// Runs a job over a problem with outputs of any size.
///
/// The job starts with the problem as it is. If the first values show an output of extreme size (beyond `2^64`, or below `2^-64`), the job
/// is stopped. It then starts again with every such output divided by a power of two. Evaluations: those of the job. Answers of a costly
/// model that were held back are not evaluated again. For a function without cost, up to 129 further points give the size of its outputs.
///
/// A job within another job is treated as a part of it.
pub(crate) fn at_any_size<R: Restore, E: Restore>(
    problem: &Problem,
    run: &Run<'_>,
    job: impl Fn(&Problem, &Run<'_>) -> Result<R, E>,
) -> Result<R, E> {
    if problem.magnitudes().is_some() {
        return job(problem, run);
    }
    let watched = problem.watched();
    let Some((magnitudes, watch)) = watched.magnitudes().and_then(|of| Some((of, of.watch()?))) else {
        return job(problem, run);
    };
    let stop = || watch.is_extreme().then_some(StopReason::Requested).or_else(|| run.stop_reason());
    let first = job(&watched, &run.stopping_when(&stop));
    // Settle here, since a run may end before the watch has enough values.
    let extreme = watch.settle();
    let powers = if extreme { sizes(problem, watch.powers()) } else { watch.powers() };
    let restoration = Restoration {
        problem,
        powers: problem.outputs().iter().map(|&output| if extreme { powers[output] } else { Power::ONE }).collect(),
        held_back: if extreme { magnitudes.held_back() } else { Duration::ZERO },
    };
    let found = if extreme { job(&problem.divided(powers, magnitudes), run) } else { first };
    match found {
        Ok(mut found) => {
            found.restore(&restoration);
            Ok(found)
        }
        Err(mut error) => {
            error.restore(&restoration);
            Err(error)
        }
    }
}

/// Powers of two of the outputs. For a function without cost they come from fixed points, so that they do not depend on the order of the
/// answers. For any other function they are those `seen`.
fn sizes(problem: &Problem, seen: Vec<Power>) -> Vec<Power> {
    let (function, dimensions) = (problem.function(), problem.dimensions());
    if function.signature().costly {
        return seen;
    }
    let means: Vec<f64> = dimensions.iter().map(|dimension| dimension.mean()).collect();
    let varying = (0..dimensions.len()).filter(|&d| dimensions[d].sigma() > 0.0).take(AXES);
    let beside = varying.flat_map(|d| {
        [-1.0, 1.0].map(|side| {
            let mut point = means.clone();
            point[d] += side * dimensions[d].sigma();
            point
        })
    });
    let rows: Vec<Vec<f64>> = std::iter::once(means.clone()).chain(beside).collect();
    // These points belong to no result, so their ledger is left out.
    let out = Evaluator::new(problem, &Run::to_the_end()).ask(&Points::from_rows(&rows));
    let mut powers = seen;
    for (column, &output) in problem.outputs().iter().enumerate() {
        let size = out.column(column).iter().fold(0.0f64, |size, value| size.max(value.abs()));
        if size > 0.0 {
            powers[output] = Power::of(size);
        }
    }
    powers
}
