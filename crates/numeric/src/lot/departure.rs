//! Name of a shape that is not normal: the alternative with the greatest likelihood after the penalty for its parameters.
//!
//! Candidates are a mixture of two normal distributions of one sigma (two tools, two cavities), and a normal distribution cut at one end
//! or both (parts that were sorted out). Each is fitted by maximum likelihood and pays `ln(n)/2` for each parameter beyond two (G. Schwarz,
//! Estimating the dimension of a model, Annals of Statistics 6 (1978)). The name says which form is the likeliest of these, not its cause.

use serde::Serialize;

use crate::distribution::{outliers, standard_normal};
use crate::lot::LotSample;

/// Steps of expectation and maximisation. The likelihood of well separated parts is at rest after some ten.
const STEPS: usize = 200;
/// Steps of the fit of a cut normal distribution.
const CUT_STEPS: usize = 400;
/// Smallest number of values with a name.
const FEWEST: usize = 15;

/// Most likely shape of values that are not normal.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Departure {
    /// Two groups of parts with different means.
    Mixture {
        /// Means of the two groups.
        means: [f64; 2],
        /// Share of the parts in the second group.
        share: f64,
    },
    /// Parts beyond these ends are missing, as after sorting.
    Truncation {
        /// Ends; null where the distribution is not cut.
        ends: [Option<f64>; 2],
    },
    /// Single values far from all others.
    Outliers {
        /// These values, farthest first.
        values: Vec<f64>,
    },
    /// Skewed values without any of these forms.
    Skewness {
        /// Third standardised moment.
        skewness: f64,
    },
    /// Symmetric values without any of these forms.
    Kurtosis {
        /// Fourth standardised moment.
        kurtosis: f64,
    },
}

/// Likeliest form of values that a test of normality refutes. Returns None of fewer than 15 values.
///
/// ```
/// use sensitol_numeric::lot::{Departure, LotSample, likeliest_departure};
/// let two_tools: Vec<f64> = (0..40).map(|i| f64::from(i % 2) * 10.0 + f64::from(i % 5) * 0.3).collect();
/// let found = likeliest_departure(&LotSample::new(&two_tools).unwrap());
/// assert!(matches!(found, Some(Departure::Mixture { share, .. }) if (share - 0.5).abs() < 1e-6));
/// ```
pub fn likeliest_departure(column: &LotSample) -> Option<Departure> {
    let values = column.values();
    if values.len() < FEWEST {
        return None;
    }
    let far = outliers(values);
    if !far.is_empty() {
        return Some(Departure::Outliers { values: far.into_iter().map(|place| values[place]).collect() });
    }
    let u: Vec<f64> = values.iter().map(|value| (value - column.mean()) / column.sigma()).collect();
    let back = |u: f64| column.mean() + column.sigma() * u;
    let cost = 0.5 * libm::log(u.len() as f64);
    let normal = log_likelihood(&u, &|u| standard_normal::density(u));
    let mut best: Option<(f64, Departure)> = None;
    let mut offer = |gain: f64, departure: Departure| {
        if gain > best.as_ref().map_or(0.0, |(best, _)| *best) {
            best = Some((gain, departure));
        }
    };
    let (means, share, likelihood) = mixture(&u);
    offer(likelihood - normal - 2.0 * cost, Departure::Mixture { means: means.map(back), share });
    let [least, most] = [u.iter().copied().fold(f64::MAX, f64::min), u.iter().copied().fold(f64::MIN, f64::max)];
    for ends in [[Some(least), None], [None, Some(most)], [Some(least), Some(most)]] {
        let gain = cut_likelihood(&u, ends) - normal - ends.iter().flatten().count() as f64 * cost;
        offer(gain, Departure::Truncation { ends: ends.map(|end| end.map(back)) });
    }
    let moment = |order: i32| {
        let n = u.len() as f64;
        let spread = u.iter().map(|u| u * u).sum::<f64>() / n;
        u.iter().map(|u| u.powi(order)).sum::<f64>() / n / libm::pow(spread, 0.5 * f64::from(order))
    };
    Some(best.map_or_else(
        || {
            let (skewness, kurtosis) = (moment(3), moment(4));
            // Standard errors of normal values: sqrt(6/n) and sqrt(24/n).
            match skewness.abs() > 0.5 * (kurtosis - 3.0).abs() {
                true => Departure::Skewness { skewness },
                false => Departure::Kurtosis { kurtosis },
            }
        },
        |(_, departure)| departure,
    ))
}

fn log_likelihood(u: &[f64], density: &dyn Fn(f64) -> f64) -> f64 {
    u.iter().map(|u| libm::log(density(*u).max(f64::MIN_POSITIVE))).sum()
}

/// Means, share of the second group and log-likelihood of a mixture of two normal distributions with one sigma.
fn mixture(u: &[f64]) -> ([f64; 2], f64, f64) {
    let mut sorted = u.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let n = u.len() as f64;
    let mut best = ([0.0; 2], 0.5, f64::MIN);
    // The split with which the search begins decides where it ends, so three are tried.
    for split in [0.25, 0.5, 0.75] {
        let (low, high) = sorted.split_at((split * n) as usize);
        let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        let (mut means, mut share, mut sigma) = ([mean(low), mean(high)], 1.0 - split, 0.6);
        let density = |u: f64, mean: f64, sigma: f64| standard_normal::density((u - mean) / sigma) / sigma;
        for _ in 0..STEPS {
            let second = |u: f64| {
                let parts = [(1.0 - share) * density(u, means[0], sigma), share * density(u, means[1], sigma)];
                if parts[0] + parts[1] > 0.0 { parts[1] / (parts[0] + parts[1]) } else { 0.5 }
            };
            let weights: Vec<f64> = u.iter().map(|u| second(*u)).collect();
            let count: f64 = weights.iter().sum();
            if !(count > 1.0 && count < n - 1.0) {
                break;
            }
            let weighted = |side: usize| {
                let own = |weight: f64| if side == 1 { weight } else { 1.0 - weight };
                let total: f64 = weights.iter().map(|weight| own(*weight)).sum();
                u.iter().zip(&weights).map(|(u, weight)| own(*weight) * u).sum::<f64>() / total
            };
            means = [weighted(0), weighted(1)];
            share = count / n;
            let off =
                |(u, weight): (&f64, &f64)| (1.0 - weight) * (u - means[0]).powi(2) + weight * (u - means[1]).powi(2);
            let squares: f64 = u.iter().zip(&weights).map(off).sum();
            sigma = (squares / n).sqrt().max(1e-3);
        }
        let both = |u: f64| (1.0 - share) * density(u, means[0], sigma) + share * density(u, means[1], sigma);
        let likelihood = log_likelihood(u, &both);
        if likelihood > best.2 {
            best = (means, share, likelihood);
        }
    }
    best
}

/// Greatest log-likelihood of a normal distribution cut at these ends.
fn cut_likelihood(u: &[f64], ends: [Option<f64>; 2]) -> f64 {
    let of = |[mean, log_sigma]: [f64; 2]| {
        let sigma = libm::exp(log_sigma);
        let tail = |end: f64| standard_normal::cdf((end - mean) / sigma);
        let above = ends[1].map_or(1.0, tail);
        let below = ends[0].map_or(0.0, tail);
        let kept = (above - below).max(f64::MIN_POSITIVE);
        log_likelihood(u, &|u| standard_normal::density((u - mean) / sigma) / (sigma * kept))
    };
    // A search along both axes with steps that shrink when neither helps: the function has one maximum.
    let (mut at, mut step) = ([0.0, 0.0], 0.5);
    let mut best = of(at);
    for _ in 0..CUT_STEPS {
        let moves = [[step, 0.0], [-step, 0.0], [0.0, step], [0.0, -step]];
        // Beyond these ends the distribution is all but a line over the values.
        let inside = |[mean, log_sigma]: &[f64; 2]| mean.abs() < 5.0 && log_sigma.abs() < 1.5;
        let tried =
            moves.map(|by| [at[0] + by[0], at[1] + by[1]]).into_iter().filter(inside).map(|place| (of(place), place));
        match tried.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((value, place)) if value > best => (best, at) = (value, place),
            _ => step *= 0.5,
        }
        if step < 1e-4 {
            break;
        }
    }
    best
}
