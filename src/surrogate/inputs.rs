//! What moments need to know of all inputs together.

use super::shape::{InputShape, shapes};
use crate::correlation::Correlation;
use crate::distribution::Distribution;

/// The shapes of the inputs, and how they vary together.
#[derive(Debug, Clone)]
pub struct Inputs {
    shapes: Vec<InputShape>,
    correlation: Option<Correlation>,
}

impl Inputs {
    /// Of these distributions, of which `correlation` tells by their positions here.
    pub fn new<'a>(
        distributions: impl IntoIterator<Item = &'a dyn Distribution>,
        correlation: Option<Correlation>,
    ) -> Self {
        Self { shapes: shapes(distributions), correlation }
    }

    /// Of independent inputs.
    pub fn independent(shapes: Vec<InputShape>) -> Self {
        Self { shapes, correlation: None }
    }

    /// Their shapes, in order.
    pub fn shapes(&self) -> &[InputShape] {
        &self.shapes
    }

    /// How some of them vary together.
    pub fn correlation(&self) -> Option<&Correlation> {
        self.correlation.as_ref()
    }
}
