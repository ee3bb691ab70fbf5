//! A distribution whose mean lies off the middle by a part of the band.

use std::sync::Arc;

use sensitol_numeric::distribution::{Distribution, Jacobi, Probability, Resample, Scaled, StandardMoments};

/// The mean that `cp` and `cpk` place: both indices stay where the tolerance changes, so the mean moves in proportion to the band.
#[derive(Debug, Clone)]
pub(super) struct OffCentre {
    pub(super) law: Arc<dyn Distribution>,
    /// How far off the middle its mean lies, in the dimension's unit.
    pub(super) by: f64,
}

impl OffCentre {
    pub(super) fn shared(self) -> Arc<dyn Distribution> {
        Arc::new(self)
    }
}

impl Distribution for OffCentre {
    fn name(&self) -> &'static str {
        self.law.name()
    }

    fn mean(&self) -> f64 {
        self.law.mean()
    }

    fn sigma(&self) -> f64 {
        self.law.sigma()
    }

    fn standard_moments(&self) -> StandardMoments {
        self.law.standard_moments()
    }

    fn support(&self) -> [f64; 2] {
        self.law.support()
    }

    fn jacobi(&self, order: usize) -> Jacobi {
        self.law.jacobi(order)
    }

    fn probability(&self) -> Option<&dyn Probability> {
        self.law.probability()
    }

    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let scaled = self.law.scaled(factor, moved + self.by * (factor - 1.0))?;
        Some(scaled.map(|law| Self { law, by: self.by * factor }.shared()))
    }

    fn measured(&self) -> Option<&dyn Resample> {
        self.law.measured()
    }
}
