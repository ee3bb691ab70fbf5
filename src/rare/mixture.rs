//! The density that points are drawn from: a mixture of densities beyond the limits, near them, and the inputs' own.
//!
//! With `a` the direction of a design point and `c = a.z`, a component draws what is across from the inputs' own law (spread
//! where the limit bends) and `c` from the tail of a normal variable beyond `t - shift`, where `t` is the crossing of the
//! surrogate on that very line. Relative to the inputs' density it has the height
//!
//! ```text
//! h(z) = s(z) [c > t - shift]/Phi(shift - t)          s: of the spreads, 1 without any
//! ```
//!
//! so that a perfect surrogate leaves nothing to chance, and a poor one costs accuracy only: whatever `t` is, it is the same
//! where points are drawn and where they are weighed.

use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;

use super::place::{FARTHEST, Place};
use super::space::Columns;
use super::target::Target;
use crate::distribution::standard_normal;

/// How likely what lies beyond a component's shifted limit is, by what lies beyond the limit itself, and the component's part
/// of the points as long as nothing else is known: from far beyond the limit to far before it.
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
/// The levels where the surrogate does not reach a limit.
const LEVELS: [f64; 5] = [0.1, 1e-2, 1e-4, 1e-6, 1e-9];
/// What is more likely than this needs no component but the inputs' own density.
const LIKELY: f64 = 0.2;
/// The part of the points from the inputs' own density.
const OWN: f64 = 0.05;
/// Rows that are drawn and weighed together.
const ROWS: usize = 512;

/// One component: None is the inputs' own density.
#[derive(Debug, Clone, Copy)]
struct Beyond {
    place: usize,
    shift: f64,
}

/// All components.
pub(super) struct Mixture<'a> {
    targets: &'a [Target<'a>],
    places: Vec<Place>,
    components: Vec<Option<Beyond>>,
    /// The parts of the components at first.
    pub(super) parts: Vec<f64>,
    dimensions: usize,
}

/// Where a place's line through each point crosses, how far out on it the point lies, and the logarithm of what the spreads make of
/// the height.
struct Crossing {
    along: Vec<f64>,
    crossing: Vec<f64>,
    spread: Vec<f64>,
}

/// Where a component begins on a line that crosses there; farther out a double knows no probability.
fn edge(crossing: f64, shift: f64) -> f64 {
    (crossing - shift).min(FARTHEST)
}

impl<'a> Mixture<'a> {
    /// For these targets, all of which get the same part.
    pub(super) fn new(targets: &'a [Target<'a>], places: Vec<Place>) -> Self {
        let dimensions = targets.first().map_or(0, |target| target.space.len());
        let mut mixture = Self { targets, places, components: vec![None], parts: vec![OWN], dimensions };
        let each = (1.0 - OWN) / targets.len() as f64;
        for target in 0..targets.len() {
            let of: Vec<usize> = (0..mixture.places.len()).filter(|&p| mixture.places[p].target == target).collect();
            let crossed = |p: usize| match mixture.places[p] {
                Place { crossed: true, distance, .. } => standard_normal::sf(distance),
                Place { .. } => 0.0,
            };
            let total: f64 = of.iter().map(|&p| crossed(p)).sum();
            // Not less than a tenth of an equal part: the nearest place need not be the whole story.
            let even = if total > 0.0 { 0.1 } else { 1.0 };
            let part = |p: usize| if total > 0.0 { 0.9 * crossed(p) / total } else { 0.0 } + even / of.len() as f64;
            let parts: Vec<f64> = of.iter().map(|&p| each * part(p)).collect();
            of.iter().zip(parts).for_each(|(&place, part)| mixture.add(place, part));
        }
        let left = 1.0 - mixture.parts.iter().sum::<f64>();
        mixture.parts[0] += left;
        mixture
    }

    fn add(&mut self, place: usize, part: f64) {
        let Place { distance, crossed, .. } = self.places[place];
        let probability = standard_normal::sf(distance);
        let layers: Vec<(f64, f64)> = match crossed {
            true => LAYERS.iter().map(|&(times, part)| (times * probability, part)).collect(),
            false => LEVELS.iter().map(|&level| (level, 1.0 / LEVELS.len() as f64)).collect(),
        };
        for (level, of) in layers {
            if level <= LIKELY && level > 0.0 {
                self.components.push(Some(Beyond { place, shift: distance - standard_normal::upper_quantile(level) }));
                self.parts.push(part * of);
            }
        }
    }

    /// How many components.
    pub(super) fn len(&self) -> usize {
        self.components.len()
    }

    pub(super) fn places(&self) -> &[Place] {
        &self.places
    }

    /// So many points of each component, one after the other. The same for any number of threads.
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

    fn block(&self, component: Option<Beyond>, rows: usize, rng: &mut Xoshiro256PlusPlus) -> Columns {
        let mut columns: Columns =
            (0..self.dimensions).map(|_| (0..rows).map(|_| rng.sample(StandardNormal)).collect()).collect();
        let Some(Beyond { place, shift }) = component else { return columns };
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

    /// The logarithm of every component's height relative to the inputs' own density: a row for every point.
    pub(super) fn heights(&self, points: &Columns) -> Vec<Vec<f64>> {
        let rows = points.first().map_or(0, Vec::len);
        let firsts: Vec<usize> = (0..rows).step_by(ROWS).collect();
        let of = |&first: &usize| {
            let last = rows.min(first + ROWS);
            let part: Columns = points.iter().map(|column| column[first..last].to_vec()).collect();
            let crossings: Vec<Crossing> = self.places.iter().map(|place| self.crossing(place, &part)).collect();
            let height = |row: usize, component: &Option<Beyond>| {
                let Some(Beyond { place, shift }) = *component else { return 0.0 };
                let Crossing { along, crossing, spread } = &crossings[place];
                let edge = edge(crossing[row], shift);
                if along[row] > edge { spread[row] - standard_normal::sf(edge).ln() } else { f64::NEG_INFINITY }
            };
            let row = |row: usize| self.components.iter().map(|component| height(row, component)).collect();
            (0..last - first).map(row).collect::<Vec<Vec<f64>>>()
        };
        firsts.par_iter().flat_map_iter(of).collect()
    }

    /// On the line through every point in the direction of the place: where the surrogate crosses the limit, near where it
    /// does so at the place itself.
    fn crossing(&self, place: &Place, points: &Columns) -> Crossing {
        let rows = points.first().map_or(0, Vec::len);
        let along_it = along(points, &place.direction);
        let mut spread = vec![0.0; rows];
        for (direction, by) in &place.spreads {
            for (spread, across) in spread.iter_mut().zip(along(points, direction)) {
                *spread -= 0.5 * across * across * (1.0 / (by * by) - 1.0) + by.ln();
            }
        }
        let crossing = match place.crossed {
            true => self.secant(place, points, &along_it),
            false => vec![place.distance; rows],
        };
        Crossing { along: along_it, crossing, spread }
    }

    /// Six steps of the secant method; where they lead nowhere, the distance of the place.
    fn secant(&self, place: &Place, points: &Columns, along: &[f64]) -> Vec<f64> {
        /// So far from the place's own distance a crossing may lie.
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
                // Outward it must rise.
                let next = if slope > 0.0 && step.is_finite() { clamped(now[row] - step) } else { now[row] };
                if (next - now[row]).abs() > 1e-9 {
                    (last[row], before[row], now[row]) = (now[row], here[row], next);
                }
            }
        }
        now
    }
}

/// How far every point lies in a direction.
fn along(points: &Columns, direction: &[f64]) -> Vec<f64> {
    let mut along = vec![0.0; points.first().map_or(0, Vec::len)];
    for (column, part) in points.iter().zip(direction) {
        along.iter_mut().zip(column).for_each(|(along, z)| *along += part * z);
    }
    along
}
