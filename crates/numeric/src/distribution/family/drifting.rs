//! Normal distribution whose mean drifts.

use std::sync::Arc;

use rand::{Rng, RngExt};

use crate::distribution::family::discretised::{Discretised, legendre};
use crate::distribution::inverse::root;
use crate::distribution::probability::checked;
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Normal, Probability, Scaled, StandardMoments, finite, positive,
    standard_normal, ziggurat,
};

/// Normal distribution within a lot, with the means of lots uniform within `drift` on either side. It describes tool wear between two
/// settings, or one setting after another. The variance is `sigma^2 + drift^2/3`.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Drifting};
/// let turned = Drifting::new(25.0, 0.01, 0.03)?;
/// assert!((turned.sigma() - (0.0001f64 + 0.0003).sqrt()).abs() < 1e-16);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Drifting {
    mean: f64,
    /// Sigma within a lot.
    within: f64,
    drift: f64,
    /// Gauss-Legendre rule over -1 to 1, with weights that sum to 1.
    rule: Vec<(f64, f64)>,
}

/// Nodes of the rule over the lots. Up to a product of [`SMOOTH`] it is exact to the last digits.
const NODES: usize = 24;
/// Greatest product of the half-width, in sigmas of a lot, and the logarithmic slope of a tail for which the rule is used. Above it a
/// difference of closed forms loses at most two digits.
const SMOOTH: f64 = 2.0;

impl Drifting {
    /// Distribution with the mean of all lots, the sigma of one lot, and the greatest distance of a lot's mean from that of all. The last
    /// two must be above 0.
    pub fn new(mean: f64, sigma: f64, drift: f64) -> Result<Self, DistributionError> {
        let (mean, within, drift) = (finite("mean", mean)?, positive("sigma", sigma)?, positive("drift", drift)?);
        let rule = legendre(NODES).into_iter().map(|(node, weight)| (node, 0.5 * weight)).collect();
        Ok(Self { mean, within, drift, rule })
    }

    /// Deviation from the mean and drift, both in sigmas of a lot.
    fn z(&self, x: f64) -> [f64; 2] {
        [(x - self.mean) / self.within, self.drift / self.within]
    }

    /// Mean over all lots of a function of the distance from the lot's mean.
    fn over_lots(&self, z: f64, h: f64, f: impl Fn(f64) -> f64) -> f64 {
        self.rule.iter().map(|(node, weight)| weight * f(z + h * node)).sum()
    }

    /// Probability above `z`, which is not below the mean.
    fn above(&self, z: f64, h: f64) -> f64 {
        match h * (1.0 + z) <= SMOOTH {
            true => self.over_lots(z, h, standard_normal::sf),
            false => (beyond(z - h) - beyond(z + h)) / (2.0 * h),
        }
    }

    /// Density at `z`, per sigma of a lot.
    fn height(&self, z: f64, h: f64) -> f64 {
        match h * (1.0 + z) <= SMOOTH {
            true => self.over_lots(z, h, standard_normal::density),
            false => (standard_normal::sf(z - h) - standard_normal::sf(z + h)) / (2.0 * h),
        }
    }

    fn tail(&self, [z, h]: [f64; 2]) -> f64 {
        match z {
            f64::INFINITY => 0.0,
            _ if z < 0.0 => 1.0 - self.tail([-z, h]),
            _ => self.above(z, h),
        }
    }

    /// Value above which the probability is `p`, in sigmas of a lot.
    fn with_above(&self, p: f64) -> f64 {
        let h = self.drift / self.within;
        match p {
            _ if p > 0.5 => return -self.with_above(1.0 - p),
            0.5 => return 0.0,
            0.0 => return f64::INFINITY,
            _ if p.is_nan() => return p,
            _ => {}
        }
        let middle = standard_normal::upper_quantile(p);
        let off = |z: f64| {
            let above = self.above(z, h);
            (libm::log(p / above), self.height(z, h) / above)
        };
        root([(middle - h).max(0.0), middle + h], middle, off)
    }
}

/// Integral of the normal tail beyond `z`: `density(z) - z sf(z)`.
fn beyond(z: f64) -> f64 {
    if z == f64::INFINITY { 0.0 } else { standard_normal::density(z) - z * standard_normal::sf(z) }
}

impl Distribution for Drifting {
    fn name(&self) -> &'static str {
        "drifting-normal"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        libm::hypot(self.within, self.drift / 3f64.sqrt())
    }

    /// Moments from the cumulants of the uniform part: `-2 d^4/15, 16 d^6/63, -16 d^8/15`.
    fn standard_moments(&self) -> StandardMoments {
        let part = (self.drift / self.sigma()).powi(2);
        let cumulants = [-2.0 / 15.0 * part.powi(2), 16.0 / 63.0 * part.powi(3), -16.0 / 15.0 * part.powi(4)];
        let [k4, k6, k8] = cumulants;
        StandardMoments::from_cumulants([0.0, k4, 0.0, k6, 0.0, k8])
    }

    fn support(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// Coefficients from Gauss-Hermite within a lot and Gauss-Legendre over the lots, which is exact.
    fn jacobi(&self, order: usize) -> Jacobi {
        let within = Normal::new(0.0, 1.0).expect("the standard normal distribution").jacobi(order + 2).gauss();
        let mut points = Discretised::default();
        for (node, weight) in legendre(order + 2) {
            let lot = self.drift / self.within * node;
            let inner = within.nodes.iter().zip(&within.weights);
            inner.for_each(|(z, inner)| points.push(lot + z, weight * inner));
        }
        points.standardise();
        points.symmetric_jacobi(order)
    }

    /// Copy with the sigma of a lot scaled. The drift stays, like a shift.
    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = Self::new(self.mean + moved, self.within * factor, self.drift);
        Some(scaled.map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Drifting {
    fn density(&self, x: f64) -> Option<f64> {
        let [z, h] = self.z(x);
        Some(self.height(z.abs(), h) / self.within)
    }

    fn cdf(&self, x: f64) -> f64 {
        let [z, h] = self.z(x);
        self.tail([-z, h])
    }

    fn sf(&self, x: f64) -> f64 {
        self.tail(self.z(x))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.mean - self.within * self.with_above(checked(p))
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.mean + self.within * self.with_above(checked(p))
    }

    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        ziggurat::normals(rng, ziggurat::STANDARD, out);
        for value in out {
            let lot: f64 = rng.random();
            *value = self.mean + self.within * *value + self.drift * (2.0 * lot - 1.0);
        }
    }
}
