//! Runs over outputs of any size: those of extreme size are divided by powers of two, and the results multiplied again.

use std::time::Duration;

use crate::assembly::{Points, Request, Responses, Run};
use crate::problem::Problem;
use crate::summary::{RunSummary, StopReason};
use sensitol_numeric::power::Power;

/// Axes along which the size of an output is looked for.
const AXES: usize = 64;

/// The end of a run: results, or the reason why there are none.
pub(crate) trait Restore {
    /// Returns to the units of the problem as it was given.
    fn restore(&mut self, back: &Restoration<'_>);
}

/// The way back to the units of a problem.
pub(crate) struct Restoration<'a> {
    /// The problem as it was given.
    pub(crate) problem: &'a Problem,
    /// The power of two by which each characteristic was divided.
    powers: Vec<Power>,
    /// Time within the model for answers that were held back.
    held_back: Duration,
}

impl Restoration<'_> {
    /// The power of two by which a characteristic was divided.
    pub(crate) fn power(&self, characteristic: usize) -> Power {
        self.powers[characteristic]
    }

    /// The power of two of the characteristic of this name; 1 where there is none.
    pub(crate) fn power_of(&self, name: &str) -> Power {
        let place = self.problem.characteristics().iter().position(|one| one.name() == name);
        place.map_or(Power::ONE, |place| self.power(place))
    }

    /// Whether nothing was divided.
    pub(crate) fn is_nothing(&self) -> bool {
        self.powers.iter().all(|power| power.is_one())
    }

    /// Adds the time for answers that were held back.
    pub(crate) fn add_time(&self, run: &mut RunSummary) {
        run.wall += self.held_back;
        run.in_model += self.held_back;
    }
}

/// Runs a job over a problem whose outputs have any size.
///
/// The job begins with the problem as it is. Where the first values show an output of extreme size (beyond `2^64`, or below `2^-64`), it is broken off,
/// and begins anew with every such output divided by a power of two. Evaluations: those of the job; answers of a costly model that were held
/// back are not asked for again. Of a function that costs nothing up to 129 points tell how large its outputs are.
///
/// A job within another one is a part of it.
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
    // A run may end before it has seen enough to be sure.
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

/// The powers of two of the outputs. Of a function that costs nothing they are those of some points of its own, so that they do not
/// depend on which points were answered first; of any other those that were `seen`.
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
    let mut out = Responses::open(rows.len(), problem.outputs().len());
    let points = Points::from_rows(&rows);
    function.evaluate(&Request::values(&points, problem.outputs()), &Run::to_the_end(), &mut out);
    let mut powers = seen;
    for (column, &output) in problem.outputs().iter().enumerate() {
        let size = out.column(column).iter().fold(0.0f64, |size, value| size.max(value.abs()));
        if size > 0.0 {
            powers[output] = Power::of(size);
        }
    }
    powers
}
