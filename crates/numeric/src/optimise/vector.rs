//! Vector for argmin. Its own support for `Vec` would add a second generator of random numbers.

use argmin_math::{
    ArgminAdd, ArgminDot, ArgminL1Norm, ArgminL2Norm, ArgminMinMax, ArgminMul, ArgminSignum, ArgminSub, ArgminZeroLike,
};

/// Numbers that are added, scaled and multiplied by position.
#[derive(Clone)]
pub(crate) struct Vector(pub(crate) Vec<f64>);

impl Vector {
    fn with(&self, other: &Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(&a, &b)| of(a, b)).collect())
    }

    fn each(&self, of: impl Fn(f64) -> f64) -> Self {
        Self(self.0.iter().map(|&a| of(a)).collect())
    }
}

impl ArgminAdd<Self, Self> for Vector {
    fn add(&self, other: &Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl ArgminAdd<f64, Self> for Vector {
    fn add(&self, other: &f64) -> Self {
        self.each(|a| a + other)
    }
}

impl ArgminSub<Self, Self> for Vector {
    fn sub(&self, other: &Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl ArgminSub<f64, Self> for Vector {
    fn sub(&self, other: &f64) -> Self {
        self.each(|a| a - other)
    }
}

impl ArgminMul<Self, Self> for Vector {
    fn mul(&self, other: &Self) -> Self {
        self.with(other, |a, b| a * b)
    }
}

impl ArgminMul<f64, Self> for Vector {
    fn mul(&self, other: &f64) -> Self {
        self.each(|a| a * other)
    }
}

/// A line search scales a vector by a number from the left.
impl ArgminMul<Vector, Vector> for f64 {
    fn mul(&self, other: &Vector) -> Vector {
        other.each(|a| a * self)
    }
}

impl ArgminDot<Self, f64> for Vector {
    fn dot(&self, other: &Self) -> f64 {
        self.0.iter().zip(&other.0).map(|(a, b)| a * b).sum()
    }
}

impl ArgminL1Norm<f64> for Vector {
    fn l1_norm(&self) -> f64 {
        self.0.iter().map(|a| a.abs()).sum()
    }
}

impl ArgminL2Norm<f64> for Vector {
    fn l2_norm(&self) -> f64 {
        self.0.iter().map(|a| a.powi(2)).sum::<f64>().sqrt()
    }
}

impl ArgminMinMax for Vector {
    fn min(x: &Self, y: &Self) -> Self {
        x.with(y, |a, b| if a < b { a } else { b })
    }

    fn max(x: &Self, y: &Self) -> Self {
        x.with(y, |a, b| if a > b { a } else { b })
    }
}

impl ArgminSignum for Vector {
    fn signum(self) -> Self {
        self.each(f64::signum)
    }
}

impl ArgminZeroLike for Vector {
    fn zero_like(&self) -> Self {
        self.each(|_| 0.0)
    }
}
