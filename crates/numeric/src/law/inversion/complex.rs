//! Complex numbers on the crate's own elementary functions, so that results have the same bits on every processor.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

use crate::elementary::{Cos, Elementary, Exp, Sin};

/// Complex number `re + i im`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::law) struct Complex {
    pub(in crate::law) re: f64,
    pub(in crate::law) im: f64,
}

impl Complex {
    pub(in crate::law) const ZERO: Self = Self { re: 0.0, im: 0.0 };
    pub(in crate::law) const ONE: Self = Self { re: 1.0, im: 0.0 };

    pub(in crate::law) const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    /// Unit complex number `exp(i angle)`.
    pub(in crate::law) fn cis(angle: f64) -> Self {
        Self { re: Cos::of(angle), im: Sin::of(angle) }
    }

    pub(in crate::law) fn exp(self) -> Self {
        Self::cis(self.im) * Exp::of(self.re)
    }

    /// Principal logarithm.
    pub(in crate::law) fn ln(self) -> Self {
        Self { re: 0.5 * libm::log(self.square()), im: libm::atan2(self.im, self.re) }
    }

    /// Squared modulus `|z|^2`.
    pub(in crate::law) fn square(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    pub(in crate::law) fn abs(self) -> f64 {
        self.square().sqrt()
    }

    pub(in crate::law) fn is_finite(self) -> bool {
        self.re.is_finite() && self.im.is_finite()
    }
}

impl From<f64> for Complex {
    fn from(re: f64) -> Self {
        Self { re, im: 0.0 }
    }
}

impl Add for Complex {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl Sub for Complex {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }
}

impl Neg for Complex {
    type Output = Self;

    fn neg(self) -> Self {
        Self { re: -self.re, im: -self.im }
    }
}

impl Mul for Complex {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}

impl Mul<f64> for Complex {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }
}

impl Div for Complex {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let square = other.square();
        Self {
            re: (self.re * other.re + self.im * other.im) / square,
            im: (self.im * other.re - self.re * other.im) / square,
        }
    }
}

impl AddAssign for Complex {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl MulAssign for Complex {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}
