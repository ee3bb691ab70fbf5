//! Nominal values moved to where the fewest assemblies are rejected.

use super::minimise::minimised;
use super::response::Responses;
use crate::capability::Law;
use crate::characteristic::SpecLimits;
use crate::moments::Moments;
use crate::problem::Problem;

/// Steps of the central differences, in sigmas.
const STEP: f64 = 1e-4;
/// The gradient of the logarithm per sigma at which it is at rest.
const REST: f64 = 1e-9;
const DESCENT: u64 = 200;

/// By how many sigmas each of these dimensions should move so that the fewest assemblies are rejected, all characteristics with limits
/// together; at fixed derivatives. None where that is unknown.
///
/// Minimised is `ln (sum of rejected shares) - ln (least share kept)`, which has a slope however far off the limits are. Where several
/// dimensions do the same, each moves in proportion to its effect, the least way in sigmas.
pub(super) fn shifts(problem: &Problem, responses: &Responses, of: &[usize]) -> Option<Vec<f64>> {
    let limited: Vec<(usize, SpecLimits)> = (problem.characteristics().iter().enumerate())
        .map(|(c, one)| (c, one.limits()))
        .filter(|(_, limits)| limits.exist())
        .collect();
    let ones = vec![1.0; problem.dimensions().len()];
    let value = |shifts: &[f64]| -> Option<f64> {
        let mut all = vec![0.0; ones.len()];
        of.iter().zip(shifts).for_each(|(&d, &shift)| all[d] = shift);
        let (mut rejected, mut kept) = (0.0, f64::INFINITY);
        for &(c, limits) in &limited {
            let moments = responses.moments_shifted(c, &ones, Some(&all))?;
            let [out, within] = shares(&moments, limits)?;
            rejected += out.exp();
            kept = within.min(kept);
        }
        Some(rejected.max(f64::MIN_POSITIVE).ln() - kept)
    };
    let function = |shifts: &[f64]| {
        let here = value(shifts)?;
        let mut at = shifts.to_vec();
        let gradient: Option<Vec<f64>> = (0..shifts.len())
            .map(|j| {
                at[j] = shifts[j] + STEP;
                let up = value(&at);
                at[j] = shifts[j] - STEP;
                let down = value(&at);
                at[j] = shifts[j];
                Some((up? - down?) / (2.0 * STEP))
            })
            .collect();
        Some((here, gradient?))
    };
    let start = vec![0.0; of.len()];
    value(&start)?;
    Some(minimised(&function, &start, REST, DESCENT))
}

/// Logarithms of the shares rejected and kept.
fn shares(moments: &Moments, limits: SpecLimits) -> Option<[f64; 2]> {
    let Law::Pearson(law) = Law::fit(moments).ok()? else { return None };
    let below = limits.lower().map_or(f64::NEG_INFINITY, |lower| law.log_cdf(lower));
    let above = limits.upper().map_or(f64::NEG_INFINITY, |upper| law.log_sf(upper));
    let most = below.max(above);
    // Beyond all that doubles tell, and beyond the end of a law with ends: as far as its quantiles reach.
    let out =
        if most == f64::NEG_INFINITY { -700.0 } else { most + ((below - most).exp() + (above - most).exp()).ln() };
    let left = limits.lower().map_or(0.0, |lower| law.log_sf(lower));
    let right = limits.upper().map_or(0.0, |upper| law.log_cdf(upper));
    Some([out.max(-700.0), left.min(right).max(-1e5)])
}
