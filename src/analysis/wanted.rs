//! Whether the estimated errors are what was wanted.

use super::CharacteristicAnalysis;
use crate::method::Accuracies;
use crate::warning::Figure;

/// A standard error is this part of what is wanted, so that two of them keep it; where it is more, the sample is drawn again.
pub(super) const PART: f64 = 0.5;
/// A further sample has so many times the points of the one before: half its error, and all samples together take a third more points than
/// the last.
pub(super) const MORE: usize = 4;

/// The figures with an accuracy to reach beside sigma and their estimated errors, infinite where an error is unknown; without
/// figures that the characteristic does not have: a shape where nothing varies, a yield without limits.
pub(super) fn beside_sigma(one: &CharacteristicAnalysis, wanted: &Accuracies) -> Vec<(Figure, f64, f64)> {
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

/// The largest of them in parts of what is wanted; 0 where nothing is.
pub(super) fn excess(one: &CharacteristicAnalysis, wanted: &Accuracies) -> f64 {
    beside_sigma(one, wanted).into_iter().map(|(_, error, wanted)| error / wanted).fold(0.0, f64::max)
}
