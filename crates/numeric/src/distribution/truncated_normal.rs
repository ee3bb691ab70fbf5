//! The normal distribution cut at two limits.

use std::sync::Arc;

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::pearson::LEGENDRE;

use super::discretised::{Discretised, ORDER, legendre};
use super::inverse::root;
use super::probability::{checked, clamped, random_tail};
use super::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, interval, positive,
    standard_normal,
};

/// Normal distribution of which only what lies within two limits is left, as after sorting.
///
/// Its mean and sigma follow; mean and sigma of the normal distribution before the cut are the parent's. A parent that is
/// wide beside the limits leaves a uniform distribution, a narrow one the normal itself.
///
/// ```
/// use crate::distribution::{Distribution, TruncatedNormal};
/// // Sorted at two sigma: the variance is 1 - 4 density(2)/P(|z| < 2).
/// let pin = TruncatedNormal::new(-2.0, 2.0, 0.0, 1.0)?;
/// assert!((pin.sigma() - 0.879_625_661_034_239_8).abs() < 1e-14);
/// # Ok::<(), crate::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TruncatedNormal {
    middle: f64,
    half: f64,
    shift: f64,
    parent: f64,
    cut: Cut,
    mean: f64,
    sigma: f64,
    moments: StandardMoments,
    jacobi: Jacobi,
}

/// The log of the density may fall by this before the rest of it is left out of the moments.
const FALL: f64 = 120.0;
/// Sigmas by which the parent's mean may lie outside the limits.
const FARTHEST: f64 = 40.0;
/// Pieces of the interval, with as many nodes on each.
const PIECES: usize = 32;
const NODES: usize = 16;
/// A product of width and steepness below which one rule of this many nodes integrates to all digits.
const SHORT: f64 = 2.0;
/// Acceptance below which samples are drawn by the quantile function.
const ACCEPTED: f64 = 0.25;

impl TruncatedNormal {
    /// The normal distribution with this mean and sigma, cut at `lower` and `upper`; the mean may lie outside them.
    pub fn new(lower: f64, upper: f64, mean: f64, sigma: f64) -> Result<Self, DistributionError> {
        let [middle, half] = interval(lower, upper)?;
        Self::about(middle, half, finite("mean", mean)? - middle, sigma)
    }

    /// The normal distribution with mean `middle + shift` and this sigma, cut at `middle - half` and `middle + half`.
    pub fn about(middle: f64, half: f64, shift: f64, sigma: f64) -> Result<Self, DistributionError> {
        let (middle, half) = (finite("the middle", middle)?, positive("the half width", half)?);
        let (shift, parent) = (finite("shift", shift)?, positive("sigma", sigma)?);
        let cut = Cut::new((-half - shift) / parent, (half - shift) / parent);
        if !(cut.peak.abs() <= FARTHEST && cut.ends[0] < cut.ends[1] && cut.total.is_finite()) {
            let range = "within the limits or at most 40 sigmas outside";
            return Err(DistributionError::OutOfRange {
                parameter: "the mean before the cut",
                value: middle + shift,
                range,
            });
        }
        let mut fine = cut.discretised();
        let [mean, sigma] = fine.standardise();
        let (mut moments, mut jacobi) = (fine.moments(), fine.jacobi(ORDER));
        let mut mean = shift + parent * mean;
        if shift == 0.0 {
            (mean, jacobi) = (0.0, jacobi.symmetric());
            (moments.skewness, moments.m5, moments.m7, moments.h7) = (0.0, 0.0, 0.0, 0.0);
        }
        Ok(Self { middle, half, shift, parent, cut, mean: middle + mean, sigma: parent * sigma, moments, jacobi })
    }

    /// In sigmas of the parent from its mean.
    fn z(&self, x: f64) -> f64 {
        ((x - self.middle) - self.shift) / self.parent
    }

    fn x(&self, z: f64) -> f64 {
        if z == self.cut.ends[0] {
            return self.middle - self.half;
        }
        if z == self.cut.ends[1] {
            return self.middle + self.half;
        }
        (self.middle + (self.shift + self.parent * z)).clamp(self.middle - self.half, self.middle + self.half)
    }
}

impl Distribution for TruncatedNormal {
    fn name(&self) -> &'static str {
        "truncated-normal"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    /// By Gauss-Legendre: the closed forms lose every digit where the parent is wide beside the limits.
    fn standard_moments(&self) -> StandardMoments {
        self.moments
    }

    fn support(&self) -> [f64; 2] {
        [self.middle - self.half, self.middle + self.half]
    }

    /// Up to order 16.
    fn jacobi(&self, order: usize) -> Jacobi {
        self.jacobi.truncated(order)
    }

    /// The parent's sigma scales with the band; a shift of its mean stays.
    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::about(self.middle + moved, self.half * factor, self.shift, self.parent * factor);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for TruncatedNormal {
    fn density(&self, x: f64) -> Option<f64> {
        let inside = (x - self.middle).abs() <= self.half;
        Some(if inside { self.cut.weight(self.z(x)) / (self.cut.total * self.parent) } else { 0.0 })
    }

    fn cdf(&self, x: f64) -> f64 {
        self.cut.masses(self.z(x))[0]
    }

    fn sf(&self, x: f64) -> f64 {
        self.cut.masses(self.z(x))[1]
    }

    fn quantile(&self, p: f64) -> f64 {
        let p = checked(p);
        self.x(self.cut.quantile([p, 1.0 - p]))
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        let p = checked(p);
        self.x(self.cut.quantile([1.0 - p, p]))
    }

    /// Rejection from the parent where a good part of it is left.
    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        let [low, high] = self.cut.ends;
        let rejects = standard_normal::cdf(high) - standard_normal::cdf(low) > ACCEPTED;
        for value in out {
            let z = loop {
                if !rejects {
                    let (p, upper) = random_tail(rng);
                    break self.cut.quantile(if upper { [1.0 - p, p] } else { [p, 1.0 - p] });
                }
                let z = rng.sample::<f64, _>(StandardNormal);
                if z >= low && z <= high {
                    break z;
                }
            };
            *value = self.x(z);
        }
    }
}

/// The standard normal density between two ends, relative to its largest value there.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cut {
    ends: [f64; 2],
    /// Where it is largest.
    peak: f64,
    total: f64,
}

impl Cut {
    fn new(low: f64, high: f64) -> Self {
        let mut cut = Self { ends: [low, high], peak: 0.0f64.clamp(low, high), total: 1.0 };
        cut.total = cut.mass(low, high);
        cut
    }

    /// Density at `z` by that at the peak.
    fn weight(&self, z: f64) -> f64 {
        libm::exp(-0.5 * (z - self.peak) * (z + self.peak))
    }

    /// Integral of [`weight`](Self::weight) between two places inside, all of it positive terms or differences without
    /// cancellation.
    fn mass(&self, from: f64, to: f64) -> f64 {
        if from < 0.0 && to > 0.0 {
            return self.mass(from, 0.0) + self.mass(0.0, to);
        }
        if to <= 0.0 && from < 0.0 {
            return Self { ends: [-self.ends[1], -self.ends[0]], peak: -self.peak, total: 1.0 }.mass(-to, -from);
        }
        if (to - from) * to.max(1.0) > SHORT {
            return self.weight(from) * standard_normal::mills(from) - self.weight(to) * standard_normal::mills(to);
        }
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let pair = |(node, weight): &(f64, f64)| {
            weight * (self.weight(middle - half * node) + self.weight(middle + half * node))
        };
        half * LEGENDRE.iter().map(pair).sum::<f64>()
    }

    /// Probabilities below and above.
    fn masses(&self, z: f64) -> [f64; 2] {
        if z.is_nan() {
            return [f64::NAN; 2];
        }
        let [low, high] = self.ends;
        let z = z.clamp(low, high);
        [clamped(self.mass(low, z) / self.total), clamped(self.mass(z, high) / self.total)]
    }

    /// Where the probabilities below and above are these, the smaller one exact.
    fn quantile(&self, [below, above]: [f64; 2]) -> f64 {
        let [low, high] = self.ends;
        let (lower, p) = if below <= above { (true, below) } else { (false, above) };
        if p.is_nan() {
            return f64::NAN;
        }
        if p == 0.0 {
            return if lower { low } else { high };
        }
        // As if it were flat, or as if it were not cut.
        let flat = if lower { low + p * (high - low) } else { high - p * (high - low) };
        let uncut = if lower { standard_normal::quantile(p) } else { standard_normal::upper_quantile(p) };
        let start = if high - low < 1.0 || self.peak != 0.0 { flat } else { uncut };
        let off = |z: f64| {
            let tail = self.masses(z)[usize::from(!lower)];
            let slope = self.weight(z) / (self.total * tail);
            let error = libm::log(tail / p);
            if lower { (error, slope) } else { (-error, slope) }
        };
        root([low, high], start, off)
    }

    /// Gauss-Legendre on pieces of where the density counts.
    fn discretised(&self) -> Discretised {
        let [low, high] = self.ends;
        // Where the log of the density has fallen by that much: (z^2 - peak^2)/2 = FALL.
        let reach = 2.0 * FALL / (self.peak.abs() + (self.peak * self.peak + 2.0 * FALL).sqrt());
        let (from, to) = (low.max(self.peak - reach), high.min(self.peak + reach));
        let (rule, width) = (legendre(NODES), (to - from) / PIECES as f64);
        let mut fine = Discretised::default();
        for piece in 0..PIECES {
            let start = from + width * piece as f64;
            fine.piece([start, start + width], &rule, |z| self.weight(z));
        }
        fine
    }
}
