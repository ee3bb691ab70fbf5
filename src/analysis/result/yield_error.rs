//! Errors of the yield that follow from the estimated errors of the moments.

use crate::method::ErrorEstimate;
use sensitol_numeric::capability::{Capability, Law};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::moments::Moments;

/// Error of the reject rate: its changes by the error of each moment, combined as the root of the sum of squares.
///
/// Returns None if an error is unknown, there are no limits, or no distribution of the Pearson system has such moments.
pub(in crate::analysis) fn of_yield(estimate: &ErrorEstimate, moments: &Moments, limits: SpecLimits) -> Option<f64> {
    limits.exist().then(|| of_shares(estimate, moments, limits)).flatten().map(|[all, ..]| all)
}

/// Errors of the shares below and above the limits, computed like [`of_yield`].
pub(in crate::analysis) fn of_sides(
    estimate: &ErrorEstimate,
    moments: &Moments,
    limits: SpecLimits,
) -> [Option<f64>; 2] {
    let of = of_shares(estimate, moments, limits);
    [of.map(|[_, below, _]| below), of.map(|[.., above]| above)]
}

/// Errors of the share of all rejects, of those below and of those above.
fn of_shares(estimate: &ErrorEstimate, moments: &Moments, limits: SpecLimits) -> Option<[f64; 3]> {
    let rejected = |moments: Moments| {
        let law = Law::fit(&moments).ok()?;
        let of = Capability::of(&law, moments.mean(), moments.sigma(), limits);
        Some([of.rejected(), of.below, of.above].map(|share| share.unwrap_or(0.0)))
    };
    let (mean, sigma, skewness, excess) = (moments.mean(), moments.sigma(), moments.skewness()?, moments.excess()?);
    let here = rejected(*moments)?;
    let [off_mean, off_sigma, off_skewness, off_kurtosis] =
        [estimate.mean?, estimate.sigma?, estimate.skewness?, estimate.kurtosis?];
    // An error of sigma as large as sigma leaves nothing known.
    if off_sigma >= sigma {
        return None;
    }
    let moved = |side: f64| {
        [
            Moments::new(mean + side * off_mean, sigma, skewness, excess),
            Moments::new(mean, sigma + side * off_sigma, skewness, excess),
            Moments::new(mean, sigma, skewness + side * off_skewness, excess),
            Moments::new(mean, sigma, skewness, excess + side * off_kurtosis),
        ]
    };
    let (up, down) = (moved(1.0), moved(-1.0));
    let part = |(up, down): (&Moments, &Moments)| {
        // A moment at the border of possible values can be moved to one side only.
        let off = [*up, *down].into_iter().filter_map(rejected);
        let off = off.map(|other| std::array::from_fn(|share| (other[share] - here[share]).abs()));
        off.reduce(|a: [f64; 3], b| std::array::from_fn(|share| a[share].max(b[share])))
    };
    let parts: Vec<[f64; 3]> = up.iter().zip(&down).map(part).collect::<Option<_>>()?;
    Some(std::array::from_fn(|share| parts.iter().map(|part| part[share]).fold(0.0, libm::hypot)))
}
