//! Whether the law of four moments rejects what the surface rejects that has these moments.
//!
//! A Pearson law with the right moments need not have the right tails: a uniform dimension beside normal ones, say, or a sum of few.
//! The surface costs nothing to look at, so that it is sampled wherever there are limits.

use rayon::prelude::*;
use serde::Serialize;

use super::CharacteristicAnalysis;
use crate::distribution::StandardMoments;
use crate::method::{Options, Outcome};
use crate::problem::Problem;
use crate::sampling::{Draws, Portion, SOBOL_DIMENSIONS, Sampler};

/// Points of the surface, in blocks of so many,
const POINTS: usize = 1 << 14;
const ROWS: usize = 1024;
/// and how many times as many where fewer than so many lie beyond and the dimensions are no more than this.
const MORE: usize = 4;
const FEW: f64 = 64.0;
const QUICK: usize = 16;
/// Standard errors, as if the law were right, of a random sample, of which a quasi-random one has less, from which a difference is one,
const SEEN: f64 = 4.0;
/// and points beyond those, as few are not spread as a normal law.
const SURE: f64 = 8.0;
/// and from which part of the larger of both on it is worth a warning.
const APART: f64 = 0.2;
/// A curvature or product below this part of the slopes is rounding.
const STRAIGHT: f64 = 1e-12;

/// What law and surface reject.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Tails {
    /// The share beyond the limits by the law of four moments.
    pub law: f64,
    /// Of the points of the surface.
    pub surface: f64,
    /// How many these are.
    pub points: usize,
}

impl Tails {
    /// How far the two are apart, where that is more than the sample's chance were the law right.
    fn difference(&self) -> Option<f64> {
        let n = self.points as f64;
        let chance = SEEN * (self.law * (1.0 - self.law).max(0.0) * n).sqrt();
        let apart = (self.surface - self.law) * n;
        (apart > chance + SURE || -apart > chance).then_some(apart.abs() / n)
    }

    /// What the law is off by the points: all of a difference that is seen, and of others what two standard errors leave of it;
    /// less than one point is not seen.
    pub(super) fn off(&self) -> f64 {
        let n = self.points as f64;
        let chance = (self.surface * n).max(1.0).sqrt() / n;
        let open = (self.surface - self.law).abs() - 2.0 * chance;
        self.difference().unwrap_or(open).max(1.0 / n)
    }

    /// Whether the law is not to be trusted with the yield.
    pub(super) fn misses(&self) -> bool {
        self.difference().is_some_and(|apart| apart > APART * self.law.max(self.surface))
    }
}

/// Looks at every characteristic with limits whose surface is not plainly normal, and widens the estimated error of its yield by
/// what the law is off, or may be off unseen. Evaluates nothing of the model.
pub(super) fn look(problem: &Problem, outcome: &Outcome, characteristics: &mut [CharacteristicAnalysis]) {
    let asked: Vec<usize> = (0..characteristics.len()).filter(|&c| is_asked(outcome, &characteristics[c], c)).collect();
    if asked.is_empty() {
        return;
    }
    let sampler = if outcome.plan.varying().len() <= SOBOL_DIMENSIONS { Sampler::Sobol } else { Sampler::Random };
    // The same points for everybody, whatever the seed: they decide nothing but whether to warn.
    let Ok(draws) = Draws::new(problem.dimensions(), problem.correlation(), sampler, Options::SEED) else { return };
    // Block by block, so that a thousand dimensions take no more memory than ten.
    let beyond = |block: usize| -> Vec<usize> {
        let points = draws.points(Portion { replicate: 0, first: (block * ROWS) as u64, rows: ROWS });
        let columns = problem.standardised(&points, outcome.plan.varying());
        let of = |&c: &usize| {
            let surrogate = outcome.fitted[c].surrogate.as_ref();
            let Some((surrogate, rises)) = surrogate.and_then(|one| Some((one, one.rises(&columns)?))) else {
                return 0;
            };
            let limits = problem.characteristics()[c].limits();
            rises.iter().filter(|&&rise| !limits.contains(surrogate.centre + rise)).count()
        };
        asked.iter().map(of).collect()
    };
    let add = |a: Vec<usize>, b: Vec<usize>| a.iter().zip(&b).map(|(a, b)| a + b).collect();
    let nothing = || vec![0; asked.len()];
    let count = |blocks: std::ops::Range<usize>| blocks.into_par_iter().map(beyond).reduce(nothing, add);
    let rejected = |c: &usize| characteristics[*c].capability.and_then(|capability| capability.rejected());
    let laws: Vec<Option<f64>> = asked.iter().map(rejected).collect();
    let (mut points, mut found) = (POINTS, count(0..POINTS / ROWS));
    let few =
        |(law, &beyond): (&Option<f64>, &usize)| law.is_some_and(|law| (law * POINTS as f64).max(beyond as f64) < FEW);
    if outcome.plan.varying().len() <= QUICK && laws.iter().zip(&found).any(few) {
        points = MORE * POINTS;
        found = add(found, count(POINTS / ROWS..points / ROWS));
    }
    for ((&c, law), beyond) in asked.iter().zip(laws).zip(found) {
        let Some(law) = law else { continue };
        let one = &mut characteristics[c];
        let tails = Tails { law, surface: beyond as f64 / points as f64, points };
        if let Some(estimate) = one.error_estimate.as_mut() {
            estimate.yield_ = estimate.yield_.map(|error| error + tails.off());
        }
        one.tails = Some(tails);
    }
}

fn is_asked(outcome: &Outcome, one: &CharacteristicAnalysis, c: usize) -> bool {
    let surrogate = outcome.fitted[c].surrogate.as_ref();
    let Some(surrogate) = surrogate.filter(|_| one.characteristic.limits().exist() && one.model_sampled.is_none())
    else {
        return false;
    };
    let normal = outcome.plan.inputs().shapes().iter().all(|shape| shape.moments == StandardMoments::NORMAL);
    let straight = surrogate.parts.iter().all(|part| part.is_some_and(|part| part.is_straight(STRAIGHT)));
    let sigma = one.moments.map_or(0.0, |moments| moments.sigma());
    let apart = surrogate.interactions.pairs().iter().all(|(.., product)| product.abs() <= STRAIGHT * sigma);
    !(normal && straight && apart)
}
