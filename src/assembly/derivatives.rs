//! Exact derivatives, of the functions that know them.

/// Where derivatives are asked for, and which.
#[derive(Debug, Clone, Copy)]
pub struct Directions<'a> {
    /// The point.
    pub point: &'a [f64],
    /// The inputs along which first and second derivatives are wanted.
    pub inputs: &'a [usize],
    /// The pairs of inputs whose mixed second derivative is wanted.
    pub pairs: &'a [(usize, usize)],
}

/// One output's derivatives at a point; None for those that do not exist there, as at a kink.
#[derive(Debug, Clone, PartialEq)]
pub struct Derivatives {
    /// By each input asked.
    pub first: Vec<Option<f64>>,
    /// Twice by each input asked.
    pub second: Vec<Option<f64>>,
    /// By both inputs of each pair asked.
    pub mixed: Vec<Option<f64>>,
}
