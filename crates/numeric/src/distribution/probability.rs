//! Probabilities of a distribution that is completely known.

use rand::{Rng, RngExt};

use crate::distribution::standard_normal;

/// Density, probabilities, quantiles and samples, in the dimension's own unit.
///
/// Each tail has a function of its own, because `1 - cdf` and `quantile(1 - p)` lose the digits that a small tail needs. At an end of the
/// support the nearer tail is 0 and the other one 1. NaN gives NaN.
///
/// Accuracy, unless a distribution states another one: either probability to 1e-12 relative, quantiles of probabilities from 1e-12 to 1 -
/// 1e-12 to 1e-12 sigma.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Normal};
/// let bore = Normal::new(25.0, 0.01)?;
/// let law = bore.probability().expect("a normal distribution is known whole");
/// assert_eq!(law.cdf(25.0), 0.5);
/// assert!((law.sf(25.03) - 1.349_898_031_630_095e-3).abs() < 1e-15);
/// assert!((law.upper_quantile(1e-9) - 25.0 - 0.059_978_070_150_076_87).abs() < 1e-14);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
pub trait Probability: Send + Sync {
    /// Density per unit of `x`. Returns None if there is none, as for measured values, which are atoms.
    fn density(&self, x: f64) -> Option<f64>;

    /// Probability of a value of at most `x`: the cumulative distribution function.
    fn cdf(&self, x: f64) -> f64;

    /// Probability of a value above `x`: the survival function.
    fn sf(&self, x: f64) -> f64;

    /// Least value whose `cdf` is at least `p`. Returns NaN if `p` is not a probability.
    fn quantile(&self, p: f64) -> f64;

    /// Value above which the probability is `p`, with the digits of a small `p`. Returns NaN if `p` is not a probability.
    fn upper_quantile(&self, p: f64) -> f64;

    /// Points inside the support at which the density is not smooth, ascending: corners and jumps at which a quadrature splits.
    ///
    /// Empty by default: the density is smooth between the ends of the support.
    fn corners(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Values that have a probability of their own, ascending, with that probability. Empty if there is a density only.
    fn atoms(&self) -> Vec<(f64, f64)> {
        Vec::new()
    }

    /// Density of the part outside the [`atoms`](Self::atoms).
    fn smooth_density(&self, x: f64) -> f64 {
        self.density(x).unwrap_or(0.0)
    }

    /// Replaces probabilities by quantiles. The probabilities are above 0, counted from the nearer end: `p` from below, `-p` from above.
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

/// Value with the same probability below it as `z` has in the standard normal distribution, with the digits of the nearer tail.
pub fn behind_normal(law: &dyn Probability, z: f64) -> f64 {
    if z < 0.0 { law.quantile(standard_normal::cdf(z)) } else { law.upper_quantile(standard_normal::sf(z)) }
}

/// Random probability of at most one half and the end that it is counted from, so that both tails are equally fine.
pub(super) fn random_tail(rng: &mut dyn Rng) -> (f64, bool) {
    (0.5 * rng.sample::<f64, _>(rand_distr::Open01), rng.random())
}

/// Probability limited to its range against rounding. NaN stays NaN.
pub(super) fn clamped(p: f64) -> f64 {
    p.clamp(0.0, 1.0)
}

/// Returns `p` if it is a probability, NaN otherwise.
pub(super) fn checked(p: f64) -> f64 {
    if (0.0..=1.0).contains(&p) { p } else { f64::NAN }
}
