//! Sums and products in double-word arithmetic: the second double holds the rounding error of the first.
//!
//! The algorithms of M. Joldes, J.-M. Muller and V. Popescu, "Tight and rigorous error bounds for basic building blocks of double-word
//! arithmetic", ACM TOMS 44 (2017), 15. The relative error of sums and products is a few `2^-106`.

use std::ops::{Add, Mul, Sub};

/// Exact sum of two doubles that do not overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Double {
    high: f64,
    low: f64,
}

impl Double {
    /// `a + b` without rounding error.
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let from_a = high - b;
        let from_b = high - from_a;
        Self { high, low: (a - from_a) + (b - from_b) }
    }

    /// `a b` without rounding error.
    pub(crate) fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        Self { high, low: a.mul_add(b, -high) }
    }

    /// `a + b` without rounding error, provided `|a| >= |b|`.
    fn ordered(a: f64, b: f64) -> Self {
        let high = a + b;
        Self { high, low: b - (high - a) }
    }
}

impl From<f64> for Double {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl From<Double> for f64 {
    fn from(value: Double) -> Self {
        value.high
    }
}

/// Algorithm 4 of Joldes et al.
impl Add<f64> for Double {
    type Output = Self;

    fn add(self, other: f64) -> Self {
        let sum = Self::sum(self.high, other);
        Self::ordered(sum.high, self.low + sum.low)
    }
}

/// Algorithm 6 of Joldes et al.
impl Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, low) = (Self::sum(self.high, other.high), Self::sum(self.low, other.low));
        let first = Self::ordered(high.high, high.low + low.high);
        Self::ordered(first.high, low.low + first.low)
    }
}

impl Sub<f64> for Double {
    type Output = Self;

    fn sub(self, other: f64) -> Self {
        self + -other
    }
}

impl Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

/// Algorithm 9 of Joldes et al.
impl Mul<f64> for Double {
    type Output = Self;

    fn mul(self, other: f64) -> Self {
        let product = Self::product(self.high, other);
        Self::ordered(product.high, self.low.mul_add(other, product.low))
    }
}

impl Mul<Double> for f64 {
    type Output = Double;

    fn mul(self, other: Double) -> Double {
        other * self
    }
}

/// Algorithm 12 of Joldes et al.
impl Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = Self::product(self.high, other.high);
        let mixed = self.low.mul_add(other.high, self.high.mul_add(other.low, self.low * other.low));
        Self::ordered(product.high, product.low + mixed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integers of at most 62 bits: 128-bit arithmetic gives the exact sums and products, and two doubles hold all their digits.
    #[test]
    fn what_two_doubles_hold_is_exact() {
        let whole = |value: Double| value.high as i128 + value.low as i128;
        let of = |value: i64| {
            let high = value as f64;
            Double::sum(high, (i128::from(value) - high as i128) as f64)
        };
        for a in [1, -3, 94_906_267, (1 << 53) + 1, -(1 << 61) + 12_345, 4_503_599_627_370_497] {
            for b in [7, -1, 67_108_865, (1 << 40) + 3] {
                assert_eq!(whole(of(a) + of(b)), i128::from(a) + i128::from(b), "{a} + {b}");
                assert_eq!(whole(of(a) - of(b)), i128::from(a) - i128::from(b), "{a} - {b}");
                assert_eq!(whole(of(a) + b as f64), i128::from(a) + i128::from(b), "{a} + {b}");
                assert_eq!(whole(of(a) * b as f64), i128::from(a) * i128::from(b), "{a} * {b}");
                assert_eq!(whole(of(a) * of(b)), i128::from(a) * i128::from(b), "{a} * {b}");
                assert_eq!(whole(b as f64 * of(a)), i128::from(a) * i128::from(b), "{b} * {a}");
            }
        }
    }

    /// `(1 + e)^2 - 1 - 2e = e^2` is lost in one double, for `e = 2^-40`.
    #[test]
    fn a_difference_keeps_its_digits() {
        let e = f64::powi(2.0, -40);
        let square = Double::from(1.0 + e) * Double::from(1.0 + e);
        assert_eq!(f64::from(square - 1.0 - 2.0 * e), e * e);
        assert_eq!((1.0 + e) * (1.0 + e) - 1.0 - 2.0 * e, 0.0);
    }
}
