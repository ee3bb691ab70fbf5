//! The probabilities of a distribution that is known whole.

use rand::{Rng, RngExt};

use super::standard_normal;

/// Density, probabilities, quantiles and samples, in the dimension's own unit.
///
/// Both tails are asked for by name, because `1 - cdf` and `quantile(1 - p)` have lost the digits that a small tail needs.
/// At an end of the support the nearer tail is 0 and the other one 1; NaN gives NaN.
///
/// Accuracy: relative 1e-12 of either probability, quantiles of probabilities from 1e-12 to 1 - 1e-12 to 1e-12 sigma,
/// unless a distribution says otherwise.
///
/// ```
/// use crate::distribution::{Distribution, Normal};
/// let bore = Normal::new(25.0, 0.01)?;
/// let law = bore.probability().expect("a normal distribution is known whole");
/// assert_eq!(law.cdf(25.0), 0.5);
/// assert!((law.sf(25.03) - 1.349_898_031_630_095e-3).abs() < 1e-15);
/// assert!((law.upper_quantile(1e-9) - 25.0 - 0.059_978_070_150_076_87).abs() < 1e-14);
/// # Ok::<(), crate::distribution::DistributionError>(())
/// ```
pub trait Probability: Send + Sync {
    /// Density per unit of `x`; None where there is none, as for measured values, which are atoms.
    fn density(&self, x: f64) -> Option<f64>;

    /// Probability of at most `x`: the cumulative distribution function.
    fn cdf(&self, x: f64) -> f64;

    /// Probability of more than `x`: the survival function.
    fn sf(&self, x: f64) -> f64;

    /// The least value whose `cdf` is at least `p`; NaN where `p` is not a probability.
    fn quantile(&self, p: f64) -> f64;

    /// The value above which the probability is `p`, with the digits of a small `p`; NaN where `p` is not a probability.
    fn upper_quantile(&self, p: f64) -> f64;

    /// Where the density is not smooth inside the support, ascending: corners and jumps at which a quadrature splits.
    ///
    /// Empty by default: the density is smooth between the ends of the support.
    fn corners(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Values that have a probability of their own, ascending, with that probability; empty where there is a density.
    fn atoms(&self) -> Vec<(f64, f64)> {
        Vec::new()
    }

    /// Density of what is not in the [`atoms`](Self::atoms).
    fn smooth_density(&self, x: f64) -> f64 {
        self.density(x).unwrap_or(0.0)
    }

    /// Puts quantiles in the place of probabilities above 0, counted from the nearer end: `p` from below, `-p` from above.
    fn quantiles(&self, tails: &mut [f64]) {
        for tail in tails {
            *tail = if *tail < 0.0 { self.upper_quantile(-*tail) } else { self.quantile(*tail) };
        }
    }

    /// Fills `out` with independent random values.
    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        for value in out {
            let (p, upper) = random_tail(rng);
            *value = if upper { self.upper_quantile(p) } else { self.quantile(p) };
        }
    }
}

/// The value that stands where `z` stands in a standard normal distribution, with the digits of the nearer tail.
pub fn behind_normal(law: &dyn Probability, z: f64) -> f64 {
    if z < 0.0 { law.quantile(standard_normal::cdf(z)) } else { law.upper_quantile(standard_normal::sf(z)) }
}

/// A random probability of at most one half and the end that it is counted from, so that both tails are as fine.
pub(super) fn random_tail(rng: &mut dyn Rng) -> (f64, bool) {
    (0.5 * rng.sample::<f64, _>(rand_distr::Open01), rng.random())
}

/// A probability that rounding has not pushed out of its range; NaN stays NaN.
pub(super) fn clamped(p: f64) -> f64 {
    p.clamp(0.0, 1.0)
}

/// `p` if it is a probability, NaN if not.
pub(super) fn checked(p: f64) -> f64 {
    if (0.0..=1.0).contains(&p) { p } else { f64::NAN }
}
