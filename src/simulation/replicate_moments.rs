//! Moments and quantiles of the points of several replicates, with their standard errors.

use crate::simulation::count::Replicate;
use crate::simulation::replicate_error::of_replicates;
use sensitol_numeric::sampling::{Estimate, FEWEST, Fine, Summary, of_moments};

/// Smallest number of values beyond a quantile with which its standard error is meaningful.
const BEYOND: f64 = 5.0;

/// Bins of all replicates together. Returns None if there is no replicate with bins.
pub(super) fn pooled(replicates: &[Replicate]) -> Option<Fine> {
    let mut fines = replicates.iter().filter_map(|replicate| replicate.fine.as_ref());
    let mut all = fines.next()?.clone();
    fines.for_each(|fine| all.merge(fine));
    Some(all)
}

/// Moments of the points of all replicates. The standard errors come from the sample if it is random, else from the replicates.
pub(super) fn moments(all: &Summary, replicates: &[Replicate]) -> [Option<Estimate>; 4] {
    let mut estimates = of_moments(all);
    if replicates.len() > 1 {
        let each: Vec<[Option<Estimate>; 4]> =
            replicates.iter().map(|replicate| of_moments(&replicate.summary)).collect();
        for (moment, estimate) in estimates.iter_mut().enumerate() {
            if let Some(estimate) = estimate {
                let values = each.iter().map(|of| of[moment].map(|estimate| estimate.value));
                let known = replicates.iter().all(|replicate| replicate.summary.count() >= FEWEST);
                estimate.standard_error = of_replicates(values).filter(|_| known);
            }
        }
    }
    estimates
}

/// Quantile with its standard error: half the distance of the quantiles one binomial standard deviation on either side, or the scatter of
/// replicates.
pub(super) fn quantile(p: f64, fine: &Fine, [least, greatest]: [f64; 2], replicates: &[Replicate]) -> Option<Estimate> {
    let n = fine.total() as f64;
    // If fewer than one value is expected beyond it, it would be the least or the greatest one for any tail.
    if p.min(1.0 - p) * n < 1.0 {
        return None;
    }
    let value = fine.at_rank(p * n)?.clamp(least, greatest);
    let beyond = p.min(1.0 - p) * n / replicates.len() as f64;
    let standard_error = match replicates.len() {
        _ if beyond < BEYOND => None,
        1 => {
            let ranks = (p * (1.0 - p) * n).sqrt();
            let at = |rank: f64| fine.at_rank(rank);
            at(p * n + ranks).zip(at(p * n - ranks)).map(|(high, low)| 0.5 * (high - low))
        }
        _ => of_replicates(replicates.iter().map(|replicate| {
            let fine = replicate.fine.as_ref()?;
            fine.at_rank(p * fine.total() as f64)
        })),
    };
    // Includes the error of the interpolation within a bin.
    let standard_error = standard_error.map(|error| libm::hypot(error, fine.blur(p * n)));
    Some(Estimate { value, standard_error })
}
