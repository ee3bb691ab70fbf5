//! The errors of the yield that follow from the estimated errors of the moments.

use crate::method::ErrorEstimate;
use sensitol_numeric::capability::{Capability, Law};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::moments::Moments;

/// How far the rejected share moves when each moment is off by its error, one after the other, as the root of the sum of
/// squares; None where an error is unknown, there are no limits, or no law has such moments.
pub(super) fn of_yield(estimate: &ErrorEstimate, moments: &Moments, limits: SpecLimits) -> Option<f64> {
    let rejected = |moments: Moments| {
        let law = Law::fit(&moments).ok()?;
        Capability::of(&law, moments.mean(), moments.sigma(), limits).rejected()
    };
    let (mean, sigma, skewness, excess) = (moments.mean(), moments.sigma(), moments.skewness()?, moments.excess()?);
    let here = rejected(*moments)?;
    let [off_mean, off_sigma, off_skewness, off_kurtosis] =
        [estimate.mean?, estimate.sigma?, estimate.skewness?, estimate.kurtosis?];
    // Errors as large as this say that nothing is known.
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
        // A moment at the border of what is possible has one side only.
        let off = [*up, *down].into_iter().filter_map(rejected).map(|other| (other - here).abs());
        off.reduce(f64::max)
    };
    let parts: Option<Vec<f64>> = up.iter().zip(&down).map(part).collect();
    Some(parts?.into_iter().fold(0.0, libm::hypot))
}
