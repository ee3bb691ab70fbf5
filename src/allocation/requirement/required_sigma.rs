//! Required sigma.
//!
//! ```text
//! value = (sigma/s)^2     s: the greatest sigma
//! ```

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::requirement::form::{Basis, FALLS, RequirementForm};
use crate::allocation::requirement::process_options::{OptionUses, ProcessOptions};
use crate::allocation::requirement::slack::Slack;
use crate::allocation::surface::response::Responses;
use crate::analysis::CharacteristicAnalysis;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::requirement::Requirement;

/// Least part of the required sigma that remains after the uncertainty is subtracted.
const LEFT: f64 = 0.5;

/// Sigma of at most a length.
pub(super) struct RequiredSigma;

impl RequirementForm for RequiredSigma {
    fn basis(&self) -> Basis {
        Basis::Moments
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    fn is_replaced_by_goals(&self) -> bool {
        false
    }

    fn used(&self, amount: f64, [_, high]: [f64; 2]) -> f64 {
        (high / amount).powi(2)
    }

    fn missed(&self, amount: f64, [_, high]: [f64; 2]) -> Option<f64> {
        Some(high - amount)
    }

    fn stricter(&self, amount: f64, more: f64) -> (f64, f64) {
        (libm::exp(-FALLS * more) * amount, 1.0)
    }

    fn uncertainty(&self, requirement: Requirement, found: &CharacteristicAnalysis) -> f64 {
        // The interval does not depend on the required sigma.
        let judged = found.judge(requirement);
        judged.value.zip(judged.interval).map_or(0.0, |(value, [_, high])| (value - high).abs())
    }

    fn target(&self, row: &Constraint, responses: &Responses) -> f64 {
        let most = row.requirement.amount();
        (most - responses.of[row.characteristic].uncertainty.of(&row.requirement)).max(LEFT * most)
    }

    fn slack(&self, _row: &Constraint, _moments: &Moments, target: f64) -> Option<Slack> {
        Some(Slack::Given { sigma: target, by_mean: 0.0 })
    }

    fn measured(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        Some(responses.moments(row.characteristic, &responses.factors(priced, at))?.sigma())
    }

    fn excess(
        &self,
        row: &Constraint,
        responses: &Responses,
        (factors, shifts): (&[f64], &[f64]),
        _width: f64,
    ) -> Option<f64> {
        Some(self.ratio(row, responses, &[], factors, Some(shifts))? - 1.0)
    }

    fn widened(&self, row: &Constraint, by: f64) -> Option<Constraint> {
        let most = row.requirement.amount() + by;
        (most > 0.0).then_some(Constraint { requirement: row.requirement.with_amount(most), ..*row })
    }

    fn extent(&self, row: &Constraint) -> Option<f64> {
        Some(row.requirement.amount())
    }

    fn prices(
        &self,
        row: &Constraint,
        responses: &Responses,
        (priced, at): (&[Priced], &[f64]),
        multiplier: f64,
    ) -> Option<[Option<f64>; 3]> {
        let price = self.price_of_slack(row, responses, (priced, at), multiplier);
        Some([None, None, Some(price / row.requirement.amount())])
    }

    fn option_uses(&self, row: &Constraint, options: &ProcessOptions<'_>) -> Option<OptionUses> {
        let moments = options.moments(row.characteristic)?;
        self.squares_in_slack(row, options, &moments)
    }
}
