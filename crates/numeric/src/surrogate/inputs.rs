//! Properties of all inputs together that the moments need.

use std::sync::Arc;

use crate::correlation::Correlation;
use crate::distribution::Rule;
use crate::surrogate::input_shape::InputShape;

/// Shapes of the inputs, and their correlation.
#[derive(Debug, Clone)]
pub struct Inputs {
    shapes: Vec<InputShape>,
    correlation: Option<Correlation>,
}

impl Inputs {
    /// Inputs of these shapes. `correlation` refers to them by their positions here.
    pub fn new(shapes: Vec<InputShape>, correlation: Option<Correlation>) -> Self {
        Self { shapes, correlation }
    }

    /// Independent inputs of these shapes.
    pub fn independent(shapes: Vec<InputShape>) -> Self {
        Self { shapes, correlation: None }
    }

    /// Replaces the rule of the input at this position.
    pub fn with_rule(mut self, position: usize, rule: Arc<Rule>) -> Self {
        self.shapes[position].rule = rule;
        self
    }

    /// Shapes of the inputs, in order.
    pub fn shapes(&self) -> &[InputShape] {
        &self.shapes
    }

    /// Correlation of the inputs. Returns None if they are independent.
    pub fn correlation(&self) -> Option<&Correlation> {
        self.correlation.as_ref()
    }
}
