//! The dimensions as a process makes them, which says how its parts lie within the band.

use std::sync::Arc;

use sensitol_numeric::dimension::Dimension;

/// The dimensions of a group as a process makes them, in the order of its members.
#[derive(Debug, Clone)]
pub struct Made(Arc<Vec<Dimension>>);

impl PartialEq for Made {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Made {
    pub fn new(dimensions: Vec<Dimension>) -> Self {
        Self(Arc::new(dimensions))
    }

    pub fn dimensions(&self) -> &[Dimension] {
        &self.0
    }
}
