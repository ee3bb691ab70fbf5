//! Responses with other distributions of the dimensions, at fixed derivatives, and the sums that lists of such options
//! need.

use std::sync::Mutex;

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::surface::band::{Reach, Scaling};
use crate::allocation::surface::response::{Response, Responses, is_straight, shapes_of};
use crate::analysis::law_over;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::surrogate::{Inputs, Relocation};

impl Responses {
    /// Responses with these dimensions in place of those at which the derivatives were taken, with surface
    /// distributions if `laws`. Slopes and worst cases are those of the linearization point, because they depend on
    /// bands, not on distributions. Returns None if a distribution has no moments.
    pub(in crate::allocation) fn with_dimensions(&self, dimensions: &[Dimension], laws: bool) -> Option<Self> {
        let mut shapes = self.inputs.shapes().to_vec();
        let mut moved = Vec::with_capacity(self.varying.len());
        for (shape, &d) in shapes.iter_mut().zip(&self.varying) {
            let (old, new) = (&self.dimensions[d], &dimensions[d]);
            *shape = shapes_of(new)?;
            let shift = (new.mean() - old.mean()) / old.sigma();
            moved.push(Relocation { shift, stretch: new.sigma() / old.sigma() });
        }
        let inputs = Inputs::new(shapes, self.inputs.correlation().cloned());
        let of_inputs: Option<Vec<_>> = self.varying.iter().map(|&d| dimensions[d].law().cloned()).collect();
        let of = |one: &Response| {
            let surrogate = one.surrogate.as_ref().map(|surrogate| surrogate.relocated(&moved));
            let law = match (&surrogate, &of_inputs) {
                (Some(surrogate), Some(inputs_of)) if laws && one.limits.exist() => {
                    law_over(surrogate, inputs_of, inputs.correlation(), one.rounding).ok()
                }
                _ => None,
            };
            Response {
                surrogate,
                nominal: one.nominal,
                slopes: one.slopes.clone(),
                depends: one.depends.clone(),
                limits: one.limits,
                rounding: one.rounding,
                law,
                uncertainty: one.uncertainty.clone(),
                sampled: None,
                worst: None,
                over_zones: one.over_zones,
            }
        };
        Some(Self {
            dimensions: dimensions.to_vec(),
            varying: self.varying.clone(),
            // Tolerances are fixed here, so the scaling has no effect.
            scaling: vec![Scaling::Similar { alpha: 0.0 }; self.varying.len()],
            reach: dimensions.iter().map(Reach::of).collect(),
            correlated: self.correlated.clone(),
            of: self.of.iter().map(of).collect(),
            laws: of_inputs,
            corrections: Mutex::default(),
            reject_fits: Mutex::default(),
            joint_uncertainty: self.joint_uncertainty,
            inputs,
        })
    }

    /// True if the surface of a characteristic is straight, and no samples of the model correct it.
    pub(in crate::allocation) fn is_straight(&self, c: usize) -> bool {
        self.of[c].surrogate.as_ref().is_some_and(is_straight) && !self.is_sampled(c)
    }

    /// Slopes of a sum of independent dimensions, whose variances add up. Returns None for other characteristics.
    pub(in crate::allocation) fn slopes_of_sum(&self, c: usize) -> Option<Vec<f64>> {
        let sum = self.is_straight(c) && self.correlated.is_empty();
        self.of[c].slopes.clone().filter(|_| sum)
    }

    /// Squared part of the rss by bands without a cost, and factor of `T^2` for every group. Returns None if squares do
    /// not add up.
    pub(in crate::allocation) fn squares_of_bands(&self, c: usize, priced: &[Priced]) -> Option<(f64, Vec<f64>)> {
        let slopes = self.of[c].slopes.as_ref().filter(|_| self.correlated.is_empty())?;
        let is_priced = |d: &usize| priced.iter().any(|group| group.members.contains(d));
        let fixed = (0..slopes.len()).filter(|d| !is_priced(d)).map(|d| (slopes[d] * self.reach[d].half).powi(2)).sum();
        let of = |group: &Priced| group.members.iter().map(|&d| slopes[d].powi(2)).sum();
        Some((fixed, priced.iter().map(of).collect()))
    }
}
