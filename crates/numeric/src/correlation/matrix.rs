//! Correlation matrices: a test for definiteness, the nearest correlation matrix, and a factor.

use faer::{Mat, Side};

/// Eigenvalues above minus this are taken as rounded zeros: coefficients are typed with few digits.
const ZERO: f64 = 1e-12;
/// Greatest number of rounds of the alternating projections. They converge linearly: a few dozen give a few digits.
const ROUNDS: usize = 2000;
/// Greatest change of an element in a round at which the projections end.
const STILL: f64 = 1e-9;

/// Nearest correlation matrix if this one has a negative eigenvalue. Returns None if it has none.
///
/// Alternating projections with Dykstra's correction (Higham 2002, algorithm 3.3): nearest in the Frobenius norm.
pub(super) fn nearest_if_indefinite(matrix: &Mat<f64>) -> Option<Mat<f64>> {
    let least = |of: &Mat<f64>| eigen(of).0.into_iter().fold(f64::INFINITY, f64::min);
    let m = matrix.nrows();
    if least(matrix) >= -ZERO * m as f64 {
        return None;
    }
    let (mut y, mut correction) = (matrix.clone(), Mat::zeros(m, m));
    for _ in 0..ROUNDS {
        let shifted = &y - &correction;
        let semidefinite = clipped(&shifted);
        correction = &semidefinite - &shifted;
        let next = Mat::from_fn(m, m, |j, k| if j == k { 1.0 } else { semidefinite[(j, k)] });
        let moved = (&next - &y).norm_max();
        y = next;
        if moved < STILL {
            break;
        }
    }
    Some(y)
}

/// Factor `L` with `L L'` equal to this matrix.
pub(super) fn factor(matrix: &Mat<f64>) -> Mat<f64> {
    if let Ok(cholesky) = matrix.llt(Side::Lower) {
        let lower = cholesky.L();
        return Mat::from_fn(matrix.nrows(), matrix.nrows(), |j, k| if k <= j { lower[(j, k)] } else { 0.0 });
    }
    let (values, vectors) = eigen(matrix);
    Mat::from_fn(matrix.nrows(), matrix.nrows(), |j, k| vectors[(j, k)] * values[k].max(0.0).sqrt())
}

/// Nearest matrix without negative eigenvalues.
fn clipped(matrix: &Mat<f64>) -> Mat<f64> {
    let (values, vectors) = eigen(matrix);
    let m = matrix.nrows();
    let scaled = Mat::from_fn(m, m, |j, k| vectors[(j, k)] * values[k].max(0.0));
    let product = &scaled * vectors.transpose();
    // Make the product symmetric to the last bit.
    Mat::from_fn(m, m, |j, k| 0.5 * (product[(j, k)] + product[(k, j)]))
}

fn eigen(matrix: &Mat<f64>) -> (Vec<f64>, Mat<f64>) {
    let eigen =
        matrix.self_adjoint_eigen(Side::Lower).expect("the eigenvalues of a symmetric matrix of finite numbers");
    let values = (0..matrix.nrows()).map(|k| eigen.S()[k]).collect();
    (values, eigen.U().to_owned())
}
