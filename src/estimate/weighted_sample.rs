//! Sample in strata that is stored, for shares that are computed after it was drawn.

use crate::estimate::figures::{jackknife, student, totals};
use crate::estimate::rank_quantile::{OrderedSample, SampleQuantile, quantiles};
use crate::estimate::tails::{SampleTails, Weighed, tail};
use crate::estimate::verified::Verified;
use sensitol_numeric::law::{LawTail, REPORTED_QUANTILES};
use sensitol_numeric::power::{Rescale, Rescaling};

/// Points of one stratum in one randomisation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WeightedPart {
    /// Index of the randomisation.
    pub(super) replicate: usize,
    /// Values of the model, NaN without a value.
    pub(super) values: Vec<f64>,
    /// Weights of the points.
    pub(super) weights: Vec<f64>,
    /// Values of the surface at the same points. Empty if they are unknown.
    pub(super) surface: Vec<f64>,
}

/// Values with their weights, by randomisation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WeightedSample {
    parts: Vec<WeightedPart>,
    replicates: usize,
    /// Weight of one point, which is part of the error of a share.
    one: f64,
}

impl Rescale for WeightedSample {
    fn rescale(&mut self, by: &mut Rescaling) {
        for part in &mut self.parts {
            part.values.rescale(by);
            part.surface.rescale(by);
        }
    }
}

impl WeightedSample {
    pub(super) fn new(parts: Vec<WeightedPart>, replicates: usize, one: f64) -> Self {
        Self { parts, replicates, one }
    }

    /// Finite values of the model with their weights and randomisations.
    fn valid(&self) -> Vec<Weighed> {
        let mut all = Vec::with_capacity(self.parts.iter().map(|part| part.values.len()).sum());
        for part in &self.parts {
            let points = part.values.iter().zip(&part.weights).filter(|(y, _)| y.is_finite());
            all.extend(points.map(|(&y, &weight)| (y, weight, part.replicate)));
        }
        all
    }

    /// Values of the surface with their weights and randomisations. Returns None if some point has no value of model or surface, because
    /// the two samples are of different assemblies then.
    fn of_surface(&self) -> Option<Vec<Weighed>> {
        let mut all = Vec::with_capacity(self.parts.iter().map(|part| part.values.len()).sum());
        for part in &self.parts {
            if part.surface.len() != part.values.len() || !part.values.iter().all(|y| y.is_finite()) {
                return None;
            }
            all.extend(part.surface.iter().zip(&part.weights).map(|(&y, &weight)| (y, weight, part.replicate)));
        }
        Some(all)
    }

    /// Quantiles at the probabilities of reports, as [`quantiles`](Self::quantiles).
    pub(crate) fn reported_quantiles(&self) -> [Option<SampleQuantile>; 7] {
        self.quantiles(&REPORTED_QUANTILES).try_into().unwrap_or([None; 7])
    }

    /// Quantiles of the model at probabilities below or above, those of the surface beside them. None for a probability that the sample
    /// does not resolve.
    pub(crate) fn quantiles(&self, tails: &[(LawTail, f64)]) -> Vec<Option<SampleQuantile>> {
        let Some(model) = OrderedSample::of(&self.valid(), self.replicates) else { return vec![None; tails.len()] };
        let surface = self.of_surface().and_then(|all| OrderedSample::of(&all, self.replicates));
        quantiles(&model, surface.as_ref(), tails, self.one)
    }

    /// Density as a table between far quantiles, `[y, density, error]`. Returns None if the values do not spread.
    pub(crate) fn density(&self) -> Option<Vec<[f64; 3]>> {
        /// Number of intervals. The scatter of a sample of 40 000 points is 5 % of the peak with them.
        const PLACES: usize = 96;
        /// Share of the assemblies that is left out on either side.
        const OUTSIDE: f64 = 1e-3;
        let sample = OrderedSample::of(&self.valid(), self.replicates)?;
        let [from, to] = [OUTSIDE, 1.0 - OUTSIDE].map(|share| sample.quantile(share));
        let step = (to - from) / PLACES as f64;
        if step.is_nan() || step <= 0.0 {
            return None;
        }
        // Sums of the weights in every interval, and of all weights, by randomisation.
        let mut sums = vec![vec![0.0; self.replicates]; PLACES + 1];
        for (y, weight, replicate) in self.valid() {
            sums[PLACES][replicate] += weight;
            let place = ((y - from) / step).floor();
            if (0.0..PLACES as f64).contains(&place) {
                sums[place as usize][replicate] += weight;
            }
        }
        let densities = |total: &[f64]| total[..PLACES].iter().map(|sum| sum / (total[PLACES] * step)).collect();
        let (values, errors): (Vec<f64>, Vec<f64>) = (densities(&totals(&sums)), jackknife(densities, &sums));
        let (wide, one) = (student(self.replicates), self.one / step);
        let row =
            |place: usize| [from + (place as f64 + 0.5) * step, values[place], libm::hypot(wide * errors[place], one)];
        Some((0..PLACES).map(row).collect())
    }

    /// Tails below and above, of the requested sides.
    pub(crate) fn tails(&self, [below, above]: [bool; 2]) -> SampleTails {
        let values = self.valid();
        let towards = |asked: bool, above: bool| match asked {
            true => tail(&values, above, (self.replicates, self.one)),
            false => Vec::new(),
        };
        SampleTails { below: towards(below, false), above: towards(above, true) }
    }

    /// Means of functions with values from 0 to 1, over the points that have a value.
    pub(crate) fn shares<const N: usize>(&self, of: [&dyn Fn(f64) -> f64; N]) -> [Verified; N] {
        let mut sums = vec![vec![0.0; self.replicates]; N + 1];
        for (y, weight, replicate) in self.valid() {
            for (sum, of) in sums.iter_mut().zip(of) {
                sum[replicate] += weight * of(y);
            }
            sums[N][replicate] += weight;
        }
        let means = |total: &[f64]| total[..N].iter().map(|sum| sum / total[N]).collect::<Vec<f64>>();
        let (values, errors, wide) = (means(&totals(&sums)), jackknife(means, &sums), student(self.replicates));
        std::array::from_fn(|i| Verified { value: values[i], error: libm::hypot(wide * errors[i], self.one) })
    }
}
