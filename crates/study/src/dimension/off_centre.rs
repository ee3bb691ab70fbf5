//! Distribution whose mean lies off the middle of the band by a constant fraction of its width.

use std::sync::Arc;

use sensitol_numeric::distribution::{Distribution, Jacobi, Probability, Resample, Scaled, StandardMoments};

/// Distribution with the mean placed by `cp` and `cpk`. Both indices stay constant when the tolerance changes, so the mean moves in
/// proportion to the band.
#[derive(Debug, Clone)]
pub(super) struct OffCentre {
    pub(super) law: Arc<dyn Distribution>,
    /// Distance of the mean from the middle, in the dimension's unit, with its sign.
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
