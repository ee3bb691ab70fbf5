//! Rare event: a characteristic beyond one of its limits, by its surrogate.

use crate::estimate::{Columns, NormalSpace};
use sensitol_numeric::surrogate::Surrogate;

pub(super) struct Target<'a> {
    pub(super) space: &'a NormalSpace<'a>,
    pub(super) characteristic: usize,
    /// 1 if rejects lie above the limit, -1 if they lie below.
    pub(super) side: f64,
    /// True if the means lie beyond the limit. Values that keep the limit are then sought, because they are the rarer
    /// ones.
    pub(super) kept: bool,
    /// Limit as it was given.
    pub(super) given: f64,
    /// Last value that keeps the limit.
    pub(super) limit: f64,
    pub(super) surrogate: &'a Surrogate,
    /// Sigma of the surrogate, the unit of margins.
    pub(super) sigma: f64,
}

impl Target<'_> {
    /// 1 if the sought values lie above the limit, -1 if they lie below.
    fn sign(&self) -> f64 {
        if self.kept { -self.side } else { self.side }
    }

    /// True if a value of the model is one of those sought.
    pub(super) fn sought(&self, value: f64) -> bool {
        (self.side * (value - self.limit) > 0.0) != self.kept
    }

    /// Distance of a value from the limit in sigmas, positive on the sought side.
    pub(super) fn margin_of(&self, value: f64) -> f64 {
        self.sign() * (value - self.limit) / self.sigma
    }

    /// Distance of the surrogate's values from the limit in sigmas at these normal variables, positive on the sought
    /// side.
    pub(super) fn margins(&self, normals: &Columns) -> Vec<f64> {
        let mut margins = self.surrogate.rises(&self.space.standardised(normals)).unwrap_or_default();
        let short = self.limit - self.surrogate.centre;
        margins.iter_mut().for_each(|rise| *rise = self.sign() * (*rise - short) / self.sigma);
        margins
    }

    /// Margin at a point, and its gradient by central differences.
    pub(super) fn gradient(&self, at: &[f64]) -> (f64, Vec<f64>) {
        /// Step in sigmas. It is small enough because the surrogate is a polynomial of low degree.
        const STEP: f64 = 1e-2;
        let n = at.len();
        let mut around: Columns = at.iter().map(|&z| vec![z; 2 * n + 1]).collect();
        for (j, column) in around.iter_mut().enumerate() {
            column[2 * j] += STEP;
            column[2 * j + 1] -= STEP;
        }
        let margins = self.margins(&around);
        (margins[2 * n], (0..n).map(|j| (margins[2 * j] - margins[2 * j + 1]) / (2.0 * STEP)).collect())
    }
}
