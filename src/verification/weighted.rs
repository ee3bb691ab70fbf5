//! Sample in strata that is stored, for shares that are computed after it was drawn.

use crate::verification::Verified;
use crate::verification::figures::{jackknife, student, totals};
use crate::verification::tails::{SampleTails, Weighed, tail};
use sensitol_numeric::power::{Rescale, Rescaling};

/// Values with their weights, by randomisation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WeightedSample {
    /// Index of the randomisation, values, and their weights, for every stratum of every randomisation.
    parts: Vec<(usize, Vec<f64>, Vec<f64>)>,
    replicates: usize,
    /// Weight of one point, which is part of the error of a share.
    one: f64,
}

impl Rescale for WeightedSample {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.parts.iter_mut().for_each(|(_, values, _)| values.rescale(by));
    }
}

impl WeightedSample {
    pub(super) fn new(parts: impl Iterator<Item = (usize, Vec<f64>, Vec<f64>)>, replicates: usize, one: f64) -> Self {
        Self { parts: parts.collect(), replicates, one }
    }

    /// Tails below and above, of the requested sides.
    pub(crate) fn tails(&self, [below, above]: [bool; 2]) -> SampleTails {
        let of = |(replicate, values, weights): &(usize, Vec<f64>, Vec<f64>)| -> Vec<Weighed> {
            let points = values.iter().zip(weights).filter(|(y, _)| y.is_finite());
            points.map(|(&y, &weight)| (y, weight, *replicate)).collect()
        };
        let values: Vec<Weighed> = self.parts.iter().flat_map(of).collect();
        let towards = |asked: bool, above: bool| match asked {
            true => tail(&values, above, (self.replicates, self.one)),
            false => Vec::new(),
        };
        SampleTails { below: towards(below, false), above: towards(above, true) }
    }

    /// Finite values in ascending order, with their weights.
    pub(crate) fn sorted(&self) -> Vec<(f64, f64)> {
        let of = |(_, values, weights): &(usize, Vec<f64>, Vec<f64>)| -> Vec<(f64, f64)> {
            values.iter().copied().zip(weights.iter().copied()).filter(|(y, _)| y.is_finite()).collect()
        };
        let mut all: Vec<(f64, f64)> = self.parts.iter().flat_map(of).collect();
        all.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        all
    }

    /// Means of functions with values from 0 to 1, over the points that have a value.
    pub(crate) fn shares<const N: usize>(&self, of: [&dyn Fn(f64) -> f64; N]) -> [Verified; N] {
        let mut sums = vec![vec![0.0; self.replicates]; N + 1];
        for (replicate, values, weights) in &self.parts {
            for (&y, weight) in values.iter().zip(weights).filter(|(y, _)| y.is_finite()) {
                for (sum, of) in sums.iter_mut().zip(of) {
                    sum[*replicate] += weight * of(y);
                }
                sums[N][*replicate] += weight;
            }
        }
        let means = |total: &[f64]| total[..N].iter().map(|sum| sum / total[N]).collect::<Vec<f64>>();
        let (values, errors, wide) = (means(&totals(&sums)), jackknife(means, &sums), student(self.replicates));
        std::array::from_fn(|i| Verified { value: values[i], error: libm::hypot(wide * errors[i], self.one) })
    }
}
