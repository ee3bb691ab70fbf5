//! Form of a requirement in an allocation, implemented by every kind of requirement.
//!
//! ```text
//! value <= 1          the constraint, with slopes by ln T of every group
//! value = (sigma/s)^2 with s the slack, the sigma that just keeps the requirement        unless a kind says otherwise
//! ```
//!
//! A kind that limits sigma at a mean and a shape gives its [`slack`](RequirementForm::slack), and the default methods
//! follow from it. A new kind is a variant of [`Requirement`], a file beside this one, and a line in
//! [`form_of`](crate::allocation::requirement::registry::form_of).

use std::sync::Arc;

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::{Constraint, known_or_infinite};
use crate::allocation::requirement::linearised::Linearised;
use crate::allocation::requirement::process_options::{OptionUses, ProcessOptions};
use crate::allocation::requirement::slack::{Slack, by_slack};
use crate::allocation::surface::response::Responses;
use crate::allocation::surface::surface_slack::Correction;
use crate::analysis::CharacteristicAnalysis;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::requirement::Requirement;

/// Rate at which a required sigma, or the slack, falls over the range of a Pareto front: from 1.5 to 0.55 times the required value.
pub(super) const FALLS: f64 = 0.4;
/// Step of a move of the limits, in sigmas of the slack. Truncation is 1e-10, and rounding 1e-11.
const LIMIT_STEP: f64 = 1e-5;

/// Figures that a requirement is judged by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::allocation) enum Basis {
    /// Extremes over the box of the tolerance bands.
    Box,
    /// Widths of the tolerance bands in the linear model.
    Bands,
    /// Mean and sigma.
    Moments,
    /// Distribution of the characteristic.
    Distribution,
}

impl Basis {
    /// True if bands alone determine the requirement, whatever distribution parts have within them.
    pub(in crate::allocation) fn is_by_band(self) -> bool {
        matches!(self, Self::Box | Self::Bands)
    }
}

/// Kind of requirement, as a constraint on tolerances at fixed derivatives.
///
/// `row` is one side of a requirement of this kind. `at` are half bands of the groups `priced`, `factors` the factors of
/// all dimensions, and `shifts` moves of nominal values in sigmas. A figure that is unknown is None. No method evaluates
/// the model.
///
/// # Cost
///
/// The default methods take one to three sets of moments of the surface; slopes take as many as there are groups if
/// formulas do not give them.
pub(in crate::allocation) trait RequirementForm: Sync {
    /// Figures that the requirement is judged by.
    fn basis(&self) -> Basis;

    /// True if one constraint holds both limits, false if each limit has a constraint of its own.
    fn is_two_sided(&self) -> bool {
        false
    }

    /// True if a goal for a given cost takes the place of the requirement.
    fn is_replaced_by_goals(&self) -> bool {
        true
    }

    /// Used part of a requirement from the interval of its figure: at most 1 if the interval keeps the amount. For sums
    /// of normal dimensions it is a sum of squares of the tolerances, for a worst case a sum.
    fn used(&self, amount: f64, interval: [f64; 2]) -> f64;

    /// Distance by which the pessimistic end of an interval misses the amount, in the unit of the amount. Returns None if
    /// the requirement cannot be made stricter by it.
    fn missed(&self, _amount: f64, _interval: [f64; 2]) -> Option<f64> {
        None
    }

    /// Amount with `more` sigmas, and the part of the slack that may be used then, for a point of a Pareto front.
    fn stricter(&self, amount: f64, more: f64) -> (f64, f64) {
        (amount, libm::exp(-FALLS * more))
    }

    /// Distance from the figure that judges trial tolerances to the pessimistic end of its interval in an analysis, in
    /// the unit of the amount. It is 0 if an error is unknown.
    fn uncertainty(&self, _requirement: Requirement, _found: &CharacteristicAnalysis) -> f64 {
        0.0
    }

    /// Required amount, made stricter by the uncertainty at the linearization point, in the unit of the amount.
    fn target(&self, row: &Constraint, _responses: &Responses) -> f64 {
        row.requirement.amount()
    }

    /// Largest sigma that keeps the requirement with this mean and shape, in the unit of the characteristic. Returns None
    /// if no sigma does, and if sigma does not determine the requirement.
    fn slack(&self, _row: &Constraint, _moments: &Moments, _target: f64) -> Option<Slack> {
        None
    }

    /// Correction of the slack by the surface distribution, without unit.
    fn correction(&self, _row: &Constraint, _responses: &Responses) -> Option<Arc<Correction>> {
        None
    }

    /// Ratio of the variation to its slack, without unit.
    fn ratio(
        &self,
        row: &Constraint,
        responses: &Responses,
        _priced: &[Priced],
        factors: &[f64],
        shifts: Option<&[f64]>,
    ) -> Option<f64> {
        let moments = responses.moments_shifted(row.characteristic, factors, shifts)?;
        let slack = self.slack(row, &moments, self.target(row, responses))?;
        Some(self.corrected_ratio(row, responses, (&moments, &slack), factors))
    }

    /// Ratio of sigma to its slack, corrected at these factors.
    fn corrected_ratio(
        &self,
        row: &Constraint,
        responses: &Responses,
        (moments, slack): (&Moments, &Slack),
        factors: &[f64],
    ) -> f64 {
        let factor = self.correction(row, responses).map_or(1.0, |of| of.factor(factors));
        by_slack(moments.sigma(), factor * slack.sigma())
    }

    /// Value of the constraint at half bands, without unit.
    fn value(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        let ratio = self.ratio(row, responses, priced, &responses.factors(priced, at), None)?;
        Some(ratio * ratio)
    }

    /// Value of the constraint with all dimensions at these factors of their tolerances.
    fn value_at(&self, row: &Constraint, responses: &Responses, factors: &[f64]) -> Option<f64> {
        let ratio = self.ratio(row, responses, &[], factors, None)?;
        Some(ratio * ratio)
    }

    /// Value and slopes of the constraint at half bands.
    fn linearised(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<Linearised> {
        let k = row.characteristic;
        let factors = responses.factors(priced, at);
        let moments = responses.moments(k, &factors)?;
        let slack = self.slack(row, &moments, self.target(row, responses))?;
        let ratio = self.corrected_ratio(row, responses, (&moments, &slack), &factors);
        Linearised::of_ratio(ratio, priced.len(), || {
            if responses.is_plain(k) {
                // Sigma squared is the sum of the groups' squares.
                let (variance, squares) = responses.plain_squares(k, priced, &factors)?;
                return Some(squares.iter().map(|square| square / variance).collect());
            }
            self.slack_slopes(row, responses, priced, (&slack, &factors))
        })
    }

    /// Slopes of `ln(sigma/s)` by `ln T` of every group.
    fn slack_slopes(
        &self,
        row: &Constraint,
        responses: &Responses,
        priced: &[Priced],
        (slack, factors): (&Slack, &[f64]),
    ) -> Option<Vec<f64>> {
        let by = responses.moment_slopes(row.characteristic, priced, factors)?;
        let partial = slack.slopes()?;
        let of = |by: &[f64; 4]| by[1] - partial[0] * by[0] - partial[1] * by[2] - partial[2] * by[3];
        let correction = self.correction(row, responses);
        let corrected = |group: &Priced| {
            let slopes = group.members.iter().map(|&d| correction.as_ref().map_or(0.0, |of| of.slope(d, factors)));
            slopes.sum::<f64>()
        };
        Some(by.iter().zip(priced).map(|(by, group)| of(by) - corrected(group)).collect())
    }

    /// Figure of the requirement at half bands, in the unit of the amount.
    fn measured(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64>;

    /// Scale of [`excess`](Self::excess): 1, or the half-width that varies at the linearization point.
    fn width(&self, _row: &Constraint, _responses: &Responses, _ones: &[f64]) -> Option<f64> {
        Some(1.0)
    }

    /// Excess over the requirement in units of `width`. It is at most 0 if the requirement is kept, and smooth in
    /// factors and shifts if the surface is.
    fn excess(
        &self,
        row: &Constraint,
        responses: &Responses,
        (factors, shifts): (&[f64], &[f64]),
        _width: f64,
    ) -> Option<f64> {
        Some(self.ratio(row, responses, &[], factors, Some(shifts))?.powi(2) - 1.0)
    }

    /// Excess with its slopes by `ln T` of every group, as a row of a sequential quadratic program.
    fn smooth_row(
        &self,
        row: &Constraint,
        responses: &Responses,
        (priced, at): (&[Priced], &[f64]),
        _width: f64,
    ) -> Option<(f64, Vec<f64>)> {
        let linearised = self.linearised(row, responses, priced, at)?;
        Some((linearised.value - 1.0, linearised.slopes))
    }

    /// Constraint that gives way by a length in the unit of the characteristic. Returns None if nothing is left of it.
    fn widened(&self, row: &Constraint, by: f64) -> Option<Constraint> {
        row.with_limits_moved(by)
    }

    /// Length by which a constraint can give way: half of the distance between the limits, in their unit.
    fn extent(&self, row: &Constraint) -> Option<f64> {
        row.extent_of_limits()
    }

    /// Saving per unit by which the lower limit goes down, the upper one up, or a required sigma grows.
    fn prices(
        &self,
        row: &Constraint,
        responses: &Responses,
        (priced, at): (&[Priced], &[f64]),
        multiplier: f64,
    ) -> Option<[Option<f64>; 3]> {
        let moments = responses.moments(row.characteristic, &responses.factors(priced, at))?;
        let price = self.price_of_slack(row, responses, (priced, at), multiplier);
        let [lower, upper] = self.slack_by_limits(row, &moments, self.target(row, responses))?;
        let of = |exists: bool, by: f64| (exists && by != 0.0).then_some(price * by);
        Some([of(row.limits.lower().is_some(), lower), of(row.limits.upper().is_some(), upper), None])
    }

    /// Saving per relative growth of the slack. The value falls as the inverse square of the slack.
    fn price_of_slack(
        &self,
        row: &Constraint,
        responses: &Responses,
        (priced, at): (&[Priced], &[f64]),
        multiplier: f64,
    ) -> f64 {
        2.0 * multiplier * known_or_infinite(self.value(row, responses, priced, at))
    }

    /// Derivatives of the logarithm of the slack by an outward move of the lower and the upper limit, per unit.
    fn slack_by_limits(&self, row: &Constraint, moments: &Moments, target: f64) -> Option<[f64; 2]> {
        let step = LIMIT_STEP * self.slack(row, moments, target)?.sigma();
        let moved = |lower: f64, upper: f64| {
            Some(self.slack(&row.with_each_limit_moved([lower, upper]), moments, target)?.sigma())
        };
        let difference = |by: &dyn Fn(f64) -> Option<f64>| match (by(step), by(-step)) {
            (Some(up), Some(down)) => (libm::log(up) - libm::log(down)) / (2.0 * step),
            _ => 0.0,
        };
        Some([difference(&|step| moved(step, 0.0)), difference(&|step| moved(0.0, step))])
    }

    /// True if one sum of powers of the tolerances represents the constraint exactly.
    fn is_sum(&self, row: &Constraint, responses: &Responses) -> bool {
        responses.is_plain(row.characteristic)
    }

    /// True if the constraint is convex in the tolerances.
    fn is_convex(&self, row: &Constraint, responses: &Responses) -> bool {
        responses.is_norm(row.characteristic)
    }

    /// True if the surface represents the constraint exactly for any distributions of processes.
    fn is_exact_for_processes(&self, row: &Constraint, responses: &Responses) -> bool {
        row.characteristics(responses).into_iter().all(|c| responses.is_straight(c))
    }

    /// Value of the constraint with the distributions of a choice of processes.
    fn value_of_choice(&self, row: &Constraint, own: &Responses, ones: &[f64]) -> f64 {
        known_or_infinite(self.value_at(row, own, ones))
    }

    /// Use of the slack by every process option. Returns None if the options do not add up.
    fn option_uses(&self, row: &Constraint, options: &ProcessOptions<'_>) -> Option<OptionUses> {
        if !options.means_stay(row.characteristic) {
            return None;
        }
        let moments = options.moments(row.characteristic)?;
        self.squares_in_slack(row, options, &moments)
    }

    /// Squares of the sigmas of every process option in the square of the slack at these moments.
    fn squares_in_slack(
        &self,
        row: &Constraint,
        options: &ProcessOptions<'_>,
        moments: &Moments,
    ) -> Option<OptionUses> {
        let slack = self.slack(row, moments, self.target(row, options.responses))?;
        options.variances(row.characteristic, slack.sigma())
    }
}
