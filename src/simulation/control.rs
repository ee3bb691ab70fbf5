//! The second-order surrogate as control variate: what of the moments is known exactly, and how it is had.
//!
//! The moments of the surrogate are exact; only what the model differs by is sampled ([`super::difference`]). Nothing is assumed of the
//! surrogate: coefficients are fitted, and where the plain sample has the smaller standard error, it is the estimate.

use super::surrogates::{KnownSurrogate, Shape, Surrogates};
use super::{ROWS, SimulationError, SimulationOptions};
use crate::assembly::{Points, Run};
use crate::evaluation::Evaluated;
use crate::method::{Method, Options, Outcome};
use crate::problem::Problem;
use crate::summary::StopReason;
use sensitol_numeric::characteristic::KeptLimits;

use sensitol_numeric::moments::Sampled;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::{Draws, Portion, Sampler};
use sensitol_numeric::surrogate::Surrogate;

/// Points of the surrogate for every point of the model, by which its own share within the limits is known,
const MORE: u64 = 32;
/// never fewer or more than these,
const LEAST: u64 = 1 << 18;
const MOST: u64 = 1 << 24;
/// and no more operations than this, about: some seconds.
const EFFORT: u64 = 1 << 31;

/// The surrogates of a problem.
pub(super) struct Control<'p> {
    problem: &'p Problem,
    pub(super) outcome: Outcome,
    /// For every characteristic; None where the surrogate does not vary, and explains nothing.
    pub(super) twins: Vec<Option<Twin>>,
}

/// The surrogate of one characteristic.
pub(super) struct Twin {
    surrogate: Surrogate,
    pub(super) method: Method,
    pub(super) evaluations: usize,
    pub(super) centre: f64,
    /// `E[t^3]` and `E[t^4]` are its skewness and kurtosis.
    pub(super) moments: Shape,
    /// Their standard errors, where correlated inputs leave them no closed form.
    pub(super) sampled: Option<Sampled>,
    pub(super) limits: KeptLimits,
    /// Where there are limits.
    pub(super) outside: Option<Outside>,
}

/// How many values of the surrogate lie outside the limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outside {
    pub(super) points: u64,
    /// Below and above.
    pub(super) hits: [u64; 2],
}

impl<'p> Control<'p> {
    /// Analyses the problem; has no surrogates when it was stopped meanwhile.
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

    /// Of an analysis that has been made, whose points are not counted again.
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

    /// Why it was stopped before the surrogates were known.
    pub(super) fn stopped(&self) -> Option<StopReason> {
        self.outcome.evaluated.stopped
    }

    /// Every surrogate with its rises at these points.
    pub(super) fn beside(&self, points: &Points) -> Vec<Option<(&Twin, Vec<f64>)>> {
        self.twins.iter().zip(self.rises(points)).map(|(twin, rises)| Some((twin.as_ref()?, rises))).collect()
    }

    /// For every characteristic how far its surrogate lies above its centre at these points; empty where it has none.
    pub(super) fn rises(&self, points: &Points) -> Vec<Vec<f64>> {
        let inputs = self.problem.standardised(points, self.outcome.plan.varying());
        let rises = |twin: &Option<Twin>| twin.as_ref().and_then(|twin| twin.surrogate.rises(&inputs));
        self.twins.iter().map(|twin| rises(twin).unwrap_or_default()).collect()
    }

    /// The surrogates' own shares outside the limits, by a sample that costs no evaluation, of another stream than the
    /// model's.
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
        // Whole numbers: the order in which threads finish does not matter.
        let hits = (0..blocks).into_par_iter().map(block).collect::<Vec<_>>().into_iter().fold(nothing(), add);
        for (twin, hits) in self.twins.iter_mut().zip(hits) {
            if let Some(twin) = twin.as_mut().filter(|twin| twin.limits.exist()) {
                twin.outside = Some(Outside { points, hits });
            }
        }
        Ok(())
    }
}

/// The surrogates as they stand beside the model.
fn twins(problem: &Problem, outcome: &Outcome, known: Vec<Option<KnownSurrogate>>) -> Vec<Option<Twin>> {
    let twin = |(c, known): (usize, Option<KnownSurrogate>)| {
        known.map(|KnownSurrogate { surrogate, moments, sampled }| Twin {
            centre: surrogate.centre,
            surrogate,
            method: outcome.method,
            evaluations: outcome.evaluated.evaluations,
            moments,
            sampled,
            limits: problem.kept_limits(c),
            outside: None,
        })
    };
    known.into_iter().enumerate().map(twin).collect()
}

impl Twin {
    /// Whether the surrogate lies below and above the limits, from its rise.
    pub(super) fn sides(&self, rise: f64) -> [bool; 2] {
        self.limits.broken(self.centre + rise)
    }
}
