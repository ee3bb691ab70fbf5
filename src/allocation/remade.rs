//! The surfaces with other distributions of the dimensions, at fixed derivatives; and what adds up in lists of such.

use std::sync::Mutex;

use super::bands::{Reach, Scaling};
use super::constraint::Constraint;
use super::cost::Priced;
use super::response::{Response, Responses, is_straight, shapes_of};
use crate::analysis::law_over;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::surrogate::{Inputs, Relocation};

impl Responses {
    /// With these dimensions in place of those at which the derivatives were taken; with laws where a yield is asked for. Slopes and worst cases
    /// are those of the station: of bands, not of distributions. None where a distribution has no moments.
    pub(super) fn remade(&self, dimensions: &[Dimension], laws: bool) -> Option<Self> {
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
                unknown: one.unknown,
                sampled: None,
                worst: None,
                over_zones: one.over_zones,
            }
        };
        Some(Self {
            dimensions: dimensions.to_vec(),
            varying: self.varying.clone(),
            // Tolerances stay where they are.
            scaling: vec![Scaling::Similar { alpha: 0.0 }; self.varying.len()],
            reach: dimensions.iter().map(Reach::of).collect(),
            correlated: self.correlated.clone(),
            of: self.of.iter().map(of).collect(),
            laws: of_inputs,
            corrections: Mutex::default(),
            reject_fits: Mutex::default(),
            joint_unknown: self.joint_unknown,
            inputs,
        })
    }

    /// Whether the surface of a characteristic is straight, and the model agrees.
    pub(super) fn is_straight(&self, c: usize) -> bool {
        self.of[c].surrogate.as_ref().is_some_and(is_straight) && !self.is_sampled(c)
    }

    /// The slopes of a sum of independent dimensions, whose variances add up; None of anything else.
    pub(super) fn slopes_of_sum(&self, c: usize) -> Option<Vec<f64>> {
        let sum = self.is_straight(c) && self.correlated.is_empty();
        self.of[c].slopes.clone().filter(|_| sum)
    }

    /// The squares of what the bands without a cost add to the rss, and of every group the factor of `T^2`; None where they do not add up.
    pub(super) fn squares_of_bands(&self, c: usize, priced: &[Priced]) -> Option<(f64, Vec<f64>)> {
        let slopes = self.of[c].slopes.as_ref().filter(|_| self.correlated.is_empty())?;
        let is_priced = |d: &usize| priced.iter().any(|group| group.members.contains(d));
        let fixed = (0..slopes.len()).filter(|d| !is_priced(d)).map(|d| (slopes[d] * self.reach[d].half).powi(2)).sum();
        let of = |group: &Priced| group.members.iter().map(|&d| slopes[d].powi(2)).sum();
        Some((fixed, priced.iter().map(of).collect()))
    }
}

impl Constraint {
    /// Of a linear worst case the room, less what has no cost, and the factors of every group's `T`.
    pub(super) fn linear_room(&self, responses: &Responses, priced: &[Priced]) -> Option<(f64, Vec<f64>)> {
        if !responses.has_linear_worst_case(self.characteristic) {
            return None;
        }
        let (constant, coefficients) = responses.worst_case(self.characteristic, priced, self.is_above())?;
        Some((self.nominal_room(responses)? * self.part - constant, coefficients))
    }

    /// The room of an rss about a middle that no tolerance moves.
    pub(super) fn still_room(&self, responses: &Responses, priced: &[Priced]) -> Option<f64> {
        let members = || priced.iter().flat_map(|group| &group.members);
        if members().any(|&d| responses.reach[d].lean != 0.0) {
            return None;
        }
        let ones = vec![1.0; responses.dimensions.len()];
        Some(self.part * self.room_about(responses.middle(self.characteristic, &ones, None)?)?)
    }

    /// The greatest sigma about the mean as it is; with `normal` of a normal distribution.
    pub(super) fn most_sigma(&self, responses: &Responses, normal: bool) -> Option<f64> {
        let ones = vec![1.0; responses.dimensions.len()];
        let found = responses.moments(self.characteristic, &ones)?;
        let moments = if normal { Moments::new(found.mean(), found.sigma(), 0.0, 0.0) } else { found };
        match self.requirement {
            Requirement::Rss | Requirement::WorstCase => None,
            _ => Some(self.room(&moments, self.target(responses))?.sigma()),
        }
    }
}
