//! Lognormal distribution.

use std::sync::Arc;

use rand::Rng;

use crate::distribution::family::one_sided::ratio;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, standard_normal, ziggurat,
};

/// Lognormal distribution from an origin on, with given mean and sigma. The logarithm of the distance from the origin is normal.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Lognormal};
/// let runout = Lognormal::new(0.0, 1.0, 0.5)?;
/// let v: f64 = 0.25;
/// assert!((runout.standard_moments().skewness - (3.0 + v) * v.sqrt()).abs() < 1e-15);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lognormal {
    origin: f64,
    mean: f64,
    sigma: f64,
    /// Distance of the mean from the origin.
    distance: f64,
    /// Variance of `x/distance`.
    v: f64,
    /// Sigma of the logarithm.
    tau: f64,
}

/// Largest ratio of sigma to the distance of the mean from the origin. Beyond it the recurrence overflows.
const LARGEST: f64 = 1e4;
/// Cumulants of a lognormal variable of mean 1 and variance v, as coefficients of powers of v. They are the numbers of connected graphs on
/// n labelled vertices, by edges from n-1 on: `E x^n = (1+v)^(n(n-1)/2)` counts all graphs, and cumulants count connected ones (OEIS
/// A062734). Rows for n = 3 to 8.
const CONNECTED: [&[f64]; 6] = [
    &[3.0, 1.0],
    &[16.0, 15.0, 6.0, 1.0],
    &[125.0, 222.0, 205.0, 120.0, 45.0, 10.0, 1.0],
    &[1296.0, 3660.0, 5700.0, 6165.0, 4945.0, 2997.0, 1365.0, 455.0, 105.0, 15.0, 1.0],
    &[
        16807.0, 68295.0, 156_555.0, 258_125.0, 331_506.0, 343_140.0, 290_745.0, 202_755.0, 116_175.0, 54257.0,
        20349.0, 5985.0, 1330.0, 210.0, 21.0, 1.0,
    ],
    &[
        262_144.0,
        1_436_568.0,
        4_483_360.0,
        10_230_360.0,
        18_602_136.0,
        28_044_072.0,
        35_804_384.0,
        39_183_840.0,
        37_007_656.0,
        30_258_935.0,
        21_426_300.0,
        13_112_470.0,
        6_905_220.0,
        3_107_937.0,
        1_184_032.0,
        376_740.0,
        98280.0,
        20475.0,
        3276.0,
        378.0,
        28.0,
        1.0,
    ],
];

impl Lognormal {
    /// Distribution from `origin` on. `mean` must lie above `origin`, and `sigma` be at most 10 000 times that distance.
    pub fn new(origin: f64, mean: f64, sigma: f64) -> Result<Self, DistributionError> {
        let [distance, ratio] = ratio(origin, mean, sigma, LARGEST)?;
        let v = ratio * ratio;
        Ok(Self { origin, mean, sigma, distance, v, tau: libm::log1p(v).sqrt() })
    }

    /// Standardised logarithm.
    fn z(&self, x: f64) -> f64 {
        if x.is_nan() {
            return x;
        }
        let off = (x - self.mean) / self.distance;
        // Next to the mean use the deviation from it, elsewhere the distance from the origin. Either keeps the digits of x.
        let log =
            if off.abs() < 0.5 { libm::log1p(off) } else { libm::log(((x - self.origin) / self.distance).max(0.0)) };
        log / self.tau + 0.5 * self.tau
    }

    fn x(&self, z: f64) -> f64 {
        let log = self.tau * (z - 0.5 * self.tau);
        if log.abs() < 0.5 {
            self.mean + self.distance * libm::expm1(log)
        } else {
            self.origin + self.distance * libm::exp(log)
        }
    }
}

impl Distribution for Lognormal {
    fn name(&self) -> &'static str {
        "lognormal"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Moments from cumulants, which are polynomials in `v = (sigma/distance)^2` with positive coefficients: skewness `(3 + v) sqrt v`,
    /// excess `16 v + 15 v^2 + 6 v^3 + v^4`, and so on.
    fn standard_moments(&self) -> StandardMoments {
        let root = self.v.sqrt();
        // v^(n-1) sum of c v^i, divided by v^(n/2).
        let cumulant = |n: i32| {
            let sum = CONNECTED[n as usize - 3].iter().rev().fold(0.0, |sum, c| sum * self.v + c);
            sum * root.powi(n - 2)
        };
        StandardMoments::from_cumulants([3, 4, 5, 6, 7, 8].map(cumulant))
    }

    fn support(&self) -> [f64; 2] {
        [self.origin, f64::INFINITY]
    }

    /// Coefficients of Stieltjes-Wigert polynomials. With `w = 1 + v`, standardised and free of cancellation,
    /// `alpha[n] = (w^(2n) - 1 + w^(n-1) (w^n - 1))/sqrt v` and `beta[n] = w^(3n-3) (w^n - 1)/v`.
    ///
    /// Other distributions have the same moments, and therefore the same rules.
    fn jacobi(&self, order: usize) -> Jacobi {
        let log = libm::log1p(self.v);
        let less_one = |power: f64| libm::expm1(power * log);
        let power = |power: f64| libm::exp(power * log);
        let alpha = |n: usize| {
            let n = n as f64;
            (less_one(2.0 * n) + power(n - 1.0) * less_one(n)) / self.v.sqrt()
        };
        let beta = |n: usize| power(3.0 * n as f64 - 3.0) * less_one(n as f64) / self.v;
        // Stop before the coefficients overflow.
        let known = (0..order).take_while(|&n| alpha(n).is_finite() && beta(n + 1).is_finite()).count();
        Jacobi::new((0..known).map(alpha).collect(), (1..=known).map(beta).collect())
    }

    /// Copy with sigma scaled. Mean and origin stay, so the shape changes.
    fn scaled(&self, factor: f64, _: f64) -> Option<Scaled> {
        Some(Self::new(self.origin, self.mean, self.sigma * factor).map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Lognormal {
    fn density(&self, x: f64) -> Option<f64> {
        if x <= self.origin {
            return Some(0.0);
        }
        Some(standard_normal::density(self.z(x)) / (self.tau * (x - self.origin)))
    }

    fn cdf(&self, x: f64) -> f64 {
        standard_normal::cdf(self.z(x))
    }

    fn sf(&self, x: f64) -> f64 {
        standard_normal::sf(self.z(x))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.x(standard_normal::quantile(p))
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.x(standard_normal::upper_quantile(p))
    }

    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        ziggurat::normals(rng, ziggurat::STANDARD, out);
        out.iter_mut().for_each(|value| *value = self.x(*value));
    }
}
