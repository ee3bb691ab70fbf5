//! Outermost piece of the axis: a series at an end of the support, or one at infinity.

use crate::pearson::coefficients::{End, Infinity};

/// Greatest number of terms of a series.
const TERMS: usize = 120;
/// Bound for the size of a term: the series ends after two terms in a row below it.
const SMALL: f64 = 1e-18;

/// Closed form of the density beyond some place, up to a factor. Its variable `v` is the distance relative to the place where the series
/// begins to converge.
#[derive(Debug, Clone)]
pub(super) struct Ending {
    kind: Kind,
    /// End of the support, or the place from which distances towards infinity count.
    origin: f64,
    /// +1 if the distance grows with z, -1 if it shrinks.
    sign: f64,
    /// Distance from the origin at which `v` is 1.
    reach: f64,
    series: Vec<f64>,
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    /// `p ~ v^(alpha-1) sum_k d_k v^k`, v from 0 to 1.
    Finite { alpha: f64 },
    /// `p ~ v^-(r+2) sum_k d_k v^-k`, v from 1 to infinity.
    Infinite { r: f64 },
}

impl Ending {
    /// Series at the end `at` of the support, which lies to the right (`side` = 1) or to the left (-1).
    pub(super) fn finite(at: f64, side: f64, end: &End) -> Option<Self> {
        let End { alpha, k, bk } = *end;
        // The density vanishes long before it reaches so flat an end.
        if !at.is_finite() || !alpha.is_finite() || alpha > 1e6 {
            return None;
        }
        let reach = (0.3 / k.abs()).min(2.0 / (bk - k).abs());
        let series = series(|n, last, _| last * (k * n - bk) * reach / n)?;
        Some(Self { kind: Kind::Finite { alpha }, origin: at, sign: -side, reach, series })
    }

    /// Series towards infinity on the right (`side` = 1) or on the left (-1).
    pub(super) fn infinite(infinity: &Infinity, side: f64, c1_by_c2: f64) -> Option<Self> {
        let Infinity { centre, kappa2, r } = *infinity;
        let odd = 0.5 * r * c1_by_c2;
        let even = kappa2.abs();
        let reach = (2.5 * even.sqrt()).max(0.5 * odd.abs()).max((0.5 * r * even).sqrt());
        if !reach.is_finite() || reach == 0.0 || !r.is_finite() {
            return None;
        }
        let (odd, even) = (side * odd / reach, kappa2 / reach / reach);
        let series = series(|n, last, before| -(odd * last + even * (r + n) * before) / n)?;
        Some(Self { kind: Kind::Infinite { r }, origin: centre, sign: side, reach, series })
    }

    /// Distance of `z` from the origin, positive within the support.
    fn distance(&self, z: f64) -> f64 {
        self.sign * (z - self.origin)
    }

    pub(super) fn relative(&self, z: f64) -> f64 {
        self.distance(z) / self.reach
    }

    pub(super) fn position(&self, v: f64) -> f64 {
        self.origin + self.sign * self.reach * v
    }

    /// Place at which the series begins to converge.
    pub(super) fn border(&self) -> f64 {
        self.position(1.0)
    }

    /// True if the series converges at `z`.
    pub(super) fn covers(&self, z: f64) -> bool {
        let v = self.relative(z);
        match self.kind {
            Kind::Finite { .. } => v <= 1.0,
            Kind::Infinite { .. } => v >= 1.0,
        }
    }

    fn powers(&self, v: f64) -> f64 {
        match self.kind {
            Kind::Finite { .. } => v,
            Kind::Infinite { .. } => 1.0 / v,
        }
    }

    fn sum(&self, x: f64) -> f64 {
        self.series.iter().rev().fold(0.0, |sum, d| sum * x + d)
    }

    /// `log p` up to a constant of the ending.
    pub(super) fn log_density(&self, v: f64) -> f64 {
        let factor = match self.kind {
            Kind::Finite { alpha } => alpha - 1.0,
            Kind::Infinite { r } => -(r + 2.0),
        };
        // Avoids 0 * -infinity at an end with a finite density.
        let power = if factor == 0.0 { 0.0 } else { factor * libm::log(v) };
        power + libm::log(self.sum(self.powers(v)))
    }

    /// Mass beyond, divided by the density: Mills' ratio in z.
    pub(super) fn mills(&self, v: f64) -> f64 {
        let x = self.powers(v);
        let first = match self.kind {
            Kind::Finite { alpha } => alpha,
            Kind::Infinite { r } => r + 1.0,
        };
        let beyond = self.series.iter().enumerate().rev().fold(0.0, |sum, (k, d)| sum * x + d / (first + k as f64));
        self.reach * v * beyond / self.sum(x)
    }

    /// Logarithm of the mass beyond, up to the constant of [`log_density`](Self::log_density), and its derivative by `log v`.
    pub(super) fn log_mass(&self, log_v: f64) -> (f64, f64) {
        let v = libm::exp(log_v);
        let mills = self.mills(v);
        let slope = self.reach * v / mills;
        (self.log_density(v) + libm::log(mills), if matches!(self.kind, Kind::Finite { .. }) { slope } else { -slope })
    }

    /// Mass between `v` and `to`, both at a finite end, with `to` farther inside. Each term is computed without cancellation, so that a
    /// small difference keeps its digits. Includes the constant of [`log_density`](Self::log_density).
    pub(super) fn inner(&self, v: f64, to: f64) -> f64 {
        let Kind::Finite { alpha } = self.kind else { return f64::NAN };
        let log = libm::log(v / to);
        let term = |(k, d): (usize, &f64)| {
            let exponent = alpha + k as f64;
            d * libm::pow(to, exponent) * -libm::expm1(exponent * log) / exponent
        };
        self.reach * self.series.iter().enumerate().map(term).sum::<f64>()
    }

    /// Distance from the origin at the relative distance `v`.
    pub(super) fn length(&self, v: f64) -> f64 {
        self.reach * v
    }

    pub(super) fn is_finite(&self) -> bool {
        matches!(self.kind, Kind::Finite { .. })
    }
}

/// Coefficients of a series: `d_0 = 1`, and `d_n` from the two before it, until the terms are negligible. Returns None if they do not
/// become negligible.
fn series(next: impl Fn(f64, f64, f64) -> f64) -> Option<Vec<f64>> {
    let mut series = vec![1.0];
    let (mut before, mut last) = (0.0, 1.0f64);
    for n in 1..TERMS {
        let term = next(n as f64, last, before);
        series.push(term);
        if term.abs() < SMALL && last.abs() < SMALL {
            return Some(series);
        }
        (before, last) = (last, term);
    }
    None
}
