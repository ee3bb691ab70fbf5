//! Safeguarded Newton method. Steps are bounded by the scale of the unknowns and by their bounds, and shortened until the equations come
//! closer to zero. In the end they are repeated until rounding stops them.

use faer::Mat;

use crate::assembly::implicit::linear::Linear;
use crate::assembly::implicit::system::{Scales, System};

/// State at which the conditions hold.
#[derive(Debug, Clone)]
pub(super) struct Root {
    pub(super) u: Vec<f64>,
    /// Sign of the Jacobian's determinant.
    pub(super) sign: f64,
    pub(super) iterations: usize,
}

/// State at which a search ended without a root.
#[derive(Debug, Clone)]
pub(super) struct Stuck {
    pub(super) u: Vec<f64>,
    pub(super) values: Vec<f64>,
    /// True if the equations hold there, but do not determine the unknowns.
    pub(super) singular: bool,
}

/// Greatest number of steps of one search.
const MOST: usize = 60;
/// Longest step, in scales of the unknowns.
pub(super) const REACH: f64 = 0.5;
/// Length of a step, in scales, below which all further steps are full Newton steps.
pub(super) const NEAR: f64 = 1e-6;
/// Length of steps that rounding of the unknowns alone causes, in scales.
pub(super) const ROUNDING: f64 = 1e-16;
/// Greatest length of the last step of a successful search, in scales.
pub(super) const FOUND: f64 = 1e-10;
/// Least decrease of the equations, as a part of the predicted decrease.
const DECREASE: f64 = 1e-4;
/// Greatest number of halvings of a step until the decrease is reached.
const HALVINGS: usize = 30;

/// System of conditions at one point, with its scales.
pub(super) struct Search<'s> {
    pub(super) system: &'s System,
    pub(super) scales: &'s Scales,
    pub(super) given: &'s [f64],
}

impl Search<'_> {
    /// Returns the scaled Jacobian at a state. Returns None if it is not finite.
    pub(super) fn linear(&self, u: &[f64]) -> Option<Linear> {
        let jacobian = self.system.jacobian(self.given, u, self.scales);
        let Scales { equations, unknowns } = self.scales;
        let n = self.system.len();
        Linear::new(Mat::from_fn(n, n, |i, j| jacobian[(i, j)] * unknowns[j] / equations[i]))
    }

    /// Returns the full Newton step at a state, in scales. Returns None if it has no value.
    pub(super) fn first_step(&self, u: &[f64]) -> Option<Vec<f64>> {
        let (scaled, norm) = self.scaled(&self.system.values(self.given, u));
        let linear = self.linear(u).filter(|_| norm.is_finite())?;
        Some(linear.solve(&scaled.iter().map(|value| -value).collect::<Vec<f64>>()))
    }

    /// Returns the scaled equations and their norm, which is infinite if an equation has no value.
    fn scaled(&self, values: &[f64]) -> (Vec<f64>, f64) {
        let scaled: Vec<f64> = values.iter().zip(&self.scales.equations).map(|(value, size)| value / size).collect();
        let norm = scaled.iter().map(|value| value * value).sum::<f64>().sqrt();
        (scaled, if norm.is_nan() { f64::INFINITY } else { norm })
    }

    /// Returns a state moved by a step in scales, and limited to the bounds.
    pub(super) fn moved(&self, u: &[f64], step: &[f64], part: f64) -> Vec<f64> {
        let one = |j: usize| {
            let [lower, upper] = self.system.unknowns[j].bounds();
            (u[j] + part * step[j] * self.scales.unknowns[j]).clamp(lower, upper)
        };
        (0..u.len()).map(one).collect()
    }

    /// Returns the largest difference between two states, in scales.
    pub(super) fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let parts = a.iter().zip(b).zip(&self.scales.unknowns).map(|((a, b), scale)| ((a - b) / scale).abs());
        parts.fold(0.0, f64::max)
    }

    /// Returns the state near `start` at which the conditions hold.
    pub(super) fn from(&self, start: &[f64]) -> Result<Root, Stuck> {
        let mut u = start.to_vec();
        let mut values = self.system.values(self.given, &u);
        // Length of the last full Newton step, once the search is near.
        let mut last = f64::INFINITY;
        for iterations in 0..MOST {
            let (scaled, norm) = self.scaled(&values);
            let Some(linear) = self.linear(&u).filter(|_| norm.is_finite()) else { break };
            let opposite: Vec<f64> = scaled.iter().map(|value| -value).collect();
            let step = linear.solve(&opposite);
            let length = step.iter().fold(0.0f64, |length, t| length.max(t.abs()));
            if length < NEAR || last < NEAR {
                // Steps that get shorter are not caused by rounding yet.
                if length <= ROUNDING || length > 0.5 * last {
                    let found = last.min(length) < FOUND && norm < NEAR;
                    return if found {
                        Ok(Root { u, sign: linear.sign(), iterations })
                    } else {
                        Err(Stuck { u, values, singular: norm < NEAR })
                    };
                }
                last = length;
                u = self.moved(&u, &step, 1.0);
                values = self.system.values(self.given, &u);
                continue;
            }
            // A very long step belongs to a nearly singular Jacobian: directions that are not determined are left out.
            let step = if length < 1.0 / NEAR { step } else { linear.least(&opposite) };
            let Some(next) = self.shortened(&u, &step, norm) else { break };
            (u, values) = next;
        }
        let singular = self.scaled(&values).1 < NEAR;
        Err(Stuck { u, values, singular })
    }

    /// Returns the state after the largest part of a step that brings the equations closer to zero, with the equations there.
    fn shortened(&self, u: &[f64], step: &[f64], norm: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let length = step.iter().fold(0.0f64, |length, t| length.max(t.abs()));
        let mut part = (REACH / length).min(1.0);
        for _ in 0..HALVINGS {
            let next = self.moved(u, step, part);
            let values = self.system.values(self.given, &next);
            if self.scaled(&values).1 <= (1.0 - DECREASE * part) * norm && next != u {
                return Some((next, values));
            }
            part *= 0.5;
        }
        None
    }

    /// Returns the equation with the greatest residual, relative to the size of its terms.
    pub(super) fn worst(&self, values: &[f64]) -> usize {
        let off = |i: usize| match (values[i] / self.scales.equations[i]).abs() {
            off if off.is_nan() => f64::INFINITY,
            off => off,
        };
        (0..values.len()).max_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(0)
    }
}
