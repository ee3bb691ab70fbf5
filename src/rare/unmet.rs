//! Bound of the probability of rejects that no point met.
//!
//! Points of known law say what they would have met. Let a region be all assemblies beyond `c` in each of k directions
//! across each other: a half-space for k = 1, a corner for more. It holds `Phi(-c)^k` of the assemblies. A point of
//! `N(0, s^2)` lies in it with the probability `Phi(-c/s)^k`, whatever the directions are. The expected number of points
//! in it is
//!
//! ```text
//! m(c) = sum_s n_s Phi(-c/s)^k
//! ```
//!
//! for `n_s` points of each scale. It falls with `c`. No point in the region excludes, with 97.5 %, every `c` with
//! `m(c) > -ln 0.025`. The bound is `Phi(-c)^k` at the `c` where they are equal. For k directions with different
//! distances it is less. It is doubled for regions that are no sharp corner. With k = 3 it holds for a contact that
//! needs three dimensions, and for a step of two. For a region that needs more directions at once, only the plain points
//! give the bound that it states.

use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::rare::design_point::FARTHEST;
use sensitol_numeric::distribution::standard_normal;

/// Greatest number of directions of a region. Contacts and states of assemblies need one to three dimensions at once. Four would raise the
/// bound of 1000 points from some 70 ppm to some 800 ppm.
const DIRECTIONS: usize = 3;
/// Probability that the bound is too low by chance: 2.5 %, the upper half of a 95 % interval.
const CHANCE: f64 = 0.025;
/// Factor of the bound for regions that are no sharp corner. Of contacts whose edge other dimensions move, the wide
/// points meet less than of a corner of the same probability: by a factor of 1.3 to 1.8 in the bound.
const BLUNT: f64 = 2.0;
/// Least distance of a region, in sigmas. It then holds all assemblies.
const NEAREST: f64 = -9.0;

/// Bound of the probability of a region without a sampled point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Unmet {
    /// Greatest probability of such a region, with 97.5 %. It is in the upper end of the interval.
    pub most: f64,
    /// Points that would have met it: of the inputs' own distribution and of wider ones, without explained rejects.
    pub points: u64,
    /// Greatest number of directions that the region needs at once: 1 for a half-space, 2 or 3 for a corner.
    pub directions: u64,
}

/// Number of points of `N(0, scale^2)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Group {
    pub(super) scale: f64,
    pub(super) points: u64,
}

impl Unmet {
    /// Bound from groups of points, of which `strayed` lie in regions that nothing explains. Returns None without a
    /// point.
    pub(super) fn new(groups: &[Group], strayed: u64, variables: usize) -> Option<Self> {
        let points = groups.iter().map(|group| group.points).sum();
        let directions = variables.clamp(1, DIRECTIONS);
        // Points that exclude nothing leave all assemblies open.
        let most = corner(groups, strayed, directions as i32).map_or(1.0, |most| (BLUNT * most).min(1.0));
        (points > 0).then_some(Self { most, points, directions: directions as u64 })
    }

    /// This bound, or that of other groups of points if it is less. No point of those lies in the region.
    pub(super) fn least(self, groups: &[Group]) -> Self {
        let other = Self::new(groups, 0, self.directions as usize);
        other.filter(|other| other.most < self.most).unwrap_or(self)
    }
}

/// Greatest probability of a corner of so many directions that `strayed` points met. Returns None for too few points.
fn corner(groups: &[Group], strayed: u64, directions: i32) -> Option<f64> {
    let expected = |c: f64| {
        groups.iter().map(|group| group.points as f64 * standard_normal::sf(c / group.scale).powi(directions)).sum()
    };
    // Greatest Poisson mean that gives no more points than this with the probability `CHANCE`.
    let greatest = 0.5 * ChiSquared::new(2.0 * (strayed as f64 + 1.0)).ok()?.inverse_cdf(1.0 - CHANCE);
    let (mut low, mut high): (f64, f64) = (NEAREST, FARTHEST);
    let most: f64 = expected(low);
    if most <= greatest {
        return None;
    }
    // Sixty halvings use up the digits of a double.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let at: f64 = expected(middle);
        if at > greatest {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(standard_normal::sf(low).powi(directions))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(pairs: &[(f64, u64)]) -> Vec<Group> {
        pairs.iter().map(|&(scale, points)| Group { scale, points }).collect()
    }

    /// 400 points three times as wide without a reject: `1 - Phi(-b/3) = 0.025^(1/400)`, and `Phi(-7.07)` is 8e-13
    /// (tables of the normal distribution give `Phi(-2.357) = 0.0092`).
    #[test]
    fn no_reject_bounds_the_distance() {
        let half_space = |pairs: &[(f64, u64)]| corner(&groups(pairs), 0, 1);
        let bound = half_space(&[(3.0, 400)]).unwrap();
        let distance = -standard_normal::quantile(bound);
        assert!((distance - 7.07).abs() < 0.01, "{distance}");
        // More points, or wider ones, lower the bound.
        assert!(half_space(&[(3.0, 800)]).unwrap() < bound && half_space(&[(6.0, 400)]).unwrap() < bound);
        assert!(half_space(&[(1.5, 400), (3.0, 400)]).unwrap() < bound);
        // Three points cannot exclude a half-space through the middle: all miss it with a probability of 1/8.
        assert_eq!(half_space(&[(1.0, 3)]), None);
        assert_eq!(half_space(&[]), None);
    }

    /// Plain points bound any region as a count does: 3.689 of n without a hit, 5.572 with one (Garwood 1936).
    #[test]
    fn plain_points_bound_as_a_count() {
        for directions in 1..=3 {
            for (strayed, mean) in [(0, 3.689), (1, 5.572)] {
                let bound = corner(&groups(&[(1.0, 1000)]), strayed, directions).unwrap();
                assert!((1000.0 * bound - mean).abs() < 1e-3, "{bound}");
            }
        }
    }

    /// A hundred of which ninety lie in unexplained regions exclude nothing. A thousand plain points that met nothing
    /// bound the rest as a count does, doubled.
    #[test]
    fn points_of_the_sum_bound_what_explored_rejects_leave_open() {
        let open = Unmet::new(&groups(&[(4.0, 100)]), 90, 3).unwrap();
        assert_eq!((open.most, open.points, open.directions), (1.0, 100, 3));
        let bound = open.least(&groups(&[(1.0, 1000)]));
        assert!((1000.0 * bound.most - 2.0 * 3.689).abs() < 2e-3 && bound.points == 1000, "{bound:?}");
        // Fewer points, or none, leave the bound as it is.
        let close = Unmet::new(&groups(&[(3.0, 400)]), 0, 3).unwrap();
        assert_eq!((close.least(&groups(&[(1.0, 10)])), close.least(&[])), (close, close));
        assert_eq!(Unmet::new(&[], 0, 3), None);
    }

    /// Brute force: the corner of the bound is missed by all points in 2.5 % of trials.
    #[test]
    fn the_corner_of_the_bound_is_missed_in_one_of_forty() {
        use rand::{RngExt, SeedableRng};
        let pairs = [(1.0, 30), (3.0, 50), (4.0, 20)];
        let bound = corner(&groups(&pairs), 0, 3).unwrap();
        let distance = standard_normal::upper_quantile(bound.cbrt());
        let mut rng = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(5);
        let mut beyond = |scale: f64| {
            (0..3).fold(true, |all, _| scale * rng.sample::<f64, _>(rand_distr::StandardNormal) > distance && all)
        };
        let missed =
            |_: &u32| !pairs.iter().any(|&(scale, points)| (0..points).fold(false, |met, _| beyond(scale) || met));
        let missed = (0..20_000u32).filter(missed).count() as f64 / 20_000.0;
        // Four standard errors of 0.0011. The Poisson law of the bound misses a little more than points do.
        assert!((missed - 0.0235).abs() < 0.0055, "{missed}");
    }
}
