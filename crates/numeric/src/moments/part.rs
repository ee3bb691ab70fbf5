//! Univariate part of one input, and its joint cumulants with the input.

use crate::distribution::{Rule, StandardMoments};

/// Univariate part `g(u)` of one input. Only its variation and its mean count, so it may include a constant.
#[derive(Debug, Clone)]
pub enum Term<'a> {
    /// Quadratic `g = linear u + curvature u^2`, exact for any input by its moments 3 to 8.
    Quadratic {
        /// Coefficient of `u`.
        linear: f64,
        /// Coefficient of `u^2`.
        curvature: f64,
        /// Moments of the input.
        moments: &'a StandardMoments,
    },
    /// Tabulated `g`: any function, given at the nodes of a quadrature rule of the input.
    Tabulated {
        /// Values of `g` at the nodes of the rule.
        values: Vec<f64>,
        /// Quadrature rule of the input, in standardised units.
        rule: &'a Rule,
        /// Moments of the input.
        moments: &'a StandardMoments,
    },
}

/// Joint cumulants of a part `g` with its input `u`: the part enters the moments of the whole by these only.
///
/// The part is split as `g = p u + h` with `E[u h] = 0`. Every cumulant is computed from `p` and `h`, so that a small curvature beside a
/// large slope keeps its digits.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct JointCumulants {
    /// Slope of the best straight line, `E[g u]`.
    pub p: f64,
    /// Variance that no straight line explains, `E[h^2]`.
    pub curved: f64,
    /// Joint cumulant `cum(g, u, u)`.
    pub q: f64,
    /// Joint cumulant `cum(g, g, u)`.
    pub w: f64,
    /// Third cumulant `cum(g, g, g)`.
    pub k3: f64,
    /// Joint cumulant `cum(g, u, u, u)`.
    pub c13: f64,
    /// Joint cumulant `cum(g, g, u, u)`.
    pub c22: f64,
    /// Fourth cumulant `cum(g, g, g, g)`.
    pub k4: f64,
    /// Skewness of the input.
    pub s: f64,
    /// Excess kurtosis of the input.
    pub k: f64,
}

impl Term<'_> {
    /// Mean `E[g]`, for a quadratic the curvature.
    pub fn mean(&self) -> f64 {
        match self {
            Self::Quadratic { curvature, .. } => *curvature,
            Self::Tabulated { values, rule, .. } => expectation(rule, |i| values[i]),
        }
    }

    /// Largest coefficient or deviation, used as a scale. It is 0 only if `g` is constant.
    pub(super) fn largest(&self) -> f64 {
        match self {
            Self::Quadratic { linear, curvature, .. } => linear.abs().max(curvature.abs()),
            Self::Tabulated { values, .. } => {
                let mean = self.mean();
                values.iter().map(|value| (value - mean).abs()).fold(0.0, f64::max)
            }
        }
    }

    /// Variance of `factor g`.
    pub fn variance(&self, factor: f64) -> f64 {
        let (p, h) = self.split(factor);
        p * p + h.hh
    }

    /// Joint cumulants of `factor g`.
    pub fn part(&self, factor: f64) -> JointCumulants {
        let (p, h) = self.split(factor);
        let moments = self.moments();
        let (s, k) = (moments.skewness, moments.excess);
        // Since E h = E[u h] = 0, these are cumulants of u and h alone. The names give the powers.
        let RestCumulants { uuh, uhh, hhh, uuuh, uuhh, uhhh, hhhh, hh } = h;
        JointCumulants {
            p,
            curved: hh,
            q: p * s + uuh,
            w: p * p * s + 2.0 * p * uuh + uhh,
            k3: p * p * p * s + 3.0 * p * p * uuh + 3.0 * p * uhh + hhh,
            c13: p * k + uuuh,
            c22: p * p * k + 2.0 * p * uuuh + uuhh,
            k4: p.powi(4) * k + 4.0 * p.powi(3) * uuuh + 6.0 * p * p * uuhh + 4.0 * p * uhhh + hhhh,
            s,
            k,
        }
    }

    /// Derivatives of the joint cumulants of `factor g` by the logarithm of the input's scale, about its mean. `growth` holds the values of
    /// `u g'(u)` at the nodes of a table.
    pub(super) fn part_growth(&self, factor: f64, growth: &[f64]) -> JointCumulants {
        let ((p, h), moments) = (self.split(factor), self.moments());
        let (dp, dh) = self.split_growth(factor, growth);
        let (s, k) = (moments.skewness, moments.excess);
        JointCumulants {
            p: dp,
            curved: dh.hh,
            q: dp * s + dh.uuh,
            w: 2.0 * p * dp * s + 2.0 * (dp * h.uuh + p * dh.uuh) + dh.uhh,
            k3: 3.0 * p * p * (dp * s + dh.uuh) + 6.0 * p * dp * h.uuh + 3.0 * (dp * h.uhh + p * dh.uhh) + dh.hhh,
            c13: dp * k + dh.uuuh,
            c22: 2.0 * p * dp * k + 2.0 * (dp * h.uuuh + p * dh.uuuh) + dh.uuhh,
            k4: 4.0 * p.powi(3) * (dp * k + dh.uuuh)
                + 6.0 * p * p * (2.0 * dp * h.uuuh + dh.uuhh)
                + 12.0 * p * dp * h.uuhh
                + 4.0 * (dp * h.uhhh + p * dh.uhhh)
                + dh.hhhh,
            s: 0.0,
            k: 0.0,
        }
    }

    /// Derivative of the mean of `g` by the logarithm of the input's scale.
    pub(super) fn mean_growth(&self, growth: &[f64]) -> f64 {
        match self {
            Self::Quadratic { curvature, .. } => 2.0 * curvature,
            Self::Tabulated { rule, .. } => expectation(rule, |i| growth[i]),
        }
    }

    fn moments(&self) -> &StandardMoments {
        match self {
            Self::Quadratic { moments, .. } | Self::Tabulated { moments, .. } => moments,
        }
    }

    /// Splits `factor g - E = p u + h` into the slope and the cumulants of the rest.
    fn split(&self, factor: f64) -> (f64, RestCumulants) {
        match self {
            // Differences of a straight line leave a small curvature by rounding. An infinite moment would turn it into a figure.
            Self::Quadratic { linear, curvature, moments }
                if !moments.are_finite() && curvature.abs() <= STRAIGHT * linear.abs() =>
            {
                (factor * linear, RestCumulants::default())
            }
            Self::Quadratic { linear, curvature, moments } => {
                let (b, a) = (factor * linear, factor * curvature);
                (b + a * moments.skewness, RestCumulants::of_curvature(a, moments))
            }
            Self::Tabulated { values, rule, moments } => {
                let (p, rest) = split_table(values, rule, factor);
                let mut rest = RestCumulants::of_table(&rest, rule);
                // Without a fourth moment no curvature has a finite variance, although the rule gives one.
                if moments.excess.is_nan() {
                    let straight = rest.hh.sqrt() <= STRAIGHT * p.abs();
                    rest = RestCumulants { hh: if straight { 0.0 } else { f64::NAN }, ..RestCumulants::default() };
                }
                (p, rest)
            }
        }
    }

    /// Derivatives of the results of [`split`](Self::split) by the logarithm of the input's scale.
    fn split_growth(&self, factor: f64, growth: &[f64]) -> (f64, RestCumulants) {
        match self {
            // The slope is proportional to the scale, the curvature to its square.
            Self::Quadratic { linear, .. } => {
                let (p, h) = self.split(factor);
                (2.0 * p - factor * linear, h.growing_as_squares())
            }
            Self::Tabulated { values, rule, .. } => {
                let ((_, h), (dp, dh)) = (split_table(values, rule, factor), split_table(growth, rule, factor));
                (dp, RestCumulants::growth_of_table(&h, &dh, rule))
            }
        }
    }
}

/// Greatest ratio of curvature to slope, both per sigma, that is taken as a rounding error of differences.
const STRAIGHT: f64 = 1e-6;

/// Cumulants of `u` and `h`, where `E h = E[u h] = 0`.
#[derive(Default)]
struct RestCumulants {
    hh: f64,
    uuh: f64,
    uhh: f64,
    hhh: f64,
    uuuh: f64,
    uuhh: f64,
    uhhh: f64,
    hhhh: f64,
}

impl RestCumulants {
    /// Cumulants for `h = a (u^2 - 1 - s u)`. With `v = u^2 - 1`, every cumulant expands into those of `v` and `u`, which are the
    /// combinations in `StandardMoments`.
    fn of_curvature(a: f64, m: &StandardMoments) -> Self {
        let (s, k) = (m.skewness, m.excess);
        let (vv, uuv, uvv, vvv) = (k + 2.0, k + 2.0, m.m5 - 2.0 * s, m.m6 - 3.0 * m.kurtosis() + 2.0);
        let (uuuv, uuvv, uvvv, vvvv) = (m.m5 - 4.0 * s, m.h6, m.h7, m.h8);
        let s2 = s * s;
        Self {
            hh: a * a * (vv - s2),
            uuh: a * (uuv - s2),
            uhh: a * a * (uvv - 2.0 * s * uuv + s2 * s),
            hhh: a.powi(3) * (vvv - 3.0 * s * uvv + 3.0 * s2 * uuv - s2 * s2),
            uuuh: a * (uuuv - s * k),
            uuhh: a * a * (uuvv - 2.0 * s * uuuv + s2 * k),
            uhhh: a.powi(3) * (uvvv - 3.0 * s * uuvv + 3.0 * s2 * uuuv - s2 * s * k),
            hhhh: a.powi(4) * (vvvv - 4.0 * s * uvvv + 6.0 * s2 * uuvv - 4.0 * s2 * s * uuuv + s2 * s2 * k),
        }
    }

    /// Derivatives by the logarithm of the input's scale, if `h` is proportional to the square of the scale.
    fn growing_as_squares(self) -> Self {
        Self {
            hh: 4.0 * self.hh,
            uuh: 2.0 * self.uuh,
            uhh: 4.0 * self.uhh,
            hhh: 6.0 * self.hhh,
            uuuh: 2.0 * self.uuuh,
            uuhh: 4.0 * self.uuhh,
            uhhh: 6.0 * self.uhhh,
            hhhh: 8.0 * self.hhhh,
        }
    }

    /// Derivatives by the logarithm of the input's scale, if that of `h` is `d`.
    fn growth_of_table(h: &[f64], d: &[f64], rule: &Rule) -> Self {
        let mean = |f: &dyn Fn(f64, f64, f64) -> f64| expectation(rule, |i| f(rule.nodes[i], h[i], d[i]));
        let (hh, growth) = (mean(&|_, h, _| h * h), mean(&|_, h, d| 2.0 * h * d));
        Self {
            hh: growth,
            uuh: mean(&|u, _, d| u * u * d),
            uhh: mean(&|u, h, d| 2.0 * u * h * d),
            hhh: mean(&|_, h, d| 3.0 * h * h * d),
            uuuh: mean(&|u, _, d| u * u * u * d),
            uuhh: mean(&|u, h, d| 2.0 * (u * u - 1.0) * h * d),
            uhhh: mean(&|u, h, d| 3.0 * u * h * h * d),
            hhhh: mean(&|_, h, d| 4.0 * h * h * h * d) - 6.0 * hh * growth,
        }
    }

    fn of_table(h: &[f64], rule: &Rule) -> Self {
        let mean = |f: &dyn Fn(f64, f64) -> f64| expectation(rule, |i| f(rule.nodes[i], h[i]));
        let hh = mean(&|_, h| h * h);
        Self {
            hh,
            uuh: mean(&|u, h| u * u * h),
            uhh: mean(&|u, h| u * h * h),
            hhh: mean(&|_, h| h * h * h),
            uuuh: mean(&|u, h| u * u * u * h),
            uuhh: mean(&|u, h| (u * u - 1.0) * h * h),
            uhhh: mean(&|u, h| u * h * h * h),
            hhhh: mean(&|_, h| h.powi(4)) - 3.0 * hh * hh,
        }
    }
}

/// Slope of the best straight line through `factor g`, and the rest at the nodes.
fn split_table(values: &[f64], rule: &Rule, factor: f64) -> (f64, Vec<f64>) {
    let mean = expectation(rule, |i| values[i]);
    let centred: Vec<f64> = values.iter().map(|value| factor * (value - mean)).collect();
    let p = expectation(rule, |i| centred[i] * rule.nodes[i]);
    (p, centred.iter().zip(&rule.nodes).map(|(g, u)| g - p * u).collect())
}

fn expectation(rule: &Rule, value: impl Fn(usize) -> f64) -> f64 {
    rule.weights.iter().enumerate().map(|(i, weight)| weight * value(i)).sum()
}
