//! Arithmetic of residuals and measures, on numbers with derivatives and on formulas alike.

/// A number with which the equations of joints and the measures are written once, and evaluated in several ways.
pub(crate) trait Number: Clone {
    /// A constant.
    fn constant(value: f64) -> Self;
    /// The value at the present poses.
    fn value(&self) -> f64;
    /// Sum.
    fn plus(&self, other: &Self) -> Self;
    /// Difference.
    fn minus(&self, other: &Self) -> Self;
    /// Product.
    fn times(&self, other: &Self) -> Self;
    /// Quotient.
    fn over(&self, other: &Self) -> Self;
    /// The number with the other sign.
    fn negative(&self) -> Self;
    /// Square root.
    fn square_root(&self) -> Self;
    /// Sine of an angle in radians.
    fn sine(&self) -> Self;
    /// Cosine of an angle in radians.
    fn cosine(&self) -> Self;
    /// Angle in radians of the direction (x, self).
    fn angle_over(&self, x: &Self) -> Self;
    /// Length of the vector (self, other).
    fn length_with(&self, other: &Self) -> Self;
    /// Absolute value.
    fn absolute(&self) -> Self;
    /// The greater of two numbers.
    fn greater(&self, other: &Self) -> Self;
}
