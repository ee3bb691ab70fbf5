//! Branch and bound in interval arithmetic, which proves that no assembly lies beyond an extreme.
//!
//! Source: Moore, Kearfott and Cloud, Introduction to Interval Analysis, 2009, chapters 6 and 11: monotonicity test,
//! mean value form, boxes with the lowest bound first.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::assembly::Bounds;
use crate::assembly::formula::Interval;
use crate::extremes::zone::{EDGE, Zone};

/// Box: an interval for every dimension.
type Region = Vec<[f64; 2]>;

/// Certain bounds of the least value in a box.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Least {
    /// Lower bound: no value in the box is below it.
    pub(super) lower: f64,
    /// Number of boxes on which the bounds were computed.
    pub(super) boxes: usize,
    /// Upper bound of the least value: the given one, or that of the value at a better point.
    pub(super) best: f64,
    /// Point whose value is below the given least value, if one was found.
    pub(super) better: Option<Vec<f64>>,
}

/// Greatest number of times that a box with newly held dimensions is bounded again before it is split.
const AGAIN: usize = 4;

/// Bounds the least value of `bounds` over the part of `region` within all `zones`.
///
/// It ends when the bound is at most `allowed` below `best`, when `limit` boxes have been examined, or when `stop`
/// returns true. A dimension along which the value is monotonic is held at the end with the lesser value, unless a zone
/// ends before it.
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
    // Least bound of the boxes that cannot be split.
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

/// Box that may hold the least value. The order is reversed: the box with the lowest bound is the greatest, for the
/// heap.
struct Open {
    lower: f64,
    region: Region,
    /// Greatest change of the value along each dimension.
    swing: Vec<f64>,
}

impl Search<'_> {
    /// Bounds a box, and evaluates its middle for a better least value. Returns None if nothing in the box has a value.
    fn examine(&mut self, mut region: Region, above: f64) -> Option<Open> {
        if self.zones.iter().any(|zone| zone.leaves_out(&region)) {
            return None;
        }
        self.zones.iter().for_each(|zone| zone.shrink(&mut region));
        let mut found = self.look(&region);
        // Each held dimension narrows the bounds of the slopes, which may hold more dimensions.
        for _ in 0..AGAIN {
            if found.value.is_empty() {
                return None;
            }
            // Bounds of a long formula of many dimensions take many operations, so `stop` is asked between two of them.
            if !found.value.is_whole() || (self.stop)() || !hold(&mut region, &found.slopes, self.zones) {
                break;
            }
            found = self.look(&region);
        }
        let middle: Vec<f64> = region.iter().map(|&[lower, upper]| middle(lower, upper)).collect();
        let at = self.look(&middle.iter().map(|&x| [x, x]).collect::<Region>()).value;
        // The middle is moved into the zones, so that its value belongs to a possible assembly.
        let mut within = middle.clone();
        self.zones.iter().for_each(|zone| zone.enter(&mut within, EDGE));
        match within == middle {
            true => self.reach(within, at),
            false => self.try_point(within),
        }
        let mut lower = above.max(found.value.lower());
        let mut swing = vec![f64::INFINITY; region.len()];
        // Mean value form: the value at the middle plus the changes along all dimensions, often tighter than the
        // bounds.
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

    /// Lower bound over the zones: the tangent plane at the middle of the box, plus the deviation of the slopes from
    /// those of the plane.
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
        // Outside the zones the mean value form is used dimension by dimension.
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
            // No row lies within the box.
            if place.is_empty() {
                return f64::INFINITY;
            }
            about = about.add(&Interval::between(bound, bound));
            zone.places().iter().zip(place).for_each(|(&d, x)| lowest[d] = x);
        }
        self.try_point(lowest);
        about.lower()
    }

    /// Computes the value at a point within all zones, and keeps it if it is below the best one.
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

/// Interval of the distances of a side's places from the middle of the box.
fn offsets([lower, upper]: [f64; 2], middle: f64) -> Interval {
    let from = |x: f64| Interval::between(x, x).subtract(&Interval::between(middle, middle));
    Interval::between(from(lower).lower(), from(upper).upper())
}

/// Interval of the change of the value along one dimension of a box.
fn change(region: &[[f64; 2]], middle: &[f64], slopes: &[Interval], d: usize) -> Interval {
    slopes[d].multiply(&offsets(region[d], middle[d]))
}

/// Holds every dimension whose slope has one sign at the end with the lesser value. Returns true if there was any.
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
    /// Splits the box across the dimension along which the value may change most. Returns None if no double lies
    /// between the ends of any.
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
