//! Required joint yield of all characteristics with limits.
//!
//! ```text
//! value = (b*/b)^2     b: normal score of the reject rate, b*: that of the allowed reject rate
//! ```

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::{Constraint, known_or_infinite};
use crate::allocation::requirement::form::{Basis, RequirementForm};
use crate::allocation::requirement::linearised::Linearised;
use crate::allocation::requirement::process_options::{OptionUses, ProcessOptions};
use crate::allocation::requirement::required_yield::{RequiredYield, value_by_laws};
use crate::allocation::surface::reject_rate::{of_scores, of_scores_with_slope};
use crate::allocation::surface::response::Responses;
use crate::allocation::surface::surface_slack::Correction;

/// Half of the difference in `ln T`. Truncation and rounding are both near 1e-9.
const STEP: f64 = 3e-5;

/// Joint yield of at least a share.
pub(super) struct RequiredJointYield;

impl RequiredJointYield {
    /// Value and slopes by differences, if the density of a fit ends too abruptly for formulas.
    fn by_differences(
        &self,
        row: &Constraint,
        responses: &Responses,
        priced: &[Priced],
        at: &[f64],
    ) -> Option<Linearised> {
        let value = |at: &[f64]| self.ratio(row, responses, priced, &responses.factors(priced, at), None);
        let here = value(at).filter(|ratio| ratio.is_finite())?.powi(2);
        let mut slopes = Vec::with_capacity(priced.len());
        let mut trial = at.to_vec();
        for g in 0..at.len() {
            let mut stepped = |step: f64| {
                trial[g] = at[g] * libm::exp(step);
                Some(value(&trial)?.powi(2))
            };
            let (up, down) = (stepped(STEP)?, stepped(-STEP)?);
            trial[g] = at[g];
            slopes.push((up - down) / (2.0 * STEP));
        }
        slopes.iter().all(|slope| slope.is_finite()).then(|| Linearised::of_squares(here, slopes))
    }
}

impl RequirementForm for RequiredJointYield {
    fn basis(&self) -> Basis {
        Basis::Distribution
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    fn used(&self, amount: f64, interval: [f64; 2]) -> f64 {
        RequiredYield.used(amount, interval)
    }

    fn missed(&self, amount: f64, interval: [f64; 2]) -> Option<f64> {
        RequiredYield.missed(amount, interval)
    }

    fn stricter(&self, amount: f64, more: f64) -> (f64, f64) {
        RequiredYield.stricter(amount, more)
    }

    fn target(&self, row: &Constraint, responses: &Responses) -> f64 {
        1.0 - Correction::allowed(row.requirement.amount(), responses.joint_uncertainty)
    }

    fn ratio(
        &self,
        row: &Constraint,
        responses: &Responses,
        _priced: &[Priced],
        factors: &[f64],
        shifts: Option<&[f64]>,
    ) -> Option<f64> {
        let share = responses.rejects(&responses.limited()).share(responses, factors, shifts)?;
        Some(of_scores(share, 1.0 - self.target(row, responses)))
    }

    fn linearised(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<Linearised> {
        let rejects = responses.rejects(&responses.limited());
        let Some((share, by)) = rejects.with_slopes(responses, priced, &responses.factors(priced, at)) else {
            return self.by_differences(row, responses, priced, at);
        };
        let [ratio, by_share] = of_scores_with_slope(share, 1.0 - self.target(row, responses));
        let slopes: Vec<f64> = by.iter().map(|slope| 2.0 * ratio * by_share * slope).collect();
        let known = ratio.is_finite() && slopes.iter().all(|slope| slope.is_finite());
        known.then(|| Linearised::of_squares(ratio * ratio, slopes))
    }

    fn measured(&self, _row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        let factors = responses.factors(priced, at);
        Some(1.0 - responses.rejects(&responses.limited()).share(responses, &factors, None)?)
    }

    fn is_sum(&self, _row: &Constraint, _responses: &Responses) -> bool {
        false
    }

    fn is_convex(&self, _row: &Constraint, _responses: &Responses) -> bool {
        false
    }

    fn value_of_choice(&self, row: &Constraint, own: &Responses, ones: &[f64]) -> f64 {
        let by_law = value_by_laws(&row.characteristics(own), self.target(row, own), own);
        by_law.unwrap_or_else(|| known_or_infinite(self.value_at(row, own, ones)))
    }

    fn option_uses(&self, _row: &Constraint, _options: &ProcessOptions<'_>) -> Option<OptionUses> {
        None
    }
}
