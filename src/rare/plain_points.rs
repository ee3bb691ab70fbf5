//! Plain points: the estimate if importance sampling is worse.
//!
//! In a hundred variables nearly all assemblies lie on a thin shell around the means. If rejects lie all over it, no
//! place draws near them. Most of the drawn points are then rejects of a weight near 0, and the few that matter come
//! from the inputs' own density. These are a sample of their own, independent of the other components. With `m` and `s`
//! equal to 1 if the model and the surrogate lie beyond the limit, and 0 otherwise,
//!
//! ```text
//! P = mean m          P = P_s + mean (m - s)
//! ```
//!
//! over them, where the share `P_s` of the surrogate is counted at many points without the model. The second form is
//! used if model and surrogate differ at fewer points than lie beyond the limit. Source: Glynn and Szechtman (2002).

use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::estimate::Columns;
use crate::rare::estimate::ProbabilityEstimate;
use crate::rare::target::Target;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::{Estimate, clopper_pearson};

/// Greatest number of points of the surrogate.
const SURROGATE: usize = 1 << 20;
/// Greatest number of coordinates of these points in all, for a time of some tenths of a second.
const NUMBERS: usize = 1 << 27;
/// Events that a count of 0 leaves possible, with 97.5 %. A surrogate that differs at as many points tells less than the count.
const UNSEEN: f64 = 3.7;
/// Points of the surrogate that are evaluated together.
const ROWS: usize = 1 << 12;

/// Points of the inputs' own density, counted for one target.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct PlainPoints {
    points: u64,
    /// Points that the target seeks.
    hits: u64,
    unknown: u64,
    /// Points that only the model has among those sought, and points that only the surrogate has.
    only: [u64; 2],
}

impl PlainPoints {
    /// Adds a point. `model` is true if the model's value is sought, and None if there is none. `surrogate` is true if
    /// the surrogate's value is sought.
    pub(super) fn add(&mut self, model: Option<bool>, surrogate: bool) {
        self.points += 1;
        match model {
            None => self.unknown += 1,
            Some(sought) => {
                self.hits += u64::from(sought);
                self.only[0] += u64::from(sought && !surrogate);
                self.only[1] += u64::from(surrogate && !sought);
            }
        }
    }

    pub(super) fn count(&self) -> u64 {
        self.points
    }

    /// Width of the interval of this probability from a plain sample of so many points.
    pub(super) fn width(points: f64, probability: f64) -> f64 {
        let [low, high] = clopper_pearson(probability * points, points);
        high - low
    }

    /// Estimate from these points, with the surrogate's own share if it is known. Returns None if there is no point.
    pub(super) fn found(&self, surrogate: Option<SurrogateShare>) -> Option<ProbabilityEstimate> {
        if self.points == 0 {
            return None;
        }
        let (n, hits) = (self.points as f64, self.hits as f64);
        let apart = (self.only[0] + self.only[1]) as f64;
        let of_surrogate = surrogate
            .filter(|share| self.unknown == 0 && apart + 1.0 < (hits + 1.0).max((n * share.value()).min(UNSEEN)));
        let (value, variance, interval) = match of_surrogate {
            Some(share) => self.beside(share),
            None => {
                let value = hits / n;
                (value, value * (1.0 - value) / n, clopper_pearson(hits, n))
            }
        };
        let known = value > 0.0;
        Some(ProbabilityEstimate {
            probability: known.then(|| Estimate { value, standard_error: Some(variance.sqrt()) }),
            interval,
            bounds: [value, (value + self.unknown as f64 / n).min(1.0)],
            hits: self.hits,
            points: self.points - self.unknown,
            effective: hits,
            greatest_part: (self.hits > 0 && of_surrogate.is_none()).then(|| 1.0 / hits),
        })
    }

    /// Value, variance and interval from the surrogate's share plus the difference of the model's.
    ///
    /// The interval joins those of the share and of the two counts of points that differ (Zou and Donner 2008). A count
    /// of zero thus still adds to the interval.
    fn beside(&self, share: SurrogateShare) -> (f64, f64, [f64; 2]) {
        let n = self.points as f64;
        let [more, fewer] = self.only.map(|count| (count as f64 / n, clopper_pearson(count as f64, n)));
        let (own, [least, most]) = (share.value(), share.interval());
        let value = (own + more.0 - fewer.0).clamp(0.0, 1.0);
        let above = libm::hypot(libm::hypot(more.1[1] - more.0, fewer.0 - fewer.1[0]), most - own);
        let below = libm::hypot(libm::hypot(more.0 - more.1[0], fewer.1[1] - fewer.0), own - least);
        let variance = own * (1.0 - own) / share.points + (more.0 + fewer.0 - (more.0 - fewer.0).powi(2)) / n;
        (value, variance, [(value - below).max(0.0), (value + above).min(1.0)])
    }
}

/// Share of the surrogate's points among those that a target seeks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SurrogateShare {
    points: f64,
    hits: f64,
}

impl SurrogateShare {
    /// Counts points of a target without an evaluation of the model. The result does not depend on the number of
    /// threads.
    pub(super) fn of(target: &Target<'_>, seed: u64) -> Self {
        let n = target.space.len();
        let blocks = (SURROGATE.min(NUMBERS / n.max(1)) / ROWS).max(1);
        let block = |block: u64| {
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed ^ (block + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
            let normals: Columns = (0..n).map(|_| (0..ROWS).map(|_| rng.sample(StandardNormal)).collect()).collect();
            target.margins(&normals).into_iter().filter(|&margin| margin > 0.0).count()
        };
        let hits: usize = (0..blocks as u64).into_par_iter().map(block).collect::<Vec<_>>().into_iter().sum();
        Self { points: (blocks * ROWS) as f64, hits: hits as f64 }
    }

    fn value(self) -> f64 {
        self.hits / self.points
    }

    fn interval(self) -> [f64; 2] {
        clopper_pearson(self.hits, self.points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(points: &[(Option<bool>, bool, u64)]) -> PlainPoints {
        let mut all = PlainPoints::default();
        for &(model, surrogate, times) in points {
            (0..times).for_each(|_| all.add(model, surrogate));
        }
        all
    }

    /// Exact interval of a count of 4 in 1000 points.
    #[test]
    fn plain_points_are_a_count() {
        let plain = counted(&[(Some(true), false, 4), (Some(false), false, 996)]);
        let found = plain.found(None).unwrap();
        assert_eq!(found.interval, clopper_pearson(4.0, 1000.0));
        assert_eq!(found.probability.unwrap().value, 0.004);
        let none = counted(&[(Some(false), false, 1000)]).found(None).unwrap();
        assert!(none.probability.is_none() && none.interval == clopper_pearson(0.0, 1000.0));
        assert_eq!(PlainPoints::default().found(None), None);
    }

    /// A surrogate that agrees at every point gives the value. Unseen differences stay in the interval.
    #[test]
    fn an_agreeing_surrogate_has_the_value() {
        let share = SurrogateShare { points: 1e6, hits: 400.0 };
        let plain = counted(&[(Some(true), true, 3), (Some(false), false, 9997)]);
        let found = plain.found(Some(share)).unwrap();
        assert_eq!(found.probability.unwrap().value, 4e-4);
        let unseen = clopper_pearson(0.0, 10_000.0)[1];
        assert!(found.interval[1] > 4e-4 + unseen && found.interval[1] < 4e-4 + 1.02 * unseen, "{found:?}");
        // A surrogate that misses the rejects is not used.
        let apart = counted(&[(Some(true), false, 5), (Some(false), true, 8), (Some(false), false, 9987)]);
        assert_eq!(apart.found(Some(share)).unwrap().interval, clopper_pearson(5.0, 10_000.0));
        // Nor is one that lies beyond the limit nearly everywhere, where the model hardly ever does.
        let everywhere = SurrogateShare { points: 1e6, hits: 999_800.0 };
        let apart = counted(&[(Some(true), true, 2), (Some(false), true, 9996), (Some(false), false, 2)]);
        let found = apart.found(Some(everywhere)).unwrap();
        assert_eq!((found.probability.unwrap().value, found.interval), (2e-4, clopper_pearson(2.0, 10_000.0)));
    }

    /// The standard error of a sum of a known share and the mean of differences is the root of their variances. Where all differences are
    /// equal, only that of the share is left.
    #[test]
    fn equal_differences_have_no_variance() {
        let share = SurrogateShare { points: 1e6, hits: 400.0 };
        let plain = counted(&[(Some(true), false, 1000)]);
        let (value, variance, _) = plain.beside(share);
        assert_eq!(value, 1.0);
        assert!((variance - 4e-4 * (1.0 - 4e-4) / 1e6).abs() < 1e-24, "{variance}");
    }

    /// Points without a value may all lie beyond.
    #[test]
    fn points_without_a_value_are_in_the_bounds() {
        let found = counted(&[(Some(true), true, 2), (None, false, 3), (Some(false), false, 995)]).found(None).unwrap();
        assert_eq!((found.bounds, found.points), ([0.002, 0.005], 997));
    }
}
