//! A surface over independent normal variables, and its values over the whole distribution.

use crate::estimate::figures::{MOMENTS, moments};
use crate::estimate::strata::{HalfSpace, between};
use crate::estimate::stratified_sample::{FAR, steepest};
use crate::estimate::{Columns, NormalSpace};
use sensitol_numeric::sampling::Normals;
use sensitol_numeric::surrogate::Surrogate;

/// Points of a surface in its core. Either tail has a quarter as many.
const KNOTS: usize = 1 << 13;
/// Smallest number of points of a surface in its core.
const FEWEST: usize = 1 << 9;
/// Greatest number of multiplications for all points of a surface: a tenth of a second.
const WORK: usize = 200_000_000;

/// A surface at weighted points of the whole distribution.
pub(super) struct CheckedSurface<'s> {
    space: &'s NormalSpace<'s>,
    surrogate: &'s Surrogate,
    pub(super) z: Columns,
    pub(super) weights: Vec<f64>,
    pub(super) values: Vec<f64>,
    /// Mean, sigma, skewness, kurtosis over these points.
    pub(super) figures: [f64; MOMENTS],
}

impl<'s> CheckedSurface<'s> {
    /// Evaluates a surrogate over its distribution. Returns None if a part of it is unknown.
    pub(super) fn new(space: &'s NormalSpace<'s>, normals: &Normals, surrogate: &'s Surrogate) -> Option<Self> {
        let knots = knots(space, surrogate);
        let q = |z: &Columns| values(surrogate, &space.standardised(z));
        // The core between the two tails, along the direction of the tails.
        let mut z = normals.columns(1, knots);
        let line = steepest(&z, &q(&z)?);
        let mut weights = vec![between(&mut z, &line, FAR) / knots as f64; knots];
        // The tails carry the higher moments, so that they get points of their own.
        for (stream, sign) in [(2, 1.0), (3, -1.0)] {
            let mut tail = normals.columns(stream, knots / 4);
            let half = HalfSpace { direction: line.iter().map(|part| sign * part).collect(), from: FAR };
            let own = half.enter(&mut tail);
            weights.extend(own.into_iter().map(|weight| weight / (knots / 4) as f64));
            z.iter_mut().zip(tail).for_each(|(all, more)| all.extend(more));
        }
        let values = q(&z)?;
        let figures = moments(&values, &weights);
        Some(Self { space, surrogate, z, weights, values, figures })
    }

    /// Values of the surface at some points. Returns None if a part of it is unknown.
    pub(super) fn at(&self, z: &Columns) -> Option<Vec<f64>> {
        values(self.surrogate, &self.space.standardised(z))
    }

    /// Standardised inputs at a point.
    pub(super) fn inputs_at(&self, z: &[f64]) -> Vec<f64> {
        let columns: Columns = z.iter().map(|&z| vec![z]).collect();
        self.space.standardised(&columns).into_iter().map(|column| column[0]).collect()
    }

    /// Number of variables.
    pub(super) fn variables(&self) -> usize {
        self.space.len()
    }

    /// Number of points in the core.
    pub(super) fn knots(&self) -> usize {
        knots(self.space, self.surrogate)
    }

    /// Share within an interval, ends included.
    pub(super) fn share(&self, interval: [f64; 2]) -> f64 {
        self.share_of(&self.values, interval)
    }

    /// Share of other values at the same points within an interval, ends included.
    pub(super) fn share_of(&self, values: &[f64], [low, high]: [f64; 2]) -> f64 {
        let within = values.iter().zip(&self.weights).filter(|(y, _)| low <= **y && **y <= high);
        within.map(|(_, weight)| weight).sum::<f64>() / self.weights.iter().sum::<f64>()
    }
}

fn knots(space: &NormalSpace<'_>, surrogate: &Surrogate) -> usize {
    let work = space.len() + surrogate.interactions.each_pair().count();
    (WORK / work).clamp(FEWEST, KNOTS)
}

fn values(surrogate: &Surrogate, standardised: &Columns) -> Option<Vec<f64>> {
    Some(surrogate.rises(standardised)?.into_iter().map(|rise| surrogate.centre + rise).collect())
}
