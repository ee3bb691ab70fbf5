//! Surfaces with cycles of products, or with a tail for which no transform exists. Components that need it are sampled. All others are
//! integrated.
//!
//! The integrand is the exact distribution of all other components if that is wide enough. Otherwise it is the distribution function along
//! one direction of the sampled ones. The control variate is the nearest surface with an exact distribution, which lacks the products that
//! prevent it: `P = P_exact + mean(1 - 1_control)` at the same points.

use crate::law::tail_table;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::law::direction::{Direction, Terms};
use crate::law::exponential_tilt::{Proposal, Tilts};
use crate::law::input::Input;
use crate::law::inversion::tail_inversion::Inversion;
use crate::law::inversion::transform::{Summed, Transform};
use crate::law::panels::{EXACT, expectation};
use crate::law::polynomial::{MonotonePieces, Quartic, derivative, roots, value};
use crate::law::sampled_points::{Along, QUANTILE, REPLICATES, Sample, visit};
use crate::law::surface::Surface;
use crate::law::tail_table::Table;
use crate::law::{LawFigure, LawOptions, LawTail};

/// Least ratio of the sigma of the exact components to that along the direction at which they replace the direction.
const WIDE: f64 = 0.5;
/// Relative error below which a plain estimate overrules a tilted one that contradicts it. The tilted one may have seen one of two modes.
const GOOD: f64 = 0.1;

/// Distribution of a surface of which a part is sampled.
#[derive(Debug)]
pub(super) struct Sampled {
    surface: Arc<Surface>,
    direction: Direction,
    tilts: Arc<Tilts>,
    full: Terms,
    /// Exact distribution of the components that are not sampled, as a table and as an inversion.
    others: Option<(Table, Inversion)>,
    control: Option<Control>,
    points: usize,
    seed: u64,
    plain: Mutex<Option<Arc<Sample>>>,
    tilted: Mutex<BTreeMap<(LawTail, usize), Arc<Sample>>>,
}

/// Control variate: the nearest surface whose distribution is exact.
#[derive(Debug)]
struct Control {
    surface: Arc<Surface>,
    /// Direction over the parts of the control variate.
    direction: Direction,
    terms: Terms,
    law: Inversion,
}

impl Control {
    /// Nearest surface that keeps the products of normal inputs, those of parabolas, or none. Returns None if none has an exact
    /// distribution.
    fn of(surface: &Surface, direction: &Direction) -> Option<Self> {
        let normal = |j: usize, k: usize| surface.inputs[j].is_normal() && surface.inputs[k].is_normal();
        let parabolas = |j: usize, k: usize| surface.is_normal_parabola(j) && surface.is_normal_parabola(k);
        let whole = surface.with_products(normal);
        let mut candidates = vec![(surface.with_products(parabolas), Summed::Singles)];
        if (0..surface.len()).any(|j| surface.inputs[j].is_normal() && !surface.is_normal_parabola(j)) {
            let straightened = whole.with_normal_parabolas();
            candidates.extend([(straightened, Summed::Singles), (whole, Summed::Perturbed)]);
        }
        let mut open: Vec<(f64, Surface, Summed)> = candidates
            .into_iter()
            .map(|(candidate, summed)| (surface.squared_distance(&candidate), candidate, summed))
            .collect();
        open.sort_by(|a, b| a.0.total_cmp(&b.0));
        open.into_iter().find_map(|(_, candidate, summed)| {
            let (exact, rest) = Transform::of(&candidate, &candidate.components(), summed);
            let shifts: f64 = candidate.parts.iter().map(|part| part[0]).sum();
            let law = Inversion::new(exact, surface.centre + shifts);
            if !rest.is_empty() || !law.is_resolved() {
                return None;
            }
            let candidate = Arc::new(candidate);
            let direction = direction.over(&candidate);
            Some(Self { terms: direction.terms(&candidate), direction, surface: candidate, law })
        })
    }
}

/// Points and kind of estimate that several limits of one tail share.
#[derive(Debug, Default)]
pub(super) struct Choice {
    /// Rung and proposal of the tilt; None for points of the own distribution.
    tilted: Option<(usize, Arc<Proposal>)>,
    /// True if the control variate is used; None until a limit has been estimated.
    beside: Cell<Option<bool>>,
}

/// Quantity that is averaged.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Quantity {
    LawTail(LawTail),
    Density,
}

impl Sampled {
    /// Sampled distribution of the components that the transform does not contain.
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
        // The centre of the surface belongs to the sampled part, so these components have the centre 0.
        let others = match wide {
            true => {
                let law = Inversion::new(transform, 0.0);
                Table::of(&law, surface.range_without(&members)).map(|table| (table, law))
            }
            false => None,
        };
        // Without a table, one direction of all inputs is integrated.
        let direction = match &others {
            Some(_) => direction.without(),
            None => Direction::of(surface, &(0..surface.len()).collect::<Vec<_>>())?,
        };
        let control = Control::of(surface, &direction);
        let (full, tilts) = (direction.terms(surface), Arc::new(Tilts::of(&direction, surface, sigma)));
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

    /// Tail beyond `y`. The smaller tail is estimated and the larger one is its complement, because few points lie in the smaller one.
    pub(super) fn tail(&self, y: f64, tail: LawTail, mean: f64) -> LawFigure {
        let nearer = if y < mean { LawTail::Lower } else { LawTail::Upper };
        let found = self.figure(y, nearer, Quantity::LawTail(nearer)).clamped();
        if nearer == tail { found } else { found.complement() }
    }

    pub(super) fn density(&self, y: f64, mean: f64) -> LawFigure {
        let tail = if y < mean { LawTail::Lower } else { LawTail::Upper };
        self.figure(y, tail, Quantity::Density)
    }

    /// Density by points of the own distribution.
    pub(super) fn plain_density(&self, y: f64) -> LawFigure {
        if let Some(coordinate) = self.only() {
            return self.convolved(coordinate, y, Quantity::Density);
        }
        let exact = self.exact(y, Quantity::Density);
        let off = y - self.surface.centre;
        let found = self.estimates(&self.direction, &self.sample(None), off, Quantity::Density, exact);
        LawFigure { value: found.best().value.max(0.0), ..found.best() }
    }

    fn sample(&self, tilted: Option<(LawTail, usize, &Proposal)>) -> Arc<Sample> {
        let control = self.control.as_ref().map(|control| (&control.direction, &control.terms));
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

    /// Only sampled coordinate, if the others have an exact distribution. It is integrated by panels instead of points.
    fn only(&self) -> Option<usize> {
        match *self.tilts.sampled() {
            [coordinate] if self.others.is_some() && !self.direction.is_behind(coordinate) => Some(coordinate),
            _ => None,
        }
    }

    fn figure(&self, y: f64, tail: LawTail, quantity: Quantity) -> LawFigure {
        if let Some(coordinate) = self.only() {
            return self.convolved(coordinate, y, quantity);
        }
        let (_, beside, found) = self.chosen(y, tail, quantity);
        let found = if beside { found.beside } else { Some(found.alone) }.unwrap_or(found.alone);
        // If no point lies beyond the limit, the error follows from the rule of three.
        let fewest = 3.0 / (REPLICATES * self.points) as f64;
        match quantity {
            Quantity::LawTail(_) if found.value <= 0.0 => LawFigure::new(0.0, found.error.max(fewest)),
            _ => found,
        }
    }

    fn exact(&self, y: f64, quantity: Quantity) -> Option<LawFigure> {
        self.control.as_ref().map(|Control { law, .. }| match quantity {
            Quantity::LawTail(tail) => law.tail(y, tail),
            Quantity::Density => law.density(y),
        })
    }

    /// Estimate that is used: rung and proposal (None for the own distribution), true if the control variate is used, and both estimates.
    fn chosen(&self, y: f64, tail: LawTail, quantity: Quantity) -> (Option<(usize, Arc<Proposal>)>, bool, Estimates) {
        let off = y - self.surface.centre;
        let exact = self.exact(y, quantity);
        let plain = self.estimates(&self.direction, &self.sample(None), off, quantity, exact);
        let own = plain.best();
        // In the middle of the distribution a tilt does not improve the estimate.
        if own.value > 0.0 && own.error < 1e-3 * own.value {
            return (None, plain.is_beside(), plain);
        }
        let others = |theta: f64| self.others.as_ref().map_or(0.0, |(_, law)| law.tilted_mean(theta));
        let Some((rung, proposal)) = self.tilts.proposal(&self.surface, off, tail, others) else {
            return (None, plain.is_beside(), plain);
        };
        let sample = self.sample(Some((tail, rung, &proposal)));
        let tilted = self.estimates(&self.direction, &sample, off, quantity, exact);
        let found = tilted.best();
        // Untilted points beyond the limit, however few, refute a tilted estimate that lies significantly below them.
        let unseen = found.value < own.value - own.error - found.error;
        let contradicted =
            unseen || own.error < GOOD * own.value && (found.value - own.value).abs() > 2.0 * (found.error + own.error);
        match own.value > 0.0 && (own.error <= found.error || contradicted) || found.value <= 0.0 {
            true => (None, plain.is_beside(), plain),
            false => (Some((rung, proposal)), tilted.is_beside(), tilted),
        }
    }

    /// Points and estimate for several limits of a tail: untilted points, or those tilted to a limit if they give the smaller error.
    pub(super) fn choice(&self, tilted_to: Option<f64>, tail: LawTail) -> Choice {
        match tilted_to.filter(|_| self.only().is_none()) {
            None => Choice::default(),
            Some(y) => {
                let (tilted, beside, _) = self.chosen(y, tail, Quantity::LawTail(tail));
                Choice { tilted, beside: Cell::new(Some(beside)) }
            }
        }
    }

    /// Exact distribution of the control variate.
    pub(super) fn control(&self) -> Option<&Inversion> {
        self.control.as_ref().filter(|_| self.only().is_none()).map(|control| &control.law)
    }

    /// Tail by the shared choice of points and estimate. `exact` computes the tail of the control variate.
    pub(super) fn tail_by(
        &self,
        y: f64,
        tail: LawTail,
        choice: &Choice,
        exact: impl FnOnce() -> Option<LawFigure>,
    ) -> LawFigure {
        let quantity = Quantity::LawTail(tail);
        if let Some(coordinate) = self.only() {
            return self.convolved(coordinate, y, quantity);
        }
        let sample = self.sample(choice.tilted.as_ref().map(|(rung, proposal)| (tail, *rung, proposal.as_ref())));
        let exact = if choice.beside.get() == Some(false) { None } else { exact() };
        let found = self.estimates(&self.direction, &sample, y - self.surface.centre, quantity, exact);
        // The estimate of the first limit is used for them all, so that no quantile lies on a jump between two estimates.
        let beside = choice.beside.get().unwrap_or_else(|| found.is_beside());
        choice.beside.set(Some(beside));
        found.beside.filter(|_| beside).unwrap_or(found.alone)
    }

    /// Points and estimate that give a tail.
    pub(super) fn held(&self, y: f64, tail: LawTail, mean: f64) -> Held {
        let nearer = if y < mean { LawTail::Lower } else { LawTail::Upper };
        let quantity = Quantity::LawTail(nearer);
        let (proposal, beside) = match self.only() {
            Some(_) => (None, false),
            None => {
                let (proposal, beside, _) = self.chosen(y, nearer, quantity);
                (proposal.map(|(_, proposal)| proposal), beside)
            }
        };
        let (direction, tilts) = (self.direction.clone(), Arc::clone(&self.tilts));
        Held { direction, tilts, proposal, beside, nearer, tail, points: self.points, seed: self.seed }
    }

    /// Tail of this distribution at the points of another one. Returns None if the structure differs.
    pub(super) fn tail_held(&self, y: f64, held: &Held) -> Option<LawFigure> {
        let same = self.surface.len() == held.direction.surface().len()
            && self.direction.members() == held.direction.members()
            && self.others.is_some() == held.direction.coordinate().is_none();
        if !same || self.only().is_some() {
            return None;
        }
        let quantity = Quantity::LawTail(held.nearer);
        let direction = held.direction.over(&self.surface);
        let full = direction.terms(&self.surface);
        let simple = self.control.as_ref().filter(|_| held.beside).map(|control| {
            let direction = held.direction.over(&control.surface);
            let terms = direction.terms(&control.surface);
            (direction, terms)
        });
        let control = simple.as_ref().map(|(direction, terms)| (direction, terms));
        let along = Along { direction: &direction, full: &full, control };
        let sample = Sample::of(&along, &held.tilts, held.proposal.as_deref(), held.points, held.seed);
        let exact = self.exact(y, quantity).filter(|_| held.beside);
        let found = self.estimates(&direction, &sample, y - self.surface.centre, quantity, exact);
        let found = if held.beside { found.beside? } else { found.alone };
        Some(if held.nearer == held.tail { found } else { found.complement() })
    }

    /// Derivatives of a tail by the logarithms of the tolerances of all inputs, by their indices.
    pub(super) fn derivatives(&self, y: f64, tail: LawTail, mean: f64) -> Vec<LawFigure> {
        let nearer = if y < mean { LawTail::Lower } else { LawTail::Upper };
        let sign = if nearer == tail { 1.0 } else { -1.0 };
        let off = y - self.surface.centre;
        let proposal = self.chosen(y, nearer, Quantity::LawTail(nearer)).0.map(|(_, proposal)| proposal);
        let exact = self.others.as_ref().map(|(table, law)| {
            let places =
                (0..self.surface.len()).filter(|j| self.direction.members().binary_search(j).is_err()).collect();
            (places, table.slopes(law, &self.surface, nearer))
        });
        let exact: Option<(Vec<usize>, tail_table::Slopes)> = exact;
        let n = self.surface.len();
        let rows = visit(&self.direction, &self.tilts, proposal.as_deref(), self.points, self.seed, |z, weight| {
            let mut sums = vec![0.0; n];
            let polynomial = self.direction.along(z, &self.full);
            let weight = weight * nearer.sign();
            // Along a direction only the crossings count; beside an exact distribution its density and its own slopes do.
            match self.direction.input() {
                Some(input) => pathwise(&self.surface, &self.direction, input, z, polynomial, off, weight, &mut sums),
                None => {
                    let left = off - polynomial[0];
                    let density = self.beside(left, Quantity::Density);
                    add_moves(&self.surface, self.direction.members(), z, weight * density, &mut sums);
                    if let Some((places, slopes)) = &exact {
                        places.iter().for_each(|&j| sums[j] += weight * nearer.sign() * slopes.at(j, left));
                    }
                }
            }
            sums
        });
        (0..n)
            .map(|j| {
                let mean = |rows: &[Vec<f64>]| rows.iter().map(|row| row[j]).sum::<f64>() / rows.len() as f64;
                let means: Vec<f64> = rows.chunks(self.points).map(mean).collect();
                let (value, error) = of_replicates(&means);
                LawFigure::new(sign * value, error)
            })
            .collect()
    }

    /// One coordinate beside an exact distribution, integrated by panels.
    fn convolved(&self, coordinate: usize, y: f64, quantity: Quantity) -> LawFigure {
        let off = y - self.surface.centre;
        let part = &self.surface.parts[coordinate];
        let found =
            expectation(&self.surface.inputs[coordinate], &[], EXACT, |z| self.beside(off - value(part, z), quantity));
        LawFigure::new(found.value, found.error + self.tabulated() * found.value)
    }

    /// Relative error of the integrand.
    fn tabulated(&self) -> f64 {
        self.others.as_ref().map_or(1e-12, |(table, _)| table.error)
    }

    /// Exact distribution of the other components, at the limit minus the sampled part.
    fn beside(&self, y: f64, quantity: Quantity) -> f64 {
        match (&self.others, quantity) {
            (Some((table, _)), Quantity::LawTail(tail)) => table.tail(y, tail),
            (Some((table, _)), Quantity::Density) => table.density(y),
            (None, Quantity::LawTail(tail)) => f64::from(u8::from(tail.sign() * -y > 0.0)),
            // An indicator function has no density.
            (None, Quantity::Density) => f64::NAN,
        }
    }

    /// Mean over a sample, with and without the control variate.
    fn estimates(
        &self,
        direction: &Direction,
        sample: &Sample,
        off: f64,
        quantity: Quantity,
        exact: Option<LawFigure>,
    ) -> Estimates {
        let inner = |polynomial: &Quartic, pieces: Option<&MonotonePieces>| match direction.input().zip(pieces) {
            None => self.beside(off - polynomial[0], quantity),
            Some((input, pieces)) => {
                let mut polynomial = *polynomial;
                polynomial[0] -= off;
                match quantity {
                    Quantity::LawTail(tail) => input.beyond_by(pieces, &polynomial, tail),
                    Quantity::Density => input.density_of(pieces, &polynomial),
                }
            }
        };
        let all = |polynomials: &[Quartic], pieces: &[MonotonePieces]| -> Vec<f64> {
            polynomials.iter().enumerate().map(|(at, polynomial)| inner(polynomial, pieces.get(at))).collect()
        };
        let n = sample.full.len() / REPLICATES;
        let weight = |at: usize| sample.weights.get(at).copied().unwrap_or(1.0);
        let means = |f: &dyn Fn(usize) -> f64| -> Vec<f64> {
            (0..REPLICATES).map(|r| (r * n..(r + 1) * n).map(f).sum::<f64>() / n as f64).collect()
        };
        let [of_full, of_control] = &sample.pieces;
        let values = all(&sample.full, of_full);
        let (mean, error) = of_replicates(&means(&|at| weight(at) * values[at]));
        let tabulated = self.tabulated();
        let alone = LawFigure::new(mean, error + tabulated * mean.abs());
        let exact = exact.filter(|_| sample.control.len() == values.len());
        let beside = exact.map(|exact| {
            let control = all(&sample.control, of_control);
            let (mean, error) = of_replicates(&means(&|at| weight(at) * (values[at] - control[at])));
            LawFigure::new(exact.value + mean, error + exact.error + tabulated * exact.value)
        });
        Estimates { alone, beside }
    }
}

/// Mean over a sample without the control variate, and with it if there is one.
#[derive(Debug, Clone, Copy)]
struct Estimates {
    alone: LawFigure,
    beside: Option<LawFigure>,
}

impl Estimates {
    fn is_beside(&self) -> bool {
        self.beside.is_some_and(|beside| beside.error < self.alone.error && beside.value > 0.0)
    }

    /// Estimate with the smaller error.
    fn best(&self) -> LawFigure {
        if self.is_beside() { self.beside.unwrap_or(self.alone) } else { self.alone }
    }
}

/// Direction, points and estimate of one tail.
#[derive(Debug)]
pub(super) struct Held {
    direction: Direction,
    tilts: Arc<Tilts>,
    proposal: Option<Arc<Proposal>>,
    beside: bool,
    nearer: LawTail,
    tail: LawTail,
    points: usize,
    seed: u64,
}

/// Adds `weight z_j dy/dz_j` of every member.
pub(super) fn add_moves(surface: &Surface, members: &[usize], z: &[f64], weight: f64, sums: &mut [f64]) {
    if weight == 0.0 {
        return;
    }
    for &j in members {
        let products: f64 = surface.neighbours[j].iter().map(|&(k, b)| b * z[k]).sum();
        sums[j] += weight * z[j] * (value(&derivative(&surface.parts[j]), z[j]) + products);
    }
}

/// Adds `weight f(w) z_j dy/dz_j/|dy/dw|` of every member at the points where the surface crosses a limit along a direction.
#[expect(clippy::too_many_arguments, reason = "what a crossing is made of")]
pub(super) fn pathwise(
    surface: &Surface,
    direction: &Direction,
    input: &Input,
    z: &[f64],
    mut polynomial: Quartic,
    off: f64,
    weight: f64,
    sums: &mut [f64],
) {
    polynomial[0] -= off;
    let slope = derivative(&polynomial);
    let mut at = z.to_vec();
    for &w in roots(&polynomial, input.ends).as_slice() {
        at.copy_from_slice(z);
        direction.slopes().iter().for_each(|&(j, d)| at[j] += d * w);
        let density = input.density(w) / value(&slope, w).abs();
        add_moves(surface, direction.members(), &at, weight * density, sums);
    }
}

/// Mean of replicates, and its error.
fn of_replicates(means: &[f64]) -> (f64, f64) {
    let n = means.len() as f64;
    let mean = means.iter().sum::<f64>() / n;
    let variance = means.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (n - 1.0);
    (mean, QUANTILE * (variance / n).sqrt())
}
