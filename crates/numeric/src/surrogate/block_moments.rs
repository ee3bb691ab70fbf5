//! Moments of a surface with blocks of dependent inputs, by the law of total moments.
//!
//! Given a place for every block, the surface is one of independent inputs with shifted slopes `b + A u`, whose cumulants are exact
//! ([`crate::moments`]). They are pooled over the places. `d` is the conditional mean minus the mean of all, and `v`, `k3`, `k4` are the
//! conditional cumulants:
//!
//! ```text
//! mean = E m     mu2 = E[v + d^2]     mu3 = E[k3 + 3 v d + d^3]     mu4 = E[k4 + 3 v^2 + 4 k3 d + 6 v d^2 + d^4]
//! ```
//!
//! Only interacting parts are pooled together: parts that share no product are independent, and their cumulants are added. The surface is
//! sampled if interacting blocks have too many combinations of places, or if dimensions are correlated beside the blocks.

use std::collections::BTreeMap;

use crate::correlation::{Atom, Correlation};
use crate::moments::{Contributions, Interactions, Moments, Term, contributions};
use crate::parallel::prelude::*;
use crate::surrogate::block_surface::Setting;
use crate::surrogate::{Inputs, Surrogate, Univariate, sampled_blocks as drawn};

/// Greatest number of combinations of places that are pooled.
const MOST: usize = 200_000;
/// Greatest number of multiplications of the pooling.
const WORK: usize = 4_000_000_000;

/// Blocks, and the other inputs that they interact with.
type Interacting = (Vec<usize>, Vec<usize>);

/// Cumulants in units of the surface's largest coefficient.
#[derive(Debug, Clone, Copy, Default)]
struct Cumulants {
    mean: f64,
    variance: f64,
    third: f64,
    fourth: f64,
}

impl Cumulants {
    fn of(moments: &Moments) -> Self {
        let sigma = moments.sigma();
        Self {
            mean: moments.mean(),
            variance: sigma * sigma,
            third: moments.skewness().unwrap_or(0.0) * sigma.powi(3),
            fourth: moments.excess().unwrap_or(0.0) * sigma.powi(4),
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            mean: self.mean + other.mean,
            variance: self.variance + other.variance,
            third: self.third + other.third,
            fourth: self.fourth + other.fourth,
        }
    }
}

/// Surface at all places of its blocks, stored so that it can be pooled with other weights too.
pub struct BlockMoments {
    /// Cumulants of the part that is independent of all blocks.
    rest: Cumulants,
    components: Vec<Component>,
    scale: f64,
    centre: f64,
}

/// Interacting blocks, with the free inputs that they interact with.
struct Component {
    blocks: Vec<usize>,
    /// Number of places of each block.
    counts: Vec<usize>,
    /// Weight and cumulants of each combination of places, that of the first block fastest.
    rows: Vec<(f64, Cumulants)>,
}

impl Surrogate {
    /// Surface at the places of its blocks. Returns None if there are no blocks, a part is unknown, or the surface must be sampled.
    pub fn pooled(&self, inputs: &Inputs) -> Option<BlockMoments> {
        let correlation = inputs.correlation().filter(|correlation| !correlation.blocks().is_empty())?;
        Setting::of(self, inputs, correlation)?.pooled()
    }
}

/// Moments and contributions of a surface with blocks. Returns None if a part is unknown.
pub(super) fn pooled(surrogate: &Surrogate, inputs: &Inputs, correlation: &Correlation) -> Option<Contributions> {
    let setting = Setting::of(surrogate, inputs, correlation)?;
    if setting.scale == 0.0 {
        let none = vec![0.0; setting.parts.len()];
        return Some(Contributions {
            moments: Moments::constant(setting.centre),
            linear: none.clone(),
            curvature: none.clone(),
            mean_shift: none,
            per_sigma: 0.0,
            products: Some(BTreeMap::new()),
            sampled: None,
        });
    }
    Some(match setting.pooled() {
        Some(pooled) => setting.contributions(&pooled),
        None => drawn::contributions(&setting),
    })
}

impl<'a> Setting<'a> {
    /// Pools the surface over the places of its blocks. Returns None if it must be sampled.
    fn pooled(&self) -> Option<BlockMoments> {
        let (rest, components) = self.components();
        let correlated = |j: &usize| self.block_of[*j].is_none() && self.correlation.members().contains(j);
        if components.iter().any(|(_, free)| free.iter().any(correlated)) {
            return None;
        }
        let of_rest = match rest.is_empty() {
            true => Cumulants::default(),
            false => {
                let found = self.rest(&rest);
                found.sampled.is_none().then(|| Cumulants::of(&found.moments))?
            }
        };
        let components = components.into_iter().map(|(blocks, free)| self.component(blocks, free));
        let components = components.collect::<Option<_>>()?;
        Some(BlockMoments { rest: of_rest, components, scale: self.scale, centre: self.centre })
    }

    /// Inputs that are independent of all blocks, and the groups of interacting blocks with their free inputs.
    fn components(&self) -> (Vec<usize>, Vec<Interacting>) {
        let n = self.parts.len();
        // Nodes of the graph: inputs, then blocks, then one node for all correlated inputs.
        let node = |j: usize| match self.block_of[j] {
            Some((block, _)) => n + block,
            None if self.correlation.members().contains(&j) => n + self.atoms.len(),
            None => j,
        };
        let mut root: Vec<usize> = (0..=n + self.atoms.len()).collect();
        fn find(root: &mut [usize], mut at: usize) -> usize {
            while root[at] != at {
                root[at] = root[root[at]];
                at = root[at];
            }
            at
        }
        for &(j, k, value) in &self.pairs {
            if value != 0.0 {
                let (a, b) = (find(&mut root, node(j)), find(&mut root, node(k)));
                root[a] = b;
            }
        }
        let mut of_root: BTreeMap<usize, Interacting> = BTreeMap::new();
        for block in 0..self.atoms.len() {
            of_root.entry(find(&mut root, n + block)).or_default().0.push(block);
        }
        let mut rest = Vec::new();
        for j in (0..n).filter(|&j| self.block_of[j].is_none()) {
            match of_root.get_mut(&find(&mut root, node(j))) {
                Some((_, free)) => free.push(j),
                None => rest.push(j),
            }
        }
        (rest, of_root.into_values().collect())
    }

    /// Products among these inputs, by their places in the list.
    fn among(&self, of: &[usize]) -> Interactions {
        let place = |j: usize| of.binary_search(&j).ok();
        let pairs = self.pairs.iter().filter_map(|&(j, k, value)| Some((place(j)?, place(k)?, value)));
        Interactions::of_pairs(of.len(), pairs)
    }

    /// Moments and contributions of the part that is independent of all blocks.
    fn rest(&self, rest: &[usize]) -> Contributions {
        let surrogate = Surrogate {
            centre: 0.0,
            parts: rest.iter().map(|&j| Some(self.parts[j])).collect(),
            interactions: self.among(rest),
        };
        let shapes = rest.iter().map(|&j| self.shapes[j].clone()).collect();
        let correlation = self.correlation.without_blocks().and_then(|others| others.among(rest));
        surrogate.contributions(&Inputs::new(shapes, correlation)).expect("every part is known")
    }

    fn component(&self, blocks: Vec<usize>, free: Vec<usize>) -> Option<Component> {
        let counts: Vec<usize> = blocks.iter().map(|&block| self.atoms[block].len()).collect();
        let total = counts.iter().try_fold(1usize, |all, &count| all.checked_mul(count))?;
        let interactions = self.among(&free);
        let terms = self.pairs.len() + self.parts.len() + interactions.work();
        if total > MOST || total.saturating_mul(terms) > WORK {
            return None;
        }
        // Collect the products with these blocks: within blocks, and between a coordinate and a free input.
        let own = |j: usize| self.block_of[j].is_some_and(|(block, _)| blocks.contains(&block));
        let place = |j: usize| free.binary_search(&j).ok();
        let mut inner = Vec::new();
        let mut across = Vec::new();
        for &(j, k, value) in &self.pairs {
            match (own(j), own(k)) {
                (true, true) => inner.push((j, k, value)),
                (true, false) => across.extend(place(k).map(|k| (j, k, value))),
                (false, true) => across.extend(place(j).map(|j| (k, j, value))),
                (false, false) => {}
            }
        }
        let members: Vec<usize> = (0..self.parts.len()).filter(|&j| own(j)).collect();
        let row = |index: usize| {
            let (weight, u) = self.place(&blocks, &counts, index);
            let at = |j: usize| u(j);
            let own: f64 = members.iter().map(|&j| self.parts[j].value(at(j))).sum();
            let centre = own + inner.iter().map(|&(j, k, value)| value * at(j) * at(k)).sum::<f64>();
            if free.is_empty() {
                return (weight, Cumulants { mean: centre, ..Cumulants::default() });
            }
            let mut slopes = vec![0.0; free.len()];
            across.iter().for_each(|&(j, k, value)| slopes[k] += value * at(j));
            let parts: Vec<Univariate> =
                free.iter().zip(&slopes).map(|(&j, slope)| self.parts[j].with_slope(*slope)).collect();
            let terms: Vec<Term<'_>> = parts.iter().zip(&free).map(|(part, &j)| part.term(&self.shapes[j])).collect();
            (weight, Cumulants::of(&contributions(centre, &terms, &interactions).moments))
        };
        let rows = (0..total).into_par_iter().map(row).collect();
        Some(Component { blocks, counts, rows })
    }

    /// Weight of a combination of places, and a function that returns the coordinate of every member of the blocks.
    fn place<'s>(
        &'s self,
        blocks: &'s [usize],
        counts: &[usize],
        index: usize,
    ) -> (f64, impl Fn(usize) -> f64 + use<'s, 'a>) {
        let places = combination(counts, index);
        let atoms: Vec<&Atom> = blocks.iter().zip(&places).map(|(&block, &at)| &self.atoms[block][at]).collect();
        let weight = atoms.iter().map(|atom| atom.weight).product();
        let u = move |j: usize| {
            let (block, coordinate) = self.block_of[j].expect("a member of a block");
            let at = blocks.iter().position(|&own| own == block).expect("a block of the component");
            atoms[at].u[coordinate]
        };
        (weight, u)
    }

    /// Contributions with the covariance of every part with the whole as its share. The shares sum to 1.
    fn contributions(&self, pooled: &BlockMoments) -> Contributions {
        let n = self.parts.len();
        let all = pooled.cumulants(&|_, _| None);
        let variance = all.variance;
        let (mut linear, mut curvature, mut mean_shift) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let mut products = BTreeMap::new();
        let share = |covariance: f64| if variance > 0.0 { covariance / variance } else { 0.0 };
        // Inputs outside the blocks: the covariance of an independent part with the whole is its variance. Correlated inputs follow below.
        for j in (0..n).filter(|&j| self.block_of[j].is_none()) {
            let term = self.parts[j].term(&self.shapes[j]);
            let part = term.part(1.0);
            (linear[j], curvature[j]) = (share(part.p * part.p), share(part.curved));
            mean_shift[j] = term.mean();
        }
        // Correlated inputs outside the blocks: take the shares of their own surface, relative to the whole.
        let (rest, _) = self.components();
        if self.correlation.without_blocks().is_some() && !rest.is_empty() {
            let found = self.rest(&rest);
            let of_rest = |value: f64| share(value * pooled.rest.variance);
            for (place, &j) in rest.iter().enumerate() {
                (linear[j], curvature[j]) = (of_rest(found.linear[place]), of_rest(found.curvature[place]));
            }
            for (place, &j) in rest.iter().enumerate() {
                for (other, &k) in rest.iter().enumerate().skip(place + 1) {
                    if let Some(value) = found.products.as_ref().and_then(|of| of.get(&(place, other))) {
                        products.insert((j, k), of_rest(*value));
                    }
                }
            }
        }
        // Members of blocks: covariance of line, rest and products with the conditional mean, over all combinations of places.
        for component in &pooled.components {
            let own = |j: usize| self.block_of[j].is_some_and(|(block, _)| component.blocks.contains(&block));
            let members: Vec<usize> = (0..n).filter(|&j| own(j)).collect();
            let mean = component.pooled(&|_, _| None).mean;
            let slope: Vec<f64> = members.iter().map(|&j| self.line(j)).collect();
            let inner: Vec<(usize, usize, f64)> =
                self.pairs.iter().copied().filter(|&(j, k, _)| own(j) && own(k)).collect();
            let mut sums = vec![[0.0; 3]; members.len()];
            let mut of_pairs = vec![0.0; inner.len()];
            for (index, (_, row)) in component.rows.iter().enumerate() {
                let (weight, u) = self.place(&component.blocks, &component.counts, index);
                let off = weight * (row.mean - mean);
                for ((sum, &j), slope) in sums.iter_mut().zip(&members).zip(&slope) {
                    let (at, value) = (u(j), self.parts[j].value(u(j)));
                    sum[0] += off * slope * at;
                    sum[1] += off * (value - slope * at);
                    sum[2] += weight * value;
                }
                of_pairs.iter_mut().zip(&inner).for_each(|(sum, &(j, k, value))| *sum += off * value * u(j) * u(k));
            }
            for (&j, sum) in members.iter().zip(&sums) {
                (linear[j], curvature[j], mean_shift[j]) = (share(sum[0]), share(sum[1]), sum[2]);
            }
            products.extend(inner.iter().zip(&of_pairs).map(|(&(j, k, _), &sum)| ((j, k), share(sum))));
        }
        // Products of two inputs of which at most one is in a block.
        for &(j, k, value) in &self.pairs {
            let covariance = match (self.block_of[j], self.block_of[k]) {
                (Some(_), Some(_)) => continue,
                (None, None) => value * value,
                (Some(_), None) => value * self.beside(j, k),
                (None, Some(_)) => value * self.beside(k, j),
            };
            products.entry((j, k)).or_insert(share(covariance));
        }
        Contributions {
            moments: pooled.scaled(all),
            linear,
            curvature,
            mean_shift: mean_shift.into_iter().map(|shift| shift * self.scale).collect(),
            per_sigma: if variance > 0.0 { 1.0 / (variance.sqrt() * self.scale) } else { 0.0 },
            products: Some(products),
            sampled: None,
        }
    }

    /// Covariance factor `sum_l A_lk R_jl` over the members of the block of `j`.
    fn beside(&self, j: usize, k: usize) -> f64 {
        let other = |&(a, b, value): &(usize, usize, f64)| match (a == k, b == k) {
            (true, _) => Some((b, value)),
            (_, true) => Some((a, value)),
            _ => None,
        };
        self.pairs.iter().filter_map(other).map(|(l, value)| value * self.correlation.of(j, l)).sum()
    }
}

/// Place of every block in a combination.
fn combination(counts: &[usize], mut index: usize) -> Vec<usize> {
    let place = |&count: &usize| {
        let place = index % count;
        index /= count;
        place
    };
    counts.iter().map(place).collect()
}

impl Component {
    /// Pools the combinations. `weights` returns other weights for the places of a block, by block and place, or None to keep its own.
    fn pooled(&self, weights: &dyn Fn(usize, usize) -> Option<f64>) -> Cumulants {
        let rows: Vec<(f64, &Cumulants)> = (self.rows.iter().enumerate())
            .map(|(index, (own, row))| {
                let places = combination(&self.counts, index);
                let mut weight = *own;
                for ((&block, &place), &count) in self.blocks.iter().zip(&places).zip(&self.counts) {
                    if let Some(given) = weights(block, place) {
                        // All places of a block of rows have the same weight, so the product with their count is the ratio of the weights.
                        weight *= given * count as f64;
                    }
                }
                (weight, row)
            })
            .collect();
        let over =
            |f: &dyn Fn(&Cumulants) -> f64| crate::moments::exact(rows.iter().map(|(weight, row)| weight * f(row)));
        let mean = over(&|row| row.mean);
        let d = |row: &Cumulants| row.mean - mean;
        let variance = over(&|row| row.variance + d(row).powi(2));
        let third = over(&|row| row.third + 3.0 * row.variance * d(row) + d(row).powi(3));
        let fourth = over(&|row| {
            let (v, d) = (row.variance, d(row));
            row.fourth + 3.0 * v * v + 4.0 * row.third * d + 6.0 * v * d * d + d.powi(4)
        });
        Cumulants { mean, variance, third, fourth: fourth - 3.0 * variance * variance }
    }
}

impl BlockMoments {
    /// Moments with other weights for the places of some blocks. The weights sum to 1 over each block.
    pub fn moments(&self, weights: &dyn Fn(usize, usize) -> Option<f64>) -> Moments {
        self.scaled(self.cumulants(weights))
    }

    /// Rough number of multiplications for moments with other weights.
    pub fn work(&self) -> usize {
        self.components.iter().map(|component| 30 * component.rows.len()).sum()
    }

    fn cumulants(&self, weights: &dyn Fn(usize, usize) -> Option<f64>) -> Cumulants {
        self.components.iter().fold(self.rest, |sum, component| sum.plus(component.pooled(weights)))
    }

    fn scaled(&self, all: Cumulants) -> Moments {
        let mean = self.centre + self.scale * all.mean;
        match all.variance > 0.0 {
            true => {
                let sigma = all.variance.sqrt();
                Moments::new(mean, self.scale * sigma, all.third / sigma.powi(3), all.fourth / all.variance.powi(2))
            }
            false => Moments::constant(mean),
        }
    }
}
