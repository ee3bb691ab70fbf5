//! Dimensions with the distribution of the chosen process.

use std::sync::Arc;

use sensitol_numeric::dimension::Dimension;

/// Dimensions of a group with the distributions of a process, in the order of its members.
#[derive(Debug, Clone)]
pub struct Made(Arc<Vec<Dimension>>);

impl PartialEq for Made {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Made {
    /// Stores the dimensions of a group.
    pub fn new(dimensions: Vec<Dimension>) -> Self {
        Self(Arc::new(dimensions))
    }

    /// Dimensions in the order of the group's members.
    pub fn dimensions(&self) -> &[Dimension] {
        &self.0
    }
}
