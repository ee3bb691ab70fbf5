//! Probability that several characteristics keep their limits together, on common points.
//!
//! ```text
//! P(any limit broken) = sum of the tails - E[ (number of broken limits - 1)+ ]
//! ```
//!
//! Each tail comes from its own distribution, and only the second term is sampled. If rejects are rare or do not coincide, that term and
//! its error are small. It is exact for two sums of normal inputs. It is also exact if all inputs have values with probabilities of their
//! own, because their combinations are listed. A value on a limit counts as kept in every branch.

use crate::characteristic::SpecLimits;
use crate::law::common_points::{CommonPoints, Counts, Limit};
use crate::law::quadrant::both_broken;
use crate::law::sampled_points::{QUANTILE, REPLICATES};
use crate::law::{LawFigure, LawTail, SurfaceLaw};
use crate::parallel::prelude::*;

/// Share of assemblies that keep all limits, for distributions over the same inputs in the same order.
///
/// Points are common to all surfaces, and most of them lie where a limit is exceeded. Cost: 2^15 values of every surface. The error
/// combines the scatter of 16 replicates and the errors of the tails. For surfaces over different inputs the result is the yield of
/// characteristics that share the input of each position.
///
/// ```
/// use std::sync::Arc;
/// use sensitol_numeric::characteristic::SpecLimits;
/// use sensitol_numeric::distribution::{Distribution, Normal};
/// use sensitol_numeric::law::{LawOptions, SurfaceLaw, joint_yield};
/// use sensitol_numeric::moments::Interactions;
/// use sensitol_numeric::surrogate::{Surrogate, Univariate};
/// let inputs: Vec<Arc<dyn Distribution>> = vec![Arc::new(Normal::new(0.0, 1.0)?), Arc::new(Normal::new(0.0, 1.0)?)];
/// let law = |slopes: [f64; 2]| {
///     let parts = slopes.map(|slope| Some(Univariate::of_coefficients(&[slope]))).to_vec();
///     let surrogate = Surrogate { centre: 0.0, parts, interactions: Interactions::none(2) };
///     SurfaceLaw::of(&surrogate, &inputs, None, &LawOptions::default())
/// };
/// // Two independent characteristics: the joint yield is the product of their yields.
/// let (first, second) = (law([1.0, 0.0])?, law([0.0, 1.0])?);
/// let limits = SpecLimits::new(Some(-2.0), Some(2.0))?;
/// let both = joint_yield(&[(&first, limits), (&second, limits)]);
/// let one = 1.0 - 2.0 * first.above(2.0).value;
/// assert!((both.value - one * one).abs() <= both.error && both.error < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn joint_yield(characteristics: &[(&SurfaceLaw, SpecLimits)]) -> LawFigure {
    let limited = limited(characteristics);
    let tails = tails(&limited);
    let sum = tails.iter().fold(LawFigure::new(0.0, 0.0), |sum, (_, tail)| {
        LawFigure::new(sum.value + tail.value, sum.error + tail.error)
    });
    let common = overlap(&limited, &tails);
    let [least, most] = joint_bounds(&by_law(&tails, limited.len()));
    LawFigure::new((1.0 - sum.value + common.value).max(least).min(most), sum.error + common.error)
}

/// Reject rate of every characteristic.
fn by_law(tails: &[(Limit, LawFigure)], laws: usize) -> Vec<f64> {
    let mut rejects = vec![0.0; laws];
    tails.iter().for_each(|(limit, tail)| rejects[limit.of] += tail.value);
    rejects
}

/// Bounds of a joint yield from the reject rates alone, for any dependence. It is at most the least single yield. It is at least the yield
/// if no assembly were rejected twice (Fréchet 1935).
///
/// ```text
/// max(0, 1 - sum of all rejects) <= P(all kept) <= 1 - max of the rejects
/// ```
pub fn joint_bounds(rejects: &[f64]) -> [f64; 2] {
    let most = 1.0 - rejects.iter().copied().fold(0.0, f64::max).min(1.0);
    [(1.0 - rejects.iter().sum::<f64>()).max(0.0).min(most), most]
}

/// Reject rates of several characteristics: the sum of the tails, and the amount by which that sum counts assemblies twice.
pub fn rejected(characteristics: &[(&SurfaceLaw, SpecLimits)]) -> (f64, LawFigure) {
    let limited = limited(characteristics);
    let tails = tails(&limited);
    (tails.iter().map(|(_, tail)| tail.value).sum(), overlap(&limited, &tails))
}

fn limited<'a>(characteristics: &[(&'a SurfaceLaw, SpecLimits)]) -> Vec<(&'a SurfaceLaw, SpecLimits)> {
    characteristics.iter().filter(|(_, limits)| limits.exist()).copied().collect()
}

fn tails(limited: &[(&SurfaceLaw, SpecLimits)]) -> Vec<(Limit, LawFigure)> {
    let of = |(of, (law, limits)): (usize, &(&SurfaceLaw, SpecLimits))| {
        let tail = |side: LawTail, y: Option<f64>| y.map(|y| (Limit { of, side }, law.tail(y, side)));
        [tail(LawTail::Lower, limits.lower()), tail(LawTail::Upper, limits.upper())]
    };
    limited.iter().enumerate().flat_map(of).flatten().collect()
}

/// Mean number of exceeded limits beyond the first. It is exact for two sums of normal inputs and for lists of values, sampled otherwise.
///
/// ```text
/// E[ (number broken - 1)+ ] = sum of the tails * mean(w (number broken - 1)+) / mean(w number broken)
/// ```
///
/// The sum of the tails is known, so the points only supply the fraction of it that exceeds another limit as well.
fn overlap(limited: &[(&SurfaceLaw, SpecLimits)], tails: &[(Limit, LawFigure)]) -> LawFigure {
    if limited.len() < 2 {
        return LawFigure::new(0.0, 0.0);
    }
    if let &[first, second] = limited
        && let Some(both) = both_broken([first, second])
    {
        return both;
    }
    let points = CommonPoints::of(limited, tails);
    if let Some(listed) = points.listed() {
        return listed;
    }
    let counts: Vec<Counts> = (0..REPLICATES).into_par_iter().map(|replicate| points.counts(replicate)).collect();
    let n = REPLICATES as f64;
    let mean = |of: fn(&Counts) -> f64| counts.iter().map(of).sum::<f64>() / n;
    let (broken, beyond) = (mean(|counts| counts.broken), mean(|counts| counts.beyond));
    let tails: f64 = tails.iter().map(|(_, tail)| tail.value).sum();
    if broken == 0.0 {
        return LawFigure::new(0.0, tails);
    }
    let (share, scale) = (beyond / broken, tails / broken);
    let off = |counts: &Counts| scale * (counts.beyond - share * counts.broken);
    let variance = counts.iter().map(|counts| off(counts) * off(counts)).sum::<f64>() / (n - 1.0);
    // The error has the same confidence as every other sampled figure. If no point exceeds two limits, a bound for rare events applies.
    let breaking = n * broken * broken / mean(|counts| counts.squares);
    let fewest = if beyond == 0.0 { tails * (3.0 / breaking).min(1.0) } else { 0.0 };
    LawFigure::new(tails * share, (QUANTILE * (variance / n).sqrt()).max(fewest))
}
