//! Univariate part of a characteristic in one dimension: a polynomial through the values at its nodes.

use crate::moments::Term;
use crate::power::rescale;
use crate::surrogate::{DerivativeOrigin, InputShape};

/// Polynomial `g(u) = c1 u + c2 u^2 + c3 u^3 + c4 u^4`, of the degree that the nodes allow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Univariate {
    pub(super) coefficients: [f64; 4],
    pub(super) degree: usize,
    pub(super) origin: DerivativeOrigin,
}

rescale!(Univariate { coefficients } without { degree, origin });

impl Univariate {
    /// Highest degree of the polynomial.
    pub const DEGREE: usize = 4;

    /// Part with the given first coefficients, up to four. They count as exact (from a formula) unless
    /// [`with_origin`](Self::with_origin) changes that.
    pub fn of_coefficients(known: &[f64]) -> Self {
        let mut coefficients = [0.0; Self::DEGREE];
        coefficients[..known.len()].copy_from_slice(known);
        Self { coefficients, degree: known.len(), origin: DerivativeOrigin::Exact }
    }

    /// Polynomial through `(u, y(u) - y(0))` at one to four different nodes, none of them 0. Returns None for another number of nodes.
    ///
    /// Exact for polynomials of a degree up to the number of nodes. If the nodes lie in symmetric pairs, odd and even part are separated,
    /// so that an even function has slope 0 to the last bit.
    ///
    /// ```
    /// use sensitol_numeric::surrogate::Univariate;
    /// let parabola = Univariate::through(&[(-1.0, 2.0), (2.0, 8.0)]).unwrap();
    /// assert_eq!((parabola.slope(), parabola.second(), parabola.degree()), (0.0, Some(4.0), 2));
    /// ```
    pub fn through(samples: &[(f64, f64)]) -> Option<Self> {
        let mut samples = samples.to_vec();
        samples.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (n, mut coefficients) = (samples.len(), [0.0; Self::DEGREE]);
        if n == 0 || n > Self::DEGREE {
            return None;
        }
        // The quotient g/u is a polynomial of one degree less through the slopes of the chords to the centre.
        let chords: Vec<(f64, f64)> = samples.iter().map(|&(u, rise)| (u, rise / u)).collect();
        if n % 2 == 0 && (0..n / 2).all(|i| chords[i].0 == -chords[n - 1 - i].0) {
            let pairs = (0..n / 2).map(|i| (chords[i], chords[n - 1 - i]));
            let (odd, even): (Vec<_>, Vec<_>) = pairs
                .map(|(left, right)| {
                    let square = right.0 * right.0;
                    ((square, 0.5 * (right.1 + left.1)), (square, 0.5 * (right.1 - left.1) / right.0))
                })
                .unzip();
            for (power, part) in [odd, even].into_iter().enumerate() {
                for (i, coefficient) in newton(&part).into_iter().enumerate() {
                    coefficients[2 * i + power] = coefficient;
                }
            }
        } else {
            coefficients[..n].copy_from_slice(&newton(&chords));
        }
        Some(Self { coefficients, degree: n, origin: DerivativeOrigin::Evaluated })
    }

    /// Sets the origin of the coefficients.
    pub fn with_origin(self, origin: DerivativeOrigin) -> Self {
        Self { origin, ..self }
    }

    /// Origin of the coefficients.
    pub fn origin(&self) -> DerivativeOrigin {
        self.origin
    }

    /// Degree up to which the coefficients are known.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Coefficients `c1` to `c4`, 0 beyond the known degree.
    pub fn coefficients(&self) -> [f64; 4] {
        self.coefficients
    }

    /// Value `g(u)` of the polynomial.
    #[inline(always)]
    pub fn value(&self, u: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |value, coefficient| (value + coefficient) * u)
    }

    /// Linear combination `a g(u) + b h(u)` of two parts.
    pub(super) fn sum(&self, a: f64, other: &Self, b: f64) -> Self {
        let coefficient = |i: usize| a * self.coefficients[i] + b * other.coefficients[i];
        Self {
            coefficients: std::array::from_fn(coefficient),
            degree: self.degree.max(other.degree),
            origin: self.origin.and(other.origin),
        }
    }

    /// First derivative at the mean, per sigma.
    pub fn slope(&self) -> f64 {
        self.coefficients[0]
    }

    /// Second derivative at the mean, per squared sigma. Returns None if it is unknown.
    pub fn second(&self) -> Option<f64> {
        (self.degree >= 2).then_some(2.0 * self.coefficients[1])
    }

    /// Coefficients of `u` and `u^2`. Returns None if the third or fourth coefficient is not 0.
    pub(super) fn parabola(&self) -> Option<[f64; 2]> {
        let [linear, curvature, third, fourth] = self.coefficients;
        (third == 0.0 && fourth == 0.0).then_some([linear, curvature])
    }

    /// Highest power with a coefficient that is not 0.
    pub fn highest_power(&self) -> usize {
        self.coefficients.iter().rposition(|of| *of != 0.0).map_or(0, |place| place + 1)
    }

    /// Largest coefficient, used as a scale.
    pub fn largest(&self) -> f64 {
        self.coefficients.iter().fold(0.0, |largest, coefficient| largest.max(coefficient.abs()))
    }

    /// True if all coefficients except the slope are at most this part of the slope.
    pub fn is_straight(&self, part: f64) -> bool {
        let [slope, higher @ ..] = self.coefficients;
        higher.iter().all(|coefficient| coefficient.abs() <= part * slope.abs())
    }

    /// Derivative `u g'(u)` of the part by the logarithm of the input's scale, at these places.
    pub(crate) fn growth_at(&self, places: &[f64]) -> Vec<f64> {
        let [a, b, c, d] = self.coefficients;
        places.iter().map(|u| (((4.0 * d * u + 3.0 * c) * u + 2.0 * b) * u + a) * u).collect()
    }

    /// Term of the moments for this part: a parabola uses the moments of the input, a higher degree its rule.
    pub fn term<'a>(&self, shape: &'a InputShape) -> Term<'a> {
        let moments = &shape.moments;
        if let Some([linear, curvature]) = self.parabola() {
            return Term::Quadratic { linear, curvature, moments };
        }
        let values = shape.rule.nodes.iter().map(|&u| self.value(u)).collect();
        Term::Tabulated { values, rule: &shape.rule, moments }
    }
}

/// Coefficients of the polynomial through these points, by divided differences.
fn newton(points: &[(f64, f64)]) -> Vec<f64> {
    let n = points.len();
    if let [(u, a), (v, b)] = *points {
        // Formula symmetric in the two points, so that opposite values cancel exactly.
        return vec![(v * a - u * b) / (v - u), (b - a) / (v - u)];
    }
    let mut differences: Vec<f64> = points.iter().map(|&(_, value)| value).collect();
    for order in 1..n {
        for i in (order..n).rev() {
            differences[i] = (differences[i] - differences[i - 1]) / (points[i].0 - points[i - order].0);
        }
    }
    let mut coefficients = vec![0.0; n];
    for i in (0..n).rev() {
        // Horner's scheme: multiply by (u - u_i), and add the next difference.
        for k in (0..n).rev() {
            coefficients[k] = if k > 0 { coefficients[k - 1] } else { 0.0 } - points[i].0 * coefficients[k];
        }
        coefficients[0] += differences[i];
    }
    coefficients
}
