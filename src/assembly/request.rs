//! A request to an assembly function: points, and which outputs.

pub use sensitol_numeric::points::Points;

/// A batch of points and the outputs wanted there.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The points, a column per input of the [`Signature`](super::Signature).
    pub points: &'a Points,
    /// Indices of the outputs wanted; nothing else need be computed.
    pub outputs: &'a [usize],
}

impl<'a> Request<'a> {
    /// These outputs at these points.
    pub fn values(points: &'a Points, outputs: &'a [usize]) -> Self {
        Self { points, outputs }
    }
}

/// A point to be looked up by; 0 has one sign only.
pub(super) fn bits(point: &[f64]) -> Vec<u64> {
    point.iter().map(|x| (x + 0.0).to_bits()).collect()
}
