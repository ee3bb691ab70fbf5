//! Numbers with their derivatives by the unknowns.

use crate::number::Number;

/// A value and its derivatives by all unknowns. A constant has no derivatives.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dual {
    value: f64,
    slopes: Vec<f64>,
}

impl Dual {
    /// The unknown of this index, of `count`.
    pub(crate) fn unknown(value: f64, index: usize, count: usize) -> Self {
        let mut slopes = vec![0.0; count];
        slopes[index] = 1.0;
        Self { value, slopes }
    }

    /// Derivative by the unknown of this index.
    pub(crate) fn slope(&self, index: usize) -> f64 {
        self.slopes.get(index).copied().unwrap_or(0.0)
    }

    /// A function of one number by its value and derivative.
    fn of_one(&self, value: f64, derivative: f64) -> Self {
        Self { value, slopes: self.slopes.iter().map(|slope| slope * derivative).collect() }
    }

    /// A function of two numbers by its value and derivatives.
    fn of_two(&self, other: &Self, value: f64, by: [f64; 2]) -> Self {
        let count = self.slopes.len().max(other.slopes.len());
        let slopes = (0..count).map(|index| by[0] * self.slope(index) + by[1] * other.slope(index)).collect();
        Self { value, slopes }
    }
}

impl Number for Dual {
    fn constant(value: f64) -> Self {
        Self { value, slopes: Vec::new() }
    }

    fn value(&self) -> f64 {
        self.value
    }

    fn plus(&self, other: &Self) -> Self {
        self.of_two(other, self.value + other.value, [1.0, 1.0])
    }

    fn minus(&self, other: &Self) -> Self {
        self.of_two(other, self.value - other.value, [1.0, -1.0])
    }

    fn times(&self, other: &Self) -> Self {
        self.of_two(other, self.value * other.value, [other.value, self.value])
    }

    fn over(&self, other: &Self) -> Self {
        let quotient = self.value / other.value;
        self.of_two(other, quotient, [1.0 / other.value, -quotient / other.value])
    }

    fn negative(&self) -> Self {
        self.of_one(-self.value, -1.0)
    }

    fn square_root(&self) -> Self {
        let root = self.value.sqrt();
        self.of_one(root, 0.5 / root)
    }

    fn sine(&self) -> Self {
        self.of_one(libm::sin(self.value), libm::cos(self.value))
    }

    fn cosine(&self) -> Self {
        self.of_one(libm::cos(self.value), -libm::sin(self.value))
    }

    fn angle_over(&self, x: &Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        self.of_two(x, libm::atan2(self.value, x.value), [x.value / square, -self.value / square])
    }

    fn length_with(&self, other: &Self) -> Self {
        let length = libm::hypot(self.value, other.value);
        self.of_two(other, length, [self.value / length, other.value / length])
    }

    fn absolute(&self) -> Self {
        self.of_one(self.value.abs(), self.value.signum())
    }

    fn greater(&self, other: &Self) -> Self {
        if self.value >= other.value { self.clone() } else { other.clone() }
    }
}
