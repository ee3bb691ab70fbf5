//! Empirical distribution of measured values.

use rand::{Rng, RngExt};

use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Resample, Reweighted, Sample, StandardMoments, probability,
};

/// Measured values, each with the same probability: the empirical distribution.
///
/// Its distribution function is a staircase, its quantiles are measured values, and no value lies outside their range. All moments are
/// those of this distribution: see [`Sample`].
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Measured};
/// let pin = Measured::new(&[9.98, 10.00, 10.00, 10.01, 10.03])?;
/// assert_eq!(pin.support(), [9.98, 10.03]);
/// let law = pin.probability().expect("measured values are known whole");
/// assert_eq!((law.quantile(0.5), law.cdf(10.0), law.density(10.0)), (10.0, 0.6, None));
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    sample: Sample,
    moments: StandardMoments,
    jacobi: Jacobi,
}

/// Highest order that quadrature needs at once. A higher order is computed when it is needed.
const ORDER: usize = 9;

impl Measured {
    /// Distribution of these values, in any order.
    ///
    /// # Errors
    /// Returns an error if a value is not finite, or if there are not two different ones.
    pub fn new(values: &[f64]) -> Result<Self, DistributionError> {
        let sample = Sample::new(values)?;
        Ok(Self { moments: sample.moments(), jacobi: sample.jacobi(ORDER), sample })
    }

    fn share(&self, count: usize) -> f64 {
        count as f64 / self.sample.len() as f64
    }

    /// Value at this index in ascending order.
    fn at(&self, rank: usize) -> f64 {
        self.sample.values()[self.sample.atom(rank)]
    }

    /// Number of values that are at most `x`.
    fn at_most(&self, x: f64) -> usize {
        match self.sample.values().partition_point(|&value| value <= x) {
            0 => 0,
            distinct => self.sample.upto()[distinct - 1],
        }
    }

    /// Least count whose share is at least `p`. Shares are compared directly, because `p n` is rounded.
    fn least_count(&self, p: f64) -> usize {
        let mut count = ((p * self.sample.len() as f64).ceil() as usize).min(self.sample.len());
        while count > 0 && self.share(count - 1) >= p {
            count -= 1;
        }
        while count < self.sample.len() && self.share(count) < p {
            count += 1;
        }
        count
    }
}

impl Distribution for Measured {
    fn name(&self) -> &'static str {
        "measured"
    }

    fn mean(&self) -> f64 {
        self.sample.mean()
    }

    fn sigma(&self) -> f64 {
        self.sample.sigma()
    }

    fn standard_moments(&self) -> StandardMoments {
        self.moments
    }

    /// Least and greatest measured value.
    fn support(&self) -> [f64; 2] {
        let values = self.sample.values();
        [values[0], values[values.len() - 1]]
    }

    fn jacobi(&self, order: usize) -> Jacobi {
        if order <= ORDER { self.jacobi.truncated(order) } else { self.sample.jacobi(order) }
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }

    fn measured(&self) -> Option<&dyn Resample> {
        Some(self)
    }
}

impl Resample for Measured {
    fn sample(&self) -> &Sample {
        &self.sample
    }

    fn reweighted(&self, counts: &[u32]) -> Reweighted {
        self.sample.reweighted(counts)
    }
}

/// Staircase: `cdf` of the least value is its share, not 0.
impl Probability for Measured {
    /// Returns None, because the values are atoms.
    fn density(&self, _: f64) -> Option<f64> {
        None
    }

    /// Distinct values with their shares.
    fn atoms(&self) -> Vec<(f64, f64)> {
        let share = |&count: &u32| self.share(count as usize);
        self.sample.values().iter().copied().zip(self.sample.counts().iter().map(share)).collect()
    }

    fn cdf(&self, x: f64) -> f64 {
        if x.is_nan() { f64::NAN } else { self.share(self.at_most(x)) }
    }

    fn sf(&self, x: f64) -> f64 {
        if x.is_nan() { f64::NAN } else { self.share(self.sample.len() - self.at_most(x)) }
    }

    /// Least value whose `cdf` is at least `p`; for `p` of 0 the least value.
    fn quantile(&self, p: f64) -> f64 {
        match probability::checked(p) {
            p if p.is_nan() => p,
            p => self.at(self.least_count(p).max(1) - 1),
        }
    }

    /// Least value with at most `p` above it.
    fn upper_quantile(&self, p: f64) -> f64 {
        let p = probability::checked(p);
        if p.is_nan() {
            return p;
        }
        let least = self.least_count(p);
        let above = if self.share(least) > p { least - 1 } else { least };
        self.at(self.sample.len() - 1 - above.min(self.sample.len() - 1))
    }

    /// Measured values, drawn with replacement.
    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        out.iter_mut().for_each(|value| *value = self.at(rng.random_range(0..self.sample.len())));
    }
}
