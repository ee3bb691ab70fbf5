//! Required rss on one side.
//!
//! ```text
//! value = (rss/s)^2     s: distance from the middle of the linear model to the limit
//! ```

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::requirement::form::{Basis, RequirementForm};
use crate::allocation::requirement::linearised::Linearised;
use crate::allocation::requirement::process_options::{OptionUses, ProcessOptions};
use crate::allocation::requirement::slack::by_slack;
use crate::allocation::surface::response::Responses;

/// Root of the sum of squares within the limits.
pub(super) struct RequiredRss;

impl RequiredRss {
    /// Middle of the linear model, and the rss.
    fn reached(row: &Constraint, responses: &Responses, factors: &[f64], shifts: &[f64]) -> Option<(f64, f64)> {
        let c = row.characteristic;
        Some((responses.middle(c, factors, Some(shifts))?, responses.rss_squared(c, &[], factors)?.0.sqrt()))
    }
}

impl RequirementForm for RequiredRss {
    fn basis(&self) -> Basis {
        Basis::Bands
    }

    fn used(&self, _amount: f64, [_, high]: [f64; 2]) -> f64 {
        high * high
    }

    fn ratio(
        &self,
        row: &Constraint,
        responses: &Responses,
        priced: &[Priced],
        factors: &[f64],
        shifts: Option<&[f64]>,
    ) -> Option<f64> {
        let rss = responses.rss_squared(row.characteristic, priced, factors)?.0.sqrt();
        let slack = row.slack_about(responses.middle(row.characteristic, factors, shifts)?)?;
        Some(by_slack(rss, row.part * slack))
    }

    fn linearised(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<Linearised> {
        let k = row.characteristic;
        let factors = responses.factors(priced, at);
        let ratio = self.ratio(row, responses, priced, &factors, None)?;
        // d ln(ratio) = d ln R - d ln s.
        Linearised::of_ratio(ratio, priced.len(), || {
            let (square, slopes) = responses.rss_squared(k, priced, &factors)?;
            let slack = row.slack_about(responses.middle(k, &factors, None)?)?;
            let sign = if row.is_above() { -1.0 } else { 1.0 };
            let moved = responses.middle_slopes(k, priced, &factors)?;
            let slope = |(slope, moved): (&f64, f64)| 0.5 * slope / square - sign * moved / slack;
            Some(slopes.iter().zip(moved).map(slope).collect())
        })
    }

    fn measured(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        self.ratio(row, responses, priced, &responses.factors(priced, at), None)
    }

    fn width(&self, row: &Constraint, responses: &Responses, ones: &[f64]) -> Option<f64> {
        Some(row.width_of_reach(Self::reached(row, responses, ones, &vec![0.0; ones.len()])?))
    }

    fn excess(
        &self,
        row: &Constraint,
        responses: &Responses,
        (factors, shifts): (&[f64], &[f64]),
        width: f64,
    ) -> Option<f64> {
        row.excess_of_reach(Self::reached(row, responses, factors, shifts)?, width)
    }

    fn prices(
        &self,
        row: &Constraint,
        responses: &Responses,
        (priced, at): (&[Priced], &[f64]),
        multiplier: f64,
    ) -> Option<[Option<f64>; 3]> {
        let price = self.price_of_slack(row, responses, (priced, at), multiplier);
        let middle = responses.middle(row.characteristic, &responses.factors(priced, at), None)?;
        Some(row.price_of_side(price / row.slack_about(middle)?))
    }

    fn is_exact_for_processes(&self, _row: &Constraint, _responses: &Responses) -> bool {
        true
    }

    /// Squares of the bands in the square of the slack. Returns None if a tolerance moves the middle.
    fn option_uses(&self, row: &Constraint, options: &ProcessOptions<'_>) -> Option<OptionUses> {
        let (responses, priced, c) = (options.responses, options.priced, row.characteristic);
        if priced.iter().flat_map(|group| &group.members).any(|&d| responses.reach[d].lean != 0.0) {
            return None;
        }
        let ones = vec![1.0; responses.dimensions.len()];
        let slack = row.part * row.slack_about(responses.middle(c, &ones, None)?)?;
        let (fixed, squares) = responses.squares_of_bands(c, priced)?;
        Some(options.of_bands(slack * slack - fixed, |g, t| squares[g] * t.powi(2)))
    }
}
