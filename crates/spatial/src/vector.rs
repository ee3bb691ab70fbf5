//! Vectors of three numbers.

use crate::number::Number;

/// A vector in space.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Vector<S>(pub(crate) [S; 3]);

impl<S: Number> Vector<S> {
    /// A vector of constants.
    pub(crate) fn constant(parts: [f64; 3]) -> Self {
        Self(parts.map(S::constant))
    }

    /// The vector with every part replaced.
    pub(crate) fn map(&self, change: impl FnMut(&S) -> S) -> Self {
        Self(self.0.each_ref().map(change))
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self([0, 1, 2].map(|i| self.0[i].plus(&other.0[i])))
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        Self([0, 1, 2].map(|i| self.0[i].minus(&other.0[i])))
    }

    pub(crate) fn scaled(&self, factor: &S) -> Self {
        self.map(|part| factor.times(part))
    }

    /// Scalar product.
    pub(crate) fn dot(&self, other: &Self) -> S {
        let products = [0, 1, 2].map(|i| self.0[i].times(&other.0[i]));
        products[0].plus(&products[1]).plus(&products[2])
    }

    /// Vector product.
    pub(crate) fn cross(&self, other: &Self) -> Self {
        let part = |i: usize, j: usize| self.0[i].times(&other.0[j]).minus(&self.0[j].times(&other.0[i]));
        Self([part(1, 2), part(2, 0), part(0, 1)])
    }

    /// Length.
    pub(crate) fn length(&self) -> S {
        self.dot(self).square_root()
    }

    /// The vector of length 1 in this direction.
    pub(crate) fn unit(&self) -> Self {
        let length = self.length();
        self.map(|part| part.over(&length))
    }

    /// Values of the parts.
    pub(crate) fn values(&self) -> [f64; 3] {
        self.0.each_ref().map(Number::value)
    }
}
