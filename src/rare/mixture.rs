//! Density from which points are drawn: a mixture of densities beyond the limits, near them, the inputs' own and a
//! wider one.
//!
//! Let `a` be the direction of a design point and `c = a.z`. A component draws the coordinates across from the inputs'
//! own distribution, spread where the limit bends. It draws `c` from the tail of a normal variable beyond `t - shift`,
//! where `t` is the crossing of the surrogate on that very line. Relative to the inputs' density it has the height
//!
//! ```text
//! h(z) = s(z) [c > t - shift]/Phi(shift - t)          s: of the spreads, 1 without any
//! ```
//!
//! so that a perfect surrogate leaves no variance. A poor one costs accuracy but gives no bias, because drawing and
//! weighting use the same `t`. At a place from the model itself, `t` is the distance of that place on every line: a
//! half-space.

use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::estimate::Columns;
use crate::estimate::strata::along;
use crate::rare::design_point::{BEFORE, FARTHEST, Place, PlaceKind};
use crate::rare::target::Target;
use sensitol_numeric::distribution::standard_normal;
use sensitol_numeric::parallel::prelude::*;

/// Layers of a place from far beyond the limit to far before it. Each is a pair: the probability beyond the shifted
/// limit relative to that beyond the limit itself, and the first part of the place's points.
const LAYERS: [(f64, f64); 9] = [
    (1e-3, 0.03),
    (0.03, 0.05),
    (0.4, 0.09),
    (1.2, 0.3),
    (1.8, 0.2),
    (4.0, 0.12),
    (20.0, 0.08),
    (150.0, 0.07),
    (1000.0, 0.06),
];
/// Probabilities beyond the shifted limit of the layers, if the surrogate does not reach the limit.
const LEVELS: [f64; 5] = [0.1, 1e-2, 1e-4, 1e-6, 1e-9];
/// Greatest probability of a layer. A more likely layer needs no component but the inputs' own density.
const LIKELY: f64 = 0.2;
/// Parts of the points from the inputs' own density and from a wider one, for at least `MANY` points. They find rejects
/// outside all places, and bound the weights there.
const SPARE: [f64; 2] = [0.1, 0.1];
/// The two parts for fewer than `MANY` points.
const SCARCE: [f64; 2] = [0.05, 0.03];
/// Number of points that is enough for the greater parts.
const MANY: u64 = 2000;
/// Standard deviation of the wide density relative to the inputs' own.
const WIDTH: f64 = 1.5;
/// Greatest number of variables for the wide density: for 12, one point in 130 times the density.
const FEW_VARIABLES: usize = 12;
/// Part of a target's points for places from the model beside those of the surrogate: if the surrogate's are likelier, and if the model's
/// are.
const SHOWN: [f64; 2] = [0.3, 0.7];
/// Rows that are drawn and weighted together.
const ROWS: usize = 512;

/// One component of the mixture.
#[derive(Debug, Clone, Copy)]
enum Component {
    /// Inputs' own density.
    Plain,
    /// Inputs' density with all standard deviations wider by [`WIDTH`].
    Wide,
    /// Density beyond the shifted limit at a place.
    Beyond { place: usize, shift: f64 },
    /// Inputs' density moved to a corner.
    Moved { place: usize },
    /// Inputs' density beyond a corner in each of its coordinates.
    Corner { place: usize },
}

pub(super) struct Mixture<'a> {
    targets: &'a [Target<'a>],
    places: Vec<Place>,
    components: Vec<Component>,
    /// First parts of the components.
    pub(super) parts: Vec<f64>,
    dimensions: usize,
}

/// Lines through all points towards a place: distances of point and crossing along it, and the logarithm of the factor of the height.
struct Crossing {
    along: Vec<f64>,
    crossing: Vec<f64>,
    spread: Vec<f64>,
}

/// Start of a component on a line with a crossing. It is at most `FARTHEST`, because a double cannot hold the
/// probabilities farther out.
fn edge(crossing: f64, shift: f64) -> f64 {
    (crossing - shift).min(FARTHEST)
}

impl Place {
    /// Logarithm of the height of the density beyond a corner.
    fn corner_height(&self, points: &Columns, row: usize) -> f64 {
        let height = |(j, sign, distance): (usize, f64, f64)| {
            let edge = edge(distance, BEFORE);
            let beyond = sign * points[j][row] > edge;
            if beyond { -libm::log(standard_normal::sf(edge)) } else { f64::NEG_INFINITY }
        };
        self.sides().map(height).sum()
    }
}

impl<'a> Mixture<'a> {
    /// Mixture for these targets, which get equal parts, and for about so many points.
    pub(super) fn new(targets: &'a [Target<'a>], places: Vec<Place>, points: u64) -> Self {
        let dimensions = targets.first().map_or(0, |target| target.space.len());
        let [plain, wide] = if points < MANY { SCARCE } else { SPARE };
        let (components, parts) = match dimensions <= FEW_VARIABLES {
            true => (vec![Component::Plain, Component::Wide], vec![plain, wide]),
            false => (vec![Component::Plain], vec![plain + wide]),
        };
        let mut mixture = Self { targets, places, components, parts, dimensions };
        let each = (1.0 - plain - wide) / targets.len() as f64;
        for target in 0..targets.len() {
            mixture.share(target, each);
        }
        let left = 1.0 - mixture.parts.iter().sum::<f64>();
        mixture.parts[0] += left;
        mixture
    }

    /// Distributes a part among the places of a target.
    fn share(&mut self, target: usize, part: f64) {
        let of = |shown: bool| -> Vec<usize> {
            let mine = |place: &Place| place.target == target && place.is_shown() == shown;
            (0..self.places.len()).filter(|&p| mine(&self.places[p])).collect()
        };
        let (known, shown) = (of(false), of(true));
        let probability = |p: usize| self.places[p].probability();
        let greatest = |of: &[usize]| of.iter().map(|&p| probability(p)).fold(0.0, f64::max);
        let shown_part = match (known.is_empty(), shown.is_empty()) {
            (_, true) => 0.0,
            (true, false) => 1.0,
            (false, false) => SHOWN[usize::from(greatest(&shown) > greatest(&known))],
        };
        // In proportion to their probabilities, but not less than a tenth of an equal part, because the nearest place
        // need not hold most of the rejects.
        let total: f64 = known.iter().map(|&p| probability(p)).sum();
        let even = if total > 0.0 { 0.1 } else { 1.0 };
        let by = |p: usize| if total > 0.0 { 0.9 * probability(p) / total } else { 0.0 } + even / known.len() as f64;
        let of_known = known.iter().map(|&p| (p, part * (1.0 - shown_part) * by(p)));
        // Half evenly, and half as the roots of their probabilities, because the share of rejects in a half-space is
        // not known.
        let roots: f64 = shown.iter().map(|&p| probability(p).sqrt()).sum();
        let root = |p: usize| if roots > 0.0 { 0.5 * probability(p).sqrt() / roots } else { 0.0 };
        let of_shown = shown.iter().map(|&p| (p, part * shown_part * (0.5 / shown.len() as f64 + root(p))));
        let parts: Vec<(usize, f64)> = of_known.chain(of_shown).collect();
        parts.into_iter().for_each(|(place, part)| self.add(place, part));
    }

    fn add(&mut self, place: usize, part: f64) {
        let Place { distance, kind, .. } = self.places[place];
        let probability = standard_normal::sf(distance);
        let layers: Vec<(f64, f64)> = match kind {
            PlaceKind::Surrogate => LAYERS.iter().map(|&(times, part)| (times * probability, part)).collect(),
            PlaceKind::Way => LEVELS.iter().map(|&level| (level, 1.0 / LEVELS.len() as f64)).collect(),
            PlaceKind::HalfSpace => {
                self.components.push(Component::Beyond { place, shift: BEFORE });
                return self.parts.push(part);
            }
            PlaceKind::Corner => {
                self.components.extend([Component::Moved { place }, Component::Corner { place }]);
                return self.parts.extend([0.5 * part; 2]);
            }
        };
        for (level, of) in layers {
            if level <= LIKELY && level > 0.0 {
                let shift = distance - standard_normal::upper_quantile(level);
                self.components.push(Component::Beyond { place, shift });
                self.parts.push(part * of);
            }
        }
    }

    /// Number of the components without a place. They are the first ones.
    pub(super) fn without_place(&self) -> usize {
        let without = |component: &&Component| matches!(component, Component::Plain | Component::Wide);
        self.components.iter().take_while(without).count()
    }

    /// Standard deviations of the components without a place, in order.
    pub(super) fn widths(&self) -> impl Iterator<Item = f64> + use<> {
        [1.0, WIDTH].into_iter().take(self.without_place())
    }

    /// Logarithm of the weight that the components of places give each point, with their first parts. It is infinite
    /// where none of them draws.
    ///
    /// The others are left out: far out, the wide density is great at every point, and says nothing about the rejects
    /// nearer to the means.
    pub(super) fn place_weights(&self, points: &Columns) -> Vec<f64> {
        let first = self.without_place();
        let weight = |heights: Vec<f64>| {
            let highest = heights[first..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if highest == f64::NEG_INFINITY {
                return f64::INFINITY;
            }
            let parts = self.parts[first..].iter().zip(&heights[first..]);
            let sum: f64 = parts.map(|(part, height)| part * libm::exp(height - highest)).sum();
            -highest - libm::log(sum)
        };
        self.heights(points).into_iter().map(weight).collect()
    }

    pub(super) fn len(&self) -> usize {
        self.components.len()
    }

    pub(super) fn places(&self) -> &[Place] {
        &self.places
    }

    /// Draws the given number of points from each component, in order. The result does not depend on the number of
    /// threads.
    pub(super) fn draw(&self, counts: &[usize], seed: u64) -> Columns {
        let mut tasks = Vec::new();
        for (component, &count) in counts.iter().enumerate() {
            tasks.extend((0..count).step_by(ROWS).map(|first| (component, first, ROWS.min(count - first))));
        }
        let block = |&(component, first, rows): &(usize, usize, usize)| {
            let key = (component as u64) << 40 | first as u64;
            self.block(self.components[component], rows, &mut Xoshiro256PlusPlus::seed_from_u64(seed ^ key))
        };
        let blocks: Vec<Columns> = tasks.par_iter().map(block).collect();
        (0..self.dimensions).map(|j| blocks.iter().flat_map(|block| block[j].iter().copied()).collect()).collect()
    }

    fn block(&self, component: Component, rows: usize, rng: &mut Xoshiro256PlusPlus) -> Columns {
        let mut columns: Columns =
            (0..self.dimensions).map(|_| (0..rows).map(|_| rng.sample(StandardNormal)).collect()).collect();
        let (place, shift) = match component {
            Component::Plain => return columns,
            Component::Wide => {
                columns.iter_mut().flatten().for_each(|z| *z *= WIDTH);
                return columns;
            }
            Component::Moved { place } => {
                let Place { direction, distance, .. } = &self.places[place];
                for (column, part) in columns.iter_mut().zip(direction) {
                    column.iter_mut().for_each(|z| *z += part * distance);
                }
                return columns;
            }
            Component::Corner { place } => {
                for (j, sign, distance) in self.places[place].sides() {
                    let beyond = standard_normal::sf(edge(distance, BEFORE));
                    for z in &mut columns[j] {
                        let tail = rng.sample::<f64, _>(rand_distr::Open01) * beyond;
                        *z = sign * standard_normal::upper_quantile(tail);
                    }
                }
                return columns;
            }
            Component::Beyond { place, shift } => (place, shift),
        };
        let place = &self.places[place];
        for (direction, spread) in &place.spreads {
            let across = along(&columns, direction);
            for (column, part) in columns.iter_mut().zip(direction) {
                column.iter_mut().zip(&across).for_each(|(z, across)| *z += (spread - 1.0) * across * part);
            }
        }
        let Crossing { along, crossing, .. } = self.crossing(place, &columns);
        for row in 0..rows {
            let tail: f64 = rng.sample::<f64, _>(rand_distr::Open01) * standard_normal::sf(edge(crossing[row], shift));
            let moved = standard_normal::upper_quantile(tail) - along[row];
            columns.iter_mut().zip(&place.direction).for_each(|(column, part)| column[row] += moved * part);
        }
        columns
    }

    /// Logarithms of the heights of all components relative to the inputs' own density, a row for every point.
    pub(super) fn heights(&self, points: &Columns) -> Vec<Vec<f64>> {
        let rows = points.first().map_or(0, Vec::len);
        let firsts: Vec<usize> = (0..rows).step_by(ROWS).collect();
        let of = |&first: &usize| {
            let last = rows.min(first + ROWS);
            let part: Columns = points.iter().map(|column| column[first..last].to_vec()).collect();
            let crossings: Vec<Crossing> = self.places.iter().map(|place| self.crossing(place, &part)).collect();
            let height = |row: usize, component: &Component| {
                let (place, shift) = match *component {
                    Component::Plain => return 0.0,
                    Component::Wide => return self.wide(&part, row),
                    Component::Moved { place } => {
                        let distance = self.places[place].distance;
                        return distance * (crossings[place].along[row] - 0.5 * distance);
                    }
                    Component::Corner { place } => return self.places[place].corner_height(&part, row),
                    Component::Beyond { place, shift } => (place, shift),
                };
                let Crossing { along, crossing, spread } = &crossings[place];
                let edge = edge(crossing[row], shift);
                if along[row] > edge { spread[row] - libm::log(standard_normal::sf(edge)) } else { f64::NEG_INFINITY }
            };
            let row = |row: usize| self.components.iter().map(|component| height(row, component)).collect();
            (0..last - first).map(row).collect::<Vec<Vec<f64>>>()
        };
        firsts.par_iter().flat_map_iter(of).collect()
    }

    /// Logarithm of the height of the wide density: `N(0, s^2)` divided by `N(0, 1)`.
    fn wide(&self, points: &Columns, row: usize) -> f64 {
        let square: f64 = points.iter().map(|column| column[row] * column[row]).sum();
        0.5 * square * (1.0 - 1.0 / (WIDTH * WIDTH)) - self.dimensions as f64 * libm::log(WIDTH)
    }

    /// Crossing of the surrogate with the limit on the line through every point in the direction of the place, near its
    /// crossing at the place.
    fn crossing(&self, place: &Place, points: &Columns) -> Crossing {
        let rows = points.first().map_or(0, Vec::len);
        let along_it = along(points, &place.direction);
        let mut spread = vec![0.0; rows];
        for (direction, by) in &place.spreads {
            for (spread, across) in spread.iter_mut().zip(along(points, direction)) {
                *spread -= 0.5 * across * across * (1.0 / (by * by) - 1.0) + libm::log(*by);
            }
        }
        let crossing = match place.kind {
            PlaceKind::Surrogate => self.secant(place, points, &along_it),
            PlaceKind::Way | PlaceKind::HalfSpace | PlaceKind::Corner => vec![place.distance; rows],
        };
        Crossing { along: along_it, crossing, spread }
    }

    /// Crossings by six steps of the secant method. A line without convergence keeps the distance of the place.
    fn secant(&self, place: &Place, points: &Columns, along: &[f64]) -> Vec<f64> {
        /// Greatest distance of a crossing from that of the place, in sigmas.
        const REACH: f64 = 5.0;
        let target = &self.targets[place.target];
        let margins = |at: &[f64]| {
            let moved = |(column, part): (&Vec<f64>, &f64)| {
                column.iter().zip(along).zip(at).map(|((z, along), t)| z + (t - along) * part).collect()
            };
            let mut margins = target.margins(&points.iter().zip(&place.direction).map(moved).collect());
            margins.iter_mut().for_each(|margin| *margin -= place.offset);
            margins
        };
        let clamped = |t: f64| t.clamp(place.distance - REACH, place.distance + REACH);
        let mut last = vec![place.distance - 0.5; along.len()];
        let mut now = vec![place.distance; along.len()];
        let mut before = margins(&last);
        for _ in 0..6 {
            let here = margins(&now);
            for row in 0..now.len() {
                let slope = (here[row] - before[row]) / (now[row] - last[row]);
                let step = here[row] / slope;
                // The margin must rise outward.
                let next = if slope > 0.0 && step.is_finite() { clamped(now[row] - step) } else { now[row] };
                if (next - now[row]).abs() > 1e-9 {
                    (last[row], before[row], now[row]) = (now[row], here[row], next);
                }
            }
        }
        now
    }
}
