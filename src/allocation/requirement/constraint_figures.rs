//! Figures of a constraint, by the form of its requirement.

use std::sync::Arc;

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::{Constraint, Side, kept, known_or_infinite};
use crate::allocation::requirement::linearised::Linearised;
use crate::allocation::requirement::registry::form_of;
use crate::allocation::surface::response::Responses;
use crate::allocation::surface::surface_slack::Correction;
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::requirement::Requirement;

/// Factor of tolerances that count as zero.
const NEARLY_ZERO: f64 = 1e-9;

impl Constraint {
    /// Constraints of a requirement: one, or one for each limit.
    pub(in crate::allocation) fn of(characteristic: usize, requirement: Requirement, limits: SpecLimits) -> Vec<Self> {
        let with_side = |side| Self { characteristic, requirement, limits, side, part: 1.0 };
        if form_of(&requirement).is_two_sided() {
            return vec![with_side(Side::Both)];
        }
        let below = limits.lower().map(|_| with_side(Side::Below));
        below.into_iter().chain(limits.upper().map(|_| with_side(Side::Above))).collect()
    }

    /// Value alone. Infinite if the requirement cannot be kept, or is unknown.
    pub(in crate::allocation) fn value(&self, responses: &Responses, priced: &[Priced], at: &[f64]) -> f64 {
        known_or_infinite(self.form().value(self, responses, priced, at))
    }

    /// Value and slopes. Returns None if they are unknown.
    pub(in crate::allocation) fn linearised(
        &self,
        responses: &Responses,
        priced: &[Priced],
        at: &[f64],
    ) -> Option<Linearised> {
        self.form().linearised(self, responses, priced, at)
    }

    /// Value with all dimensions at these factors of their tolerances. Infinite if it is unknown.
    pub(in crate::allocation) fn value_at(&self, responses: &Responses, factors: &[f64]) -> f64 {
        known_or_infinite(self.form().value_at(self, responses, factors))
    }

    /// Constraint that gives way by a length. Returns None if nothing is left of it.
    pub(in crate::allocation) fn widened(&self, by: f64) -> Option<Self> {
        self.form().widened(self, by)
    }

    /// Length by which the constraint can give way, above 0.
    pub(in crate::allocation) fn extent(&self) -> Option<f64> {
        self.form().extent(self).filter(|extent| *extent > 0.0)
    }

    /// Scale of [`excess`](Self::excess), above 0.
    pub(in crate::allocation) fn width(&self, responses: &Responses, ones: &[f64]) -> Option<f64> {
        self.form().width(self, responses, ones).filter(|width| *width > 0.0)
    }

    /// Excess over the requirement in units of `width`, at most 0 if it is kept.
    pub(in crate::allocation) fn excess(
        &self,
        responses: &Responses,
        factors: &[f64],
        shifts: &[f64],
        width: f64,
    ) -> Option<f64> {
        self.form().excess(self, responses, (factors, shifts), width).filter(|value| value.is_finite())
    }

    /// Computes the correction by the surface distribution, so that it is stored for later use.
    pub(in crate::allocation) fn prepare(&self, responses: &Responses) {
        let _: Option<Arc<Correction>> = self.form().correction(self, responses);
    }

    /// Value of the requirement at these tolerances, in its own measure. Returns None if it is unknown.
    pub(in crate::allocation) fn measured(&self, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        self.form().measured(self, responses, priced, at)
    }

    /// Saving per unit by which the lower limit goes down, the upper one up, or a required sigma grows.
    pub(in crate::allocation) fn prices(
        &self,
        responses: &Responses,
        priced: &[Priced],
        at: &[f64],
        multiplier: f64,
    ) -> Option<[Option<f64>; 3]> {
        self.form().prices(self, responses, (priced, at), multiplier)
    }

    /// Dimensions without a cost that alone break the requirement, most harmful first. The list is empty if the
    /// requirement could be kept with all other tolerances at zero.
    pub(in crate::allocation) fn without_the_priced(
        &self,
        responses: &Responses,
        priced: &[Priced],
        factors: &[f64],
    ) -> Vec<String> {
        let is_priced = |d: usize| priced.iter().any(|group| group.members.contains(&d));
        let without_cost = |d: usize| if is_priced(d) { NEARLY_ZERO } else { 1.0 };
        let alone: Vec<f64> = (0..factors.len()).map(without_cost).collect();
        if kept(self.value_at(responses, &alone)) {
            return Vec::new();
        }
        let mut harm: Vec<(f64, usize)> = (0..factors.len())
            .filter(|&d| !is_priced(d) && responses.dimensions[d].sigma() > 0.0)
            .map(|d| (responses.spread(self.characteristic, d), d))
            .filter(|(harm, _)| *harm > 0.0)
            .collect();
        harm.sort_by(|a, b| b.0.total_cmp(&a.0));
        harm.into_iter().map(|(_, d)| responses.dimensions[d].name().to_owned()).collect()
    }
}
