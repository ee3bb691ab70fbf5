//! Branch and bound: certainty that no assembly lies beyond an extreme.
//!
//! Source: Moore, Kearfott and Cloud, Introduction to Interval Analysis, 2009, chapters 6 and 11: monotonicity test and mean
//! value form, boxes with the lowest bound first.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

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

/// Circular zones of some dimensions: a box counts as far as it lies within them.
#[derive(Clone, Copy)]
pub(super) struct Zones<'z> {
    /// The dimensions of every zone.
    pub(super) places: &'z [Vec<usize>],
    /// The bands of all dimensions, whose ends are those of the zones.
    pub(super) bands: &'z [[f64; 2]],
}

/// A box that is farther outside than rounding is left out.
const EDGE: f64 = 1e-12;

impl Zones<'_> {
    /// Nothing is left out.
    pub(super) const NONE: Self = Self { places: &[], bands: &[] };

    /// Least and greatest distance of a box from the middle of a zone, in its radii.
    fn reach(&self, zone: &[usize], region: &[[f64; 2]]) -> [f64; 2] {
        let of = |&d: &usize| {
            let [lower, upper] = self.bands[d];
            let (centre, half) = (middle(lower, upper), 0.5 * (upper - lower));
            let ends = region[d].map(|x| (x - centre) / half);
            let near = if ends[0] <= 0.0 && ends[1] >= 0.0 { 0.0 } else { ends[0].abs().min(ends[1].abs()) };
            [near, ends[0].abs().max(ends[1].abs())]
        };
        zone.iter().map(of).fold([0.0; 2], |[near, far], [a, b]| [libm::hypot(near, a), libm::hypot(far, b)])
    }

    fn leave_out(&self, region: &[[f64; 2]]) -> bool {
        self.places.iter().any(|zone| self.reach(zone, region)[0] > 1.0 + EDGE)
    }

    /// The place on the edge of a zone in the direction of one outside; the point itself where it is within all zones.
    fn nearest(&self, point: &[f64]) -> Vec<f64> {
        let region: Region = point.iter().map(|&x| [x, x]).collect();
        let mut within = point.to_vec();
        for zone in self.places {
            let radius = self.reach(zone, &region)[1];
            if radius > 1.0 {
                for &d in zone {
                    let centre = middle(self.bands[d][0], self.bands[d][1]);
                    within[d] = centre + (point[d] - centre) / (radius * (1.0 + EDGE));
                }
            }
        }
        within
    }

    /// Whether every place along a dimension of a box is within its zone.
    fn free(&self, d: usize, region: &[[f64; 2]]) -> bool {
        let of = |zone: &&Vec<usize>| zone.contains(&d);
        self.places.iter().filter(of).all(|zone| self.reach(zone, region)[1] <= 1.0)
    }
}

/// How often a box that has lost dimensions is looked at again before it is split.
const AGAIN: usize = 4;

/// Bounds the least value of `bounds` over `region`, until it is certain to be no more than `allowed` below `best`, or `limit`
/// boxes have been looked at, or `stop` says so.
///
/// A dimension along which the value only rises or only falls is held at the end where it is least, where no zone ends before.
pub(super) fn least(
    bounds: &dyn Fn(&[[f64; 2]]) -> Bounds,
    region: &[[f64; 2]],
    zones: Zones<'_>,
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
    zones: Zones<'b>,
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
        if self.zones.leave_out(&region) {
            return None;
        }
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
        let within = self.zones.nearest(&middle);
        let place = |point: &[f64]| point.iter().map(|&x| [x, x]).collect::<Region>();
        let reached = if within == middle { at } else { self.look(&place(&within)).value };
        if reached.upper() < self.best - self.allowed {
            self.best = reached.upper();
            self.better = Some(within);
        }
        let mut lower = above.max(found.value.lower());
        let mut swing = vec![f64::INFINITY; region.len()];
        if found.value.is_whole() {
            let mut about = at;
            for (d, slope) in found.slopes.iter().enumerate() {
                let [from, to] =
                    region[d].map(|x| Interval::between(x, x).subtract(&Interval::between(middle[d], middle[d])));
                let change = slope.multiply(&Interval::between(from.lower(), to.upper()));
                about = about.add(&change);
                swing[d] = change.upper() - change.lower();
            }
            lower = lower.max(about.lower());
        }
        Some(Open { lower, region, swing })
    }

    fn look(&mut self, region: &[[f64; 2]]) -> Bounds {
        self.boxes += 1;
        (self.bounds)(region)
    }
}

/// Holds every dimension whose slope has one sign at the end where the value is least; says whether there was any.
fn hold(region: &mut Region, slopes: &[Interval], zones: Zones<'_>) -> bool {
    let mut held = false;
    let free: Vec<bool> = (0..region.len()).map(|d| zones.free(d, region)).collect();
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
