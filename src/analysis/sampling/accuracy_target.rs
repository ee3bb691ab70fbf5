//! Comparison of estimated errors with the requested accuracies.

use crate::analysis::CharacteristicAnalysis;
use crate::method::Accuracies;
use crate::warning::Figure;

/// Greatest standard error as a part of the requested accuracy, so that two standard errors keep it. Above it the sample is drawn again.
pub(in crate::analysis) const PART: f64 = 0.5;
/// Ratio of the points of a further sample to those of the one before. The error halves, and all samples together take a third more points
/// than the last.
pub(in crate::analysis) const MORE: usize = 4;

/// Figures other than sigma with a requested accuracy: figure, estimated error (infinite if unknown), accuracy.
///
/// Figures that the characteristic does not have are left out: a shape if nothing varies, a yield without limits.
pub(in crate::analysis) fn beside_sigma(one: &CharacteristicAnalysis, wanted: &Accuracies) -> Vec<(Figure, f64, f64)> {
    let Some(moments) = one.moments.filter(|moments| moments.sigma() > 0.0) else { return Vec::new() };
    let estimate = one.error_estimate.as_ref();
    let of = |figure: Figure| match figure {
        Figure::Sigma => estimate?.sigma.map(|error| error / moments.sigma()),
        Figure::Skewness => estimate?.skewness,
        Figure::Kurtosis => estimate?.kurtosis,
        Figure::Yield => estimate?.yield_,
    };
    let asked = |&(figure, _): &(Figure, Option<f64>)| figure != Figure::Yield || one.characteristic.limits().exist();
    let each = wanted.wanted().into_iter().filter(asked);
    each.filter_map(|(figure, wanted)| Some((figure, of(figure).unwrap_or(f64::INFINITY), wanted?))).collect()
}

/// Largest ratio of an estimated error to its requested accuracy; 0 if none is requested.
pub(in crate::analysis) fn excess(one: &CharacteristicAnalysis, wanted: &Accuracies) -> f64 {
    beside_sigma(one, wanted).into_iter().map(|(_, error, wanted)| error / wanted).fold(0.0, f64::max)
}
