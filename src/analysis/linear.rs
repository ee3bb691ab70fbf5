//! Results of slopes and tolerance bands alone: worst case, RSS, and the two usual inflations of it.
//!
//! ```text
//! worst case       W = sum of |b_i| T_i            b_i: slope, T_i: half band (three sigma without a band)
//! RSS              R = sqrt(sum of (b_i T_i)^2), with correlation sqrt(t'C t) of t_i = b_i T_i
//! inflated RSS     1.5 R
//! mean-shift RSS   m W + (1 - m) R                 m = 0.5
//! six sigma        sqrt(sum of (b_i s_i/(1 - k_i))^2)
//! ```
//!
//! about the value at the middles of all bands, in one linear model. Coordinates of one circular zone reach `T sqrt(b_x^2 + b_y^2)`
//! together in the worst case, not `T (|b_x| + |b_y|)`: no point of the zone is at both ends at once. Those of a diamond reach
//! the larger of the two. The root of the sum
//! of squares is the same for zone and box.
//!
//! Sources: A. Bender, "Benderizing tolerances", Graphic Science, December 1962, and SAE paper 680490 (1968): processes are not as
//! normal and as centred as RSS takes them to be, and a factor of 1.5 covers that. W. H. Greenwood, K. W. Chase, "A new
//! tolerance analysis method for designers and manufacturers", J. Eng. Industry 109 (1987), and K. W. Chase, A. R. Parkinson, "A
//! survey of research in the application of tolerance analysis", Research in Engineering Design 3 (1991), the estimated
//! mean shift model `sum of m_i |b_i| T_i + sqrt(sum of ((1 - m_i) b_i T_i)^2)`: means may lie off their middles, all the
//! wrong way, and what is left of each band is random. With the six-sigma tradition's shift of 1.5 sigma and three
//! sigma in every half band, all `m_i` are 0.5. That shift is of the band and not of a dimension's own sigma, as RSS and worst
//! case are of the bands: a process that is better than its tolerance asks is rewarded by the moments.
//!
//! Factors and shifts may be said of every dimension: then `sqrt(sum of (c_i b_i T_i)^2)` and `sum of m_i |b_i| T_i + sqrt(sum of
//! ((1 - m_i) b_i T_i)^2)`. The modified factor is `1 + (W - R)/(2 R (sqrt n - 1))` of `n` dimensions, 1 of one (P. Drake, Dimensioning and
//! Tolerancing Handbook, McGraw-Hill 1999, chapter 9). The six-sigma sum takes sigma of a lot `s` and the shift `k` of its mean in half
//! bands as an effective sigma `s/(1 - k)` (M. J. Harry, R. Stewart, Six Sigma Mechanical Design Tolerancing, Motorola 1988); with a shift of
//! a whole half band there is none.

use crate::problem::Problem;
use sensitol_numeric::correlation::JointLaw;
use sensitol_numeric::dimension::RssFactor;

/// The factor of the inflated RSS.
const INFLATION: f64 = 1.5;
/// The part of every half band by which its mean may be off: 1.5 sigma of 3.
const MEAN_SHIFT: f64 = 0.5;

/// The intervals of one characteristic in a linear model, as half widths about `middle`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Linear {
    /// How far the characteristic is from nominal with every dimension in the middle of its band.
    pub(super) middle: f64,
    /// The bounds that no assembly exceeds.
    pub(super) worst_case: f64,
    /// Root of the sum of squares.
    pub(super) rss: f64,
    /// 1.5 times that.
    pub(super) inflated_rss: f64,
    /// Half the worst case and half the RSS.
    pub(super) mean_shift_rss: f64,
    /// Root of the sum of squares of effective sigmas; None where every mean is in the middle of its band, or one at its end.
    pub(super) six_sigma: Option<f64>,
}

impl Linear {
    /// Of dimensions of this problem with their slopes.
    pub(super) fn of(problem: &Problem, slopes: &[(f64, usize)]) -> Self {
        let dimensions = problem.dimensions();
        let [middle, worst_case, rss] = sums(problem, slopes, |_| 1.0);
        let modified = modified(problem, slopes, [worst_case, rss]);
        let factor = |d: usize| match dimensions[d].convention().rss_factor {
            None => INFLATION,
            Some(RssFactor::Factor(factor)) => factor,
            Some(RssFactor::Modified) => modified,
        };
        let inflated_rss = match common(slopes, factor, INFLATION) {
            Some(factor) => factor * rss,
            None => sums(problem, slopes, factor)[2],
        };
        let part = |d: usize| dimensions[d].convention().mean_shift.unwrap_or(MEAN_SHIFT);
        let mean_shift_rss = match common(slopes, part, MEAN_SHIFT) {
            Some(part) => part * worst_case + (1.0 - part) * rss,
            None => sums(problem, slopes, part)[1] + sums(problem, slopes, |d| 1.0 - part(d))[2],
        };
        Self { middle, worst_case, rss, inflated_rss, mean_shift_rss, six_sigma: six_sigma(problem, slopes) }
    }
}

/// The middle, the worst case and the RSS with every half band times a weight.
fn sums(problem: &Problem, slopes: &[(f64, usize)], weight: impl Fn(usize) -> f64) -> [f64; 3] {
    let (mut middle, mut worst_case, mut rss) = (0.0, 0.0, 0.0f64);
    let mut zones: Vec<(&str, f64)> = Vec::new();
    let mut diamonds: Vec<(usize, f64)> = Vec::new();
    for &(slope, d) in slopes {
        let dimension = &problem.dimensions()[d];
        let [lower, upper] = dimension.reach();
        let reach = (weight(d) * slope * dimension.half_band()).abs();
        middle += slope * 0.5 * (lower + upper);
        rss = libm::hypot(rss, reach);
        match dimension.zone() {
            None => match diamond(problem, d) {
                None => worst_case += reach,
                Some(block) => match diamonds.iter_mut().find(|(own, _)| *own == block) {
                    Some((_, most)) => *most = most.max(reach),
                    None => diamonds.push((block, reach)),
                },
            },
            Some(zone) => match zones.iter_mut().find(|(name, _)| *name == zone) {
                Some((_, radius)) => *radius = libm::hypot(*radius, reach),
                None => zones.push((zone, reach)),
            },
        }
    }
    let halves = |d: usize| weight(d) * problem.dimensions()[d].half_band();
    rss *= together(problem, slopes, rss, halves);
    worst_case += diamonds.iter().map(|(_, most)| most).sum::<f64>();
    worst_case += zones.iter().map(|(_, radius)| radius).sum::<f64>();
    [middle, worst_case, rss]
}

/// The value that all dimensions share, `usual` where there are none; None where they differ.
fn common(slopes: &[(f64, usize)], of: impl Fn(usize) -> f64, usual: f64) -> Option<f64> {
    let first = slopes.first().map_or(usual, |&(_, d)| of(d));
    slopes.iter().all(|&(_, d)| of(d) == first).then_some(first)
}

/// The factor between worst case and RSS that their distance suggests.
fn modified(problem: &Problem, slopes: &[(f64, usize)], [worst_case, rss]: [f64; 2]) -> f64 {
    let counts = |&&(slope, d): &&(f64, usize)| slope * problem.dimensions()[d].half_band() != 0.0;
    let n = slopes.iter().filter(counts).count();
    if n < 2 || rss == 0.0 { 1.0 } else { 1.0 + 0.5 * (worst_case - rss) / (rss * ((n as f64).sqrt() - 1.0)) }
}

/// Root of the sum of squares of effective sigmas.
fn six_sigma(problem: &Problem, slopes: &[(f64, usize)]) -> Option<f64> {
    /// A shift below this part of a half band is a rounding error.
    const NOTHING: f64 = 1e-9;
    let slopes: Vec<(f64, usize)> = slopes.iter().filter(|(slope, _)| *slope != 0.0).copied().collect();
    let off = |&(_, d): &(f64, usize)| problem.dimensions()[d].lot()[1];
    if !slopes.iter().map(off).any(|off| off > NOTHING) || slopes.iter().map(off).any(|off| off >= 1.0) {
        return None;
    }
    let effective = |d: usize| {
        let [sigma, off] = problem.dimensions()[d].lot();
        sigma / (1.0 - off)
    };
    let alone = slopes.iter().fold(0.0f64, |sum, &(slope, d)| libm::hypot(sum, slope * effective(d)));
    Some(alone * together(problem, &slopes, alone, effective))
}

/// The block of a dimension that shares a diamond with another: at an end of one the other is in its middle.
fn diamond(problem: &Problem, dimension: usize) -> Option<usize> {
    let correlation = problem.correlation()?;
    let (block, _) = correlation.block_of(dimension)?;
    (correlation.blocks()[block].law == JointLaw::Diamond).then_some(block)
}

/// By what correlation widens or narrows a root of a sum of squares of slopes by reaches: `sqrt(t'R t)/|t|`.
fn together(problem: &Problem, slopes: &[(f64, usize)], alone: f64, reach: impl Fn(usize) -> f64) -> f64 {
    let Some(correlation) = problem.correlation().filter(|_| alone > 0.0) else { return 1.0 };
    let member = |&&(_, d): &&(f64, usize)| correlation.members().binary_search(&d).is_ok();
    let part = |&(slope, d): &(f64, usize)| (slope * reach(d) / alone, d);
    let members: Vec<(f64, usize)> = slopes.iter().filter(member).map(part).collect();
    let pairs = members.iter().enumerate().flat_map(|(i, a)| members[i + 1..].iter().map(move |b| (a, b)));
    let products: f64 = pairs.map(|(a, b)| 2.0 * a.0 * b.0 * correlation.of(a.1, b.1)).sum();
    (1.0 + products).max(0.0).sqrt()
}
