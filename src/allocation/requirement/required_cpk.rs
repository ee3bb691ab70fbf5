//! Required Cpk on one side.
//!
//! ```text
//! value = (sigma/s)^2     s = (distance from the mean to the limit)/(3 Cpk)
//! ```

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::requirement::form::{Basis, RequirementForm};
use crate::allocation::requirement::slack::Slack;
use crate::allocation::surface::response::Responses;
use crate::analysis::CharacteristicAnalysis;
use sensitol_numeric::capability;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::requirement::Requirement;

/// Least Cpk of a point of a Pareto front.
const LEAST_CPK: f64 = 0.05;

/// Cpk of at least a number.
pub(super) struct RequiredCpk;

impl RequiredCpk {
    /// Mean, and the distance of the required limit from it.
    fn reached(&self, row: &Constraint, responses: &Responses, factors: &[f64], shifts: &[f64]) -> Option<(f64, f64)> {
        let moments = responses.moments_shifted(row.characteristic, factors, Some(shifts))?;
        Some((moments.mean(), 3.0 * self.target(row, responses) * moments.sigma()))
    }
}

impl RequirementForm for RequiredCpk {
    fn basis(&self) -> Basis {
        Basis::Moments
    }

    fn used(&self, amount: f64, [low, _]: [f64; 2]) -> f64 {
        if low > 0.0 { (amount / low).powi(2) } else { f64::INFINITY }
    }

    fn missed(&self, amount: f64, [low, _]: [f64; 2]) -> Option<f64> {
        Some(amount - low)
    }

    fn stricter(&self, amount: f64, more: f64) -> (f64, f64) {
        ((amount + more / 3.0).max(LEAST_CPK), 1.0)
    }

    fn uncertainty(&self, requirement: Requirement, found: &CharacteristicAnalysis) -> f64 {
        // The interval does not depend on the required number.
        let judged = found.judge(requirement);
        judged.value.zip(judged.interval).map_or(0.0, |(value, [low, _])| (value - low).abs())
    }

    fn target(&self, row: &Constraint, responses: &Responses) -> f64 {
        row.requirement.amount() + responses.of[row.characteristic].uncertainty.of(&row.requirement)
    }

    fn slack(&self, row: &Constraint, moments: &Moments, target: f64) -> Option<Slack> {
        let sigma = row.signed_slack(moments.mean())? / (3.0 * target);
        let sign = if row.is_above() { -1.0 } else { 1.0 };
        (sigma > 0.0).then(|| Slack::Given { sigma, by_mean: sign / (3.0 * target * sigma) })
    }

    fn measured(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        let moments = responses.moments(row.characteristic, &responses.factors(priced, at))?;
        capability::cpk(moments.mean(), moments.sigma(), row.limits)
    }

    fn width(&self, row: &Constraint, responses: &Responses, ones: &[f64]) -> Option<f64> {
        Some(row.width_of_reach(self.reached(row, responses, ones, &vec![0.0; ones.len()])?))
    }

    fn excess(
        &self,
        row: &Constraint,
        responses: &Responses,
        (factors, shifts): (&[f64], &[f64]),
        width: f64,
    ) -> Option<f64> {
        row.excess_of_reach(self.reached(row, responses, factors, shifts)?, width)
    }

    /// Row `(mean ± 3 C sigma - limit)/width`, which has slopes at every mean. The ratio of the value has a pole where the
    /// mean passes the limit.
    fn smooth_row(
        &self,
        row: &Constraint,
        responses: &Responses,
        (priced, at): (&[Priced], &[f64]),
        width: f64,
    ) -> Option<(f64, Vec<f64>)> {
        let factors = responses.factors(priced, at);
        let still = vec![0.0; factors.len()];
        let value = self.excess(row, responses, (&factors, &still), width).filter(|value| value.is_finite())?;
        let sigma = responses.moments(row.characteristic, &factors)?.sigma();
        let sign = if row.is_above() { 1.0 } else { -1.0 };
        let reach = 3.0 * self.target(row, responses) * sigma;
        let of = |by: &[f64; 4]| (sign * by[0] + reach * by[1]) / width;
        Some((value, responses.moment_slopes(row.characteristic, priced, &factors)?.iter().map(of).collect()))
    }
}
