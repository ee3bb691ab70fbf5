//! A surface of atoms only: a step function, by the list of its values.

use super::surface::Surface;
use super::{LawFigure, LawTail};
use crate::correlation::{Atom, JointLaw};

/// Combinations that are listed at most.
const MOST: usize = 1 << 20;
/// The rounding error of the values, relative to the largest term: values nearer to each other are one.
const SAME: f64 = 1e-13;

/// A place of one or several inputs: its probability, and where each of them is.
type Place = (f64, Vec<(usize, f64)>);

/// Values in ascending order with the probabilities on either side.
#[derive(Debug)]
pub(super) struct Steps {
    values: Vec<f64>,
    weights: Vec<f64>,
    /// Probability of at most each of the values, summed from the lower end, and of at least, from the upper one.
    up: Vec<f64>,
    down: Vec<f64>,
    same: f64,
}

impl Steps {
    /// None where an input has a density, or there are too many combinations.
    pub(super) fn of(surface: &Surface) -> Option<Self> {
        // Inputs of one group take their places together.
        let mut groups: Vec<Vec<Place>> = Vec::new();
        let mut grouped = vec![false; surface.len()];
        if let Some(correlated) = &surface.correlated {
            for block in &correlated.blocks {
                if !matches!(block.law, JointLaw::Rows(_)) {
                    return None;
                }
                let row = |atom: Atom| (atom.weight, block.members.iter().copied().zip(atom.u).collect());
                groups.push(block.law.atoms(1).into_iter().map(row).collect());
                block.members.iter().for_each(|&member| grouped[member] = true);
            }
            if correlated.members.iter().any(|&member| !grouped[member]) {
                return None;
            }
        }
        for (j, input) in surface.inputs.iter().enumerate().filter(|&(j, _)| !grouped[j]) {
            if !input.is_discrete() {
                return None;
            }
            groups.push(input.atoms.iter().map(|&(at, share)| (share, vec![(j, at)])).collect());
        }
        let count = groups
            .iter()
            .try_fold(1usize, |count, group| count.checked_mul(group.len()).filter(|&count| count <= MOST))?;
        let mut found = Vec::with_capacity(count);
        let mut places = vec![0; groups.len()];
        let mut z = vec![0.0; surface.len()];
        for _ in 0..count {
            let mut weight = 1.0;
            for (group, &place) in groups.iter().zip(&places) {
                let (share, at) = &group[place];
                at.iter().for_each(|&(j, at)| z[j] = at);
                weight *= share;
            }
            found.push((surface.value(&z), weight));
            for (place, group) in places.iter_mut().zip(&groups) {
                *place += 1;
                if *place < group.len() {
                    break;
                }
                *place = 0;
            }
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let largest = found.iter().map(|(y, _)| y.abs()).fold(surface.centre.abs(), f64::max);
        let same = SAME * largest;
        let (mut values, mut weights): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        for (y, weight) in found {
            match (values.last(), weights.last_mut()) {
                (Some(last), Some(sum)) if y - last <= same => *sum += weight,
                _ => {
                    values.push(y);
                    weights.push(weight);
                }
            }
        }
        let summed = |weights: &mut dyn Iterator<Item = &f64>| -> Vec<f64> {
            weights
                .scan(0.0, |sum, weight| {
                    *sum += weight;
                    Some(*sum)
                })
                .collect()
        };
        let up = summed(&mut weights.iter());
        let mut down = summed(&mut weights.iter().rev());
        down.reverse();
        Some(Self { values, weights, up, down, same })
    }

    /// Probability strictly beyond a limit; a value that only rounding separates from the limit keeps it.
    pub(super) fn tail(&self, y: f64, tail: LawTail) -> LawFigure {
        let value = match tail {
            LawTail::Lower => match self.values.partition_point(|value| *value < y - self.same) {
                0 => 0.0,
                count => self.up[count - 1],
            },
            LawTail::Upper => {
                let first = self.values.partition_point(|value| *value <= y + self.same);
                self.down.get(first).copied().unwrap_or(0.0)
            }
        };
        LawFigure::new(value.min(1.0), 4.0 * f64::EPSILON * value)
    }

    /// The least value with at least this probability at and below it, or above it no more than `p`.
    pub(super) fn quantile(&self, tail: LawTail, p: f64) -> f64 {
        /// Sums of shares are rounded.
        const ROUNDING: f64 = 1e-14;
        let last = self.values.len() - 1;
        let place = match tail {
            LawTail::Lower => self.up.partition_point(|&up| up < p * (1.0 - ROUNDING)),
            LawTail::Upper => {
                let above = |place: usize| self.down.get(place + 1).copied().unwrap_or(0.0);
                (0..=last).find(|&place| above(place) <= p * (1.0 + ROUNDING)).unwrap_or(last)
            }
        };
        self.values[place.min(last)]
    }

    pub(super) fn range(&self) -> [f64; 2] {
        [self.values[0], self.values[self.values.len() - 1]]
    }

    /// Mean and sigma.
    pub(super) fn moments(&self) -> [f64; 2] {
        let over = |f: &dyn Fn(f64) -> f64| self.values.iter().zip(&self.weights).map(|(&y, w)| w * f(y)).sum::<f64>();
        let origin = self.values[0];
        let mean = origin + over(&|y| y - origin);
        [mean, over(&|y| (y - mean) * (y - mean)).sqrt()]
    }
}
