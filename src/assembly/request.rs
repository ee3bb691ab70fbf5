//! Request to an assembly function: points, and the requested outputs.

pub use sensitol_numeric::points::Points;

/// Batch of points, and the outputs that are requested there.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// Points, one column per input of the [`Signature`](crate::assembly::Signature).
    pub points: &'a Points,
    /// Indices of the requested outputs. Nothing else has to be computed.
    pub outputs: &'a [usize],
}

impl<'a> Request<'a> {
    /// Creates a request for these outputs at these points.
    pub fn values(points: &'a Points, outputs: &'a [usize]) -> Self {
        Self { points, outputs }
    }
}

/// Returns a key to look a point up by. Both signs of 0 give the same key.
pub(super) fn bits(point: &[f64]) -> Vec<u64> {
    point.iter().map(|x| (x + 0.0).to_bits()).collect()
}
