//! Pearson's equation, and its solution near a point.

use crate::pearson::coefficients::{Roots, Shape};

/// Greatest number of terms of a series. A panel that needs more is shortened instead.
const TERMS: usize = 48;
/// Bound for the size of a term: the series ends after two terms in a row below it.
const SMALL: f64 = 1e-18;
/// Half the length of a panel, relative to the distance of its middle to the next root. Successive terms shrink at least by this ratio.
const REACH: f64 = 0.28;
/// Greatest change of log p over half a panel.
const DROP: f64 = 2.0;
/// Greatest change of the slope of log p over half a panel, as the square root of `half^2 d / C`.
const BEND: f64 = 0.8;

/// `C(z) p' = -(c1 + d z) p` with `C(z) = 1 + c1 z + c2 z^2`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Equation {
    c1: f64,
    c2: f64,
    d: f64,
    roots: Roots,
}

/// Piece of the axis with the solution on it: `p(z) / p(middle) = sum_k a_k u^k`, `z = middle + half u`. `half` is negative if the piece
/// leads to the left, so that u grows outwards.
#[derive(Debug, Clone, Copy)]
pub(super) struct Panel {
    pub(super) middle: f64,
    pub(super) half: f64,
    terms: usize,
    series: [f64; TERMS],
}

impl Equation {
    pub(super) fn of(shape: &Shape) -> Self {
        Self { c1: shape.c1, c2: shape.c2, d: shape.d, roots: shape.roots }
    }

    /// C as a product over its roots: no cancellation near an end of the support.
    pub(super) fn c(&self, z: f64) -> f64 {
        let factor = |root: f64| if root.is_finite() { (root - z) / root } else { 1.0 };
        match self.roots {
            Roots::None => 1.0,
            Roots::Real { near, far, .. } => factor(near) * factor(far),
            Roots::Double { at } => factor(at) * factor(at),
            Roots::Complex { centre, width } => {
                let scale = libm::hypot(centre, width);
                ((z - centre) / scale).powi(2) + (width / scale).powi(2)
            }
        }
    }

    /// Derivative of `C` with respect to `z`.
    pub(super) fn c_by(&self, z: f64) -> f64 {
        self.c1 + 2.0 * self.c2 * z
    }

    pub(super) fn c2(&self) -> f64 {
        self.c2
    }

    /// Distance from `z` to the nearest root of `C`.
    fn distance(&self, z: f64) -> f64 {
        match self.roots {
            Roots::None => f64::INFINITY,
            Roots::Real { near, far, .. } => (z - near).abs().min((z - far).abs()),
            Roots::Double { at } => (z - at).abs(),
            Roots::Complex { centre, width } => libm::hypot(z - centre, width),
        }
    }

    /// Absolute value of `p'/p`.
    fn slope(&self, z: f64) -> f64 {
        ((self.c1 + self.d * z) / self.c(z)).abs()
    }

    /// Length of a panel that begins at `z`, as far as the next root limits it.
    pub(super) fn reach(&self, z: f64) -> f64 {
        2.0 * REACH * self.distance(z) / (1.0 + REACH)
    }

    /// Derivatives of `p'/p` by two parameters, given the derivatives of `c1` and `c2` by these.
    pub(super) fn slopes_by(&self, z: f64, by: [[f64; 2]; 2]) -> [f64; 2] {
        let inverse = 1.0 / self.c(z);
        let own = (self.c1 + self.d * z) * z * inverse;
        by.map(|[c1, c2]| (own * (c1 + c2 * z) - (c1 + 3.0 * c2 * z)) * inverse)
    }

    /// Panel that begins at `z` and leads outwards in the direction of `sign`. Returns None if doubles are too coarse for one.
    pub(super) fn panel(&self, z: f64, sign: f64) -> Option<Panel> {
        let mut half = REACH * self.distance(z) / (1.0 + REACH);
        half = half.min(DROP / self.slope(z)).min(BEND * (self.c(z) / self.d.abs()).sqrt());
        loop {
            let middle = z + sign * half;
            if !half.is_finite() || half <= 4.0 * f64::EPSILON * middle.abs() {
                return None;
            }
            let bend = half * (self.d.abs() / self.c(middle)).sqrt();
            let gentle = half * self.slope(middle) <= DROP && bend <= BEND;
            if let Some(panel) = gentle.then(|| self.around(middle, sign * half)).flatten() {
                return Some(panel);
            }
            half *= 0.7;
        }
    }

    /// Taylor's series about the middle by the three-term recurrence of the equation.
    fn around(&self, middle: f64, half: f64) -> Option<Panel> {
        let c = self.c(middle);
        let ratio = half / c;
        let right = [ratio * (self.c1 + self.d * middle), ratio * half * self.d];
        let left = [ratio * (self.c1 + 2.0 * self.c2 * middle), ratio * half * self.c2];
        let mut series = [0.0; TERMS];
        series[0] = 1.0;
        let (mut before, mut last) = (0.0, 1.0f64);
        for k in 0..TERMS - 1 {
            let n = k as f64;
            let next = -((right[0] + left[0] * n) * last + (right[1] + left[1] * (n - 1.0)) * before) * RECIPROCALS[k];
            series[k + 1] = next;
            if next.abs() < SMALL && last.abs() < SMALL {
                return Some(Panel { middle, half, terms: k + 1, series });
            }
            (before, last) = (last, next);
        }
        None
    }

    /// `log p(to) - log p(from)` where p falls monotonically, as accurate as the sum.
    ///
    /// `p'/p = -C'/C - (1 + c2) z/C`: the first part in closed form, the second by Gauss-Legendre on intervals of at most 0.6 of the
    /// distance to the next root.
    pub(super) fn fall(&self, from: f64, to: f64) -> f64 {
        let mut at = from;
        let mut integral = 0.0;
        while at != to {
            let step = 0.6 * self.distance(at);
            let next = if (to - at).abs() <= step { to } else { at + step.copysign(to - at) };
            if next == at {
                break;
            }
            let (middle, half) = (0.5 * (at + next), 0.5 * (next - at));
            let one = |x: f64| x / self.c(x);
            let nodes = LEGENDRE.iter().map(|(x, w)| w * (one(middle - half * x) + one(middle + half * x)));
            integral += half * nodes.sum::<f64>();
            at = next;
        }
        -libm::log(self.c(to) / self.c(from)) - (1.0 + self.c2) * integral
    }
}

impl Panel {
    /// Density relative to that in the middle, `p(z) / p(middle)`.
    pub(super) fn density(&self, u: f64) -> f64 {
        self.series[..self.terms].iter().rev().fold(0.0, |sum, a| sum * u + a)
    }

    /// Integral of `p / p(middle)` from the middle outwards to `u`.
    pub(super) fn mass(&self, u: f64) -> f64 {
        let terms = self.series[..self.terms].iter().zip(&RECIPROCALS[..self.terms]);
        self.half.abs() * u * terms.rev().fold(0.0, |sum, (a, inverse)| sum * u + a * inverse)
    }

    pub(super) fn position(&self, u: f64) -> f64 {
        self.middle + self.half * u
    }

    /// Inverse of [`position`](Self::position).
    pub(super) fn coordinate(&self, z: f64) -> f64 {
        (z - self.middle) / self.half
    }

    pub(super) fn end(&self) -> f64 {
        self.position(1.0)
    }
}

/// Reciprocals 1, 1/2, 1/3 and so on, which spare divisions.
const RECIPROCALS: [f64; TERMS] = {
    let mut reciprocals = [0.0; TERMS];
    let mut k = 0;
    while k < TERMS {
        reciprocals[k] = 1.0 / (k + 1) as f64;
        k += 1;
    }
    reciprocals
};

/// Positive nodes and weights of the Gauss-Legendre rule with 16 points (Abramowitz and Stegun 1964, table 25.4).
pub(crate) const LEGENDRE: [(f64, f64); 8] = [
    (0.09501250983763744, 0.1894506104550685),
    (0.2816035507792589, 0.18260341504492358),
    (0.45801677765722737, 0.16915651939500254),
    (0.6178762444026438, 0.14959598881657674),
    (0.755404408355003, 0.12462897125553388),
    (0.8656312023878318, 0.09515851168249279),
    (0.9445750230732326, 0.062253523938647894),
    (0.9894009349916499, 0.027152459411754096),
];
