//! The surrogate's own values, over columns of points.

use std::collections::BTreeMap;

use super::{Surrogate, Univariate};
use crate::moments::Interactions;

impl Surrogate {
    /// How far the surrogate lies above its centre at every point; None when a part is unknown.
    ///
    /// Shapes: `inputs` has a column for every part, of standardised values, all of the same length. Cost: a product for
    /// every interaction and point. No evaluation.
    ///
    /// ```
    /// use sensitol::internals::{Interactions, Surrogate, Univariate};
    /// // 7 + 2 u0 + u1^2 + 3 u0 u1
    /// let parts = vec![Some(Univariate::of_coefficients(&[2.0])), Some(Univariate::of_coefficients(&[0.0, 1.0]))];
    /// let surrogate = Surrogate { centre: 7.0, parts, interactions: Interactions::of_pairs(2, [(0, 1, 3.0)]) };
    /// assert_eq!(surrogate.rises(&[vec![1.0, -1.0], vec![2.0, 0.0]]), Some(vec![12.0, -2.0]));
    /// ```
    pub fn rises<C: AsRef<[f64]>>(&self, inputs: &[C]) -> Option<Vec<f64>> {
        let rows = inputs.first().map_or(0, |column| column.as_ref().len());
        let mut rises = vec![0.0; rows];
        for (part, column) in self.parts.iter().zip(inputs) {
            let part = part.as_ref()?;
            rises.iter_mut().zip(column.as_ref()).for_each(|(rise, &u)| *rise += part.value(u));
        }
        for (j, k, value) in self.interactions.pairs() {
            let both = inputs[j].as_ref().iter().zip(inputs[k].as_ref());
            rises.iter_mut().zip(both).for_each(|(rise, (u, v))| *rise += value * u * v);
        }
        Some(rises)
    }

    /// Without curvatures and products that are no more than rounding of the differences they come from: eight units in the last place of
    /// the value at the means, over a step of a sigma, or 1e-13 of the surface's own sigma. They make a cycle of products out of a tree
    /// and a curve out of a line, which costs a law its closed form.
    pub(crate) fn without_rounding(&self) -> Self {
        let sigma = self.parts.iter().flatten().map(|part| part.largest().powi(2)).sum::<f64>().sqrt();
        let least = (8.0 * f64::EPSILON * self.centre.abs()).max(1e-13 * sigma);
        let pairs = self.interactions.pairs();
        let kept = pairs.iter().filter(|(_, _, value)| value.abs() > least).count();
        let interactions = match kept == pairs.len() {
            true => self.interactions.clone(),
            false => {
                let kept = pairs.into_iter().filter(|(_, _, value)| value.abs() > least);
                Interactions::of_pairs(self.parts.len(), kept)
            }
        };
        let parts = self.parts.iter().map(|part| part.map(|part| part.without_bends(least))).collect();
        Self { centre: self.centre, parts, interactions }
    }

    /// `a` times this surface and `b` times another over the same inputs; None when a part of either is unknown.
    pub(crate) fn sum(&self, a: f64, other: &Self, b: f64) -> Option<Self> {
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
