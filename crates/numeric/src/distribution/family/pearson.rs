//! Pearson distribution of a dimension, fitted to measured values or given by four moments.

use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Resample, Reweighted, Sample, StandardMoments,
};
use crate::pearson::Pearson;

/// Member of the Pearson system with a given mean, sigma, skewness and kurtosis.
///
/// Fitted to measured values it has their first four moments with the divisor `n`, as in [`Sample`]. A characteristic that is linear in the
/// dimension then has the same four moments by either distribution. These moments are biased in small samples: for a normal distribution by
/// `1/2n` of sigma and by about `-6/n` in the kurtosis. A correction would increase the scatter. The effect of the scatter on the result is
/// in the report's sampling interval.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, PearsonLaw};
/// // Skewness 2 and kurtosis 9: the exponential distribution, with moments 44, 265, 1854 and 14833.
/// let wear = PearsonLaw::new(1.0, 1.0, 2.0, 6.0)?;
/// let moments = wear.standard_moments();
/// assert_eq!([moments.m5, moments.m6, moments.m7, moments.m8], [44.0, 265.0, 1854.0, 14833.0]);
/// // The tails of a kurtosis of 6 without skewness are so long that the sixth moment is infinite.
/// assert!(PearsonLaw::new(1.0, 1.0, 0.0, 6.0).is_err());
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PearsonLaw {
    law: Pearson,
    recurrence: Recurrence,
    moments: StandardMoments,
    fit: Option<Fit>,
}

/// Values that a distribution was fitted to.
#[derive(Debug, Clone, PartialEq)]
struct Fit {
    sample: Sample,
}

impl PearsonLaw {
    /// Distribution with sigma above 0, and the kurtosis given by its excess over 3.
    ///
    /// # Errors
    /// Returns an error if no distribution has these moments, or if the tails of the one that has are so long that a moment up to the
    /// eighth is infinite.
    pub fn new(mean: f64, sigma: f64, skewness: f64, excess: f64) -> Result<Self, DistributionError> {
        let law = Pearson::with_excess(mean, sigma, skewness, excess).map_err(DistributionError::Pearson)?;
        let recurrence = Recurrence::new(skewness, excess);
        if let Some(order) = (5..=8).find(|&order| !recurrence.has_moment(order)) {
            return Err(DistributionError::InfiniteMoment { order, skewness, kurtosis: 3.0 + excess });
        }
        Ok(Self { law, moments: recurrence.moments(), recurrence, fit: None })
    }

    /// Distribution with the first four moments of measured values.
    ///
    /// # Errors
    /// Returns the errors of [`new`](Self::new): samples with only two different values have moments that no Pearson distribution has. Also
    /// returns an error if a value is not finite, or if there are not two different ones.
    pub fn fitted(values: &[f64]) -> Result<Self, DistributionError> {
        let sample = Sample::new(values)?;
        let moments = sample.moments();
        let law = Self::new(sample.mean(), sample.sigma(), moments.skewness, moments.excess)?;
        Ok(Self { fit: Some(Fit { sample }), ..law })
    }
}

impl Distribution for PearsonLaw {
    fn name(&self) -> &'static str {
        "pearson"
    }

    fn mean(&self) -> f64 {
        self.law.mean()
    }

    fn sigma(&self) -> f64 {
        self.law.sigma()
    }

    /// Moments by the recurrence that follows from Pearson's equation.
    fn standard_moments(&self) -> StandardMoments {
        self.moments
    }

    fn support(&self) -> [f64; 2] {
        self.law.support()
    }

    /// Coefficients in closed form, up to the highest even moment that is finite.
    fn jacobi(&self, order: usize) -> Jacobi {
        self.recurrence.jacobi(order)
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }

    fn measured(&self) -> Option<&dyn Resample> {
        self.fit.as_ref().map(|fit| fit as &dyn Resample)
    }
}

impl Resample for Fit {
    fn sample(&self) -> &Sample {
        &self.sample
    }

    /// Distribution with the first four moments of the resample. Higher moments are NaN if they are infinite.
    fn reweighted(&self, counts: &[u32]) -> Reweighted {
        let empirical = self.sample.reweighted(counts);
        if empirical.stretch == 0.0 {
            return empirical;
        }
        let recurrence = Recurrence::new(empirical.moments.skewness, empirical.moments.excess);
        // With two values only, the two atoms are the only distribution with these four moments, and the rule is theirs.
        let rule = if empirical.rule.nodes.len() > 2 { recurrence.jacobi(RULE).gauss() } else { empirical.rule };
        Reweighted { moments: recurrence.moments(), rule, ..empirical }
    }
}

/// Number of nodes, which integrate the fourth power of a quartic exactly.
const RULE: usize = 9;

impl Probability for PearsonLaw {
    fn density(&self, x: f64) -> Option<f64> {
        Some(self.law.pdf(x))
    }

    fn cdf(&self, x: f64) -> f64 {
        self.law.cdf(x)
    }

    fn sf(&self, x: f64) -> f64 {
        self.law.sf(x)
    }

    fn quantile(&self, p: f64) -> f64 {
        self.law.quantile(p)
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.law.upper_quantile(p)
    }
}

/// Coefficients of `(C0 + C1 z + C2 z^2) p' = -(C1 + D z) p`, as in [`crate::pearson`], and their consequences by partial integration.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Recurrence {
    c0: f64,
    c1: f64,
    c2: f64,
    d: f64,
    skewness: f64,
    excess: f64,
}

impl Recurrence {
    fn new(skewness: f64, excess: f64) -> Self {
        let square = skewness * skewness;
        Self {
            c0: 12.0 + 4.0 * excess - 3.0 * square,
            c1: skewness * (6.0 + excess),
            c2: 2.0 * excess - 3.0 * square,
            d: 12.0 + 10.0 * excess - 12.0 * square,
            skewness,
            excess,
        }
    }

    /// True if the moment is finite. The density falls as the power `-D/C2`, which must be below `-(order + 1)`.
    fn has_moment(&self, order: usize) -> bool {
        self.c2 <= 0.0 || self.d > (order + 1) as f64 * self.c2
    }

    /// Moments by `(D - (n + 2) C2) m[n+1] = n (C0 m[n-1] + C1 m[n])`; NaN from the first infinite one on.
    fn moments(&self) -> StandardMoments {
        let mut m = [1.0, 0.0, 1.0, self.skewness, 3.0 + self.excess, 0.0, 0.0, 0.0, 0.0];
        for n in 4..8 {
            let next = n as f64 * (self.c0 * m[n - 1] + self.c1 * m[n]) / (self.d - (n + 2) as f64 * self.c2);
            m[n + 1] = if self.has_moment(n + 1) { next } else { f64::NAN };
        }
        let [_, _, _, m3, m4, m5, m6, m7, m8] = m;
        StandardMoments { excess: self.excess, ..StandardMoments::from_standard([m3, m4, m5, m6, m7, m8]) }
    }

    /// Recurrence of the polynomials for a density with `(sigma p)' = tau p`, here with `sigma = C0 + C1 z + C2 z^2` and
    /// `tau = -(C0 + C2) z`. One formula covers those of Jacobi, Laguerre, Hermite, Bessel and Romanovski (Koepf and Schmersau 1998,
    /// theorem 1).
    fn jacobi(&self, order: usize) -> Jacobi {
        let (a, b, c, d) = (self.c2, self.c1, self.c0, -(self.c0 + self.c2));
        let finite = (1..=order).take_while(|n| self.has_moment(2 * n)).count();
        let alpha = |n: usize| match n {
            0 => 0.0,
            _ => {
                let n = n as f64;
                -2.0 * b * n * (a * n + d - a) / ((d + 2.0 * a * n) * (d - 2.0 * a + 2.0 * a * n))
            }
        };
        let beta = |n: usize| match n {
            // The variance.
            1 => 1.0,
            _ => {
                let n = n as f64;
                let before = d + 2.0 * a * (n - 1.0);
                let inner = (n - 1.0) * (a * n + d - a) * (4.0 * a * c - b * b) + d * d * c;
                let outer = (before + a) * (before - a) * before * before;
                -n * (a * (n - 2.0) + d) * inner / outer
            }
        };
        Jacobi::new((0..finite).map(alpha).collect(), (1..=finite).map(beta).collect())
    }
}
