//! Pearson system: one distribution for every feasible pair of skewness and kurtosis.
//!
//! A density `p` with mean 0, variance 1, skewness `s` and kurtosis `b2` solves
//!
//! ```text
//! (C0 + C1 z + C2 z^2) p' = -(C1 + D z) p
//! C0 = 4 b2 - 3 s^2,  C1 = s (b2 + 3),  C2 = 2 (b2 - 3) - 3 s^2,  D = 10 b2 - 12 s^2 - 18
//! ```
//!
//! (Pearson 1895). The equation is homogeneous as in Stuart and Ord, Kendall's Advanced Theory of Statistics I, 6.2, so that no coefficient
//! is infinite anywhere in the plane. The signs of the coefficients give the classical types I to VII. Their special functions lose every
//! digit where two types meet, and a characteristic of a real assembly, nearly normal, lies just there. Therefore **one** engine computes
//! all types:
//!
//! - Taylor's series of p from panel to panel outwards,
//! - a series at a finite end of the support,
//! - a series at infinity,
//! - Laplace's continued fraction beyond the last panel.
//!
//! Densities are stored as logarithms, and masses as Mills' ratio (the mass beyond a place, divided by the density there). Thus nothing
//! underflows, both tails have all their digits, and no normalising constant is needed. The type is a label only.
//!
//! Accuracy, measured against 25 digits: 1e-13 relative for the density and for both probabilities down to 1e-300. Quantiles: 1e-13 of
//! max(1, |q|) sigmas. Closer than 1e-3 sigma to a finite end of the support, results are as accurate as the distance to the end, which has
//! lost digits. No model is evaluated. The cost is in `benches/README.md`.

mod coefficients;
mod ending;
mod equation;
mod error;
mod side;
mod slopes;
mod standard;

pub use crate::pearson::coefficients::PearsonType;
pub(crate) use equation::LEGENDRE;
pub use error::{PearsonError, TwoPoint};

use rand::RngExt;

use crate::power::rescale;
use standard::Standard;

/// Member of the Pearson system.
///
/// ```
/// use sensitol_numeric::pearson::{Pearson, PearsonType};
/// // Skewness 2, kurtosis 9, mean and sigma 1: the exponential distribution.
/// let law = Pearson::new(1.0, 1.0, 2.0, 9.0)?;
/// assert_eq!(law.kind(), PearsonType::III);
/// assert_eq!(law.support(), [0.0, f64::INFINITY]);
/// assert!((law.sf(3.0) - (-3.0f64).exp()).abs() < 1e-15);
/// assert!((law.upper_quantile(1e-9) - 1e9f64.ln()).abs() < 1e-12);
/// # Ok::<(), sensitol_numeric::pearson::PearsonError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Pearson {
    mean: f64,
    sigma: f64,
    skewness: f64,
    kurtosis: [f64; 2],
    standard: Standard,
}

rescale!(Pearson { mean, sigma } without { skewness, kurtosis, standard });

/// Two distributions are equal if their moments are.
impl PartialEq for Pearson {
    fn eq(&self, other: &Self) -> bool {
        let moments = |law: &Self| (law.mean, law.sigma, law.skewness, law.kurtosis);
        moments(self) == moments(other)
    }
}

impl Pearson {
    /// Distribution with this mean, sigma above 0, skewness, and kurtosis (3 for a normal).
    ///
    /// # Errors
    /// If a moment is not finite, sigma is not positive, or the kurtosis is not above `1 + skewness^2`.
    pub fn new(mean: f64, sigma: f64, skewness: f64, kurtosis: f64) -> Result<Self, PearsonError> {
        Self::build(mean, sigma, skewness, [kurtosis, 0.0])
    }

    /// Distribution with these moments. The excess over 3 replaces the kurtosis, which keeps all digits of the excess.
    ///
    /// # Errors
    /// Same conditions as in [`new`](Self::new).
    pub fn with_excess(mean: f64, sigma: f64, skewness: f64, excess: f64) -> Result<Self, PearsonError> {
        Self::build(mean, sigma, skewness, [3.0, excess])
    }

    /// Normal distribution.
    ///
    /// # Errors
    /// If mean or sigma are not finite, or sigma is not positive.
    pub fn normal(mean: f64, sigma: f64) -> Result<Self, PearsonError> {
        Self::new(mean, sigma, 0.0, 3.0)
    }

    fn build(mean: f64, sigma: f64, skewness: f64, kurtosis: [f64; 2]) -> Result<Self, PearsonError> {
        if !mean.is_finite() || !sigma.is_finite() {
            return Err(PearsonError::NotFinite);
        }
        if sigma <= 0.0 {
            return Err(PearsonError::Sigma { sigma });
        }
        let standard = Standard::new(skewness.abs(), kurtosis).map_err(|error| match error {
            PearsonError::Infeasible { kurtosis, .. } => PearsonError::infeasible(skewness, kurtosis),
            other => other,
        })?;
        Ok(Self { mean, sigma, skewness, kurtosis, standard })
    }

    /// Type of the distribution in the Pearson system.
    pub fn kind(&self) -> PearsonType {
        self.standard.kind
    }

    /// Expected value.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Third standardised moment.
    pub fn skewness(&self) -> f64 {
        self.skewness
    }

    /// Fourth standardised moment, 3 for a normal.
    pub fn kurtosis(&self) -> f64 {
        self.kurtosis[0] + self.kurtosis[1]
    }

    /// Excess of the kurtosis over the least possible one with this skewness, `1 + skewness^2`, relative to the latter.
    pub fn margin(&self) -> f64 {
        self.kurtosis() / (1.0 + self.skewness * self.skewness) - 1.0
    }

    fn mirrored(&self) -> bool {
        self.skewness < 0.0
    }

    /// Lower and upper end of the support, infinite if there is none.
    pub fn support(&self) -> [f64; 2] {
        let [lower, upper] = self.standard.support;
        let ends = if self.mirrored() { [-upper, -lower] } else { [lower, upper] };
        ends.map(|end| self.mean + self.sigma * end)
    }

    /// Distance from the mean in sigmas, mirrored if the skewness is negative.
    fn z(&self, x: f64) -> f64 {
        let z = (x - self.mean) / self.sigma;
        if self.mirrored() { -z } else { z }
    }

    fn x(&self, z: f64) -> f64 {
        self.mean + self.sigma * if self.mirrored() { -z } else { z }
    }

    fn turned(&self, [below, above]: [f64; 2]) -> [f64; 2] {
        if self.mirrored() { [above, below] } else { [below, above] }
    }

    /// Density, per unit of x.
    pub fn pdf(&self, x: f64) -> f64 {
        libm::exp(self.log_pdf(x))
    }

    /// Logarithm of the density.
    pub fn log_pdf(&self, x: f64) -> f64 {
        if x.is_nan() { f64::NAN } else { self.standard.log_pdf(self.z(x)) - libm::log(self.sigma) }
    }

    /// Cumulative distribution function: probability below x.
    pub fn cdf(&self, x: f64) -> f64 {
        if x.is_nan() { f64::NAN } else { self.turned(self.standard.cdf_sf(self.z(x)))[0] }
    }

    /// Survival function: probability above x, accurate even where the probability below rounds to 1.
    pub fn sf(&self, x: f64) -> f64 {
        if x.is_nan() { f64::NAN } else { self.turned(self.standard.cdf_sf(self.z(x)))[1] }
    }

    /// Derivatives by skewness and kurtosis, at this mean and sigma, of the probability below `lower` plus that above `upper`. Returns None
    /// if the density ends so abruptly that there are none.
    pub fn outside_by_shape(&self, lower: Option<f64>, upper: Option<f64>) -> Option<[f64; 2]> {
        let shape = [self.skewness.abs(), self.kurtosis[0] - 3.0 + self.kurtosis[1]];
        let [lower, upper] = [lower, upper].map(|x| x.map(|x| self.z(x)));
        let [below, above] = if self.mirrored() { [upper, lower] } else { [lower, upper] };
        let [by_skewness, by_kurtosis] = self.standard.outside_by_shape(shape, below, above)?;
        Some([if self.mirrored() { -by_skewness } else { by_skewness }, by_kurtosis])
    }

    /// Logarithm of the probability below x, finite also where the probability underflows to 0.
    pub fn log_cdf(&self, x: f64) -> f64 {
        if x.is_nan() { f64::NAN } else { self.turned(self.standard.log_cdf_sf(self.z(x)))[0] }
    }

    /// Logarithm of the probability above x, finite also where the probability underflows to 0.
    pub fn log_sf(&self, x: f64) -> f64 {
        if x.is_nan() { f64::NAN } else { self.turned(self.standard.log_cdf_sf(self.z(x)))[1] }
    }

    /// Value below which the probability is p. Returns NaN if p is not a probability.
    pub fn quantile(&self, p: f64) -> f64 {
        self.inverse([p, 1.0 - p])
    }

    /// Value above which the probability is p. A small p keeps the digits that `quantile(1 - p)` loses.
    pub fn upper_quantile(&self, p: f64) -> f64 {
        self.inverse([1.0 - p, p])
    }

    fn inverse(&self, probabilities: [f64; 2]) -> f64 {
        if !(0.0..=1.0).contains(&probabilities[0]) || !(0.0..=1.0).contains(&probabilities[1]) {
            return f64::NAN;
        }
        self.x(self.standard.quantile(self.turned(probabilities)))
    }
}

/// Random variates by the quantile function: exact, tails included, without a table.
impl rand_distr::Distribution<f64> for Pearson {
    fn sample<R: rand::Rng + ?Sized>(&self, rng: &mut R) -> f64 {
        // Draw either half from its own end, so that both tails have the same resolution.
        let (p, upper): (f64, bool) = (rng.sample(rand_distr::Open01), rng.random());
        if upper { self.upper_quantile(0.5 * p) } else { self.quantile(0.5 * p) }
    }
}
