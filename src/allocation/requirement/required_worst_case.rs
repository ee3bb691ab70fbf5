//! Required worst case on one side.
//!
//! ```text
//! value = (reach beyond the nominal)/(U - nominal)     linear in T where the surface is
//! ```

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::{Constraint, known_or_infinite};
use crate::allocation::requirement::form::{Basis, RequirementForm};
use crate::allocation::requirement::linearised::Linearised;
use crate::allocation::requirement::process_options::{OptionUses, ProcessOptions};
use crate::allocation::surface::response::Responses;

/// Worst case within the limits.
pub(super) struct RequiredWorstCase;

impl RequirementForm for RequiredWorstCase {
    fn basis(&self) -> Basis {
        Basis::Box
    }

    fn is_replaced_by_goals(&self) -> bool {
        false
    }

    fn used(&self, _amount: f64, [_, high]: [f64; 2]) -> f64 {
        high
    }

    fn value(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        self.linearised(row, responses, priced, at).map(|found| found.value)
    }

    fn value_at(&self, row: &Constraint, responses: &Responses, factors: &[f64]) -> Option<f64> {
        let all: Vec<Priced> = responses.every_dimension();
        let half_band = |group: &Priced| {
            let first = group.members[0];
            factors[first] * responses.dimensions[first].half_band()
        };
        self.value(row, responses, &all, &all.iter().map(half_band).collect::<Vec<f64>>())
    }

    /// Reach beyond the nominal divided by the slack of the limit.
    fn linearised(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<Linearised> {
        let slack = row.nominal_slack(responses)?;
        let (reach, slopes, linear) = match &responses.of[row.characteristic].worst {
            Some(worst) => {
                let (reach, by_dimension) = worst.reach(&responses.factors(priced, at), row.is_above());
                let of = |group: &Priced| {
                    by_dimension.iter().filter(|(d, _)| group.members.contains(d)).map(|(_, slope)| slope).sum()
                };
                (reach, priced.iter().map(of).collect(), false)
            }
            None => {
                let (constant, coefficients) = responses.worst_case(row.characteristic, priced, row.is_above())?;
                let slopes: Vec<f64> = coefficients.iter().zip(at).map(|(coefficient, t)| coefficient * t).collect();
                (constant + slopes.iter().sum::<f64>(), slopes, true)
            }
        };
        // A nominal value beyond the limit leaves no slack to divide by.
        let scale = if slack > 0.0 { slack } else { slack.abs().max(reach.abs()).max(f64::MIN_POSITIVE) };
        let value = 1.0 + (reach - slack * row.part) / scale;
        let slopes = slopes.into_iter().map(|slope| slope / scale).collect();
        Some(Linearised::of_uses(value, slopes, linear))
    }

    fn measured(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        self.value(row, responses, priced, at)
    }

    fn width(&self, row: &Constraint, responses: &Responses, ones: &[f64]) -> Option<f64> {
        let still = vec![0.0; ones.len()];
        Some(row.width_of_reach(responses.worst_reach(row.characteristic, ones, &still, row.is_above())?))
    }

    fn excess(
        &self,
        row: &Constraint,
        responses: &Responses,
        (factors, shifts): (&[f64], &[f64]),
        width: f64,
    ) -> Option<f64> {
        row.excess_of_reach(responses.worst_reach(row.characteristic, factors, shifts, row.is_above())?, width)
    }

    /// Price of the limit. The reach stays, and the slack that it is divided by grows.
    fn prices(
        &self,
        row: &Constraint,
        responses: &Responses,
        (priced, at): (&[Priced], &[f64]),
        multiplier: f64,
    ) -> Option<[Option<f64>; 3]> {
        let value = known_or_infinite(self.value(row, responses, priced, at));
        Some(row.price_of_side(multiplier * value / row.nominal_slack(responses)?))
    }

    fn is_sum(&self, row: &Constraint, responses: &Responses) -> bool {
        responses.has_linear_worst_case(row.characteristic)
    }

    fn is_convex(&self, row: &Constraint, responses: &Responses) -> bool {
        responses.has_linear_worst_case(row.characteristic)
    }

    fn is_exact_for_processes(&self, row: &Constraint, responses: &Responses) -> bool {
        responses.has_linear_worst_case(row.characteristic)
    }

    /// Bands in the slack of a linear worst case.
    fn option_uses(&self, row: &Constraint, options: &ProcessOptions<'_>) -> Option<OptionUses> {
        let (responses, c) = (options.responses, row.characteristic);
        if !responses.has_linear_worst_case(c) {
            return None;
        }
        let (constant, coefficients) = responses.worst_case(c, options.priced, row.is_above())?;
        let slack = row.nominal_slack(responses)? * row.part - constant;
        Some(options.of_bands(slack, |g, t| coefficients[g] * t))
    }
}
