//! Second-order surrogate as control variate: exact moments of the surrogate.
//!
//! Only the difference of model and surrogate is sampled ([`crate::simulation::surface_difference`]). Nothing is assumed of the surrogate: coefficients are
//! fitted, and if the plain sample has the smaller standard error, it is the estimate.

use crate::assembly::{Points, Run};
use crate::evaluation::Evaluated;
use crate::method::{Method, Options, Outcome};
use crate::problem::Problem;
use crate::simulation::surrogates::{KnownSurrogate, Shape, Surrogates};
use crate::simulation::{ROWS, SimulationError, SimulationOptions};
use crate::summary::StopReason;
use sensitol_numeric::characteristic::KeptLimits;

use sensitol_numeric::moments::Sampled;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::{Draws, Portion, Sampler};
use sensitol_numeric::surrogate::Surrogate;

/// Points of the surrogate for every point of the model, for the surrogate's own share within the limits.
const MORE: u64 = 32;
/// Smallest number of points of the surrogate for that share.
const LEAST: u64 = 1 << 18;
/// Greatest number of points of the surrogate for that share.
const MOST: u64 = 1 << 24;
/// Greatest number of operations for these points, approximately: some seconds.
const EFFORT: u64 = 1 << 31;

/// Surrogates of a problem as control variates.
pub(super) struct Control<'p> {
    problem: &'p Problem,
    pub(super) outcome: Outcome,
    /// Surrogates of the characteristics. None if a surrogate does not vary, and explains nothing.
    pub(super) twins: Vec<Option<Twin>>,
}

/// Surrogate of one characteristic with its exact moments.
pub(super) struct Twin {
    surrogate: Surrogate,
    pub(super) method: Method,
    pub(super) evaluations: usize,
    pub(super) centre: f64,
    /// Exact moments of the surrogate. With `t` the standardised surrogate, `E[t^3]` and `E[t^4]` are its skewness and kurtosis.
    pub(super) moments: Shape,
    /// Standard errors of the moments, if correlated inputs permit no closed form.
    pub(super) sampled: Option<Sampled>,
    pub(super) limits: KeptLimits,
    /// Counts of the surrogate outside the limits, if there are limits.
    pub(super) outside: Option<Outside>,
}

/// Number of values of the surrogate outside the limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outside {
    pub(super) points: u64,
    /// Values below and above the limits.
    pub(super) hits: [u64; 2],
}

impl<'p> Control<'p> {
    /// Analyses the problem for its surrogates. There are none if it was stopped meanwhile.
    pub(super) fn of(
        problem: &'p Problem,
        asked: &Options,
        options: &SimulationOptions,
        run: &Run<'_>,
    ) -> Result<Self, SimulationError> {
        let Surrogates { outcome, known } = Surrogates::of(problem, asked, run)?;
        let twins = twins(problem, &outcome, known);
        let mut control = Self { problem, twins, outcome };
        control.count_outside(options)?;
        Ok(control)
    }

    /// Reuses the surrogates of an existing analysis, whose points are not counted again.
    pub(super) fn beside_of(
        problem: &'p Problem,
        outcome: &Outcome,
        options: &SimulationOptions,
    ) -> Result<Self, SimulationError> {
        let known = Surrogates::known_of(problem, outcome);
        let mut outcome = outcome.clone();
        outcome.evaluated = Evaluated::nothing(problem);
        let mut control = Self { problem, twins: twins(problem, &outcome, known), outcome };
        control.count_outside(options)?;
        Ok(control)
    }

    /// Reason of a stop before the surrogates were known.
    pub(super) fn stopped(&self) -> Option<StopReason> {
        self.outcome.evaluated.stopped()
    }

    /// Every surrogate with its rises at these points.
    pub(super) fn beside(&self, points: &Points) -> Vec<Option<(&Twin, Vec<f64>)>> {
        self.twins.iter().zip(self.rises(points)).map(|(twin, rises)| Some((twin.as_ref()?, rises))).collect()
    }

    /// Rises at these points by characteristic: the values of the surrogate minus its centre. Empty if there is no surrogate.
    pub(super) fn rises(&self, points: &Points) -> Vec<Vec<f64>> {
        let inputs = self.problem.standardised(points, self.outcome.plan.varying());
        let rises = |twin: &Option<Twin>| twin.as_ref().and_then(|twin| twin.surrogate.rises(&inputs));
        self.twins.iter().map(|twin| rises(twin).unwrap_or_default()).collect()
    }

    /// Counts the surrogates' own values outside the limits, in a sample that costs no evaluation. Its stream differs from the model's.
    fn count_outside(&mut self, options: &SimulationOptions) -> Result<(), SimulationError> {
        let limited = |twin: &&Twin| twin.limits.exist();
        let work: usize = (self.twins.iter().flatten().filter(limited))
            .map(|twin| 10 * twin.surrogate.parts.len() + twin.surrogate.interactions.pairs().len())
            .sum();
        if work == 0 {
            return Ok(());
        }
        let wanted = options.samples.saturating_mul(MORE).clamp(LEAST, MOST);
        let blocks = wanted.min((EFFORT / work as u64).max(LEAST)).div_ceil(ROWS as u64);
        let (problem, points) = (self.problem, blocks * ROWS as u64);
        let draws = Draws::new(problem.dimensions(), problem.correlation(), Sampler::Random, !options.seed)?;
        let nothing = || vec![[0u64; 2]; self.twins.len()];
        let block = |block: u64| {
            let rises = self.rises(&draws.points(Portion { replicate: 0, first: block * ROWS as u64, rows: ROWS }));
            let count = |(twin, rises): (&Option<Twin>, Vec<f64>)| {
                let sides = rises.iter().map(|rise| twin.as_ref().map_or([false; 2], |twin| twin.sides(*rise)));
                sides.fold([0; 2], |hits, [below, above]| [hits[0] + u64::from(below), hits[1] + u64::from(above)])
            };
            self.twins.iter().zip(rises).map(count).collect::<Vec<[u64; 2]>>()
        };
        let add = |mut sum: Vec<[u64; 2]>, more: Vec<[u64; 2]>| {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum = [sum[0] + more[0], sum[1] + more[1]]);
            sum
        };
        // Integer sums do not depend on the order in which threads finish.
        let hits = (0..blocks).into_par_iter().map(block).collect::<Vec<_>>().into_iter().fold(nothing(), add);
        for (twin, hits) in self.twins.iter_mut().zip(hits) {
            if let Some(twin) = twin.as_mut().filter(|twin| twin.limits.exist()) {
                twin.outside = Some(Outside { points, hits });
            }
        }
        Ok(())
    }
}

/// Surrogates of all characteristics with their limits.
fn twins(problem: &Problem, outcome: &Outcome, known: Vec<Option<KnownSurrogate>>) -> Vec<Option<Twin>> {
    let twin = |(c, known): (usize, Option<KnownSurrogate>)| {
        known.map(|KnownSurrogate { surrogate, moments, sampled }| Twin {
            centre: surrogate.centre,
            surrogate,
            method: outcome.method,
            evaluations: outcome.evaluated.ledger.evaluations(),
            moments,
            sampled,
            limits: problem.kept_limits(c),
            outside: None,
        })
    };
    known.into_iter().enumerate().map(twin).collect()
}

impl Twin {
    /// True for each limit, lower and upper, that the surrogate breaks at this rise.
    pub(super) fn sides(&self, rise: f64) -> [bool; 2] {
        self.limits.broken(self.centre + rise)
    }
}
