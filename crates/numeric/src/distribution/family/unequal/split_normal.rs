//! Split normal distribution: two halves of normal distributions with unlike sigmas.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::distribution::family::discretised::{Discretised, ORDER, legendre};
use crate::distribution::probability::checked;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, positive, standard_normal,
};

/// Farthest point of the quadrature, in sigmas of its side: beyond it a normal density times any kept power is below 1e-17.
const FARTHEST: i32 = 14;
/// Nodes of the quadrature in each piece, one sigma wide.
const NODES: usize = 16;

/// Split normal distribution about its mode: a value whose errors are unlike on both sides, such as 5 +0.2 -0.1.
///
/// Formula: the density is `2/(sqrt(2 pi) (below + above)) exp(-(x - mode)^2/(2 s^2))` with `s = below` below the mode and `above` above it,
/// so that it is continuous. The probability below the mode is `below/(below + above)`. With `d = above - below` the mean is `mode +
/// sqrt(2/pi) d`, and the variance `(1 - 2/pi) d^2 + below above`. All moments are closed forms.
///
/// Source: John, The three-parameter two-piece normal family of distributions, Communications in Statistics 11 (1982) 879-885.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, SplitNormal};
/// let film = SplitNormal::new(5.0, 0.1, 0.2)?;
/// assert!((film.mean() - 5.0 - (2.0 / std::f64::consts::PI).sqrt() * 0.1).abs() < 1e-15);
/// let law = film.probability().expect("it is known whole");
/// assert!((law.cdf(5.0) - 1.0 / 3.0).abs() < 1e-15);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SplitNormal {
    mode: f64,
    below: f64,
    above: f64,
    mean: f64,
    sigma: f64,
    moments: StandardMoments,
    jacobi: Jacobi,
}

impl SplitNormal {
    /// Distribution with this mode, and with sigmas above 0 below and above it.
    ///
    /// # Errors
    /// Returns an error if a parameter is not finite, or if a sigma is not above 0.
    pub fn new(mode: f64, below: f64, above: f64) -> Result<Self, DistributionError> {
        let (mode, below, above) = (finite("mode", mode)?, positive("below", below)?, positive("above", above)?);
        // In a unit of the wider side no power overflows.
        let unit = below.max(above);
        let (s, t) = (below / unit, above / unit);
        let difference = (above - below) / unit;
        let centre = (2.0 / PI).sqrt() * difference;
        let variance = (1.0 - 2.0 / PI) * difference * difference + s * t;
        let sigma = positive("sigma", variance.sqrt() * unit)?;
        let mean = finite("mean", mode + centre * unit)?;
        let moments = StandardMoments::from_standard(standard(s, t, centre, variance.sqrt()));
        let mut points = Discretised::default();
        let rule = legendre(NODES);
        for from in 0..FARTHEST {
            let [from, to] = [f64::from(from), f64::from(from) + 1.0];
            let density = |z: f64| libm::exp(-0.5 * z * z);
            points.piece([-s * to, -s * from], &rule, |x| density(x / s));
            points.piece([t * from, t * to], &rule, |x| density(x / t));
        }
        points.standardise();
        Ok(Self { mode, below, above, mean, sigma, moments, jacobi: points.jacobi(ORDER) })
    }

    /// Probability below the mode.
    fn share(&self) -> f64 {
        self.below / (self.below + self.above)
    }

    /// Probability above the mode.
    fn other(&self) -> f64 {
        self.above / (self.below + self.above)
    }
}

/// Moments 3 to 8 of the standardised variable, from those about the mode. `s` and `t` are the sigmas of both sides.
///
/// Formula: `E[(x - mode)^n] = M_n (t^(n+1) + (-1)^n s^(n+1))/(s + t)` with the absolute moments `M_n` of a standard normal variable.
fn standard(s: f64, t: f64, centre: f64, sigma: f64) -> [f64; 6] {
    let mut absolute = [1.0, (2.0 / PI).sqrt(), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    for order in 2..=8 {
        absolute[order] = (order as f64 - 1.0) * absolute[order - 2];
    }
    let mut about_mode = [0.0; 9];
    for (order, moment) in about_mode.iter_mut().enumerate() {
        let power = order as i32 + 1;
        let side = if order % 2 == 0 { s.powi(power) } else { -s.powi(power) };
        *moment = absolute[order] * (t.powi(power) + side) / (s + t);
    }
    [3, 4, 5, 6, 7, 8].map(|order: usize| {
        let (mut sum, mut binomial) = (0.0, 1.0);
        for (k, moment) in about_mode.iter().enumerate().take(order + 1) {
            sum += binomial * moment * (-centre).powi((order - k) as i32);
            binomial *= (order - k) as f64 / (k as f64 + 1.0);
        }
        sum / sigma.powi(order as i32)
    })
}

impl Distribution for SplitNormal {
    fn name(&self) -> &'static str {
        "split-normal"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    fn standard_moments(&self) -> StandardMoments {
        self.moments
    }

    fn support(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// Coefficients up to order 16.
    fn jacobi(&self, order: usize) -> Jacobi {
        self.jacobi.truncated(order)
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::new(self.mode + moved, self.below * factor, self.above * factor);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for SplitNormal {
    fn density(&self, x: f64) -> Option<f64> {
        let side = if x < self.mode { self.below } else { self.above };
        Some(2.0 * standard_normal::density((x - self.mode) / side) / (self.below + self.above))
    }

    fn cdf(&self, x: f64) -> f64 {
        match x < self.mode {
            true => 2.0 * self.share() * standard_normal::cdf((x - self.mode) / self.below),
            false => 1.0 - 2.0 * self.other() * standard_normal::sf((x - self.mode) / self.above),
        }
    }

    fn sf(&self, x: f64) -> f64 {
        match x < self.mode {
            true => 1.0 - 2.0 * self.share() * standard_normal::cdf((x - self.mode) / self.below),
            false => 2.0 * self.other() * standard_normal::sf((x - self.mode) / self.above),
        }
    }

    fn quantile(&self, p: f64) -> f64 {
        let p = checked(p);
        match p < self.share() {
            true => self.mode + self.below * standard_normal::quantile(0.5 * p / self.share()),
            false => self.mode + self.above * standard_normal::upper_quantile(0.5 * (1.0 - p) / self.other()),
        }
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        let p = checked(p);
        match p < self.other() {
            true => self.mode + self.above * standard_normal::upper_quantile(0.5 * p / self.other()),
            false => self.mode + self.below * standard_normal::quantile(0.5 * (1.0 - p) / self.share()),
        }
    }

    /// The mode, at which the second derivative of the density jumps.
    fn corners(&self) -> Vec<f64> {
        vec![self.mode]
    }
}
