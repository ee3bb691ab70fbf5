//! Branch and bound: certainty that no assembly lies beyond an extreme.
//!
//! Source: Moore, Kearfott and Cloud, Introduction to Interval Analysis, 2009, chapters 6 and 11: monotonicity test and mean
//! value form, boxes with the lowest bound first.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::zone::{EDGE, Zone};
use crate::assembly::Bounds;
use crate::assembly::formula::Interval;

/// A box, an interval for every dimension.
type Region = Vec<[f64; 2]>;

/// Certain bounds of the least value in a box.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Least {
    /// No value is below.
    pub(super) lower: f64,
    /// Boxes that were looked at.
    pub(super) boxes: usize,
    /// The value that was believed to be the least, or the upper bound of the value at a better point.
    pub(super) best: f64,
    /// A point whose value is below what was believed to be the least.
    pub(super) better: Option<Vec<f64>>,
}

/// How often a box that has lost dimensions is looked at again before it is split.
const AGAIN: usize = 4;

/// Bounds the least value of `bounds` over the part of `region` within all `zones`, until it is certain to be no more than `allowed`
/// below `best`, or `limit` boxes have been looked at, or `stop` says so.
///
/// A dimension along which the value only rises or only falls is held at the end where it is least, where no zone ends before.
pub(super) fn least(
    bounds: &dyn Fn(&[[f64; 2]]) -> Bounds,
    region: &[[f64; 2]],
    zones: &[Zone],
    best: f64,
    allowed: f64,
    limit: usize,
    stop: &dyn Fn() -> bool,
) -> Least {
    let mut search = Search { bounds, zones, best, allowed, stop, boxes: 0, better: None };
    let mut open: BinaryHeap<Open> = search.examine(region.to_vec(), f64::NEG_INFINITY).into_iter().collect();
    // The least bound of the boxes that cannot be split.
    let mut lower = f64::INFINITY;
    while let Some(next) = open.pop() {
        if next.lower >= search.best - allowed || search.boxes >= limit || stop() {
            lower = lower.min(next.lower);
            break;
        }
        match next.halves() {
            Some(halves) => open.extend(halves.into_iter().filter_map(|half| search.examine(half, next.lower))),
            None => lower = lower.min(next.lower),
        }
    }
    Least { lower, boxes: search.boxes, best: search.best, better: search.better }
}

struct Search<'b> {
    bounds: &'b dyn Fn(&[[f64; 2]]) -> Bounds,
    zones: &'b [Zone],
    best: f64,
    allowed: f64,
    stop: &'b dyn Fn() -> bool,
    boxes: usize,
    better: Option<Vec<f64>>,
}

/// A box that may hold the least value. The one with the lowest bound is the greatest.
struct Open {
    lower: f64,
    region: Region,
    /// How much the value may change along each dimension.
    swing: Vec<f64>,
}

impl Search<'_> {
    /// None when nothing in the box has a value.
    fn examine(&mut self, mut region: Region, above: f64) -> Option<Open> {
        if self.zones.iter().any(|zone| zone.leaves_out(&region)) {
            return None;
        }
        self.zones.iter().for_each(|zone| zone.shrink(&mut region));
        let mut found = self.look(&region);
        for _ in 0..AGAIN {
            if found.value.is_empty() {
                return None;
            }
            // The bounds of a long formula of many dimensions are many operations: a stop is heard between two of them.
            if !found.value.is_whole() || (self.stop)() || !hold(&mut region, &found.slopes, self.zones) {
                break;
            }
            found = self.look(&region);
        }
        let middle: Vec<f64> = region.iter().map(|&[lower, upper]| middle(lower, upper)).collect();
        let at = self.look(&middle.iter().map(|&x| [x, x]).collect::<Region>()).value;
        let mut within = middle.clone();
        self.zones.iter().for_each(|zone| zone.enter(&mut within, EDGE));
        match within == middle {
            true => self.reach(within, at),
            false => self.try_point(within),
        }
        let mut lower = above.max(found.value.lower());
        let mut swing = vec![f64::INFINITY; region.len()];
        if found.value.is_whole() {
            let changes: Vec<Interval> =
                (0..region.len()).map(|d| change(&region, &middle, &found.slopes, d)).collect();
            swing = changes.iter().map(|change| change.upper() - change.lower()).collect();
            let about = changes.iter().fold(at, |about, change| about.add(change));
            lower = lower.max(about.lower());
            if !self.zones.is_empty() {
                lower = lower.max(self.over_zones(&region, &middle, at, (&found.slopes, &changes)));
            }
        }
        Some(Open { lower, region, swing })
    }

    /// The bound of a tangent plane at the middle of a box over the zones, and of how far slopes differ from its own.
    fn over_zones(
        &mut self,
        region: &[[f64; 2]],
        middle: &[f64],
        at: Interval,
        (slopes, changes): (&[Interval], &[Interval]),
    ) -> f64 {
        let mut about = at;
        let mut lowest = middle.to_vec();
        let zones = self.zones;
        for (d, change) in changes.iter().enumerate() {
            if !zones.iter().any(|zone| zone.places().contains(&d)) {
                about = about.add(change);
                let falls = slopes[d].lower() + slopes[d].upper() > 0.0;
                lowest[d] = region[d][usize::from(!falls)];
            }
        }
        for zone in zones {
            let own = |&d: &usize| 0.5 * slopes[d].lower() + 0.5 * slopes[d].upper();
            let plane: Vec<f64> = zone.places().iter().map(own).collect();
            if !plane.iter().all(|slope| slope.is_finite()) {
                return f64::NEG_INFINITY;
            }
            for (&d, &slope) in zone.places().iter().zip(&plane) {
                let apart = slopes[d].subtract(&Interval::between(slope, slope));
                about = about.add(&apart.multiply(&offsets(region[d], middle[d])));
            }
            let (bound, place) = zone.lowest(&plane, middle, region);
            // No row lies within.
            if place.is_empty() {
                return f64::INFINITY;
            }
            about = about.add(&Interval::between(bound, bound));
            zone.places().iter().zip(place).for_each(|(&d, x)| lowest[d] = x);
        }
        self.try_point(lowest);
        about.lower()
    }

    /// The value at a point within all zones, which may be less than what was believed to be the least.
    fn try_point(&mut self, point: Vec<f64>) {
        let value = self.look(&point.iter().map(|&x| [x, x]).collect::<Region>()).value;
        self.reach(point, value);
    }

    fn reach(&mut self, point: Vec<f64>, value: Interval) {
        if value.upper() < self.best - self.allowed {
            self.best = value.upper();
            self.better = Some(point);
        }
    }

    fn look(&mut self, region: &[[f64; 2]]) -> Bounds {
        self.boxes += 1;
        (self.bounds)(region)
    }
}

/// How far the places along a side of a box lie from its middle.
fn offsets([lower, upper]: [f64; 2], middle: f64) -> Interval {
    let from = |x: f64| Interval::between(x, x).subtract(&Interval::between(middle, middle));
    Interval::between(from(lower).lower(), from(upper).upper())
}

/// How much the value may change along one dimension of a box.
fn change(region: &[[f64; 2]], middle: &[f64], slopes: &[Interval], d: usize) -> Interval {
    slopes[d].multiply(&offsets(region[d], middle[d]))
}

/// Holds every dimension whose slope has one sign at the end where the value is least; says whether there was any.
fn hold(region: &mut Region, slopes: &[Interval], zones: &[Zone]) -> bool {
    let mut held = false;
    let free: Vec<bool> = (0..region.len()).map(|d| zones.iter().all(|zone| zone.frees(d, region))).collect();
    let moving = region.iter_mut().zip(slopes).zip(free).filter(|((band, _), free)| *free && band[0] < band[1]);
    for ((band, slope), _) in moving {
        if slope.lower() >= 0.0 {
            band[1] = band[0];
            held = true;
        } else if slope.upper() <= 0.0 {
            band[0] = band[1];
            held = true;
        }
    }
    held
}

fn middle(lower: f64, upper: f64) -> f64 {
    0.5 * lower + 0.5 * upper
}

impl Open {
    /// Split across the dimension along which the value may change most; None when no double lies between the ends of any.
    fn halves(&self) -> Option<[Region; 2]> {
        let splits = |&d: &usize| {
            let [lower, upper] = self.region[d];
            lower < middle(lower, upper) && middle(lower, upper) < upper
        };
        let width = |d: usize| self.region[d][1] - self.region[d][0];
        let relative = |d: usize| width(d) / self.region[d][0].abs().max(self.region[d][1].abs());
        let most =
            |&a: &usize, &b: &usize| self.swing[a].total_cmp(&self.swing[b]).then(relative(a).total_cmp(&relative(b)));
        let d = (0..self.region.len()).filter(splits).max_by(most)?;
        let mut halves = [self.region.clone(), self.region.clone()];
        let middle = middle(self.region[d][0], self.region[d][1]);
        (halves[0][d][1], halves[1][d][0]) = (middle, middle);
        Some(halves)
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other.lower.total_cmp(&self.lower)
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}
