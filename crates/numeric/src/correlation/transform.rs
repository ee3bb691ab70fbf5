//! Input as a function of a normal variable: `T(z) = (F^-1(Phi(z)) - mean)/sd`.

use std::f64::consts::PI;
use std::sync::LazyLock;

use crate::distribution::{Distribution, Normal, behind_normal};

/// Transform from a normal variable to an input, with its Hermite series.
#[derive(Debug, Clone, PartialEq)]
pub struct Transform {
    kind: Kind,
}

#[derive(Debug, Clone, PartialEq)]
enum Kind {
    /// Identity, `T(z) = z`, for a normal input.
    Normal,
    Tabulated {
        /// Values of `T` at the places of the grid.
        values: Vec<f64>,
        /// `c_n = E[T(z) He_n(z)]/sqrt(n!)` from n = 1 on.
        series: Vec<f64>,
        /// True if there is a density, so that a cubic between the places of the grid is accurate.
        smooth: bool,
    },
}

/// Greatest place of the grid on either side. Beyond, even the square of a lognormal with log-sd 3 is negligible.
const REACH: i32 = 16;
/// Places of the grid per unit: ten for a wave of the highest Hermite function.
const PER_UNIT: i32 = 64;
/// Terms of the Hermite series. Smooth distributions need a dozen. A triangle, whose mode is a jump of a second derivative, leaves 1e-8
/// beyond these.
const TERMS: usize = 256;
/// Excess of a required correlation over the possible range that is taken as rounding.
const SLACK: f64 = 1e-9;

/// Places of the grid, and `sqrt(density)` there. The squares of the roots times the spacing are the weights of the trapezoidal rule, which
/// converges faster than any power for integrands that decay like a normal density.
static GRID: LazyLock<[Vec<f64>; 2]> = LazyLock::new(|| {
    let places = (-REACH * PER_UNIT..=REACH * PER_UNIT).map(|i| f64::from(i) / f64::from(PER_UNIT));
    let places: Vec<f64> = places.collect();
    let roots = places.iter().map(|z| libm::exp(-0.25 * z * z) / (2.0 * PI).sqrt().sqrt()).collect();
    [places, roots]
});

fn places() -> &'static [f64] {
    &GRID[0]
}

fn roots() -> &'static [f64] {
    &GRID[1]
}

fn spacing() -> f64 {
    1.0 / f64::from(PER_UNIT)
}

impl Transform {
    /// Transform for this distribution. Returns None if only its moments are known.
    pub fn of(distribution: &dyn Distribution) -> Option<Self> {
        let law = distribution.probability()?;
        if distribution.name() == Normal::NAME {
            return Some(Self { kind: Kind::Normal });
        }
        let (mean, sigma) = (distribution.mean(), distribution.sigma());
        let values: Vec<f64> = places().iter().map(|&z| (behind_normal(law, z) - mean) / sigma).collect();
        let series = series(&values);
        Some(Self { kind: Kind::Tabulated { values, series, smooth: law.density(mean).is_some() } })
    }

    /// True if the input is normal.
    pub fn is_normal(&self) -> bool {
        self.kind == Kind::Normal
    }

    /// Value `T(z)`, by a cubic between the places of the grid. Error: 1e-8 if quantiles are smooth, 1e-6 beside the mode of a triangle.
    pub fn value(&self, z: f64) -> f64 {
        let Kind::Tabulated { values, smooth, .. } = &self.kind else { return z };
        let place = ((z + f64::from(REACH)) * f64::from(PER_UNIT)).clamp(1.0, (values.len() - 3) as f64);
        let at = place as usize;
        let t = place - at as f64;
        if !smooth {
            return values[at] + t * (values[at + 1] - values[at]);
        }
        let [a, b, c, d] = [values[at - 1], values[at], values[at + 1], values[at + 2]];
        // Lagrange's cubic through four places.
        let (p, q, r) = (t + 1.0, t - 1.0, t - 2.0);
        -a * t * q * r / 6.0 + 0.5 * b * p * q * r - 0.5 * c * p * t * r + d * p * t * q / 6.0
    }

    /// Coefficients of the best line and parabola in `z`: `E[g(T(z)) z]` and `E[g(T(z)) (z^2 - 1)]/2`.
    pub(crate) fn projected(&self, g: impl Fn(f64) -> f64) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (index, (&z, root)) in places().iter().zip(roots()).enumerate() {
            let weighted = g(self.kind.values()[index]) * root * root * spacing();
            sums[0] += weighted * z;
            sums[1] += weighted * 0.5 * (z * z - 1.0);
        }
        sums
    }

    /// Correlation of two inputs whose normal variables have the correlation `r`.
    pub fn seen(&self, other: &Self, r: f64) -> f64 {
        match (&self.kind, &other.kind) {
            (Kind::Normal, Kind::Normal) => r,
            (Kind::Normal, Kind::Tabulated { series, .. }) | (Kind::Tabulated { series, .. }, Kind::Normal) => {
                series[0] * r
            }
            (Kind::Tabulated { series: a, .. }, Kind::Tabulated { series: b, .. }) => mehler(a, b, r).0,
        }
    }

    /// Correlation of the normal variables behind two inputs with this correlation. Returns the attainable range as the error if there is
    /// none.
    pub fn behind(&self, other: &Self, correlation: f64) -> Result<f64, [f64; 2]> {
        let range = self.range(other);
        if correlation < range[0] - SLACK || correlation > range[1] + SLACK {
            return Err(range);
        }
        let (a, b) = match (&self.kind, &other.kind) {
            (Kind::Normal, Kind::Normal) => return Ok(correlation),
            (Kind::Normal, Kind::Tabulated { series, .. }) | (Kind::Tabulated { series, .. }, Kind::Normal) => {
                return Ok((correlation / series[0]).clamp(-1.0, 1.0));
            }
            (Kind::Tabulated { series: a, .. }, Kind::Tabulated { series: b, .. }) => (a, b),
        };
        if correlation == 0.0 {
            return Ok(0.0);
        }
        // Newton's method between bounds, which is safe since the series is increasing.
        let (mut low, mut high, mut r) = (-1.0, 1.0, correlation);
        for _ in 0..200 {
            let (value, slope) = mehler(a, b, r);
            if value < correlation {
                low = r
            } else {
                high = r
            }
            let newton = r - (value - correlation) / slope;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if next == r || high <= low + f64::EPSILON {
                break;
            }
            r = next;
        }
        Ok(r)
    }

    /// Least and greatest correlation of two inputs, attained if both are functions of one normal variable, falling or rising.
    fn range(&self, other: &Self) -> [f64; 2] {
        let (a, b) = match (&self.kind, &other.kind) {
            (Kind::Normal, Kind::Normal) => return [-1.0, 1.0],
            (a, b) => (a.values(), b.values()),
        };
        let product = |i: usize, k: usize| a[i] * b[k] * roots()[i] * roots()[i] * spacing();
        let last = a.len() - 1;
        let sum = |k: &dyn Fn(usize) -> usize| (0..=last).map(|i| product(i, k(i))).sum::<f64>();
        [sum(&|i| last - i).max(-1.0), sum(&|i| i).min(1.0)]
    }
}

impl Kind {
    /// Values of `T` at the places of the grid.
    fn values(&self) -> &[f64] {
        match self {
            Self::Normal => places(),
            Self::Tabulated { values, .. } => values,
        }
    }
}

/// Coefficients `c_n` by the trapezoidal rule with normalised Hermite functions, whose recurrence neither grows nor cancels.
fn series(values: &[f64]) -> Vec<f64> {
    let (z, roots) = (places(), roots());
    let (mut before, mut now) = (vec![0.0; z.len()], roots.to_vec());
    (1..=TERMS)
        .map(|n| {
            let n = n as f64;
            for i in 0..z.len() {
                let next = (z[i] * now[i] - (n - 1.0).sqrt() * before[i]) / n.sqrt();
                (before[i], now[i]) = (now[i], next);
            }
            spacing() * (0..z.len()).map(|i| values[i] * roots[i] * now[i]).sum::<f64>()
        })
        .collect()
}

/// Mehler's series at `r`, and its slope.
fn mehler(a: &[f64], b: &[f64], r: f64) -> (f64, f64) {
    let terms = a.iter().zip(b).enumerate().rev();
    let (value, slope) =
        terms.fold((0.0, 0.0), |(value, slope), (n, (a, b))| (value * r + a * b, slope * r + (n + 1) as f64 * a * b));
    (value * r, slope)
}
