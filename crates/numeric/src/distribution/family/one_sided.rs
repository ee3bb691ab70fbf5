//! Common checks of distributions with a tail, which begin at an origin and have their mean above it.

use crate::distribution::{DistributionError, finite, positive};

/// Distance of the mean above the origin.
pub(in crate::distribution) fn above_origin(origin: f64, mean: f64) -> Result<f64, DistributionError> {
    finite("origin", origin)?;
    finite("mean", mean)?;
    let distance = mean - origin;
    if distance > 0.0 && distance.is_finite() {
        Ok(distance)
    } else {
        Err(DistributionError::NotAboveOrigin { mean, origin })
    }
}

/// Least ratio of sigma to the distance of the mean from the origin, far below the resolution of doubles.
const LEAST: f64 = 1e-12;

/// Distance of the mean from the origin, and ratio of sigma to it.
pub(in crate::distribution) fn ratio(
    origin: f64,
    mean: f64,
    sigma: f64,
    largest: f64,
) -> Result<[f64; 2], DistributionError> {
    let distance = above_origin(origin, mean)?;
    let ratio = positive("sigma", sigma)? / distance;
    if (LEAST..=largest).contains(&ratio) {
        Ok([distance, ratio])
    } else {
        Err(DistributionError::SigmaToMean { sigma, distance, least: LEAST, largest })
    }
}
