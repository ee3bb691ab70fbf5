//! Figures with intervals, tests, and the level of a family of tests.

use serde::Serialize;

/// An estimate and its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LotFigure {
    /// Estimate.
    pub value: f64,
    /// 95 % interval.
    pub interval: [f64; 2],
}

/// A test of a measured figure against an assumption.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LotTest {
    /// Probability of a figure at least this far off if the assumption holds.
    pub p: f64,
    /// Probability for the whole family of tests, by Holm's method: at most the family-wise level if the assumption is refuted.
    pub adjusted: f64,
}

impl LotTest {
    /// Returns a test that stands alone.
    pub fn of(p: f64) -> Self {
        Self { p, adjusted: p }
    }

    /// True if the assumption is refuted at this level of the whole family.
    pub fn refutes(&self, level: f64) -> bool {
        self.adjusted <= level
    }
}

/// Adjusts the p-values of a family of tests: with any dependence, those up to `level` hold a false alarm with at most that probability.
///
/// Source: S. Holm, A simple sequentially rejective multiple test procedure, Scandinavian Journal of Statistics 6 (1979).
///
/// ```
/// use sensitol_numeric::lot::{LotTest, holm};
/// let mut tests = [0.01, 0.04, 0.03].map(LotTest::of);
/// holm(&mut tests.iter_mut().collect::<Vec<_>>());
/// let adjusted = tests.map(|test| test.adjusted);
/// assert!((adjusted[0] - 0.03).abs() < 1e-15 && adjusted[1] == 0.06 && adjusted[2] == 0.06);
/// ```
pub fn holm(tests: &mut [&mut LotTest]) {
    tests.sort_by(|a, b| a.p.total_cmp(&b.p));
    let mut least = 0.0_f64;
    let count = tests.len();
    for (place, test) in tests.iter_mut().enumerate() {
        least = least.max((count - place) as f64 * test.p).min(1.0);
        test.adjusted = least;
    }
}
