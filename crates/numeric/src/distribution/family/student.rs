//! Student's t distribution.

use std::f64::consts::PI;
use std::sync::Arc;

use rand::{Rng, RngExt};

use crate::distribution::inverse::root;
use crate::distribution::probability::checked;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, positive,
};
use crate::pearson::Pearson;

/// Student's t distribution about a mean, with more than 2 degrees of freedom. It describes a value that is known by the mean of few
/// readings, or by a certificate that states degrees of freedom.
///
/// The moment of order `n` exists if `degrees > n`, and is NaN otherwise: with 4 degrees or fewer the kurtosis, with 3 or fewer the
/// skewness. With 2 or fewer there is no sigma, and such a dimension is an error.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Student};
/// // A standard uncertainty of 25 nm with 18 degrees of freedom is the scale.
/// let block = Student::with_scale(50_000_623.0, 25.0, 18.0)?;
/// assert!((block.sigma() - 25.0 * (18.0f64 / 16.0).sqrt()).abs() < 1e-13);
/// assert_eq!(Student::new(0.0, 1.0, 10.0)?.standard_moments().excess, 1.0);
/// assert!(Student::new(0.0, 1.0, 4.0)?.standard_moments().excess.is_nan());
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Student {
    mean: f64,
    sigma: f64,
    degrees: f64,
    law: Tail,
}

/// Method that computes probabilities, in sigmas.
#[derive(Debug, Clone, PartialEq)]
enum Tail {
    /// Pearson's type VII, if the kurtosis exists.
    Pearson(Box<Pearson>),
    /// Series of the incomplete beta function, if it does not.
    Series(Series),
}

/// Distribution of `t` with four degrees or fewer.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Series {
    degrees: f64,
    /// Beta function `B(degrees/2, 1/2)`.
    beta: f64,
}

impl Student {
    /// Distribution with this mean, sigma above 0, and degrees of freedom above 2.
    pub fn new(mean: f64, sigma: f64, degrees: f64) -> Result<Self, DistributionError> {
        let (mean, sigma) = (finite("mean", mean)?, positive("sigma", sigma)?);
        finite("degrees", degrees)?;
        if degrees <= 2.0 {
            return Err(DistributionError::NoSigma { degrees });
        }
        let law = if degrees > 4.0 {
            Tail::Pearson(Box::new(
                Pearson::with_excess(0.0, 1.0, 0.0, 6.0 / (degrees - 4.0)).map_err(DistributionError::Pearson)?,
            ))
        } else {
            Tail::Series(Series::new(degrees))
        };
        Ok(Self { mean, sigma, degrees, law })
    }

    /// Distribution with this scale, `sigma sqrt((degrees - 2)/degrees)`: the standard uncertainty of a certificate, or `s/sqrt n` of `n`
    /// readings with `n - 1` degrees.
    pub fn with_scale(mean: f64, scale: f64, degrees: f64) -> Result<Self, DistributionError> {
        let scale = positive("scale", scale)?;
        if finite("degrees", degrees)? <= 2.0 {
            return Err(DistributionError::NoSigma { degrees });
        }
        Self::new(mean, scale * (degrees / (degrees - 2.0)).sqrt(), degrees)
    }

    fn u(&self, x: f64) -> f64 {
        (x - self.mean) / self.sigma
    }

    /// Probability above `u`, in sigmas.
    fn above(&self, u: f64) -> f64 {
        match &self.law {
            Tail::Pearson(law) => law.sf(u),
            Tail::Series(law) if u < 0.0 => 1.0 - law.above(-u * law.per_sigma()),
            Tail::Series(law) => law.above(u * law.per_sigma()),
        }
    }

    /// Value in sigmas above which the probability is `p`.
    fn with_above(&self, p: f64) -> f64 {
        match &self.law {
            Tail::Pearson(law) => law.upper_quantile(p),
            Tail::Series(law) if p > 0.5 => -law.with_above(1.0 - p) / law.per_sigma(),
            Tail::Series(law) => law.with_above(p) / law.per_sigma(),
        }
    }

    /// Moment of even order of the standardised variable, NaN if it does not exist:
    /// `(2k - 1)!! (n - 2)^(k-1) / ((n - 4) .. (n - 2k))`.
    fn even(&self, k: i32) -> f64 {
        let n = self.degrees;
        if n <= f64::from(2 * k) {
            return f64::NAN;
        }
        (2..=k).map(|i| f64::from(2 * i - 1) * (n - 2.0) / (n - f64::from(2 * i))).product()
    }

    /// Moment of odd order: 0, or NaN if it does not exist.
    fn odd(&self, order: f64) -> f64 {
        if self.degrees > order { 0.0 } else { f64::NAN }
    }
}

impl Series {
    fn new(degrees: f64) -> Self {
        let log = libm::lgamma(0.5 * degrees) - libm::lgamma(0.5 * degrees + 0.5);
        Self { degrees, beta: libm::exp(log) * PI.sqrt() }
    }

    /// Ratio of `t` to the deviation in sigmas.
    fn per_sigma(&self) -> f64 {
        (self.degrees / (self.degrees - 2.0)).sqrt()
    }

    /// Density `(1 + t^2/n)^(-(n+1)/2) / (sqrt n B)` of `t`.
    fn density(&self, t: f64) -> f64 {
        let n = self.degrees;
        libm::exp(-0.5 * (n + 1.0) * log_1p_square(t / n.sqrt())) / (n.sqrt() * self.beta)
    }

    /// Probability above a `t` that is not negative: half the regularised incomplete beta function of `n/(n + t^2)`, or one half minus half
    /// that of the complement.
    fn above(&self, t: f64) -> f64 {
        let (n, r) = (self.degrees, t / self.degrees.sqrt());
        let (a, b) = (0.5 * n, 0.5);
        if r < 1.0 {
            let y = r * r / (1.0 + r * r);
            return 0.5 - 0.5 * r / libm::pow(1.0 + r * r, a + b) / (b * self.beta) * sum(b, a, y);
        }
        if r.is_infinite() {
            return 0.0;
        }
        // x^a (1-x)^b with x = 1/(1 + r^2).
        let power = libm::exp(-a * log_1p_square(r)) * (1.0 / (1.0 + 1.0 / r / r)).sqrt();
        0.5 * power / (a * self.beta) * sum(a, b, 1.0 / (1.0 + r * r))
    }

    /// Value above which the probability is `p`, at most one half. In `z` with `t = sinh z` the logarithm of the tail is nearly straight.
    fn with_above(&self, p: f64) -> f64 {
        match p {
            _ if p.is_nan() => return p,
            0.0 => return f64::INFINITY,
            0.5 => return 0.0,
            _ => {}
        }
        let off = |z: f64| {
            let t = libm::sinh(z);
            let above = self.above(t);
            (libm::log(p / above), self.density(t) * libm::cosh(z) / above)
        };
        // Beyond z = 700 every probability underflows to 0.
        libm::sinh(root([0.0, 700.0], -libm::log(2.0 * p) / self.degrees + 0.5, off))
    }
}

/// `ln(1 + r^2)`, also if the square overflows.
fn log_1p_square(r: f64) -> f64 {
    if r.abs() > 1e100 { 2.0 * libm::log(r.abs()) } else { libm::log1p(r * r) }
}

/// Sum over k of `(a + b)_k/(a + 1)_k x^k`, of positive terms, for an `x` of at most one half.
fn sum(a: f64, b: f64, x: f64) -> f64 {
    let (mut total, mut term, mut k) = (1.0, 1.0, 0.0);
    while term > 1e-17 * total {
        term *= (a + b + k) / (a + 1.0 + k) * x;
        total += term;
        k += 1.0;
    }
    total
}

impl Distribution for Student {
    fn name(&self) -> &'static str {
        "student"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Moments; NaN from the first order on that is not below the degrees of freedom.
    fn standard_moments(&self) -> StandardMoments {
        let excess = if self.degrees > 4.0 { 6.0 / (self.degrees - 4.0) } else { f64::NAN };
        StandardMoments::with_excess(self.odd(3.0), excess, [self.odd(5.0), self.even(3), self.odd(7.0), self.even(4)])
    }

    fn support(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// Coefficients up to the highest even moment that is finite, `beta[k] = k (n - 2) (n - k + 1) / ((n - 2k) (n - 2k + 2))`. If there is
    /// no kurtosis, those of a normal distribution are used: they give nodes at which a model can be evaluated, and the right variance.
    fn jacobi(&self, order: usize) -> Jacobi {
        let n = self.degrees;
        let beta = |k: usize| {
            let k = k as f64;
            k * (n - 2.0) / (n - 2.0 * k) * ((n - k + 1.0) / (n - 2.0 * k + 2.0))
        };
        let beta: Vec<f64> = match n > 4.0 {
            true => (1..=order).take_while(|&k| n > 2.0 * k as f64).map(beta).collect(),
            false => [1.0, 2.0].into_iter().take(order).collect(),
        };
        Jacobi::new(vec![0.0; beta.len()], beta)
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::new(self.mean + moved, self.sigma * factor, self.degrees);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Student {
    fn density(&self, x: f64) -> Option<f64> {
        let u = self.u(x);
        let of_sigma = match &self.law {
            Tail::Pearson(law) => law.pdf(u),
            Tail::Series(law) => law.density(u * law.per_sigma()) * law.per_sigma(),
        };
        Some(of_sigma / self.sigma)
    }

    fn cdf(&self, x: f64) -> f64 {
        self.above(-self.u(x))
    }

    fn sf(&self, x: f64) -> f64 {
        self.above(self.u(x))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.mean - self.sigma * self.with_above(checked(p))
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.mean + self.sigma * self.with_above(checked(p))
    }

    /// Random values by the method of `rand_distr`: a normal value over the root of a chi-squared one.
    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        let law = rand_distr::StudentT::new(self.degrees).expect("degrees above 2");
        let scale = self.sigma * ((self.degrees - 2.0) / self.degrees).sqrt();
        out.iter_mut().for_each(|value| *value = self.mean + scale * rng.sample(law));
    }
}
