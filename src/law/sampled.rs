//! Surfaces with cycles of products, or with a tail that no transform bears: components that must be sampled are, and
//! everything else is integrated.
//!
//! What is integrated is the exact law of all other components, where that is wide enough, or one direction of the sampled
//! ones by its own distribution function. The nearest exact surface, without the products that make it inexact, is the
//! control: `P = P_exact + mean(1 - 1_control)` at the same points.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::direction::{Direction, Terms};
use super::inversion::Inversion;
use super::panels::expectation;
use super::points::{Along, REPLICATES, Sample};
use super::polynomial::value;
use super::surface::Surface;
use super::table::Table;
use super::tilt::Tilts;
use super::transform::Transform;
use super::{Figure, LawOptions, Tail};

/// Standard errors of the mean of 16 replicates that bound the error: Student's distribution with 15 degrees of freedom leaves
/// 1 % beyond.
const QUANTILE: f64 = 2.95;
/// Sigma of the exact components by that along the direction from which on they take its place.
const WIDE: f64 = 0.5;
/// A plain estimate of this relative error rules where a tilted one contradicts it, which may have seen one of two modes.
const GOOD: f64 = 0.1;
/// What a table of an exact law leaves, relative.
const TABULATED: f64 = 1e-7;

/// The law of a surface of which a part is sampled.
#[derive(Debug)]
pub(super) struct Sampled {
    surface: Arc<Surface>,
    direction: Direction,
    tilts: Tilts,
    full: Terms,
    /// The exact law of the components that are not sampled.
    others: Option<(Table, Inversion)>,
    control: Option<(Terms, Inversion)>,
    points: usize,
    seed: u64,
    plain: Mutex<Option<Arc<Sample>>>,
    tilted: Mutex<BTreeMap<(Tail, usize), Arc<Sample>>>,
}

/// What is averaged.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Quantity {
    Tail(Tail),
    Density,
}

impl Sampled {
    /// Of the components that are left when the transform has taken those that it can.
    pub(super) fn of(
        surface: &Arc<Surface>,
        transform: Transform,
        left: &[Vec<usize>],
        sigma: f64,
        options: &LawOptions,
    ) -> Option<Self> {
        let mut members: Vec<usize> = left.iter().flatten().copied().collect();
        members.sort_unstable();
        let direction = Direction::of(surface, &members)?;
        let wide = !transform.is_empty() && transform.sigma >= WIDE * direction.variance().sqrt();
        let (direction, others) = match wide {
            true => {
                // About the centre, which belongs to the sampled part.
                let range = surface.range_without(&members);
                let law = Inversion::new(transform, 0.0);
                (direction.without(), Some((Table::of(&law, range), law)))
            }
            false => {
                let all: Vec<usize> = (0..surface.len()).collect();
                (Direction::of(surface, &all)?, None)
            }
        };
        let simple = surface.with_products(|j, k| surface.is_normal_parabola(j) && surface.is_normal_parabola(k));
        let (exact, rest) = Transform::of(&simple, &simple.components());
        let control = rest.is_empty().then(|| (direction.terms(&simple), Inversion::new(exact, surface.centre)));
        let (full, tilts) = (direction.terms(surface), Tilts::of(&direction, surface, sigma));
        let points = options.points.div_ceil(REPLICATES).next_power_of_two();
        Some(Self {
            surface: Arc::clone(surface),
            direction,
            tilts,
            full,
            others,
            control,
            points,
            seed: options.seed,
            plain: Mutex::default(),
            tilted: Mutex::default(),
        })
    }

    pub(super) fn tail(&self, y: f64, tail: Tail) -> Figure {
        self.figure(y, tail, Quantity::Tail(tail)).clamped()
    }

    pub(super) fn density(&self, y: f64, mean: f64) -> Figure {
        let tail = if y < mean { Tail::Lower } else { Tail::Upper };
        self.figure(y, tail, Quantity::Density)
    }

    fn sample(&self, tilted: Option<(Tail, usize, &super::tilt::Proposal)>) -> Arc<Sample> {
        let control = self.control.as_ref().map(|(terms, _)| terms);
        let along = Along { direction: &self.direction, full: &self.full, control };
        match tilted {
            None => {
                let mut plain = self.plain.lock().unwrap_or_else(PoisonError::into_inner);
                let made = || Arc::new(Sample::of(&along, &self.tilts, None, self.points, self.seed));
                Arc::clone(plain.get_or_insert_with(made))
            }
            Some((tail, rung, proposal)) => {
                let mut known = self.tilted.lock().unwrap_or_else(PoisonError::into_inner);
                let made = || Arc::new(Sample::of(&along, &self.tilts, Some(proposal), self.points, self.seed));
                Arc::clone(known.entry((tail, rung)).or_insert_with(made))
            }
        }
    }

    fn figure(&self, y: f64, tail: Tail, quantity: Quantity) -> Figure {
        if let ([coordinate], Some(_), false) = (
            self.tilts.sampled(),
            &self.others,
            self.direction.is_behind(self.tilts.sampled().first().copied().unwrap_or(0)),
        ) {
            return self.convolved(*coordinate, y, quantity);
        }
        let off = y - self.surface.centre;
        let exact = self.control.as_ref().map(|(_, law)| match quantity {
            Quantity::Tail(tail) => law.tail(y, tail),
            Quantity::Density => law.density(y),
        });
        let plain = self.estimate(&self.sample(None), off, quantity, exact);
        // In the middle no tilt does better.
        if plain.value > 0.0 && plain.error < 1e-3 * plain.value {
            return plain;
        }
        let others = |theta: f64| self.others.as_ref().map_or(0.0, |(_, law)| law.tilted_mean(theta));
        let tilted = self
            .tilts
            .proposal(&self.surface, off, tail, others)
            .map(|(rung, proposal)| self.estimate(&self.sample(Some((tail, rung, &proposal))), off, quantity, exact));
        let found = match tilted {
            Some(tilted) if plain.value > 0.0 => {
                let contradicted = plain.error < GOOD * plain.value
                    && (tilted.value - plain.value).abs() > 2.0 * (tilted.error + plain.error);
                if plain.error <= tilted.error || contradicted { plain } else { tilted }
            }
            Some(tilted) if tilted.value > 0.0 => tilted,
            _ => plain,
        };
        // No point beyond the limit: the rule of three.
        let fewest = 3.0 / (REPLICATES * self.points) as f64;
        match quantity {
            Quantity::Tail(_) if found.value <= 0.0 => Figure::new(0.0, found.error.max(fewest)),
            _ => found,
        }
    }

    /// One coordinate beside an exact law: panels.
    fn convolved(&self, coordinate: usize, y: f64, quantity: Quantity) -> Figure {
        let off = y - self.surface.centre;
        let part = &self.surface.parts[coordinate];
        let found = expectation(&self.surface.inputs[coordinate], &[], |z| self.beside(off - value(part, z), quantity));
        Figure::new(found.value, found.error + TABULATED * found.value)
    }

    /// The exact law of the other components at what is left of a limit.
    fn beside(&self, y: f64, quantity: Quantity) -> f64 {
        match (&self.others, quantity) {
            (Some((table, _)), Quantity::Tail(tail)) => table.tail(y, tail),
            (Some((table, _)), Quantity::Density) => table.density(y),
            (None, Quantity::Tail(tail)) => f64::from(u8::from(tail.sign() * -y > 0.0)),
            (None, Quantity::Density) => 0.0,
        }
    }

    /// The mean over a sample, by itself or beside the control, whichever scatters less.
    fn estimate(&self, sample: &Sample, off: f64, quantity: Quantity, exact: Option<Figure>) -> Figure {
        let inner = |polynomial: &super::polynomial::Quartic| match self.direction.input() {
            None => self.beside(off - polynomial[0], quantity),
            Some(input) => {
                let mut polynomial = *polynomial;
                polynomial[0] -= off;
                match quantity {
                    Quantity::Tail(tail) => input.beyond(&polynomial, tail),
                    Quantity::Density => input.density_of(&polynomial),
                }
            }
        };
        let n = self.points;
        let weight = |at: usize| sample.weights.get(at).copied().unwrap_or(1.0);
        let means = |f: &dyn Fn(usize) -> f64| -> Vec<f64> {
            (0..REPLICATES).map(|r| (r * n..(r + 1) * n).map(f).sum::<f64>() / n as f64).collect()
        };
        let values: Vec<f64> = sample.full.iter().map(inner).collect();
        let alone = of_replicates(&means(&|at| weight(at) * values[at]));
        let tabulated = if self.others.is_some() { TABULATED } else { 1e-12 };
        let alone = Figure::new(alone.0, alone.1 + tabulated * alone.0.abs());
        let Some(exact) = exact.filter(|_| sample.control.len() == values.len()) else { return alone };
        let control: Vec<f64> = sample.control.iter().map(inner).collect();
        let (mean, error) = of_replicates(&means(&|at| weight(at) * (values[at] - control[at])));
        let beside = Figure::new(exact.value + mean, error + exact.error + tabulated * exact.value);
        if beside.error < alone.error && beside.value > 0.0 { beside } else { alone }
    }
}

/// The mean of replicates, and its error.
fn of_replicates(means: &[f64]) -> (f64, f64) {
    let n = means.len() as f64;
    let mean = means.iter().sum::<f64>() / n;
    let variance = means.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (n - 1.0);
    (mean, QUANTILE * (variance / n).sqrt())
}
