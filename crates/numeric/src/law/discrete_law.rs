//! Surface of inputs that are atoms only: a step function, as the list of its values.
//!
//! A few combinations are listed all together. If there are many, each component is listed by itself, and the sums are formed one component
//! after the other. Values on a grid then stay few.

use std::collections::BTreeMap;

use crate::correlation::{Atom, Block, JointLaw};
use crate::law::input::Input;
use crate::law::surface::Surface;
use crate::law::{LawFigure, LawTail};

/// Greatest number of combinations that are listed.
const MOST: usize = 1 << 20;

/// Atom of one or several inputs: its probability, and the value of each input by index.
type Place = (f64, Vec<(usize, f64)>);

/// Value with its probability.
pub(super) type Weighed = (f64, f64);

/// Values in ascending order with the probabilities on either side.
#[derive(Debug)]
pub(super) struct Steps {
    values: Vec<f64>,
    weights: Vec<f64>,
    /// Probability of a value of at most each of the values, summed from the lower end. `down` holds that of at least each, from the upper
    /// end.
    up: Vec<f64>,
    down: Vec<f64>,
}

/// Groups of inputs that take their values together, with their atoms. An input outside all blocks is a group of its own.
#[derive(Debug)]
pub(super) struct Groups(Vec<Vec<Place>>);

impl Groups {
    /// Groups of these inputs. Returns None if an input has no atoms, or if inputs are correlated other than by rows.
    pub(super) fn of<'i>(
        inputs: impl ExactSizeIterator<Item = &'i Input>,
        correlated: &[usize],
        blocks: &[Block],
    ) -> Option<Self> {
        let mut groups: Vec<Vec<Place>> = Vec::new();
        let mut grouped = vec![false; inputs.len()];
        // Inputs of one block take their values together.
        for block in blocks {
            if !matches!(block.law, JointLaw::Rows(_)) {
                return None;
            }
            let row = |atom: Atom| (atom.weight, block.members.iter().copied().zip(atom.u).collect());
            groups.push(block.law.atoms(1).into_iter().map(row).collect());
            block.members.iter().for_each(|&member| grouped[member] = true);
        }
        if correlated.iter().any(|&member| !grouped[member]) {
            return None;
        }
        for (j, input) in inputs.enumerate().filter(|&(j, _)| !grouped[j]) {
            if input.atoms.is_empty() {
                return None;
            }
            groups.push(input.atoms.iter().map(|&(at, share)| (share, vec![(j, at)])).collect());
        }
        Some(Self(groups))
    }

    fn of_surface(surface: &Surface) -> Option<Self> {
        let (members, blocks) =
            surface.correlated.as_ref().map_or((&[][..], &[][..]), |of| (&of.members[..], &of.blocks[..]));
        Self::of(surface.inputs.iter().map(|input| input.as_ref()), members, blocks)
    }

    /// Number of combinations. Returns None if there are more than `most`.
    pub(super) fn count(&self, most: usize) -> Option<usize> {
        let all = self.0.iter().map(Vec::len);
        all.into_iter().try_fold(1usize, |count, own| count.checked_mul(own).filter(|&count| count <= most))
    }

    /// Largest probability of one combination.
    fn likeliest(&self) -> f64 {
        self.0.iter().map(|group| group.iter().map(|(share, _)| *share).fold(0.0, f64::max)).product()
    }

    /// Visits every combination with its probability. `z` holds the values of the inputs.
    pub(super) fn each(&self, z: &mut [f64], mut visit: impl FnMut(&[f64], f64)) {
        let count: usize = self.0.iter().map(Vec::len).product();
        let mut places = vec![0; self.0.len()];
        for _ in 0..count {
            let mut weight = 1.0;
            for (group, &place) in self.0.iter().zip(&places) {
                let (share, at) = &group[place];
                at.iter().for_each(|&(j, at)| z[j] = at);
                weight *= share;
            }
            visit(z, weight);
            for (place, group) in places.iter_mut().zip(&self.0) {
                *place += 1;
                if *place < group.len() {
                    break;
                }
                *place = 0;
            }
        }
    }

    /// Groups of every component of a surface, with its members.
    fn by_component(self, surface: &Surface) -> Vec<(Vec<usize>, Self)> {
        let components = surface.components();
        let mut own: BTreeMap<usize, Vec<Vec<Place>>> = BTreeMap::new();
        for group in self.0 {
            let member = group[0].1[0].0;
            let component = components.iter().position(|members| members.binary_search(&member).is_ok());
            own.entry(component.expect("every input is in a component")).or_default().push(group);
        }
        components.into_iter().zip(own.into_values()).map(|(members, groups)| (members, Self(groups))).collect()
    }
}

/// Atoms of a surface, with values merged that only rounding separates. Returns None if an input has no atoms, or if there are too many
/// combinations.
pub(super) fn atoms(surface: &Surface, rounding: f64) -> Option<Vec<Weighed>> {
    let groups = Groups::of_surface(surface)?;
    let mut z = vec![0.0; surface.len()];
    if let Some(count) = groups.count(MOST) {
        let mut found = Vec::with_capacity(count);
        groups.each(&mut z, |z, weight| found.push((surface.value(z), weight)));
        return Some(merged(found, rounding));
    }
    let mut sums = vec![(surface.centre, 1.0)];
    for (members, groups) in groups.by_component(surface) {
        groups.count(MOST)?;
        let mut own = Vec::new();
        groups.each(&mut z, |z, weight| own.push((surface.value_of(&members, z), weight)));
        let own = merged(own, rounding);
        if sums.len().checked_mul(own.len())? > MOST {
            return None;
        }
        let each = |&(y, weight): &Weighed| own.iter().map(move |&(more, share)| (y + more, weight * share));
        sums = merged(sums.iter().flat_map(each).collect(), rounding);
    }
    Some(sums)
}

/// Largest probability of a single value of a surface, if no two combinations of its inputs give the same value. Returns 0 for a surface
/// with a density.
pub(super) fn largest_jump(surface: &Surface) -> f64 {
    Groups::of_surface(surface).map_or(0.0, |groups| groups.likeliest())
}

/// Least effect of all inputs with a density, at three sigmas, with which the transform resolves the edges of clusters; in sigmas of the
/// surface. At 7e-6 it resolved them to 1e-11, at 1.2e-6 not at all.
const NARROW: f64 = 3e-6;
/// Distance from a cluster, in sigmas, beyond which a tail is that between the clusters. It was at most 8e-6.
const BLUR: f64 = 2e-5;

/// Distance from a cluster of values within which a tail is not resolved. Returns None if no input has values of their own probability, or
/// if the inputs with a density make the clusters wide enough.
pub(super) fn blur(surface: &Surface, sigma: f64) -> Option<f64> {
    let (discrete, smooth): (Vec<usize>, Vec<usize>) =
        (0..surface.len()).partition(|&j| surface.inputs[j].is_discrete());
    if discrete.is_empty() || smooth.is_empty() {
        return None;
    }
    let spread: f64 = smooth.iter().map(|&j| most_effect(surface, j)).sum();
    (spread < NARROW * sigma).then_some(BLUR * sigma)
}

/// Effect of an input at its ends, or at three sigmas if these lie farther out.
fn most_effect(surface: &Surface, input: usize) -> f64 {
    let reach = |j: usize| surface.inputs[j].ends.iter().fold(1.0, |most: f64, end| most.max(end.abs())).min(3.0);
    let powers: f64 = (1..).zip(&surface.parts[input][1..]).map(|(power, c)| c.abs() * reach(input).powi(power)).sum();
    let products: f64 = surface.neighbours[input].iter().map(|&(k, c)| c.abs() * reach(k)).sum();
    powers + reach(input) * products
}

/// Sorts the values and merges those that are nearer to each other than the rounding error.
fn merged(mut found: Vec<Weighed>, rounding: f64) -> Vec<Weighed> {
    found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    found.dedup_by(|next, kept| {
        let same = next.0 - kept.0 <= rounding;
        kept.1 += if same { next.1 } else { 0.0 };
        same
    });
    found
}

impl Steps {
    /// Step function of at least one value, ascending, with probabilities that sum to 1.
    pub(super) fn new(values: Vec<Weighed>) -> Self {
        let (values, weights): (Vec<f64>, Vec<f64>) = values.into_iter().unzip();
        let summed = |weights: &mut dyn Iterator<Item = &f64>| -> Vec<f64> {
            weights
                .scan(0.0, |sum, weight| {
                    *sum += weight;
                    Some(*sum)
                })
                .collect()
        };
        let up = summed(&mut weights.iter());
        let mut down = summed(&mut weights.iter().rev());
        down.reverse();
        Self { values, weights, up, down }
    }

    /// Probability strictly beyond `y`.
    pub(super) fn tail(&self, y: f64, tail: LawTail) -> LawFigure {
        let value = match tail {
            LawTail::Lower => match self.values.partition_point(|value| *value < y) {
                0 => 0.0,
                count => self.up[count - 1],
            },
            LawTail::Upper => {
                let first = self.values.partition_point(|value| *value <= y);
                self.down.get(first).copied().unwrap_or(0.0)
            }
        };
        LawFigure::new(value.min(1.0), 4.0 * f64::EPSILON * value)
    }

    /// Least value with at least this probability at or below it (lower tail), or with at most `p` above it (upper tail).
    pub(super) fn quantile(&self, tail: LawTail, p: f64) -> f64 {
        /// Relative rounding error of sums of probabilities.
        const ROUNDING: f64 = 1e-14;
        let last = self.values.len() - 1;
        let place = match tail {
            LawTail::Lower => self.up.partition_point(|&up| up < p * (1.0 - ROUNDING)),
            LawTail::Upper => {
                let above = |place: usize| self.down.get(place + 1).copied().unwrap_or(0.0);
                (0..=last).find(|&place| above(place) <= p * (1.0 + ROUNDING)).unwrap_or(last)
            }
        };
        self.values[place.min(last)]
    }

    pub(super) fn range(&self) -> [f64; 2] {
        [self.values[0], self.values[self.values.len() - 1]]
    }

    /// Mean and sigma.
    pub(super) fn moments(&self) -> [f64; 2] {
        let over = |f: &dyn Fn(f64) -> f64| self.values.iter().zip(&self.weights).map(|(&y, w)| w * f(y)).sum::<f64>();
        let origin = self.values[0];
        let mean = origin + over(&|y| y - origin);
        [mean, over(&|y| (y - mean) * (y - mean)).sqrt()]
    }
}
