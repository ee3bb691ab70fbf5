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
//! All are half-widths about the value at the middles of all bands, in one linear model. Coordinates of one circular zone reach `T
//! sqrt(b_x^2 + b_y^2)` together in the worst case, not `T (|b_x| + |b_y|)`: no point of the zone is at both ends at once. Coordinates of a
//! diamond reach the larger of the two. The root of the sum of squares is the same for zone and box.
//!
//! Sources: A. Bender, "Benderizing tolerances", Graphic Science, December 1962, and SAE paper 680490 (1968): processes are less normal and
//! less centred than RSS assumes, and a factor of 1.5 covers that. W. H. Greenwood, K. W. Chase, "A new tolerance analysis method for
//! designers and manufacturers", J. Eng. Industry 109 (1987), and K. W. Chase, A. R. Parkinson, "A survey of research in the application of
//! tolerance analysis", Research in Engineering Design 3 (1991), the estimated mean shift model `sum of m_i |b_i| T_i + sqrt(sum of ((1 -
//! m_i) b_i T_i)^2)`: all means may lie off their middles in the unfavourable direction, and the rest of each band is random. The shift of
//! 1.5 sigma of the six-sigma tradition, with three sigma in every half band, makes all `m_i` 0.5. That shift is a part of the band, not of
//! a dimension's own sigma, because RSS and worst case are computed from the bands. The gain of a process that is better than its tolerance
//! shows in the moments.
//!
//! Factors and shifts may be given for each dimension: then `sqrt(sum of (c_i b_i T_i)^2)` and `sum of m_i |b_i| T_i + sqrt(sum of ((1 -
//! m_i) b_i T_i)^2)`. The modified factor is `1 + (W - R)/(2 R (sqrt n - 1))` for `n` dimensions, 1 for one (P. Drake, Dimensioning and
//! Tolerancing Handbook, McGraw-Hill 1999, chapter 9). The six-sigma sum uses the sigma `s` of a lot and the shift `k` of its mean in half
//! bands for an effective sigma `s/(1 - k)` (M. J. Harry, R. Stewart, Six Sigma Mechanical Design Tolerancing, Motorola 1988). It does not
//! exist if a mean is shifted by a whole half band.

use crate::problem::Problem;
use sensitol_numeric::correlation::{JointLaw, SolidShape};
use sensitol_numeric::dimension::RssFactor;

/// Factor of the inflated RSS without a choice of the study (Bender).
const INFLATION: f64 = 1.5;
/// Shift of the mean as a part of each half band: 1.5 sigma of 3.
const MEAN_SHIFT: f64 = 0.5;

/// Results of one characteristic in a linear model, as half-widths about `middle`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::analysis) struct Linear {
    /// Deviation of the characteristic from its nominal with every dimension in the middle of its band.
    pub(in crate::analysis) middle: f64,
    /// Greatest deviation of any assembly with all dimensions within their bands.
    pub(in crate::analysis) worst_case: f64,
    pub(in crate::analysis) rss: f64,
    /// RSS with the factors of the dimensions, 1.5 by default.
    pub(in crate::analysis) inflated_rss: f64,
    /// Sum of parts of the worst case and of the RSS, half of each by default.
    pub(in crate::analysis) mean_shift_rss: f64,
    /// Root of the sum of squares of effective sigmas. None if every mean is in the middle of its band, or one is at an end.
    pub(in crate::analysis) six_sigma: Option<f64>,
}

impl Linear {
    /// Computes the results from pairs of slope and index of the dimension.
    pub(in crate::analysis) fn of(problem: &Problem, slopes: &[(f64, usize)]) -> Self {
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

/// Middle, worst case and RSS with every half band multiplied by a weight.
fn sums(problem: &Problem, slopes: &[(f64, usize)], weight: impl Fn(usize) -> f64) -> [f64; 3] {
    let (mut middle, mut worst_case, mut rss) = (0.0, 0.0, 0.0f64);
    let mut zones: Vec<(&str, f64)> = Vec::new();
    // Greatest reach of a tip, and of the coordinates that share a circle, for every block that is a zone with tips.
    let mut tipped: Vec<(usize, f64, f64)> = Vec::new();
    for &(slope, d) in slopes {
        let dimension = &problem.dimensions()[d];
        let [lower, upper] = dimension.reach();
        let reach = (weight(d) * slope * dimension.half_band()).abs();
        middle += slope * 0.5 * (lower + upper);
        rss = libm::hypot(rss, reach);
        match dimension.zone() {
            None => match tip(problem, d) {
                None => worst_case += reach,
                Some((block, round)) => {
                    let (most, radius) = if round { (0.0, reach) } else { (reach, 0.0) };
                    match tipped.iter_mut().find(|(own, ..)| *own == block) {
                        Some((_, tip, circle)) => (*tip, *circle) = (tip.max(most), libm::hypot(*circle, radius)),
                        None => tipped.push((block, most, radius)),
                    }
                }
            },
            Some(zone) => match zones.iter_mut().find(|(name, _)| *name == zone) {
                Some((_, radius)) => *radius = libm::hypot(*radius, reach),
                None => zones.push((zone, reach)),
            },
        }
    }
    let halves = |d: usize| weight(d) * problem.dimensions()[d].half_band();
    rss *= together(problem, slopes, rss, halves);
    worst_case += tipped.iter().map(|(_, tip, circle)| tip.max(*circle)).sum::<f64>();
    worst_case += zones.iter().map(|(_, radius)| radius).sum::<f64>();
    [middle, worst_case, rss]
}

/// Common value of all dimensions, `usual` without dimensions. Returns None if they differ.
fn common(slopes: &[(f64, usize)], of: impl Fn(usize) -> f64, usual: f64) -> Option<f64> {
    let first = slopes.first().map_or(usual, |&(_, d)| of(d));
    slopes.iter().all(|&(_, d)| of(d) == first).then_some(first)
}

/// Modified RSS factor, from the ratio of worst case to RSS.
fn modified(problem: &Problem, slopes: &[(f64, usize)], [worst_case, rss]: [f64; 2]) -> f64 {
    let counts = |&&(slope, d): &&(f64, usize)| slope * problem.dimensions()[d].half_band() != 0.0;
    let n = slopes.iter().filter(counts).count();
    if n < 2 || rss == 0.0 { 1.0 } else { 1.0 + 0.5 * (worst_case - rss) / (rss * ((n as f64).sqrt() - 1.0)) }
}

/// Root of the sum of squares of effective sigmas, with correlation.
fn six_sigma(problem: &Problem, slopes: &[(f64, usize)]) -> Option<f64> {
    /// Smallest shift, in half bands, that is not a rounding error.
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

/// Block of a dimension whose zone has tips: at the tip of one coordinate the others are in their middles. True for a coordinate that shares
/// a circle of the zone.
fn tip(problem: &Problem, dimension: usize) -> Option<(usize, bool)> {
    let correlation = problem.correlation()?;
    let (block, coordinate) = correlation.block_of(dimension)?;
    match &correlation.blocks()[block].law {
        JointLaw::Diamond => Some((block, false)),
        JointLaw::Solid(solid) => match solid.shape() {
            SolidShape::Octahedron => Some((block, false)),
            SolidShape::Bicone => Some((block, solid.coordinate(coordinate) > 0)),
            SolidShape::Ball => Some((block, true)),
        },
        JointLaw::Rows(_) | JointLaw::Disc | JointLaw::Rim => None,
    }
}

/// Factor of correlation on a root of a sum of squares of slopes by reaches: `sqrt(t'R t)/|t|`.
fn together(problem: &Problem, slopes: &[(f64, usize)], alone: f64, reach: impl Fn(usize) -> f64) -> f64 {
    let Some(correlation) = problem.correlation().filter(|_| alone > 0.0) else { return 1.0 };
    let member = |&&(_, d): &&(f64, usize)| correlation.members().binary_search(&d).is_ok();
    let part = |&(slope, d): &(f64, usize)| (slope * reach(d) / alone, d);
    let members: Vec<(f64, usize)> = slopes.iter().filter(member).map(part).collect();
    let pairs = members.iter().enumerate().flat_map(|(i, a)| members[i + 1..].iter().map(move |b| (a, b)));
    let products: f64 = pairs.map(|(a, b)| 2.0 * a.0 * b.0 * correlation.of(a.1, b.1)).sum();
    (1.0 + products).max(0.0).sqrt()
}
