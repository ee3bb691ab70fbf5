//! Normal distribution cut at two limits.

use std::sync::Arc;

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use crate::pearson::LEGENDRE;

use crate::distribution::family::discretised::{Discretised, ORDER, legendre};
use crate::distribution::inverse::root;
use crate::distribution::probability::{checked, clamped, random_tail};
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments, finite, interval, positive,
    standard_normal,
};

/// Normal distribution restricted to the values within two limits, as after sorting.
///
/// The parent is the normal distribution before the cut. Mean and sigma after the cut follow from those of the parent. A parent that is
/// wide relative to the limits leaves a uniform distribution, a narrow one stays normal.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, TruncatedNormal};
/// // Sorted at two sigma: the variance is 1 - 4 density(2)/P(|z| < 2).
/// let pin = TruncatedNormal::new(-2.0, 2.0, 0.0, 1.0)?;
/// assert!((pin.sigma() - 0.879_625_661_034_239_8).abs() < 1e-14);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
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

/// Fall of the logarithm of the density from its peak beyond which values are left out of the moments.
const FALL: f64 = 120.0;
/// Greatest distance of the parent's mean outside the limits, in sigmas.
const FARTHEST: f64 = 40.0;
/// Pieces of the interval for the moments.
const PIECES: usize = 32;
/// Nodes of Gauss-Legendre on each piece.
const NODES: usize = 16;
/// Greatest product of width and steepness for which one rule integrates to all digits.
const SHORT: f64 = 2.0;
/// Acceptance rate below which random values are drawn by the quantile function.
const ACCEPTED: f64 = 0.25;

impl TruncatedNormal {
    /// Normal distribution with this mean and sigma, cut at `lower` and `upper`. The mean may lie outside them.
    pub fn new(lower: f64, upper: f64, mean: f64, sigma: f64) -> Result<Self, DistributionError> {
        let [middle, half] = interval(lower, upper)?;
        Self::about(middle, half, finite("mean", mean)? - middle, sigma)
    }

    /// Normal distribution with mean `middle + shift` and this sigma, cut at `middle - half` and `middle + half`.
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

    /// Deviation from the parent's mean in its sigmas.
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

    /// Moments by Gauss-Legendre. The closed forms lose every digit if the parent is wide relative to the limits.
    fn standard_moments(&self) -> StandardMoments {
        self.moments
    }

    fn support(&self) -> [f64; 2] {
        [self.middle - self.half, self.middle + self.half]
    }

    /// Coefficients up to order 16.
    fn jacobi(&self, order: usize) -> Jacobi {
        self.jacobi.truncated(order)
    }

    /// Copy with the parent's sigma scaled like the band. A shift of its mean stays.
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

    /// Random values by rejection from the parent, or by the quantile function if the cut leaves little of the parent.
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

/// Standard normal density between two ends, relative to its largest value there.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cut {
    ends: [f64; 2],
    /// Value with the largest density.
    peak: f64,
    total: f64,
}

impl Cut {
    fn new(low: f64, high: f64) -> Self {
        let mut cut = Self { ends: [low, high], peak: 0.0f64.clamp(low, high), total: 1.0 };
        cut.total = cut.mass(low, high);
        cut
    }

    /// Density at `z` relative to that at the peak.
    fn weight(&self, z: f64) -> f64 {
        libm::exp(-0.5 * (z - self.peak) * (z + self.peak))
    }

    /// Integral of [`weight`](Self::weight) between two values inside, as positive terms or differences without cancellation.
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

    /// Probabilities below and above `z`.
    fn masses(&self, z: f64) -> [f64; 2] {
        if z.is_nan() {
            return [f64::NAN; 2];
        }
        let [low, high] = self.ends;
        let z = z.clamp(low, high);
        [clamped(self.mass(low, z) / self.total), clamped(self.mass(z, high) / self.total)]
    }

    /// Value with these probabilities below and above it. The smaller one is used.
    fn quantile(&self, [below, above]: [f64; 2]) -> f64 {
        let [low, high] = self.ends;
        let (lower, p) = if below <= above { (true, below) } else { (false, above) };
        if p.is_nan() {
            return f64::NAN;
        }
        if p == 0.0 {
            return if lower { low } else { high };
        }
        // Start as for a flat density, or as for a normal one without a cut.
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

    /// Gauss-Legendre on pieces of the interval in which the density counts.
    fn discretised(&self) -> Discretised {
        let [low, high] = self.ends;
        // Distance at which the logarithm of the density has fallen by FALL: (z^2 - peak^2)/2 = FALL.
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
