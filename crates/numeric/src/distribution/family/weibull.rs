//! Weibull distribution.

use std::sync::Arc;

use crate::distribution::family::discretised::{Discretised, ORDER};
use crate::distribution::family::one_sided::{above_origin, ratio};
use crate::distribution::inverse::root;
use crate::distribution::probability::checked;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, between, positive,
};

/// Weibull distribution from an origin on, with given mean and sigma, or mean and shape: `P(above x) = exp(-t^shape)` at the distance `t`
/// from the origin in units of the scale.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Weibull};
/// // Shape 1 is the exponential distribution.
/// let life = Weibull::new(0.0, 3.0, 3.0)?;
/// assert!((life.standard_moments().skewness - 2.0).abs() < 1e-13);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Weibull {
    origin: f64,
    mean: f64,
    sigma: f64,
    /// Inverse of the shape.
    power: f64,
    scale: f64,
    /// Ratio of the mean's distance from the origin to the scale, minus 1.
    off: f64,
    moments: StandardMoments,
    jacobi: Jacobi,
}

/// Largest ratio of sigma to the distance of the mean from the origin, at a shape of 0.09.
const LARGEST: f64 = 1e3;
/// Values of the zeta function at 2, 3 and so on.
const ZETA: [f64; 23] = [
    1.644_934_066_848_226_4,
    1.202_056_903_159_594_2,
    1.082_323_233_711_138_2,
    1.036_927_755_143_37,
    1.017_343_061_984_449,
    1.008_349_277_381_922_8,
    1.004_077_356_197_944_3,
    1.002_008_392_826_082_2,
    1.000_994_575_127_818,
    1.000_494_188_604_119_5,
    1.000_246_086_553_308,
    1.000_122_713_347_578_5,
    1.000_061_248_135_058_7,
    1.000_030_588_236_307,
    1.000_015_282_259_408_7,
    1.000_007_637_197_637_9,
    1.000_003_817_293_265,
    1.000_001_908_212_716_6,
    1.000_000_953_962_033_9,
    1.000_000_476_932_986_8,
    1.000_000_238_450_502_7,
    1.000_000_119_219_926,
    1.000_000_059_608_189,
];
/// Euler-Mascheroni constant.
const EULER: f64 = 0.577_215_664_901_532_9;
/// Argument below which logarithms of gamma functions are summed as series.
const SMALL: f64 = 0.1;

/// `log Gamma(1 + x)`, with all its digits next to 0.
fn log_gamma_1p(x: f64) -> f64 {
    if x.abs() < SMALL { -EULER * x + zeta_series(x, |_| 1.0) } else { libm::lgamma(1.0 + x) }
}

/// Sum over n from 2 on of `zeta(n) factor(n) (-x)^n / n`.
fn zeta_series(x: f64, factor: impl Fn(f64) -> f64) -> f64 {
    let term = |(i, zeta): (usize, &f64)| {
        let n = i as f64 + 2.0;
        zeta * factor(n) * (-x).powi(i as i32 + 2) / n
    };
    ZETA.iter().enumerate().rev().map(term).sum()
}

/// `log(1 + (sigma/mean)^2)` as a function of the inverse shape: `log Gamma(1 + 2x) - 2 log Gamma(1 + x)`, nearly `zeta(2) x^2`.
fn log_spread(power: f64) -> f64 {
    if power < 0.5 * SMALL {
        return zeta_series(power, |n| libm::exp2(n) - 2.0);
    }
    log_gamma_1p(2.0 * power) - 2.0 * log_gamma_1p(power)
}

impl Weibull {
    /// Distribution from `origin` on. `mean` must lie above `origin`, and `sigma` be at most 1000 times that distance. The shape is
    /// computed.
    pub fn new(origin: f64, mean: f64, sigma: f64) -> Result<Self, DistributionError> {
        let [_, ratio] = ratio(origin, mean, sigma, LARGEST)?;
        let wanted = libm::log1p(ratio * ratio);
        // In logarithms the spread is nearly straight over the inverse shape, with slope 2 at the small end and 1 at the large one.
        let off = |log_power: f64| {
            let power = libm::exp(log_power);
            let spread = log_spread(power);
            let h = 1e-5;
            let slope = (log_spread(power * (1.0 + h)) - log_spread(power * (1.0 - h))) / (2.0 * h * spread);
            (libm::log(spread / wanted), slope)
        };
        let start = libm::log(wanted.sqrt().max(wanted));
        let power = libm::exp(root([-40.0, 5.0], start, off));
        Self::build(origin, mean, sigma, power)
    }

    /// Distribution with this shape, from 0.09 to 1e12.
    pub fn with_shape(origin: f64, mean: f64, shape: f64) -> Result<Self, DistributionError> {
        let distance = above_origin(origin, mean)?;
        let shape = between("shape", positive("shape", shape)?, [0.09, 1e12], "from 0.09 to 1e12")?;
        let power = 1.0 / shape;
        let sigma = distance * libm::expm1(log_spread(power)).sqrt();
        Self::build(origin, mean, sigma, power)
    }

    fn build(origin: f64, mean: f64, sigma: f64, power: f64) -> Result<Self, DistributionError> {
        let off = libm::expm1(log_gamma_1p(power));
        let mut fine = discretised(power);
        fine.standardise();
        let (moments, jacobi) = (fine.moments(), fine.jacobi(ORDER));
        if !moments.are_finite() {
            return Err(DistributionError::NoLaw { reason: "its moments are beyond the range of a double".into() });
        }
        let scale = (mean - origin) / (1.0 + off);
        Ok(Self { origin, mean, sigma, power, scale, off, moments, jacobi })
    }

    pub(crate) fn shape(&self) -> f64 {
        1.0 / self.power
    }

    /// Logarithm of the distance from the origin, in units of the scale.
    fn log(&self, x: f64) -> f64 {
        // For a large shape all values lie next to the scale. Then use the deviation from the mean, which keeps the digits.
        let beside = (x - self.mean) / self.scale + self.off;
        match beside.abs() < 0.5 {
            true => libm::log1p(beside),
            false if x <= self.origin => f64::NEG_INFINITY,
            false => libm::log((x - self.origin) / self.scale),
        }
    }

    /// Hazard `t^shape`: the negative logarithm of the probability above.
    fn hazard(&self, x: f64) -> f64 {
        libm::exp(self.log(x) / self.power)
    }

    /// Value at which the logarithm of the hazard is `log_hazard`.
    fn at_hazard(&self, log_hazard: f64) -> f64 {
        let log = self.power * log_hazard;
        if log.abs() < 0.5 {
            self.mean + self.scale * (libm::expm1(log) - self.off)
        } else {
            self.origin + self.scale * libm::exp(log)
        }
    }
}

/// Quadrature of `t - 1` by the trapezoidal rule in the logarithm of the hazard, which converges like `exp(-c/step)`. In closed form the
/// central moments are differences of gamma functions that agree in most of their digits.
fn discretised(power: f64) -> Discretised {
    // Moments up to order 2 ORDER + 2 have their weight at hazards around this one.
    let peak = (2 * ORDER + 2) as f64 * power;
    let step = (0.7 / (1.0 + peak).sqrt()).min(0.2);
    let (from, to) = (-160.0, libm::log(2.0 * peak + 140.0));
    let mut fine = Discretised::default();
    let steps = ((to - from) / step) as usize;
    for i in 0..=steps {
        let log_hazard = from + step * i as f64;
        fine.push(libm::expm1(power * log_hazard), libm::exp(log_hazard - libm::exp(log_hazard)));
    }
    fine
}

impl Distribution for Weibull {
    fn name(&self) -> &'static str {
        "weibull"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Moments by quadrature of positive terms. In closed form they are differences of gamma functions, which cancel.
    fn standard_moments(&self) -> StandardMoments {
        self.moments
    }

    fn support(&self) -> [f64; 2] {
        [self.origin, f64::INFINITY]
    }

    /// Coefficients up to order 16.
    fn jacobi(&self, order: usize) -> Jacobi {
        self.jacobi.truncated(order)
    }

    /// Copy with sigma scaled. Mean and origin stay, so the shape changes.
    fn scaled(&self, factor: f64, _: f64) -> Option<Scaled> {
        Some(Self::new(self.origin, self.mean, self.sigma * factor).map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Weibull {
    fn density(&self, x: f64) -> Option<f64> {
        if x < self.origin {
            return Some(0.0);
        }
        let (log, shape) = (self.log(x), self.shape());
        let power = if shape == 1.0 { 0.0 } else { (shape - 1.0) * log };
        Some(shape / self.scale * libm::exp(power - self.hazard(x)))
    }

    fn cdf(&self, x: f64) -> f64 {
        -libm::expm1(-self.hazard(x))
    }

    fn sf(&self, x: f64) -> f64 {
        libm::exp(-self.hazard(x))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.at_hazard(libm::log(-libm::log1p(-checked(p))))
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.at_hazard(libm::log(-libm::log(checked(p))))
    }
}
