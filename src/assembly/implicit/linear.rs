//! Small square systems: solution and sign of the determinant.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::prelude::*;

/// Factorised Jacobian, scaled so that its entries are of the order of 1.
pub(super) struct Linear {
    lu: PartialPivLu<f64>,
    matrix: Mat<f64>,
}

/// Smallest singular value, as part of the largest, of a direction that a step includes.
const LEAST: f64 = 1e-8;

impl Linear {
    /// Factorises a matrix. Returns None if an entry is not finite.
    pub(super) fn new(matrix: Mat<f64>) -> Option<Self> {
        let finite = (0..matrix.nrows()).all(|i| (0..matrix.ncols()).all(|j| matrix[(i, j)].is_finite()));
        finite.then(|| Self { lu: matrix.partial_piv_lu(), matrix })
    }

    /// Returns the solution of `J t = b`. If `J` is singular, it is the smallest step with the least residual.
    pub(super) fn solve(&self, b: &[f64]) -> Vec<f64> {
        let right = Mat::from_fn(b.len(), 1, |i, _| b[i]);
        let exact = self.lu.solve(&right);
        let exact: Vec<f64> = (0..b.len()).map(|i| exact[(i, 0)]).collect();
        if exact.iter().all(|t| t.is_finite()) { exact } else { self.least(b) }
    }

    /// Returns the solution of `J^T t = b`, or None if `J` is singular.
    pub(super) fn solve_transposed(&self, b: &[f64]) -> Option<Vec<f64>> {
        let found = self.lu.solve_transpose(&Mat::from_fn(b.len(), 1, |i, _| b[i]));
        let found: Vec<f64> = (0..b.len()).map(|i| found[(i, 0)]).collect();
        found.iter().all(|t| t.is_finite()).then_some(found)
    }

    /// Returns the smallest step with the least residual, along the directions that are determined.
    pub(super) fn least(&self, b: &[f64]) -> Vec<f64> {
        let Ok(svd) = self.matrix.svd() else { return vec![0.0; b.len()] };
        let (u, s, v) = (svd.U(), svd.S().column_vector(), svd.V());
        let mut t = vec![0.0; b.len()];
        for k in (0..b.len()).filter(|&k| s[k] > LEAST * s[0]) {
            let along: f64 = (0..b.len()).map(|i| u[(i, k)] * b[i]).sum::<f64>() / s[k];
            t.iter_mut().enumerate().for_each(|(j, t)| *t += along * v[(j, k)]);
        }
        t
    }

    /// Returns the sign of the determinant, which changes where a branch of solutions ends.
    pub(super) fn sign(&self) -> f64 {
        let (upper, (forward, _)) = (self.lu.U(), self.lu.P().arrays());
        let mut sign: f64 = (0..forward.len()).map(|i| upper[(i, i)].signum()).product();
        let mut seen = vec![false; forward.len()];
        for start in 0..forward.len() {
            let (mut at, mut length) = (start, 0);
            while !std::mem::replace(&mut seen[at], true) {
                at = forward[at];
                length += 1;
            }
            if length > 0 && length % 2 == 0 {
                sign = -sign;
            }
        }
        sign
    }

    /// Returns the matrix itself.
    pub(super) fn matrix(&self) -> &Mat<f64> {
        &self.matrix
    }
}
