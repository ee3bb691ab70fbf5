//! What slopes and tolerance bands alone say: worst case, RSS, and the two usual inflations of it.
//!
//! ```text
//! worst case       W = sum of |b_i| T_i            b_i: slope, T_i: half band (three sigma without a band)
//! RSS              R = sqrt(sum of (b_i T_i)^2), with correlation sqrt(t'C t) of t_i = b_i T_i
//! inflated RSS     1.5 R
//! mean-shift RSS   m W + (1 - m) R                 m = 0.5
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

use crate::correlation::JointLaw;
use crate::problem::Problem;

/// The factor of the inflated RSS.
const INFLATION: f64 = 1.5;
/// The part of every half band by which its mean may be off: 1.5 sigma of 3.
const MEAN_SHIFT: f64 = 0.5;

/// The intervals of one characteristic in a linear model, as half widths about `middle`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Linear {
    /// How far the characteristic is from nominal with every dimension in the middle of its band.
    pub(super) middle: f64,
    /// What no assembly exceeds.
    pub(super) worst_case: f64,
    /// Root of the sum of squares.
    pub(super) rss: f64,
    /// 1.5 times that.
    pub(super) inflated_rss: f64,
    /// Half the worst case and half the RSS.
    pub(super) mean_shift_rss: f64,
}

impl Linear {
    /// Of dimensions of this problem with their slopes.
    pub(super) fn of(problem: &Problem, slopes: &[(f64, usize)]) -> Self {
        let (mut middle, mut worst_case, mut rss) = (0.0, 0.0, 0.0f64);
        let mut zones: Vec<(&str, f64)> = Vec::new();
        let mut diamonds: Vec<(usize, f64)> = Vec::new();
        for &(slope, d) in slopes {
            let dimension = &problem.dimensions()[d];
            let [lower, upper] = dimension.reach();
            let reach = (slope * dimension.half_band()).abs();
            middle += slope * 0.5 * (lower + upper);
            rss = rss.hypot(reach);
            match dimension.zone() {
                None => match diamond(problem, d) {
                    None => worst_case += reach,
                    Some(block) => match diamonds.iter_mut().find(|(own, _)| *own == block) {
                        Some((_, most)) => *most = most.max(reach),
                        None => diamonds.push((block, reach)),
                    },
                },
                Some(zone) => match zones.iter_mut().find(|(name, _)| *name == zone) {
                    Some((_, radius)) => *radius = radius.hypot(reach),
                    None => zones.push((zone, reach)),
                },
            }
        }
        rss *= together(problem, slopes, rss);
        worst_case += diamonds.iter().map(|(_, most)| most).sum::<f64>();
        worst_case += zones.iter().map(|(_, radius)| radius).sum::<f64>();
        Self {
            middle,
            worst_case,
            rss,
            inflated_rss: INFLATION * rss,
            mean_shift_rss: MEAN_SHIFT * worst_case + (1.0 - MEAN_SHIFT) * rss,
        }
    }
}

/// The block of a dimension that shares a diamond with another: at an end of one the other is in its middle.
fn diamond(problem: &Problem, dimension: usize) -> Option<usize> {
    let correlation = problem.correlation()?;
    let (block, _) = correlation.block_of(dimension)?;
    (correlation.blocks()[block].law == JointLaw::Diamond).then_some(block)
}

/// By what correlation widens or narrows the RSS: `sqrt(t'R t)/|t|`.
fn together(problem: &Problem, slopes: &[(f64, usize)], alone: f64) -> f64 {
    let Some(correlation) = problem.correlation().filter(|_| alone > 0.0) else { return 1.0 };
    let member = |&&(_, d): &&(f64, usize)| correlation.members().binary_search(&d).is_ok();
    let part = |&(slope, d): &(f64, usize)| (slope * problem.dimensions()[d].half_band() / alone, d);
    let members: Vec<(f64, usize)> = slopes.iter().filter(member).map(part).collect();
    let pairs = members.iter().enumerate().flat_map(|(i, a)| members[i + 1..].iter().map(move |b| (a, b)));
    let products: f64 = pairs.map(|(a, b)| 2.0 * a.0 * b.0 * correlation.of(a.1, b.1)).sum();
    (1.0 + products).max(0.0).sqrt()
}
