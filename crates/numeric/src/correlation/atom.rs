//! Places of a block with their probabilities.

/// Place of a block with its probability.
pub struct Atom {
    pub(crate) weight: f64,
    /// Coordinate of each member, in sigmas off its mean.
    pub(crate) u: Vec<f64>,
}
