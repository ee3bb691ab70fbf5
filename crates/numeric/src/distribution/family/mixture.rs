//! Mixture of distributions, such as two machines or two suppliers.

use std::sync::Arc;

use rand::{Rng, RngExt};

use crate::distribution::family::discretised::{Discretised, ORDER};
use crate::distribution::inverse::root;
use crate::distribution::probability::{checked, clamped};
use crate::distribution::{Distribution, DistributionError, Jacobi, Probability, Scaled, StandardMoments};
use crate::power::Power;

/// Distribution of values from several sources, each with its own distribution and share.
///
/// ```
/// use std::sync::Arc;
/// use sensitol_numeric::distribution::{Distribution, Mixture, Normal, Part};
/// let part = |name: &str, weight: f64, mean: f64| -> Result<Part, sensitol_numeric::distribution::DistributionError> {
///     Ok(Part { name: name.into(), weight, distribution: Arc::new(Normal::new(mean, 0.1)?) })
/// };
/// let bore = Mixture::new(vec![part("machine 1", 3.0, 10.0)?, part("machine 2", 1.0, 10.4)?])?;
/// assert!((bore.mean() - 10.1).abs() < 1e-14);
/// assert!((bore.sigma().powi(2) - (0.01 + 0.75 * 0.25 * 0.16)).abs() < 1e-14);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Mixture {
    /// Sources, with weights that sum to 1.
    parts: Vec<Part>,
    mean: f64,
    sigma: f64,
    moments: StandardMoments,
    /// Recurrence, as far as the parts' own recurrences extend.
    jacobi: Jacobi,
    atoms: Atoms,
}

/// Values with a probability of their own, ascending.
#[derive(Debug, Clone)]
struct Atoms {
    values: Vec<f64>,
    shares: Vec<f64>,
    /// Probability of a value of at most each of the values. `above` holds that of a greater value.
    upto: Vec<f64>,
    above: Vec<f64>,
    /// True if the atoms are the whole distribution.
    whole: bool,
}

impl Atoms {
    /// Atoms of all parts, whose weights sum to 1.
    fn of(parts: &[Part]) -> Self {
        /// Least total of the shares that counts as 1, because shares are rounded.
        const WHOLE: f64 = 1.0 - 1e-12;
        let own = |part: &Part| -> Vec<(f64, f64)> {
            Mixture::law(part).atoms().into_iter().map(|(x, share)| (x, part.weight * share)).collect()
        };
        let mut atoms: Vec<(f64, f64)> = parts.iter().flat_map(own).collect();
        atoms.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        atoms.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            kept.1 += if same { next.1 } else { 0.0 };
            same
        });
        let (values, shares): (Vec<f64>, Vec<f64>) = atoms.into_iter().unzip();
        let running = |sum: &mut f64, share: &f64| {
            *sum += share;
            Some(*sum)
        };
        let upto: Vec<f64> = shares.iter().scan(0.0, running).collect();
        let mut above: Vec<f64> = shares.iter().rev().scan(0.0, running).collect();
        above.reverse();
        let shifted = usize::from(!above.is_empty());
        above.rotate_left(shifted);
        above.last_mut().into_iter().for_each(|last| *last = 0.0);
        let whole = upto.last().is_some_and(|all| *all >= WHOLE);
        Self { values, shares, upto, above, whole }
    }

    /// Least value with at least this probability at or below it, or with at most this probability above it.
    fn inverse(&self, p: f64, upper: bool) -> f64 {
        /// Relative rounding error of sums of shares.
        const ROUNDING: f64 = 1e-14;
        let place = match upper {
            true => self.above.partition_point(|&above| above > p * (1.0 + ROUNDING)),
            false => self.upto.partition_point(|&upto| upto < p * (1.0 - ROUNDING)),
        };
        self.values[place.min(self.values.len() - 1)]
    }

    /// Atom that differs from `x` only by rounding, or `x` if there is none.
    fn snapped(&self, x: f64, rounding: f64) -> f64 {
        let after = self.values.partition_point(|&value| value < x);
        let beside = self.values[after.saturating_sub(1)..].iter().take(2);
        beside.copied().find(|value| (value - x).abs() <= rounding).unwrap_or(x)
    }
}

/// One source of a mixture.
#[derive(Debug, Clone)]
pub struct Part {
    /// Common name of the source.
    pub name: String,
    /// Share of the source, relative to those of the others.
    pub weight: f64,
    /// Distribution of the values from this source.
    pub distribution: Arc<dyn Distribution>,
}

/// Part of sigma within which a quantile counts as at an atom. A search ends next to the jump.
const ON_AN_ATOM: f64 = 1e-12;
/// Part of sigma below which two bounds of a quantile count as equal.
const SAME: f64 = 1e-15;

impl Mixture {
    /// Mixture of at least one part. Weights must be above 0 and need not sum to 1.
    pub fn new(mut parts: Vec<Part>) -> Result<Self, DistributionError> {
        if parts.is_empty() {
            return Err(DistributionError::NoParts);
        }
        for part in &parts {
            if !(part.weight > 0.0 && part.weight.is_finite()) {
                return Err(DistributionError::BadWeight { part: part.name.clone(), weight: part.weight });
            }
            if part.distribution.probability().is_none() {
                return Err(DistributionError::NotWhole { part: part.name.clone() });
            }
        }
        let total: f64 = parts.iter().map(|part| part.weight).sum();
        parts.iter_mut().for_each(|part| part.weight /= total);
        let first = parts[0].distribution.mean();
        let mean = first + weighted(&parts, |part| part.mean() - first);
        // Scale to a unit of their own, so that squares of extreme deviations do not overflow.
        let size = |part: &Part| (part.distribution.mean() - mean).abs().max(part.distribution.sigma());
        let unit = Power::of(parts.iter().map(size).fold(0.0, f64::max));
        let square = |deviation: f64| unit.inverse().times(deviation).powi(2);
        let sigma = unit.times(weighted(&parts, |part| square(part.mean() - mean) + square(part.sigma())).sqrt());
        let moments = standard_moments(&parts, mean, sigma);
        if parts.iter().any(|part| !part.distribution.standard_moments().are_finite()) {
            let reason =
                "a part has no eighth moment; a student distribution has one with more than 8 degrees of freedom";
            return Err(DistributionError::NoLaw { reason: reason.into() });
        }
        if !(mean.is_finite() && sigma.is_finite() && moments.are_finite()) {
            return Err(DistributionError::NoLaw { reason: "its moments are beyond the range of a double".into() });
        }
        let jacobi = jacobi(&parts, mean, sigma);
        let atoms = Atoms::of(&parts);
        Ok(Self { parts, mean, sigma, moments, jacobi, atoms })
    }

    fn law(part: &Part) -> &dyn Probability {
        part.distribution.probability().expect("checked when the mixture was made")
    }

    fn sum(&self, f: impl Fn(&dyn Probability) -> f64) -> f64 {
        self.parts.iter().map(|part| part.weight * f(Self::law(part))).sum()
    }

    /// Value beyond which the tail has this probability. It lies between the least and the greatest quantile of the parts.
    fn inverse(&self, p: f64, upper: bool) -> f64 {
        if checked(p).is_nan() {
            return f64::NAN;
        }
        if self.atoms.whole {
            return self.atoms.inverse(p, upper);
        }
        let quantiles = self.parts.iter().map(|part| {
            let law = Self::law(part);
            if upper { law.upper_quantile(p) } else { law.quantile(p) }
        });
        let (low, high) =
            quantiles.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        if p == 0.0 || p == 1.0 {
            return if upper == (p == 0.0) { high } else { low };
        }
        if high - low <= SAME * self.sigma {
            return low;
        }
        // Count from the mean, so that the rounding of large values does not end the search too early.
        let off = |u: f64| {
            let x = self.mean + u;
            let tail = self.sum(|law| if upper { law.sf(x) } else { law.cdf(x) });
            let slope = self.sum(|law| law.density(x).unwrap_or(f64::NAN)) / tail;
            let error = libm::log(tail / p);
            if upper { (-error, slope) } else { (error, slope) }
        };
        let found = self.mean + root([low - self.mean, high - self.mean], 0.5 * (low + high) - self.mean, off);
        self.atoms.snapped(found, ON_AN_ATOM * self.sigma)
    }
}

fn weighted(parts: &[Part], f: impl Fn(&dyn Distribution) -> f64) -> f64 {
    parts.iter().map(|part| part.weight * f(part.distribution.as_ref())).sum()
}

/// Moments about the common mean by the binomial theorem. In the excess the parts' own normal fourth moments cancel against 3 by algebra.
/// With `d` a part's offset and `1 + r` its variance, in common sigmas, the excess is
/// `sum weight (excess (1+r)^2 + 4 skewness (1+r)^(3/2) d + 6 r d^2 + d^4 + 3 r^2)`, because `sum weight (r + d^2) = 0`.
fn standard_moments(parts: &[Part], mean: f64, sigma: f64) -> StandardMoments {
    let shape = |part: &dyn Distribution| ((part.mean() - mean) / sigma, part.sigma() / sigma, part.standard_moments());
    let moment = |order: usize| {
        weighted(parts, |part| {
            let (d, s, own) = shape(part);
            let mut choose = 1.0;
            let mut sum = 0.0;
            for (k, own) in own.raw().iter().enumerate().take(order + 1) {
                sum += choose * own * s.powi(k as i32) * d.powi((order - k) as i32);
                choose *= (order - k) as f64 / (k + 1) as f64;
            }
            sum
        })
    };
    let excess = weighted(parts, |part| {
        let (d, s, own) = shape(part);
        let r = (s - 1.0) * (s + 1.0);
        let s2 = s * s;
        own.excess * s2 * s2 + 4.0 * own.skewness * s2 * s * d + 6.0 * r * d * d + d.powi(4) + 3.0 * r * r
    });
    StandardMoments::with_excess(moment(3), excess, [5, 6, 7, 8].map(moment))
}

/// Recurrence from the parts' Gauss rules of one order more, which integrate all polynomials that it needs.
fn jacobi(parts: &[Part], mean: f64, sigma: f64) -> Jacobi {
    let own: Vec<Jacobi> = parts.iter().map(|part| part.distribution.jacobi(ORDER)).collect();
    let known = own.iter().filter(|jacobi| !jacobi.is_whole()).map(|jacobi| jacobi.order() - 1).min();
    let order = known.unwrap_or(ORDER - 1);
    let mut points = Discretised::default();
    for (part, own) in parts.iter().zip(own) {
        let rule = if own.is_whole() { own.gauss() } else { own.truncated(order + 1).gauss() };
        let (d, s) = ((part.distribution.mean() - mean) / sigma, part.distribution.sigma() / sigma);
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            points.push(d + s * node, part.weight * weight);
        }
    }
    points.standardise();
    points.jacobi(order)
}

impl Distribution for Mixture {
    fn name(&self) -> &'static str {
        "mixture"
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
        let ends = self.parts.iter().map(|part| part.distribution.support());
        ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [lower, upper]| [low.min(lower), high.max(upper)])
    }

    /// Recurrence up to one order less than the shortest one of a part, at most 15.
    fn jacobi(&self, order: usize) -> Jacobi {
        self.jacobi.truncated(order)
    }

    /// Copy with every part scaled as by itself. Returns None if a part does not scale. Distances between parts count as shifts and stay.
    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let mut parts = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            match part.distribution.scaled(factor, moved)? {
                Ok(distribution) => parts.push(Part { distribution, ..part.clone() }),
                Err(error) => return Some(Err(error)),
            }
        }
        Some(Self::new(parts).map(|scaled| Arc::new(scaled) as _))
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Mixture {
    /// Density of all parts. Returns None if a part has no density.
    fn density(&self, x: f64) -> Option<f64> {
        self.parts.iter().map(|part| Some(part.weight * Self::law(part).density(x)?)).sum()
    }

    /// Corners of the parts, and the finite ends of their supports.
    fn corners(&self) -> Vec<f64> {
        let own = |part: &Part| {
            let ends = part.distribution.support().into_iter().filter(|end| end.is_finite());
            Self::law(part).corners().into_iter().chain(ends).collect::<Vec<_>>()
        };
        let mut corners: Vec<f64> = self.parts.iter().flat_map(own).collect();
        corners.sort_unstable_by(f64::total_cmp);
        corners.dedup();
        corners
    }

    fn atoms(&self) -> Vec<(f64, f64)> {
        self.atoms.values.iter().copied().zip(self.atoms.shares.iter().copied()).collect()
    }

    fn smooth_density(&self, x: f64) -> f64 {
        self.sum(|law| law.smooth_density(x))
    }

    fn cdf(&self, x: f64) -> f64 {
        clamped(self.sum(|law| law.cdf(x)))
    }

    fn sf(&self, x: f64) -> f64 {
        clamped(self.sum(|law| law.sf(x)))
    }

    fn quantile(&self, p: f64) -> f64 {
        self.inverse(p, false)
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        self.inverse(p, true)
    }

    /// Random values, each from a part drawn by weight and by the part's own method.
    fn fill(&self, rng: &mut dyn Rng, out: &mut [f64]) {
        for value in out {
            let mut left: f64 = rng.random();
            let drawn = self.parts.iter().find(|part| {
                left -= part.weight;
                left < 0.0
            });
            let part = drawn.unwrap_or(&self.parts[self.parts.len() - 1]);
            Self::law(part).fill(rng, std::slice::from_mut(value));
        }
    }
}
