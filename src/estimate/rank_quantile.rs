//! Quantiles of a sample in strata, with the quantiles of a surface at the same points.
//!
//! ```text
//! plain   q         smallest value whose cumulative weight reaches p
//!         error     greater distance of the quantiles at p - e and p + e, with e the error of the share up to q
//! paired  q         q_model - q_surface + q_law,      all at p, the first two from the same points
//!         error     the same distance, with e the error of the mean of 1[model <= q_model] - 1[surface <= q_surface],
//!                   the error of q_law, and (q_law - q_surface) (1 - r), as the root of the sum of squares,
//!                   with r the distance of neighbouring quantiles of the model, divided by that of the surface
//! ```
//!
//! Points on which model and surface agree do not scatter the paired quantile: only the difference of the two is sampled. The error of a
//! share becomes that of a quantile by inverting the distribution function, without a density (Woodruff, J. Am. Stat. Assoc. 47 (1952)
//! 635). It holds for values in steps too, because the interval then reaches to the next step.

use crate::estimate::replicate_sums::ReplicateSums;
use crate::estimate::verified::Verified;
use sensitol_numeric::capability::EstimatedQuantile;
use sensitol_numeric::law::{LawFigure, LawTail, REPORTED_QUANTILES};
use sensitol_numeric::power::rescale;

/// Greatest factor between the slopes of the two distribution functions for which the paired quantile is used.
const ALIKE: f64 = 2.0;

/// Quantile of the model's sample at one probability.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SampleQuantile {
    /// Quantile from the values of the model alone.
    pub(crate) plain: Verified,
    /// Quantile of the surface at the same points. None if the surface has no value at some point, or the model none.
    paired: Option<PairedQuantile>,
}

/// Integer with the order of a double, as that of [`f64::total_cmp`].
fn ordered_bits(value: f64) -> i64 {
    let bits = value.to_bits().cast_signed();
    bits ^ ((bits >> 63).cast_unsigned() >> 1).cast_signed()
}

/// Quantile of a surface at the points of the model's sample.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PairedQuantile {
    /// Quantile of the surface.
    surface: f64,
    /// Error of the difference of the two quantiles.
    error: f64,
    /// Distance of neighbouring quantiles of the model, divided by that of the surface.
    ratio: f64,
}

rescale!(SampleQuantile { plain, paired } without {});
rescale!(PairedQuantile { surface, error } without { ratio });

impl SampleQuantile {
    /// Quantile with the distribution of the surface as control variate, if that lowers the error.
    pub(crate) fn with_law(&self, law: Option<LawFigure>) -> Verified {
        let Some((paired, law)) = self.paired.zip(law) else { return self.plain };
        // Distribution functions of different slopes turn a difference of shares into different distances.
        let moved = law.value - paired.surface;
        let error = libm::hypot(libm::hypot(paired.error, law.error), moved * (1.0 - paired.ratio));
        let alike = (1.0 / ALIKE..=ALIKE).contains(&paired.ratio);
        match alike && error < self.plain.error {
            true => Verified { value: self.plain.value + moved, error },
            false => self.plain,
        }
    }
}

/// Values of a sample in ascending order, with their weights and randomisations.
pub(super) struct OrderedSample {
    values: Vec<f64>,
    /// Cumulative weight up to each value, the value included, divided by the whole weight.
    shares: Vec<f64>,
    /// Whole weight of every randomisation.
    whole: Vec<f64>,
    /// Weight and randomisation of each value.
    points: Vec<(f64, usize)>,
}

impl OrderedSample {
    /// Sorts values with their weights and randomisations. Returns None if there is no weight, or some value is not finite.
    pub(super) fn of(all: &[(f64, f64, usize)], replicates: usize) -> Option<Self> {
        let total: f64 = all.iter().map(|(_, weight, _)| weight).sum();
        if total.is_nan() || total <= 0.0 || all.iter().any(|(value, ..)| !value.is_finite()) {
            return None;
        }
        // Integers of the same order are compared in one instruction.
        let mut order: Vec<(i64, usize)> =
            all.iter().enumerate().map(|(index, (value, ..))| (ordered_bits(*value), index)).collect();
        order.sort_unstable();
        let mut whole = vec![0.0; replicates];
        let mut sum = 0.0;
        let (mut values, mut shares, mut points) = (Vec::new(), Vec::new(), Vec::new());
        for (_, index) in order {
            let (value, weight, replicate) = all[index];
            whole[replicate] += weight;
            sum += weight;
            values.push(value);
            shares.push(sum / total);
            points.push((weight, replicate));
        }
        Some(Self { values, shares, whole, points })
    }

    /// Quantile at a share.
    pub(super) fn quantile(&self, share: f64) -> f64 {
        self.values[self.place(share)]
    }

    /// Index of the quantile at a share.
    fn place(&self, share: f64) -> usize {
        self.shares.partition_point(|&own| own < share).min(self.values.len() - 1)
    }

    /// Weight up to a value, that value included, of every randomisation.
    fn up_to(&self, place: usize) -> Vec<f64> {
        let value = self.values[place];
        let mut sums = vec![0.0; self.whole.len()];
        let within = self.values.partition_point(|&own| own <= value);
        self.points[..within].iter().for_each(|&(weight, replicate)| sums[replicate] += weight);
        sums
    }

    /// Distances of the quantiles a share `error` below and above `share` from that at `share`. None if one of them lies outside of 0 to 1.
    fn reach(&self, share: f64, error: f64) -> Option<[f64; 2]> {
        let (low, high) = (share - error, share + error);
        let middle = self.values[self.place(share)];
        (low > 0.0 && high < 1.0)
            .then(|| [middle - self.values[self.place(low)], self.values[self.place(high)] - middle])
    }
}

/// Reported quantiles of points of equal weight, each with the index of its randomisation. None at a probability that the points do not
/// resolve.
pub(crate) fn reported_quantiles(
    points: impl Iterator<Item = (f64, usize)>,
    replicates: usize,
) -> [Option<EstimatedQuantile>; 7] {
    let points: Vec<(f64, f64, usize)> = points.map(|(value, replicate)| (value, 1.0, replicate)).collect();
    let one = 1.0 / points.len().max(1) as f64;
    let Some(sample) = OrderedSample::of(&points, replicates) else { return [None; 7] };
    let found = quantiles(&sample, None, &REPORTED_QUANTILES, one).into_iter();
    let estimate =
        |found: SampleQuantile| EstimatedQuantile { value: found.plain.value, error: Some(found.plain.error) };
    found.map(|found| found.map(estimate)).collect::<Vec<_>>().try_into().unwrap_or([None; 7])
}

/// Quantiles of the model at shares in (0, 1), and those of a surface at the same points. None for a share that is not resolved: its error
/// reaches 0 or 1.
///
/// `one` is the weight of a point, which is part of every error: a rare event may exist although no point shows it.
pub(super) fn quantiles(
    model: &OrderedSample,
    surface: Option<&OrderedSample>,
    tails: &[(LawTail, f64)],
    one: f64,
) -> Vec<Option<SampleQuantile>> {
    let ratio = |total: &[f64]| vec![total[0] / total[1]];
    let difference = |total: &[f64]| vec![(total[0] - total[2]) / total[1]];
    let error_of = |of: &dyn Fn(&[f64]) -> Vec<f64>, sums: Vec<Vec<f64>>| {
        ReplicateSums::by_sum(sums).estimates(of)[0].with_point(one).error
    };
    let quantile = |&(tail, p): &(LawTail, f64)| -> Option<SampleQuantile> {
        let share = match tail {
            LawTail::Lower => p,
            LawTail::Upper => 1.0 - p,
        };
        let place = model.place(share);
        // Scatter of the share up to the quantile over the randomisations, with the share that no point may have shown.
        let [up_to, whole] = [model.up_to(place), model.whole.clone()];
        let of_share = error_of(&ratio, vec![up_to.clone(), whole.clone()]);
        let [down, up] = model.reach(share, of_share)?;
        let plain = Verified { value: model.values[place], error: down.max(up) };
        let paired = surface.and_then(|surface| {
            let own = surface.place(share);
            let apart = error_of(&difference, vec![up_to, whole, surface.up_to(own)]);
            let [own_down, own_up] = surface.reach(share, of_share)?;
            let [less, more] = model.reach(share, apart)?;
            let ratio = (down + up) / (own_down + own_up);
            Some(PairedQuantile { surface: surface.values[own], error: less.max(more), ratio })
        });
        Some(SampleQuantile { plain, paired: paired.filter(|paired| paired.ratio.is_finite()) })
    };
    tails.iter().map(quantile).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sensitol_numeric::pearson::Pearson;

    const TAILS: [(LawTail, f64); 3] = [(LawTail::Lower, 0.01), (LawTail::Lower, 0.5), (LawTail::Upper, 0.001)];

    /// Evenly spaced quantiles of a normal distribution, dealt to 16 randomisations.
    fn normal(count: usize, of: impl Fn(f64) -> f64) -> OrderedSample {
        let law = Pearson::normal(0.0, 1.0).unwrap();
        let value = |i: usize| of(law.quantile((i as f64 + 0.5) / count as f64));
        OrderedSample::of(&(0..count).map(|i| (value(i), 1.0, i % 16)).collect::<Vec<_>>(), 16).unwrap()
    }

    /// Quantiles of a normal distribution, from tables: -2.326348, 0, 3.090232.
    #[test]
    fn quantiles_of_a_normal_sample_are_those_of_tables() {
        let sample = normal(200_000, |z| z);
        for (found, exact) in quantiles(&sample, None, &TAILS, 5e-6).into_iter().zip([-2.326_348, 0.0, 3.090_232]) {
            let plain = found.unwrap().plain;
            assert!((plain.value - exact).abs() <= plain.error && plain.error < 0.01, "{plain:?} for {exact}");
        }
    }

    /// A model that is its surface has the quantile of the surface's distribution, with the error of that and of one point.
    #[test]
    fn a_model_that_is_its_surface_has_the_quantiles_of_its_law() {
        let sample = normal(20_000, |z| z);
        let found = quantiles(&sample, Some(&sample), &TAILS, 1e-5)[0].unwrap();
        let law = LawFigure::counted(-2.326_347_874, 1e-9);
        let paired = found.with_law(Some(law));
        assert!((paired.value - law.value).abs() < 1e-12 && paired.error < 2e-3 && paired.error < found.plain.error);
    }

    /// A quantile within a step of the model has an error that reaches to the next step, with a smooth surface beside it too.
    #[test]
    fn a_step_widens_the_error_of_a_quantile() {
        let (steps, smooth) = (normal(20_000, f64::round), normal(20_000, |z| z));
        // The share up to -0.5 is 0.308538: the quantile there lies at the end of a step.
        let at = [(LawTail::Lower, 0.308_538)];
        let found = quantiles(&steps, Some(&smooth), &at, 1e-4)[0].unwrap();
        let law = LawFigure::counted(-0.5, 1e-9);
        assert!(found.with_law(Some(law)).error >= 1.0, "{found:?}");
    }

    /// Integers keep the order of doubles of either sign.
    #[test]
    fn integers_have_the_order_of_doubles() {
        let values = [f64::MIN, -2.5, -1e-300, -0.0, 0.0, 1e-300, 1.0, 2.5, f64::MAX];
        assert!(values.windows(2).all(|two| ordered_bits(two[0]) < ordered_bits(two[1])));
    }

    /// A share of less than the weight of one point is not resolved.
    #[test]
    fn a_share_below_the_weight_of_a_point_has_no_quantile() {
        let sample = normal(1000, |z| z);
        assert_eq!(quantiles(&sample, None, &[(LawTail::Upper, 1e-4)], 1e-3), [None]);
    }
}
