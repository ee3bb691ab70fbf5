//! Change of quantiles, and of the reject rate of a surface, by the errors of the moments.
//!
//! ```text
//! shift(y) = sigma sqrt((dm/sigma)^2 + (z ds/sigma)^2 + ((z^2 - 1) dskew/6)^2 + ((z^3 - 3 z) dkurt/24)^2),    z = (y - m)/sigma
//! error    = P(beyond y, moved by its shift towards the mean) - P(beyond y)
//! ```
//!
//! The errors of the moments move every quantile by the first-order terms of the Cornish-Fisher expansion. A limit that is moved by the
//! same amount gives the greatest share that the true one may have. Far out this is many times the share itself. Moving the parameters of a
//! fit does not show that. Source: R. A. Fisher, E. A. Cornish, Technometrics 2 (1960), eq. of the second order.

use crate::analysis::CharacteristicAnalysis;
use sensitol_numeric::law::{LawTail, SurfaceLaw};

/// Errors of the shares below and above the limits, 0 without that limit. Returns None if the error of a moment is unknown.
pub(in crate::analysis) fn error_of_shares(one: &CharacteristicAnalysis, law: &SurfaceLaw) -> Option<[f64; 2]> {
    let estimate = one.error_estimate.as_ref()?;
    let errors = [estimate.mean?, estimate.sigma?, estimate.skewness?, estimate.kurtosis?];
    let limits = one.characteristic.limits();
    let sides = [(limits.lower(), LawTail::Lower), (limits.upper(), LawTail::Upper)];
    let moved = |(limit, tail): (Option<f64>, LawTail)| {
        let Some(limit) = limit else { return 0.0 };
        let shift = moment_shift(limit, [law.mean(), law.sigma()], errors);
        let towards = limit + (law.mean() - limit).clamp(-shift, shift);
        (law.tail(towards, tail).value - law.tail(limit, tail).value).abs()
    };
    Some(sides.map(moved))
}

/// Distance by which the errors of mean, sigma, skewness and kurtosis move the quantile at a limit.
pub(in crate::analysis) fn moment_shift(
    limit: f64,
    [mean, sigma]: [f64; 2],
    [of_mean, of_sigma, of_skewness, of_kurtosis]: [f64; 4],
) -> f64 {
    let z = (limit - mean) / sigma;
    let parts = [
        of_mean,
        z * of_sigma,
        sigma * (z * z - 1.0) / 6.0 * of_skewness,
        sigma * (z.powi(3) - 3.0 * z) / 24.0 * of_kurtosis,
    ];
    parts.into_iter().fold(0.0, libm::hypot)
}

#[cfg(test)]
mod tests {
    use super::moment_shift;

    /// The quantile of a normal distribution moves with its mean exactly, and with its sigma multiplied by its distance in sigmas.
    #[test]
    fn mean_and_sigma_move_a_limit_exactly() {
        assert_eq!(moment_shift(10.0, [4.0, 2.0], [0.5, 0.0, 0.0, 0.0]), 0.5);
        // Three sigmas out an error of 0.1 of sigma moves the quantile by 0.3.
        assert!((moment_shift(10.0, [4.0, 2.0], [0.0, 0.1, 0.0, 0.0]) - 0.3).abs() < 1e-15);
    }

    /// A gamma distribution of shape k has skewness 2/sqrt(k) and kurtosis 3 + 6/k. Its quantile differs from that of a normal distribution
    /// at the same tail probability by the shift, up to the next order. Quantile of k = 10,000 at 2.326348 sigmas: 2.34107... by the
    /// Wilson-Hilferty cube, whose error is O(1/k^1.5): (1 - 1/(9k) + z/(3 sqrt k))^3.
    #[test]
    fn skewness_moves_a_limit_as_a_gamma_law_is_moved() {
        let (k, z) = (1e4f64, 2.326_347_874_040_841);
        let cube = (1.0 - 1.0 / (9.0 * k) + z / (3.0 * k.sqrt())).powi(3);
        let moved = (k * cube - k) / k.sqrt() - z;
        let own = moment_shift(z, [0.0, 1.0], [0.0, 0.0, 2.0 / k.sqrt(), 0.0]);
        assert!((own - moved).abs() < 2e-3 * moved, "{own:e} {moved:e}");
    }
}
