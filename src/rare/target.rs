//! A rare event: a characteristic beyond one of its limits, as the surrogate sees it.

use super::space::{Columns, Space};
use sensitol_numeric::surrogate::Surrogate;

/// One limit of one characteristic.
pub(super) struct Target<'a> {
    pub(super) space: &'a Space<'a>,
    pub(super) characteristic: usize,
    /// 1 for what lies above the limit, -1 for what lies below.
    pub(super) side: f64,
    /// Where the means lie beyond the limit, what keeps it is sought instead: the rarer of the two.
    pub(super) kept: bool,
    /// The limit as it was given.
    pub(super) given: f64,
    /// The last value that keeps it.
    pub(super) limit: f64,
    pub(super) surrogate: &'a Surrogate,
    /// The surrogate's, to measure by.
    pub(super) sigma: f64,
}

impl Target<'_> {
    /// 1 where what is sought lies above the limit, -1 where it lies below.
    fn sign(&self) -> f64 {
        if self.kept { -self.side } else { self.side }
    }

    /// Whether a value of the model is one that is sought.
    pub(super) fn sought(&self, value: f64) -> bool {
        (self.side * (value - self.limit) > 0.0) != self.kept
    }

    /// How far a value lies among those sought, in sigmas; negative where it is none.
    pub(super) fn margin_of(&self, value: f64) -> f64 {
        self.sign() * (value - self.limit) / self.sigma
    }

    /// How far the surrogate lies among those sought at these normal variables, in sigmas; negative where it does not.
    pub(super) fn margins(&self, normals: &Columns) -> Vec<f64> {
        let mut margins = self.surrogate.rises(&self.space.standardised(normals)).unwrap_or_default();
        let short = self.limit - self.surrogate.centre;
        margins.iter_mut().for_each(|rise| *rise = self.sign() * (*rise - short) / self.sigma);
        margins
    }

    /// The margin at a point and its gradient by central differences.
    pub(super) fn gradient(&self, at: &[f64]) -> (f64, Vec<f64>) {
        /// In sigmas: the surrogate is a polynomial of low degree.
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
