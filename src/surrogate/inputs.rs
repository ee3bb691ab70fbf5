//! What moments need to know of all inputs together.

use super::shape::InputShape;
use crate::correlation::Correlation;

/// The shapes of the inputs, and how they vary together.
#[derive(Debug, Clone)]
pub struct Inputs {
    shapes: Vec<InputShape>,
    correlation: Option<Correlation>,
}

impl Inputs {
    /// Of these shapes; `correlation` tells of them by their positions here.
    pub fn new(shapes: Vec<InputShape>, correlation: Option<Correlation>) -> Self {
        Self { shapes, correlation }
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
