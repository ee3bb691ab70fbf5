//! Tests of one measured dimension against the assumed distribution.

use crate::distribution::Distribution;
use crate::lot::reference_law::{chi_squared_two_sided, student_two_sided};
use crate::lot::shape::{anderson_darling_normal, cramer_von_mises_of_shape};
use crate::lot::{LotSample, LotTest};

/// Smallest number of values with a test of the shape: the formula of the p-value holds from here on.
const LEAST_OF_SHAPE: usize = 8;

/// Tests of measured values against an assumed distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColumnTests {
    /// Test of the mean.
    pub mean: LotTest,
    /// Test of the standard deviation.
    pub sigma: LotTest,
    /// Test of the shape, with mean and sigma of the values. None of fewer than eight values, or if the assumed shape is unknown.
    pub shape: Option<LotTest>,
}

impl LotSample {
    /// Tests of mean, standard deviation and shape against an assumed distribution.
    ///
    /// The mean has Student's test, the variance the chi-squared test with the degrees of freedom of the assumed kurtosis. A normal shape
    /// has the test of Anderson and Darling, another one that of Cramér and von Mises, with mean and sigma of the values.
    pub fn tests(&self, assumed: &dyn Distribution) -> ColumnTests {
        let n = self.count() as f64;
        let t = (self.mean() - assumed.mean()) / (self.sigma() / n.sqrt());
        let excess = assumed.standard_moments().kurtosis() - 3.0;
        let freedom = self.freedom(excess);
        let ratio = freedom * (self.sigma() / assumed.sigma()).powi(2);
        let shape = (self.count() >= LEAST_OF_SHAPE).then(|| match assumed.name() {
            "normal" => Some(anderson_darling_normal(self).1),
            _ => cramer_von_mises_of_shape(self, assumed),
        });
        ColumnTests {
            mean: LotTest::of(student_two_sided(t, n - 1.0)),
            sigma: LotTest::of(chi_squared_two_sided(ratio, freedom)),
            shape: shape.flatten().map(LotTest::of),
        }
    }
}
