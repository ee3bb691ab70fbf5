//! Test of the shape of a distribution, with mean and sigma of the values.
//!
//! For a normal shape the statistic is that of Anderson and Darling (1952), whose p-value has a closed form. For another shape it is that of
//! Cramér and von Mises, since a standardised value beyond the ends of a bounded shape would decide the other one alone. Its p-value comes
//! from samples of that shape, each standardised by its own mean and sigma (W. Stute, W. González Manteiga, M. Presedo Quindimil, Bootstrap
//! based goodness-of-fit-tests, Metrika 40 (1993)). Below their least share the tail is continued as an exponential one (T. A. Knijnenburg
//! et al., Fewer permutations, more accurate P-values, Bioinformatics 25 (2009)).

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::distribution::{Distribution, standard_normal};
use crate::lot::LotSample;

/// Seed of the samples, so that a p-value is always the same.
const SEED: u64 = 1;
/// Values drawn for one p-value: some tenths of a second for the slowest quantile functions.
const DRAWN: usize = 400_000;
/// Greatest number of samples: more digits of a p-value than these give have no use.
const SAMPLES: usize = 2000;
/// Smallest number of samples: the tail is fitted to a tenth of them.
const FEWEST: usize = 200;
/// Share of the samples to which the exponential tail is fitted.
const TAIL: f64 = 0.1;
/// Least probability of a value, so that its logarithm is finite.
const LEAST: f64 = 1e-300;

/// Statistic of Anderson and Darling against a normal distribution with the mean and sigma of the values, and its p-value.
///
/// Accuracy: the p-value is that of a fit, with two to three digits.
///
/// Source: R. B. D'Agostino, M. A. Stephens, Goodness-of-Fit Techniques (1986), table 4.9.
pub fn anderson_darling_normal(column: &LotSample) -> (f64, f64) {
    let standard = |value: &f64| (value - column.mean()) / column.sigma();
    let statistic = statistic(column.values(), &|value| {
        let u = standard(&value);
        [standard_normal::cdf(u), standard_normal::cdf(-u)]
    });
    let n = column.count() as f64;
    let corrected = statistic * (1.0 + 0.75 / n + 2.25 / (n * n));
    (statistic, of_normal(corrected))
}

fn of_normal(a: f64) -> f64 {
    /// Statistic from which on the fit would rise again.
    const LARGEST: f64 = 10.0;
    let a = a.min(LARGEST);
    let p = match a {
        a if a >= 0.6 => libm::exp(1.2937 - 5.709 * a + 0.0186 * a * a),
        a if a >= 0.34 => libm::exp(0.9177 - 4.279 * a - 1.38 * a * a),
        a if a >= 0.2 => 1.0 - libm::exp(-8.318 + 42.796 * a - 59.938 * a * a),
        a => 1.0 - libm::exp(-13.436 + 101.14 * a - 223.73 * a * a),
    };
    p.clamp(0.0, 1.0)
}

/// P-value of the shape of an assumed distribution, with mean and sigma of the values. Returns None if only its moments are known, or if
/// it has steps.
///
/// Accuracy: the standard error of a share of up to 2000 samples.
pub fn cramer_von_mises_of_shape(column: &LotSample, assumed: &dyn Distribution) -> Option<f64> {
    let law = assumed.probability().filter(|law| law.atoms().is_empty())?;
    let (mean, sigma) = (assumed.mean(), assumed.sigma());
    let of = |column: &LotSample| {
        let mut sorted = column.values().to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let n = sorted.len() as f64;
        let off = |(place, value): (usize, &f64)| {
            let placed = mean + sigma * (value - column.mean()) / column.sigma();
            law.cdf(placed) - (2 * place + 1) as f64 / (2.0 * n)
        };
        1.0 / (12.0 * n) + sorted.iter().enumerate().map(|one| off(one).powi(2)).sum::<f64>()
    };
    let found = of(column);
    let n = column.count();
    let samples = (DRAWN / n).clamp(FEWEST, SAMPLES);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(SEED);
    let mut values = vec![0.0; n];
    let mut drawn: Vec<f64> = Vec::with_capacity(samples);
    for _ in 0..samples {
        law.fill(&mut rng, &mut values);
        drawn.extend(LotSample::new(&values).map(|sample| of(&sample)));
    }
    drawn.sort_unstable_by(|a, b| b.total_cmp(a));
    let kept = (TAIL * drawn.len() as f64) as usize;
    let edge = *drawn.get(kept)?;
    if found <= edge {
        let above = drawn.partition_point(|one| *one >= found);
        return Some((above as f64 + 1.0) / (drawn.len() as f64 + 1.0));
    }
    let slope = drawn[..kept].iter().map(|one| one - edge).sum::<f64>() / kept as f64;
    Some(TAIL * libm::exp((edge - found) / slope))
}

/// Statistic of Anderson and Darling, from the probabilities below and above every value.
fn statistic(values: &[f64], tails: &dyn Fn(f64) -> [f64; 2]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let tails: Vec<[f64; 2]> = sorted.iter().map(|value| tails(*value)).collect();
    let n = tails.len();
    let term = |place: usize| {
        let weight = (2 * place + 1) as f64;
        weight * (libm::log(tails[place][0].max(LEAST)) + libm::log(tails[n - 1 - place][1].max(LEAST)))
    };
    -(n as f64) - (0..n).map(term).sum::<f64>() / n as f64
}
