//! The family of all tests of a lot.

use crate::lot::{CharacteristicInLot, CorrelationInLot, DimensionInLot};
use sensitol_numeric::lot::{LotTest, holm};

/// Adjusts all tests as one family and returns their number.
pub(super) fn adjust(
    dimensions: &mut [DimensionInLot],
    correlations: &mut [CorrelationInLot],
    characteristics: &mut [CharacteristicInLot],
) -> usize {
    let mut tests: Vec<&mut LotTest> = Vec::new();
    for one in dimensions {
        tests.extend([&mut one.mean_test, &mut one.sigma_test]);
        tests.extend(&mut one.shape_test);
        tests.extend(&mut one.trend_test);
        tests.extend(one.groups.iter_mut().map(|of| &mut of.test));
    }
    tests.extend(correlations.iter_mut().map(|pair| &mut pair.test));
    for one in characteristics {
        let all = one.against_assumed.iter_mut().chain(&mut one.against_parts);
        tests.extend(all.flatten());
    }
    // A test without a p-value refutes nothing.
    tests.iter_mut().filter(|test| test.p.is_nan()).for_each(|test| **test = LotTest::of(1.0));
    holm(&mut tests);
    tests.len()
}
