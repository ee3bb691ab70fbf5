//! Surface over the inputs with a part in it, its range, and its independent components.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

use faer::Mat;

use crate::correlation::{Block, Correlation};
use crate::distribution::Distribution;
use crate::elementary::{Work, on_this_processor};
use crate::law::LawError;
use crate::law::input::Input;
use crate::law::polynomial::{Quartic, range, value};
use crate::surrogate::Surrogate;

/// Surface `y = centre + sum g_j(z_j) + sum b_jk z_j z_k` over the inputs that have a part in it.
#[derive(Debug, Clone)]
pub(super) struct Surface {
    pub(super) centre: f64,
    pub(super) inputs: Vec<Arc<Input>>,
    pub(super) parts: Vec<Quartic>,
    /// Products with other inputs, as (other input, coefficient), ascending.
    pub(super) neighbours: Vec<Vec<(usize, f64)>>,
    /// Joint variation of the inputs.
    pub(super) correlated: Option<Correlated>,
    /// Index in this surface of each of the surrogate's inputs; None for an input without a part in the surface.
    pub(super) places: Vec<Option<usize>>,
}

/// Correlated inputs of a surface.
#[derive(Debug, Clone)]
pub(super) struct Correlated {
    /// Indices in the surface, ascending.
    pub(super) members: Vec<usize>,
    /// Correlation of the normal variables behind the members.
    pub(super) normal: Mat<f64>,
    /// Blocks of members with one joint distribution, by indices in the surface.
    pub(super) blocks: Vec<Block>,
}

impl Correlated {
    pub(super) fn place(&self, input: usize) -> Option<usize> {
        self.members.binary_search(&input).ok()
    }

    /// Correlation of the normal variables behind two inputs.
    pub(super) fn between(&self, a: usize, b: usize) -> f64 {
        match (self.place(a), self.place(b)) {
            _ if a == b => 1.0,
            (Some(a), Some(b)) => self.normal[(a, b)],
            _ => 0.0,
        }
    }

    /// True if two inputs vary together.
    pub(super) fn linked(&self, a: usize, b: usize) -> bool {
        self.between(a, b) != 0.0 || self.blocks.iter().any(|block| [a, b].iter().all(|j| block.members.contains(j)))
    }
}

impl Surface {
    pub(super) fn of(
        surrogate: &Surrogate,
        laws: &[Arc<dyn Distribution>],
        correlation: Option<&Correlation>,
    ) -> Result<Self, LawError> {
        let n = surrogate.parts.len();
        if laws.len() != n || surrogate.interactions.dimensions() != n {
            return Err(LawError::Shapes { parts: n, inputs: laws.len() });
        }
        let finite = |value: f64| if value.is_finite() { Ok(value) } else { Err(LawError::NotFinite) };
        let mut coefficients = Vec::with_capacity(n);
        for (position, part) in surrogate.parts.iter().enumerate() {
            let part = part.ok_or(LawError::UnknownPart { position })?;
            let mut quartic = [0.0; 5];
            for (to, from) in quartic[1..].iter_mut().zip(part.coefficients()) {
                *to = finite(from)?;
            }
            coefficients.push(quartic);
        }
        // Products are iterated twice instead of listed, because there may be half a million.
        let products = || surrogate.interactions.each_pair().filter(|&(_, _, value)| value != 0.0);
        let mut of_each = vec![0; n];
        for (j, k, value) in products() {
            finite(value)?;
            (of_each[j], of_each[k]) = (of_each[j] + 1, of_each[k] + 1);
        }
        let counts: Vec<bool> =
            (0..n).map(|j| of_each[j] > 0 || coefficients[j].iter().any(|&coefficient| coefficient != 0.0)).collect();
        let mut places = vec![None; n];
        let (mut inputs, mut parts) = (Vec::new(), Vec::new());
        let mut made: HashMap<*const (), Arc<Input>> = HashMap::new();
        for position in (0..n).filter(|&position| counts[position]) {
            places[position] = Some(inputs.len());
            parts.push(coefficients[position]);
            // Inputs with one and the same distribution object share its panels.
            let input = match made.entry(Arc::as_ptr(&laws[position]).cast()) {
                Entry::Occupied(known) => Arc::clone(known.get()),
                Entry::Vacant(new) => {
                    let input = Input::of(&laws[position]).ok_or(LawError::MomentsOnly { position })?;
                    Arc::clone(new.insert(Arc::new(input)))
                }
            };
            inputs.push(input);
        }
        let mut neighbours: Vec<Vec<(usize, f64)>> =
            (0..n).filter(|&position| counts[position]).map(|position| Vec::with_capacity(of_each[position])).collect();
        for (j, k, value) in products() {
            let (Some(j), Some(k)) = (places[j], places[k]) else { continue };
            neighbours[j].push((k, value));
            neighbours[k].push((j, value));
        }
        neighbours.iter_mut().for_each(|row| row.sort_unstable_by_key(|&(k, _)| k));
        let correlated = correlation.and_then(|correlation| Correlated::of(correlation, &places));
        Ok(Self { centre: finite(surrogate.centre)?, inputs, parts, neighbours, correlated, places })
    }

    /// Number of inputs with a part in the surface.
    pub(super) fn len(&self) -> usize {
        self.inputs.len()
    }

    /// Coefficient of a product.
    pub(super) fn product(&self, j: usize, k: usize) -> f64 {
        let row = &self.neighbours[j];
        row.binary_search_by_key(&k, |&(k, _)| k).map_or(0.0, |at| row[at].1)
    }

    /// Every product once, with `j < k`.
    pub(super) fn products(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let rows = self.neighbours.iter().enumerate();
        rows.flat_map(|(j, row)| row.iter().filter(move |(k, _)| *k > j).map(move |&(k, value)| (j, k, value)))
    }

    /// True if the part is a parabola of a normal input.
    pub(super) fn is_normal_parabola(&self, j: usize) -> bool {
        self.inputs[j].is_normal() && self.parts[j][3] == 0.0 && self.parts[j][4] == 0.0
    }

    /// True if the input is correlated with another one.
    pub(super) fn is_correlated(&self, j: usize) -> bool {
        self.correlated.as_ref().is_some_and(|correlated| correlated.place(j).is_some())
    }

    pub(super) fn value(&self, z: &[f64]) -> f64 {
        let own: f64 = self.parts.iter().zip(z).map(|(part, &z)| value(part, z)).sum();
        self.centre + own + self.products().map(|(j, k, b)| b * z[j] * z[k]).sum::<f64>()
    }

    /// Contribution of these inputs to the value, with the products among them. `members` must be ascending.
    pub(super) fn value_of(&self, members: &[usize], z: &[f64]) -> f64 {
        let own = |&j: &usize| {
            let within = |(k, _): &&(usize, f64)| *k > j && members.binary_search(k).is_ok();
            let products: f64 = self.neighbours[j].iter().filter(within).map(|&(k, b)| b * z[j] * z[k]).sum();
            value(&self.parts[j], z[j]) + products
        };
        members.iter().map(own).sum()
    }

    /// Sum of the magnitudes of the centre and of all parts and products, each at the largest atoms of its inputs.
    pub(super) fn magnitude(&self) -> f64 {
        let farthest: Vec<f64> =
            self.inputs.iter().map(|input| input.atoms.iter().map(|(z, _)| z.abs()).fold(0.0, f64::max)).collect();
        let part = |(part, z): (&Quartic, &f64)| part.iter().rev().fold(0.0, |sum, c| sum * z + c.abs());
        let parts: f64 = self.parts.iter().zip(&farthest).map(part).sum();
        let products: f64 = self.products().map(|(j, k, b)| (b * farthest[j] * farthest[k]).abs()).sum();
        self.centre.abs() + parts + products
    }

    /// Values of the surface at some points. `z` has one column for every input.
    pub(super) fn values(&self, z: &[&[f64]], points: usize) -> Vec<f64> {
        on_this_processor(Values { surface: self, z, points })
    }

    /// Sets of inputs that depend on each other by products or by correlation, each ascending.
    pub(super) fn components(&self) -> Vec<Vec<usize>> {
        let n = self.len();
        let mut of: Vec<Option<usize>> = vec![None; n];
        let mut components = Vec::new();
        for start in 0..n {
            if of[start].is_some() {
                continue;
            }
            let (mut component, mut open) = (Vec::new(), vec![start]);
            of[start] = Some(components.len());
            while let Some(j) = open.pop() {
                component.push(j);
                let products = self.neighbours[j].iter().map(|&(k, _)| k);
                let together = self.correlated.iter().flat_map(|correlated| {
                    let own = correlated.place(j).is_some();
                    correlated.members.iter().copied().filter(move |&k| own && correlated.linked(j, k))
                });
                for k in products.chain(together) {
                    if of[k].is_none() {
                        of[k] = Some(components.len());
                        open.push(k);
                    }
                }
            }
            component.sort_unstable();
            components.push(component);
        }
        components
    }

    /// Copy of the surface with only those products that `keep` selects.
    pub(super) fn with_products(&self, keep: impl Fn(usize, usize) -> bool) -> Self {
        let row = |(j, row): (usize, &Vec<(usize, f64)>)| row.iter().copied().filter(|&(k, _)| keep(j, k)).collect();
        let neighbours = self.neighbours.iter().enumerate().map(row).collect();
        let Self { centre, inputs, parts, correlated, places, .. } = self;
        let (inputs, parts, correlated, places) = (inputs.clone(), parts.clone(), correlated.clone(), places.clone());
        Self { centre: *centre, inputs, parts, neighbours, correlated, places }
    }

    /// Copy of the surface with the nearest parabola in place of every higher part of a normal input: `3 z` for `z^3`, `6 z^2 - 3` for
    /// `z^4`. Constants stay in the parts.
    pub(super) fn with_normal_parabolas(&self) -> Self {
        let parabola = |(part, input): (&Quartic, &Arc<Input>)| match (input.is_normal(), *part) {
            (true, [c0, c1, c2, c3, c4]) => [c0 - 3.0 * c4, c1 + 3.0 * c3, c2 + 6.0 * c4, 0.0, 0.0],
            (false, part) => part,
        };
        let parts = self.parts.iter().zip(&self.inputs).map(parabola).collect();
        Self { parts, ..self.clone() }
    }

    /// Variance of the difference to another surface over the same inputs. Inputs are treated as uncorrelated, and parts as those of normal
    /// inputs, by Hermite polynomials.
    pub(super) fn squared_distance(&self, other: &Self) -> f64 {
        let parts: f64 = (0..self.len())
            .map(|j| {
                let [_, c1, c2, c3, c4] = std::array::from_fn(|k| self.parts[j][k] - other.parts[j][k]);
                (c1 + 3.0 * c3).powi(2) + 2.0 * (c2 + 6.0 * c4).powi(2) + 6.0 * c3 * c3 + 24.0 * c4 * c4
            })
            .sum();
        parts + self.products().map(|(j, k, b)| (b - other.product(j, k)).powi(2)).sum::<f64>()
    }

    /// Copy of the surface with one input scaled by this factor.
    pub(super) fn scaled(&self, input: usize, by: f64) -> Self {
        let mut scaled = self.clone();
        scaled.parts[input].iter_mut().enumerate().for_each(|(k, c)| *c *= by.powi(k as i32));
        for &(other, _) in &self.neighbours[input] {
            for (j, k) in [(input, other), (other, input)] {
                scaled.neighbours[j].iter_mut().filter(|(at, _)| *at == k).for_each(|(_, b)| *b *= by);
            }
        }
        scaled
    }

    /// Range of the contribution of all other inputs. It is infinite if one of them has products.
    pub(super) fn range_without(&self, members: &[usize]) -> [f64; 2] {
        let others = (0..self.len()).filter(|j| members.binary_search(j).is_err());
        others.fold([0.0; 2], |[low, high], j| match self.neighbours[j].is_empty() {
            true => {
                let [least, most] = range(&self.parts[j], self.inputs[j].support);
                [low + least, high + most]
            }
            false => [f64::NEG_INFINITY, f64::INFINITY],
        })
    }

    /// Interval that contains every value of the surface: exact without products, possibly wider with them.
    pub(super) fn range(&self) -> [f64; 2] {
        let mut total = [self.centre; 2];
        for (part, input) in self.parts.iter().zip(&self.inputs) {
            let [low, high] = range(part, input.support);
            total = [total[0] + low, total[1] + high];
        }
        for (j, k, b) in self.products() {
            let (u, v) = (self.inputs[j].support, self.inputs[k].support);
            let corners = [u[0] * v[0], u[0] * v[1], u[1] * v[0], u[1] * v[1]].map(|product| b * product);
            total[0] += corners.iter().copied().fold(f64::INFINITY, f64::min);
            total[1] += corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        }
        // Infinities of both signs sum to NaN: there is no bound.
        let low = if total[0].is_nan() { f64::NEG_INFINITY } else { total[0] };
        let high = if total[1].is_nan() { f64::INFINITY } else { total[1] };
        // The rounding errors of the sums are added on either side, so that the bounds are a proof.
        let slack = |end: f64| 4.0 * f64::EPSILON * (self.len() + 1) as f64 * end.abs().max(self.centre.abs());
        [low - slack(low), high + slack(high)]
    }
}

/// Points that are computed together.
const LANES: usize = 256;

struct Values<'a> {
    surface: &'a Surface,
    z: &'a [&'a [f64]],
    points: usize,
}

impl Work for Values<'_> {
    type Output = Vec<f64>;

    /// Values with every sum in the order of [`Surface::value`].
    #[inline(always)]
    fn work(self) -> Vec<f64> {
        let Self { surface, z, points } = self;
        let mut values = Vec::with_capacity(points);
        for first in (0..points).step_by(LANES) {
            let rows = first..points.min(first + LANES);
            let (mut own, mut products) = ([0.0; LANES], [0.0; LANES]);
            for (part, z) in surface.parts.iter().zip(z) {
                own.iter_mut().zip(&z[rows.clone()]).for_each(|(own, &z)| *own += value(part, z));
            }
            for (j, k, b) in surface.products() {
                let both = z[j][rows.clone()].iter().zip(&z[k][rows.clone()]);
                products.iter_mut().zip(both).for_each(|(sum, (zj, zk))| *sum += b * zj * zk);
            }
            let sums = own.iter().zip(&products).take(rows.len());
            values.extend(sums.map(|(own, products)| surface.centre + own + products));
        }
        values
    }
}

impl Correlated {
    fn of(correlation: &Correlation, places: &[Option<usize>]) -> Option<Self> {
        let kept: Vec<(usize, usize)> = (correlation.members().iter().enumerate())
            .filter_map(|(member, &position)| Some((places.get(position).copied().flatten()?, member)))
            .collect();
        let normal = correlation.normal();
        let members = correlation.members();
        let linked = |&&(_, a): &&(usize, usize)| {
            kept.iter().any(|&(_, b)| a != b && correlation.linked(members[a], members[b]))
        };
        let kept: Vec<(usize, usize)> = kept.iter().filter(linked).copied().collect();
        if kept.is_empty() {
            return None;
        }
        let normal = Mat::from_fn(kept.len(), kept.len(), |a, b| normal[(kept[a].1, kept[b].1)]);
        let place = |member: usize| places.get(member).copied().flatten();
        let blocks = correlation.blocks().iter().filter_map(|block| block.among(&place)).collect();
        Some(Self { members: kept.iter().map(|&(place, _)| place).collect(), normal, blocks })
    }
}
