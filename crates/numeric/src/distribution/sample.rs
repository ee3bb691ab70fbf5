//! Measured values: the distinct ones with their counts, and the moments of the distribution that has them as atoms.

use rand::{Rng, RngExt};

use crate::distribution::{DistributionError, Jacobi, Rule, StandardMoments, finite, positive};
use crate::elementary::Double;

/// Measured values as a distribution that gives each of them the same probability, `1/n`.
///
/// Mean, sigma and moments are those of this one distribution. Sigma divides by `n`, not by `n - 1`, and so do moments 3 to 8. Quantiles
/// and resamples belong to the same distribution. The error of a sample of this size is estimated by resamples.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    values: Vec<f64>,
    counts: Vec<u32>,
    /// Number of measured values that are at most each of the distinct ones.
    upto: Vec<usize>,
    mean: f64,
    sigma: f64,
    standard: Vec<f64>,
}

/// Distribution of a sample after the counts of its values have changed.
#[derive(Debug, Clone, PartialEq)]
pub struct Reweighted {
    /// Change of the mean, in sigmas of the sample.
    pub shift: f64,
    /// New sigma, in sigmas of the sample; 0 if only one distinct value is left.
    pub stretch: f64,
    /// Moments 3 to 8 of `v = (u - shift)/stretch`; NaN for those that do not exist.
    pub moments: StandardMoments,
    /// Rule that integrates polynomials of `v`.
    pub rule: Rule,
}

/// Distribution that follows from measured values.
pub trait Resample: Sync {
    /// Measured values.
    fn sample(&self) -> &Sample;

    /// Distribution if the distinct value `i` had been measured `counts[i]` times, not all of them 0.
    fn reweighted(&self, counts: &[u32]) -> Reweighted;
}

impl Sample {
    /// Sample of these values, in any order.
    ///
    /// # Errors
    /// Returns an error if a value is not finite, or if there are not two different ones.
    ///
    /// ```
    /// use sensitol_numeric::distribution::sample::Sample;
    /// let sample = Sample::new(&[2.0, 1.0, 2.0, 3.0])?;
    /// assert_eq!((sample.len(), sample.values(), sample.counts()), (4, &[1.0, 2.0, 3.0][..], &[1, 2, 1][..]));
    /// assert_eq!((sample.mean(), sample.sigma()), (2.0, 0.5f64.sqrt()));
    /// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
    /// ```
    pub fn new(measured: &[f64]) -> Result<Self, DistributionError> {
        for &value in measured {
            finite("a measured value", value)?;
        }
        let mut sorted = measured.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let (mut values, mut counts): (Vec<f64>, Vec<u32>) = (Vec::new(), Vec::new());
        for value in sorted {
            match (values.last(), counts.last_mut()) {
                (Some(&last), Some(count)) if last == value => *count += 1,
                _ => {
                    values.push(value);
                    counts.push(1);
                }
            }
        }
        if values.len() < 2 {
            return Err(DistributionError::NoVariation { count: measured.len(), value: values.first().copied() });
        }
        let upto = counts.iter().scan(0, |sum, &count| {
            *sum += count as usize;
            Some(*sum)
        });
        let upto = upto.collect();
        // Count from one of the values, so that a large offset costs no digit of the deviations. Scale by the largest deviation, so that no
        // square leaves the range of a double.
        let origin = values[values.len() / 2];
        let scale = values.iter().map(|value| (value - origin).abs()).fold(0.0, f64::max);
        positive("the range of the measured values", scale)?;
        let mut standard: Vec<f64> = values.iter().map(|value| (value - origin) / scale).collect();
        let n = measured.len() as f64;
        let average = |terms: &mut dyn Iterator<Item = f64>| f64::from(terms.fold(Double::from(0.0), |a, b| a + b)) / n;
        let mean = average(&mut standard.iter().zip(&counts).map(|(u, &count)| f64::from(count) * u));
        standard.iter_mut().for_each(|u| *u -= mean);
        let sigma = average(&mut standard.iter().zip(&counts).map(|(u, &count)| f64::from(count) * u * u)).sqrt();
        standard.iter_mut().for_each(|u| *u /= sigma);
        Ok(Self { mean: origin + scale * mean, sigma: scale * sigma, values, counts, upto, standard })
    }

    /// Number of measured values.
    #[expect(clippy::len_without_is_empty, reason = "a sample without values cannot be")]
    pub fn len(&self) -> usize {
        self.upto[self.upto.len() - 1]
    }

    /// Distinct values, ascending.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Number of times that each distinct value was measured.
    pub fn counts(&self) -> &[u32] {
        &self.counts
    }

    /// Number of measured values that are at most each of the distinct ones.
    pub fn upto(&self) -> &[usize] {
        &self.upto
    }

    /// Mean of the values.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Root of the mean squared deviation, divided by `n` as for the distribution that has these values.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Standardised distinct values, `(value - mean)/sigma`.
    pub fn standard(&self) -> &[f64] {
        &self.standard
    }

    /// Moments 3 to 8 of `(value - mean)/sigma`, in two passes about the mean.
    pub fn moments(&self) -> StandardMoments {
        moments(&self.standard, &self.counts)
    }

    /// Recurrence of the distribution that has these values as atoms, up to `order` or the number of distinct values.
    ///
    /// Method: Gragg and Harwood (1984). The atoms are added one by one by plane rotations, which is stable for any number of them.
    pub fn jacobi(&self, order: usize) -> Jacobi {
        let atoms = self.values.len();
        let rows = order.min(atoms);
        // Squares of the off-diagonal elements below the diagonal; the first is the whole mass.
        let (mut alpha, mut beta) = (vec![0.0; rows + 1], vec![0.0; rows + 1]);
        for (added, (&u, &count)) in self.standard.iter().zip(&self.counts).enumerate() {
            let (mut incoming, mut gamma, mut sigma, mut t) = (f64::from(count), 1.0, 0.0, 0.0);
            for row in 0..=added.min(rows) {
                let last = if row == added { u } else { alpha[row] };
                let rho = beta[row] + incoming;
                let (kept, before) = (gamma * rho, sigma);
                (gamma, sigma) = if rho <= 0.0 { (1.0, 0.0) } else { (beta[row] / rho, incoming / rho) };
                let next = sigma * (last - u) - gamma * t;
                alpha[row] = last - (next - t);
                t = next;
                incoming = if sigma <= 0.0 { before * beta[row] } else { t * t / sigma };
                beta[row] = kept;
            }
        }
        alpha.truncate(rows);
        beta.remove(0);
        // These are known exactly: mean 0, variance 1, and the number of atoms.
        alpha[0] = 0.0;
        beta[0] = 1.0;
        if rows == atoms {
            beta[rows - 1] = 0.0;
        }
        Jacobi::new(alpha, beta)
    }

    /// Draws as many values as were measured, with replacement, and writes the count of each distinct one.
    pub fn draw(&self, rng: &mut dyn Rng, counts: &mut Vec<u32>) {
        counts.clear();
        counts.resize(self.values.len(), 0);
        for _ in 0..self.len() {
            counts[self.atom(rng.random_range(0..self.len()))] += 1;
        }
    }

    /// Index of the distinct value at this rank of all measured values in ascending order.
    pub(super) fn atom(&self, rank: usize) -> usize {
        if self.values.len() == self.len() { rank } else { self.upto.partition_point(|&upto| upto <= rank) }
    }

    /// [`Resample::reweighted`] of the distribution that has these values as atoms.
    pub(super) fn reweighted(&self, counts: &[u32]) -> Reweighted {
        let total: f64 = counts.iter().map(|&count| f64::from(count)).sum();
        let present = || self.standard.iter().zip(counts).filter(|&(_, &count)| count > 0);
        let over = |f: &dyn Fn(f64) -> f64| present().map(|(&u, &count)| f64::from(count) * f(u)).sum::<f64>() / total;
        let shift = over(&|u| u);
        let stretch = over(&|u| (u - shift) * (u - shift)).sqrt();
        if present().nth(1).is_none() || stretch == 0.0 {
            let rule = Rule { nodes: vec![0.0], weights: vec![1.0] };
            return Reweighted { shift, stretch: 0.0, moments: StandardMoments::NORMAL, rule };
        }
        let (nodes, present): (Vec<f64>, Vec<u32>) =
            present().map(|(u, &count)| ((u - shift) / stretch, count)).unzip();
        let moments = moments(&nodes, &present);
        let weights = present.iter().map(|&count| f64::from(count) / total).collect();
        Reweighted { shift, stretch, moments, rule: Rule { nodes, weights } }
    }
}

/// Moments 3 to 8 of standardised atoms.
fn moments(standard: &[f64], counts: &[u32]) -> StandardMoments {
    let total: f64 = counts.iter().map(|&count| f64::from(count)).sum();
    let mut sums = [0.0; 6];
    for (&u, &count) in standard.iter().zip(counts) {
        let mut power = f64::from(count) * u * u;
        for sum in &mut sums {
            power *= u;
            *sum += power;
        }
    }
    StandardMoments::from_standard(sums.map(|sum| sum / total))
}
