//! The facts about all inputs together that moments need.

use std::sync::Arc;

use super::shape::InputShape;
use crate::correlation::Correlation;
use crate::distribution::Rule;

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

    /// With another rule for the input at this position.
    pub fn with_rule(mut self, position: usize, rule: Arc<Rule>) -> Self {
        self.shapes[position].rule = rule;
        self
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
