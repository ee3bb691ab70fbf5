//! Values with two derivatives by one variable, for maxima over an angle, and the search for such a maximum.

use std::ops::{Add, Div, Mul, Neg, Sub};

use sensitol_numeric::elementary::{Elementary, Exp, Ln};

/// Number type of the formulas of a mechanism: plain, or with derivatives by the crank angle.
pub(super) trait Real:
    Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    fn sqrt(self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn abs(self) -> Self;
    fn value(self) -> f64;
}

impl Real for f64 {
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn exp(self) -> Self {
        Exp::of(self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        Ln::of(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self
    }
}

/// A value with its first and second derivative. Sums and products with a number are inlined even where code is optimised for size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jet(pub(super) [f64; 3]);

impl Jet {
    /// Function of `x`, given its value and derivatives at `x`.
    #[inline]
    fn through(x: Self, [f, d, dd]: [f64; 3]) -> Self {
        let [_, x1, x2] = x.0;
        Self([f, d * x1, dd * x1 * x1 + d * x2])
    }
}

impl Real for Jet {
    #[inline]
    fn sqrt(self) -> Self {
        let root = self.0[0].sqrt();
        Self::through(self, [root, 0.5 / root, -0.25 / (root * self.0[0])])
    }

    #[inline]
    fn exp(self) -> Self {
        let power = Exp::of(self.0[0]);
        Self::through(self, [power; 3])
    }

    #[inline]
    fn ln(self) -> Self {
        let x = self.0[0];
        Self::through(self, [Ln::of(x), 1.0 / x, -1.0 / (x * x)])
    }

    #[inline]
    fn abs(self) -> Self {
        if self.0[0] < 0.0 { -self } else { self }
    }

    #[inline]
    fn value(self) -> f64 {
        self.0[0]
    }
}

impl Neg for Jet {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let [a, a1, a2] = self.0;
        Self([-a, -a1, -a2])
    }
}

impl Add for Jet {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, a1, a2], [b, b1, b2]) = (self.0, other.0);
        Self([a + b, a1 + b1, a2 + b2])
    }
}

impl Sub for Jet {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, a1, a2], [b, b1, b2]) = (self.0, other.0);
        Self([a - b, a1 - b1, a2 - b2])
    }
}

impl Mul for Jet {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let ([a, a1, a2], [b, b1, b2]) = (self.0, other.0);
        Self([a * b, a1 * b + a * b1, a2 * b + 2.0 * a1 * b1 + a * b2])
    }
}

impl Div for Jet {
    type Output = Self;

    #[inline]
    fn div(self, other: Self) -> Self {
        let x = other.0[0];
        self * Self::through(other, [1.0 / x, -1.0 / (x * x), 2.0 / (x * x * x)])
    }
}

impl Add<f64> for Jet {
    type Output = Self;

    #[inline(always)]
    fn add(self, constant: f64) -> Self {
        let [a, a1, a2] = self.0;
        Self([a + constant, a1, a2])
    }
}

impl Mul<f64> for Jet {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        let [a, a1, a2] = self.0;
        Self([a * factor, a1 * factor, a2 * factor])
    }
}

/// Size of the last step of the search. The remaining error is about its third power.
const LAST_STEP: f64 = 1e-6;
/// Greatest number of steps: halving ends any bracket within them.
const MOST_STEPS: usize = 64;

/// Largest value of a smooth function within `ends`, and its place. `start` lies in the same lobe.
///
/// Newton's method on the first derivative, within a bracket that the sign of the derivative narrows. The error of the last step is removed
/// by the parabola there. So the value is a smooth function of all parameters, independent of the grid and of the last step.
pub(super) fn climb(function: impl Fn(f64) -> Jet, start: f64, ends: [f64; 2]) -> Peak {
    let ([mut low, mut high], mut at) = (ends, start);
    let mut top = Peak { at, value: f64::NAN };
    for _ in 0..MOST_STEPS {
        let Jet([value, slope, curvature]) = function(at);
        top = Peak { at, value };
        if slope > 0.0 {
            low = at;
        } else {
            high = at;
        }
        let newton = at - slope / curvature;
        // If the function rises towards an end, that end is the largest.
        let inside = curvature < 0.0 && newton >= low && newton <= high;
        let next = if inside { newton } else { 0.5 * (low + high) };
        if inside && (next - at).abs() < LAST_STEP {
            return Peak { at: next, value: value - 0.5 * slope * slope / curvature };
        }
        if next == at {
            break;
        }
        at = next;
    }
    top
}

/// A maximum with its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Peak {
    pub(super) at: f64,
    pub(super) value: f64,
}
