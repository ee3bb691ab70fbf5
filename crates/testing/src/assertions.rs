//! Assertions about numbers, and dimensions for many tests.

use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::StandardMoments;

/// Asserts `|found - expected| <= tolerance max(|expected|, scale)`.
#[track_caller]
pub fn close(found: f64, expected: f64, tolerance: f64, scale: f64) {
    let error = (found - expected).abs();
    let allowed = tolerance * expected.abs().max(scale);
    assert!(error <= allowed, "{found} is {error:e} off {expected}, more than {allowed:e}");
}

/// Asserts `|found - expected| <= tolerance |expected|`.
#[track_caller]
pub fn relative(found: f64, expected: f64, tolerance: f64) {
    close(found, expected, tolerance, 0.0);
}

/// Normal dimensions `x0`, `x1` and so on with these means and tolerances.
pub fn normals(means: &[f64], tolerances: &[f64]) -> Vec<Dimension> {
    let dimension = |(index, (&mean, &tolerance)): (usize, (&f64, &f64))| {
        Dimension::normal(format!("x{index}"), mean, tolerance).unwrap()
    };
    means.iter().zip(tolerances).enumerate().map(dimension).collect()
}

/// `n` normal dimensions with mean 0 and sigma 1.
pub fn standard(n: usize) -> Vec<Dimension> {
    normals(&vec![0.0; n], &vec![3.0; n])
}

/// All numbers of the moments of a standardised variable.
pub fn fields(m: StandardMoments) -> [f64; 9] {
    [m.skewness, m.excess, m.m5, m.m6, m.m7, m.m8, m.h6, m.h7, m.h8]
}
