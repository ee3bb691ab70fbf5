//! Values of the surrogate over columns of points.

use std::collections::BTreeMap;

use crate::elementary::{Work, on_this_processor};
use crate::moments::{Interactions, Row};
use crate::parallel::prelude::*;
use crate::surrogate::{Surrogate, Univariate};

/// Rows of a tile: their sums stay in registers while all products are added.
const TILE: usize = 32;
/// Rows of a block: their sums stay in the nearest cache while all parts are added.
const BLOCK: usize = 1024;
/// Smallest number of inputs for which the products of a tile are worth a task.
const MANY: usize = 64;

impl Surrogate {
    /// Values of the surrogate minus its centre, at every point. Returns None if a part is unknown.
    ///
    /// Shapes: `inputs` has a column of standardised values for every part, all of the same length. Cost: one product for every interaction
    /// and point, and no evaluation.
    ///
    /// ```
    /// use sensitol_numeric::moments::Interactions;
    /// use sensitol_numeric::surrogate::{Surrogate, Univariate};
    /// // 7 + 2 u0 + u1^2 + 3 u0 u1
    /// let parts = vec![Some(Univariate::of_coefficients(&[2.0])), Some(Univariate::of_coefficients(&[0.0, 1.0]))];
    /// let surrogate = Surrogate { centre: 7.0, parts, interactions: Interactions::of_pairs(2, [(0, 1, 3.0)]) };
    /// assert_eq!(surrogate.rises(&[vec![1.0, -1.0], vec![2.0, 0.0]]), Some(vec![12.0, -2.0]));
    /// ```
    pub fn rises<C: AsRef<[f64]>>(&self, inputs: &[C]) -> Option<Vec<f64>> {
        let inputs: Vec<&[f64]> = inputs.iter().map(AsRef::as_ref).collect();
        let parts: Vec<Univariate> = self.parts.iter().copied().collect::<Option<_>>()?;
        let mut rises = vec![0.0; inputs.first().map_or(0, |column| column.len())];
        for (block, rises) in rises.chunks_mut(BLOCK).enumerate() {
            on_this_processor(Parts { parts: &parts, inputs: &inputs, first: block * BLOCK, rises });
        }
        if self.interactions.each_pair().next().is_none() {
            return Some(rises);
        }
        let products = |(tile, rises): (usize, &mut [f64])| {
            let inputs: Vec<&[f64]> = inputs.iter().map(|column| &column[tile * TILE..][..rises.len()]).collect();
            on_this_processor(Products { interactions: &self.interactions, inputs: &inputs, rises });
        };
        // The products of a row are added in the same order by any number of threads.
        if rises.len() > TILE && self.parts.len() >= MANY {
            rises.par_chunks_mut(TILE).enumerate().for_each(products);
        } else {
            rises.chunks_mut(TILE).enumerate().for_each(products);
        }
        Some(rises)
    }

    /// Removes curvatures and products within the rounding errors of the differences that they come from. The bound is eight units in the
    /// last place of the value at the means, over a step of one sigma, or 1e-13 of the surface's own sigma. Such terms would turn a tree of
    /// products into a graph with cycles and a line into a curve, and cost the distribution its closed form.
    pub fn without_rounding(&self) -> Self {
        let sigma = self.parts.iter().flatten().map(|part| part.largest().powi(2)).sum::<f64>().sqrt();
        let least = (8.0 * f64::EPSILON * self.centre.abs()).max(1e-13 * sigma);
        let counts = |&(_, _, value): &(usize, usize, f64)| value.abs() > least;
        let interactions = match self.interactions.each_pair().all(|pair| counts(&pair)) {
            true => self.interactions.clone(),
            false => Interactions::of_pairs(self.parts.len(), self.interactions.each_pair().filter(counts)),
        };
        let parts = self.parts.iter().map(|part| part.map(|part| part.without_bends(least))).collect();
        Self { centre: self.centre, parts, interactions }
    }

    /// Linear combination of `a` times this surface and `b` times another over the same inputs. Returns None if a part of either is
    /// unknown.
    pub fn sum(&self, a: f64, other: &Self, b: f64) -> Option<Self> {
        let part = |(one, other): (&Option<Univariate>, &Option<Univariate>)| -> Option<Option<Univariate>> {
            Some(Some(one.as_ref()?.sum(a, other.as_ref()?, b)))
        };
        let mut pairs: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        for (surface, by) in [(self, a), (other, b)] {
            for (j, k, value) in surface.interactions.pairs() {
                *pairs.entry((j, k)).or_default() += by * value;
            }
        }
        let pairs = pairs.into_iter().map(|((j, k), value)| (j, k, value));
        Some(Self {
            centre: a * self.centre + b * other.centre,
            parts: self.parts.iter().zip(&other.parts).map(part).collect::<Option<_>>()?,
            interactions: Interactions::of_pairs(self.parts.len(), pairs),
        })
    }
}

/// Work that adds every part to the rows from `first` on.
struct Parts<'a> {
    parts: &'a [Univariate],
    inputs: &'a [&'a [f64]],
    first: usize,
    rises: &'a mut [f64],
}

impl Work for Parts<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        for (part, column) in self.parts.iter().zip(self.inputs) {
            let column = &column[self.first..];
            self.rises.iter_mut().zip(column).for_each(|(rise, &u)| *rise += part.value(u));
        }
    }
}

/// Work that adds every product to some rows, in the order of the pairs.
struct Products<'a> {
    interactions: &'a Interactions,
    /// Column of each input, with as many values as there are rows.
    inputs: &'a [&'a [f64]],
    rises: &'a mut [f64],
}

impl Work for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { interactions, inputs, rises } = self;
        for j in 0..interactions.dimensions() {
            match interactions.row(j) {
                Row::Sparse(row) => {
                    let later = row.iter().filter(|&&(k, _)| j < k);
                    add(later.map(|&(k, value)| (value, inputs[k])), inputs[j], rises);
                }
                Row::Dense(row) => {
                    let later = row.iter().zip(inputs).skip(j + 1).filter(|(value, _)| **value != 0.0);
                    add(later.map(|(&value, &column)| (value, column)), inputs[j], rises);
                }
            }
        }
    }
}

/// Adds the products of one input with others.
#[inline(always)]
fn add<'a>(others: impl Iterator<Item = (f64, &'a [f64])>, u: &[f64], rises: &mut [f64]) {
    if let (Some(u), Some(rises)) = (u.first_chunk::<TILE>(), rises.first_chunk_mut::<TILE>()) {
        let mut sums = *rises;
        for v in others {
            let (value, Some(v)) = (v.0, v.1.first_chunk::<TILE>()) else { continue };
            for row in 0..TILE {
                sums[row] += value * u[row] * v[row];
            }
        }
        *rises = sums;
        return;
    }
    for (value, v) in others {
        rises.iter_mut().zip(u.iter().zip(v)).for_each(|(rise, (u, v))| *rise += value * u * v);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference: the formula itself, row after row and pair after pair. The same order of the same operations gives the same bits.
    #[test]
    fn products_are_added_in_the_order_of_the_pairs() {
        // Rows that fill tiles and a rest, input counts below and above the one worth tasks, dense and sparse products.
        for (inputs, rows, every) in [(3, 70, 1), (70, 100, 1), (70, 100, 40), (9, 1, 1)] {
            let value = |place: usize| ((place * 7919 % 1009) as f64 - 500.0) / 97.0;
            let columns: Vec<Vec<f64>> =
                (0..inputs).map(|j| (0..rows).map(|row| value(j * rows + row + 3)).collect()).collect();
            let pairs: Vec<(usize, usize, f64)> = (0..inputs)
                .flat_map(|j| (j + 1..inputs).map(move |k| (j, k)))
                .filter(|(j, k)| (j + k) % every == 0)
                .map(|(j, k)| (j, k, value(j * inputs + k)))
                .filter(|&(.., value)| value != 0.0)
                .collect();
            let parts = vec![Some(Univariate::of_coefficients(&[0.0])); inputs];
            let interactions = Interactions::of_pairs(inputs, pairs.iter().copied());
            let rises = Surrogate { centre: 0.0, parts, interactions }.rises(&columns).expect("all parts are known");
            for (row, rise) in rises.iter().enumerate() {
                let sum = pairs.iter().fold(0.0, |sum, &(j, k, value)| sum + value * columns[j][row] * columns[k][row]);
                assert_eq!(rise.to_bits(), sum.to_bits(), "{inputs} inputs, row {row}");
            }
        }
    }
}
