//! Tails of a sample in strata, for comparison with a fitted distribution.

use serde::Serialize;

use crate::estimate::replicate_sums::ReplicateSums;
use crate::estimate::verified::Verified;
use sensitol_numeric::power::rescale;

/// Greatest number of points of a tail.
const SHOWN: usize = 40;
/// Share at which a tail begins.
const FROM: f64 = 0.1;
/// Share at which a tail ends. Points in the strata of the tails weigh less the farther out they are.
const TO: f64 = 1e-6;
/// Smallest number of points at or beyond the last value: a share of fewer is meaningless.
const FEWEST: usize = 4;

/// Tails of a sample on every side with a limit: from 10 % to 1 ppm or the last few points, in even steps of the logarithm.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SampleTails {
    /// Tail towards the lower limit. Empty if there is none.
    pub below: Vec<TailPoint>,
    /// Tail towards the upper limit. Empty if there is none.
    pub above: Vec<TailPoint>,
}

/// A value of the characteristic, and the share of the assemblies at or beyond it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TailPoint {
    /// Value of the characteristic.
    pub at: f64,
    /// Share of the assemblies at or beyond the value.
    pub share: f64,
    /// Estimated error of the share; null if all values are of one randomisation, so that there is no scatter.
    pub error: Option<f64>,
}

rescale!(SampleTails { below, above } without {});
rescale!(TailPoint { at } without { share, error });

/// A value with its weight and its randomisation.
pub(super) type Weighed = (f64, f64, usize);

/// Tail of finite values towards one side. `one` is the weight of a point, which is part of the error.
pub(super) fn tail(values: &[Weighed], above: bool, (replicates, one): (usize, f64)) -> Vec<TailPoint> {
    let mut whole = vec![0.0; replicates];
    values.iter().for_each(|&(_, weight, replicate)| whole[replicate] += weight);
    let total: f64 = whole.iter().sum();
    // Values on the other side of the mean are no tail, and need not be sorted.
    let mean = values.iter().map(|(value, weight, _)| weight * value).sum::<f64>() / total;
    let beyond = |value: f64| if above { value >= mean } else { value <= mean };
    let mut ordered: Vec<Weighed> = values.iter().copied().filter(|&(value, ..)| beyond(value)).collect();
    ordered.sort_unstable_by(|a, b| if above { b.0.total_cmp(&a.0) } else { a.0.total_cmp(&b.0) });
    let least = ordered.iter().take(FEWEST).map(|(_, weight, _)| weight / total).sum::<f64>().max(TO);
    if ordered.len() < FEWEST || least >= FROM {
        return Vec::new();
    }
    let step = libm::log(FROM / least) / (SHOWN - 1) as f64;
    let mut at = Vec::with_capacity(SHOWN);
    let mut sums: Vec<Vec<f64>> = Vec::with_capacity(SHOWN + 1);
    let mut so_far = vec![0.0; replicates];
    let (mut share, mut next) = (0.0, 0);
    let reached = |share: f64, next: usize| share >= least * libm::exp(step * next as f64) * (1.0 - 1e-9);
    for (place, &(value, weight, replicate)) in ordered.iter().enumerate() {
        so_far[replicate] += weight;
        share += weight / total;
        // A point of the tail includes all values equal to it.
        let last_of_its_value = ordered.get(place + 1).is_none_or(|next| next.0 != value);
        if last_of_its_value && place + 1 >= FEWEST && reached(share, next) {
            at.push(value);
            sums.push(so_far.clone());
            while next < SHOWN && reached(share, next) {
                next += 1;
            }
            if next == SHOWN {
                break;
            }
        }
    }
    sums.push(whole);
    let shares = |total: &[f64]| {
        let (all, parts) = total.split_last().map_or((0.0, total), |(all, parts)| (*all, parts));
        parts.iter().map(|part| part / all).collect::<Vec<f64>>()
    };
    let point = |(at, share): (f64, Verified)| {
        let known = share.error.is_finite();
        TailPoint { at, share: share.value, error: known.then(|| share.with_point(one).error) }
    };
    let estimates = ReplicateSums::by_sum(sums).estimates(shares);
    let mut found: Vec<TailPoint> = at.into_iter().zip(estimates).map(point).collect();
    found.reverse();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use sensitol_numeric::pearson::Pearson;

    /// For 100 000 evenly weighted normal quantiles, the share beyond a value is the normal distribution's to half the weight of a point.
    #[test]
    fn the_tails_of_a_normal_law_are_its_own() {
        const COUNT: usize = 100_000;
        let law = Pearson::new(10.0, 0.5, 0.0, 3.0).unwrap();
        let quantile = |i: usize| law.quantile((i as f64 + 0.5) / COUNT as f64);
        let values: Vec<Weighed> = (0..COUNT).map(|i| (quantile(i), 2.0, i % 16)).collect();
        for above in [false, true] {
            let found = tail(&values, above, (16, 1e-5));
            assert_eq!(found.len(), SHOWN);
            assert!((found[0].share - FROM).abs() < 2e-5 && (found[SHOWN - 1].share - 4e-5).abs() < 1e-12);
            for point in &found {
                let exact = if above { law.sf(point.at) } else { law.cdf(point.at) };
                // A quantile is in the middle of its point's weight.
                assert!((point.share - exact - 0.5 / COUNT as f64).abs() < 1e-9, "{point:?} for {exact}");
                assert!(point.error.unwrap() >= 1e-5);
            }
            assert!(found.windows(2).all(|two| two[1].share < two[0].share && (two[1].at > two[0].at) == above));
        }
    }

    /// Half of all values at each of two ends: there is no share below 10 %.
    #[test]
    fn two_values_have_no_tail() {
        let values: Vec<Weighed> = (0..1000).map(|i| (f64::from(i % 2), 1.0, i as usize % 16)).collect();
        let found = tail(&values, true, (16, 1e-3));
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].at, found[0].share), (1.0, 0.5));
    }

    /// Without the only randomisation that has values there is no share: the error is unknown.
    #[test]
    fn values_of_one_randomisation_have_no_error() {
        let values: Vec<Weighed> = (0..1000).map(|i| (f64::from(i), 1.0, 3)).collect();
        let found = tail(&values, true, (16, 1e-3));
        assert!(!found.is_empty() && found.iter().all(|point| point.error.is_none()), "{found:?}");
    }
}
