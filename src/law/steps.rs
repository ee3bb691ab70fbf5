//! A surface of atoms only: a step function, by the list of its values.

use super::surface::Surface;
use super::{LawFigure, LawTail};

/// Combinations that are listed at most.
const MOST: usize = 1 << 20;
/// What the values have lost by rounding, relative to the largest term: values nearer to each other are one.
const SAME: f64 = 1e-13;

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
        let mut count = 1usize;
        for input in &surface.inputs {
            if !input.is_discrete() {
                return None;
            }
            count = count.checked_mul(input.atoms.len()).filter(|&count| count <= MOST)?;
        }
        if surface.correlated.is_some() {
            return None;
        }
        let mut found = Vec::with_capacity(count);
        let mut places = vec![0; surface.len()];
        let mut z = vec![0.0; surface.len()];
        for _ in 0..count {
            let mut weight = 1.0;
            for (j, &place) in places.iter().enumerate() {
                let (at, share) = surface.inputs[j].atoms[place];
                z[j] = at;
                weight *= share;
            }
            found.push((surface.value(&z), weight));
            for (place, input) in places.iter_mut().zip(&surface.inputs) {
                *place += 1;
                if *place < input.atoms.len() {
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
