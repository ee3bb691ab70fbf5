//! Weighted points of a model, by randomisation, and every figure of them with its error.
//!
//! The error of a share includes the weight of one point, because a rare event may exist although no point shows it.

use crate::estimate::figures::{MOMENTS, carried_by, effective, moments, standard, student};
use crate::estimate::ordered_points::OUTSIDE;
use crate::estimate::rank_quantile::{OrderedSample, SampleQuantile, quantiles};
use crate::estimate::replicate_sums::ReplicateSums;
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

/// Figures of a sample.
pub(crate) struct Figures {
    /// Mean, sigma, skewness, kurtosis, then a share for every requested interval.
    pub(crate) estimates: Vec<Verified>,
    /// Share of the assemblies that have a value.
    pub(crate) valid: Verified,
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
        let sample = OrderedSample::of(&self.valid(), self.replicates)?;
        let [from, to] = [OUTSIDE, 1.0 - OUTSIDE].map(|share| sample.quantile(share));
        let step = (to - from) / PLACES as f64;
        if step.is_nan() || step <= 0.0 {
            return None;
        }
        // Sums of the weights in every interval, and of all weights.
        let mut sums = ReplicateSums::new(PLACES + 1, self.replicates);
        for (y, weight, replicate) in self.valid() {
            sums.add(PLACES, replicate, weight);
            let place = ((y - from) / step).floor();
            if (0.0..PLACES as f64).contains(&place) {
                sums.add(place as usize, replicate, weight);
            }
        }
        let densities = |total: &[f64]| total[..PLACES].iter().map(|sum| sum / (total[PLACES] * step)).collect();
        let row = |(place, density): (usize, Verified)| {
            let Verified { value, error } = density.with_point(self.one / step);
            [from + (place as f64 + 0.5) * step, value, error]
        };
        Some(sums.estimates(densities).into_iter().enumerate().map(row).collect())
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
    pub(crate) fn shares<const N: usize>(&self, of: impl Fn(f64) -> [f64; N]) -> [Verified; N] {
        self.means(self.valid().into_iter().map(|(y, weight, replicate)| (of(y), weight, replicate)))
    }

    /// Difference of the shares of model and surface within each interval, ends included: `mean(1_model - 1_surface)`. Returns None if
    /// there is no surface, or if some points have no value, because the shares refer to different assemblies then.
    pub(crate) fn difference<const N: usize>(&self, intervals: [[f64; 2]; N]) -> Option<[Verified; N]> {
        let within = |[low, high]: [f64; 2], y: f64| f64::from(u8::from(low <= y && y <= high));
        let points = self.valid().into_iter().zip(self.of_surface()?);
        Some(self.means(points.map(|((model, weight, replicate), (surface, ..))| {
            (intervals.map(|interval| within(interval, model) - within(interval, surface)), weight, replicate)
        })))
    }

    /// Means of terms over points, each with its weight and its randomisation.
    fn means<const N: usize>(&self, points: impl Iterator<Item = ([f64; N], f64, usize)>) -> [Verified; N] {
        let mut sums = ReplicateSums::new(N + 1, self.replicates);
        for (terms, weight, replicate) in points {
            terms.into_iter().enumerate().for_each(|(sum, term)| sums.add(sum, replicate, weight * term));
            sums.add(N, replicate, weight);
        }
        let found = sums.estimates(|total| total[..N].iter().map(|sum| sum / total[N]).collect());
        std::array::from_fn(|index| found[index].with_point(self.one))
    }

    /// Figures, with the shares of the assemblies within these intervals, ends included.
    ///
    /// Points without a value are left out of numerator and denominator alike: every figure refers to the assemblies that have a value.
    pub(crate) fn figures(&self, intervals: &[[f64; 2]]) -> Figures {
        let all = || self.parts.iter().flat_map(|part| part.values.iter().zip(&part.weights));
        let (values, weights): (Vec<f64>, Vec<f64>) = all().filter(|(y, _)| y.is_finite()).unzip();
        let total: f64 = all().map(|(_, weight)| weight).sum();
        let [origin, spread, ..] = moments(&values, &weights);
        let scale = if spread > 0.0 { spread } else { 1.0 };
        // Sums of the valid points, of powers 1 to 4, of every interval, and of all points.
        let count = 1 + MOMENTS + intervals.len();
        let mut sums = ReplicateSums::new(count + 1, self.replicates);
        for part in &self.parts {
            let mut row = vec![0.0; count + 1];
            for (&y, &weight) in part.values.iter().zip(&part.weights) {
                row[count] += weight;
                if !y.is_finite() {
                    continue;
                }
                let v = (y - origin) / scale;
                let mut term = weight;
                for sum in &mut row[..=MOMENTS] {
                    *sum += term;
                    term *= v;
                }
                for (sum, [low, high]) in row[1 + MOMENTS..].iter_mut().zip(intervals) {
                    *sum += if *low <= y && y <= *high { weight } else { 0.0 };
                }
            }
            row.into_iter().enumerate().for_each(|(sum, more)| sums.add(sum, part.replicate, more));
        }
        let of = |total: &[f64]| {
            let raw: Vec<f64> = total[1..count].iter().map(|sum| sum / total[0]).collect();
            standard(&raw, origin, scale)
        };
        let (figures, errors) = sums.jackknifed(of);
        let student = student(self.replicates);
        let estimate = |(index, (value, error)): (usize, (f64, f64))| {
            if index >= MOMENTS {
                return Verified { value, error: error * student }.with_point(self.one);
            }
            // Few points may carry a high power: the jackknife underestimates its error.
            let terms = values.iter().zip(&weights);
            let carried = terms.map(|(y, weight)| weight * ((y - origin) / scale).abs().powi(index as i32 + 1));
            Verified { value, error: error * carried_by(effective(carried)) * student }
        };
        let estimates = figures.into_iter().zip(errors).enumerate().map(estimate).collect();
        let failed = total > 0.0 && values.len() < all().count();
        let off = match failed {
            true => sums.estimates(|total| vec![total[0] / total[count]])[0].with_point(self.one).error,
            false => self.one,
        };
        Figures { estimates, valid: Verified { value: weights.iter().sum::<f64>() / total, error: off } }
    }

    /// Weight of one point.
    pub(crate) fn point(&self) -> f64 {
        self.one
    }

    /// True if no point has a value.
    pub(crate) fn is_void(&self) -> bool {
        !self.parts.iter().flat_map(|part| &part.values).any(|y| y.is_finite())
    }
}
