//! Required yield of a characteristic.
//!
//! ```text
//! value = (sigma/s)^2     s: sigma at which mean and shape give just the yield by the Pearson fit, corrected by the surface distribution
//! ```

use std::sync::Arc;

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::{Constraint, known_or_infinite};
use crate::allocation::requirement::form::{Basis, RequirementForm};
use crate::allocation::requirement::process_options::{OptionUses, ProcessOptions};
use crate::allocation::requirement::slack::Slack;
use crate::allocation::surface::pearson_slack::YieldSlack;
use crate::allocation::surface::reject_rate::of_scores;
use crate::allocation::surface::response::{Responses, is_judged_by_law};
use crate::allocation::surface::surface_slack::Correction;
use crate::analysis::CharacteristicAnalysis;
use sensitol_numeric::capability::{Capability, Law};
use sensitol_numeric::distribution::standard_normal;
use sensitol_numeric::law::rejected;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::requirement::Requirement;

/// Least normal score of a point of a Pareto front: a yield of 8 %.
const LEAST_SCORE: f64 = 0.1;

/// Yield of at least a share.
pub(super) struct RequiredYield;

impl RequiredYield {
    /// Allowed reject rate after the uncertainty at the linearization point is subtracted.
    fn allowed(row: &Constraint, responses: &Responses) -> f64 {
        let uncertainty = responses.of[row.characteristic].uncertainty.of(&row.requirement);
        Correction::allowed(row.requirement.amount(), uncertainty)
    }
}

impl RequirementForm for RequiredYield {
    fn basis(&self) -> Basis {
        Basis::Distribution
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    fn used(&self, amount: f64, [low, _]: [f64; 2]) -> f64 {
        of_scores((1.0 - low).max(0.0), 1.0 - amount).powi(2)
    }

    fn missed(&self, amount: f64, [low, _]: [f64; 2]) -> Option<f64> {
        Some(amount - low)
    }

    fn stricter(&self, amount: f64, more: f64) -> (f64, f64) {
        let level = standard_normal::upper_quantile(0.5 * (1.0 - amount)) + more;
        (1.0 - 2.0 * standard_normal::sf(level.max(LEAST_SCORE)), 1.0)
    }

    fn uncertainty(&self, _: Requirement, found: &CharacteristicAnalysis) -> f64 {
        // The yield that judges trial tolerances is that of the surface distribution, or of the Pearson fit.
        let law = found.evidence.surface_law.as_ref().filter(|_| is_judged_by_law(found)).and_then(|law| law.yield_);
        let judged = law.or_else(|| found.evidence.pearson?.yield_());
        judged.zip(found.yield_interval()).map_or(0.0, |(value, [low, _])| value - low)
    }

    fn target(&self, row: &Constraint, responses: &Responses) -> f64 {
        1.0 - Self::allowed(row, responses)
    }

    fn slack(&self, row: &Constraint, moments: &Moments, target: f64) -> Option<Slack> {
        YieldSlack::of(moments, row.distances(moments.mean()), 1.0 - target).map(Slack::Yield)
    }

    fn correction(&self, row: &Constraint, responses: &Responses) -> Option<Arc<Correction>> {
        let target = self.target(row, responses);
        let slack = |moments: &Moments| Some(self.slack(row, moments, target)?.sigma());
        let slopes = |moments: &Moments| self.slack(row, moments, target)?.slopes();
        let (required, allowed) = (row.requirement.amount(), Self::allowed(row, responses));
        responses.correction(row.characteristic, (required, allowed), &slack, &slopes)
    }

    fn measured(&self, row: &Constraint, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        let moments = responses.moments(row.characteristic, &responses.factors(priced, at))?;
        let law = Law::fit(&moments).ok()?;
        Capability::of(&law, moments.mean(), moments.sigma(), row.limits).yield_()
    }

    fn value_of_choice(&self, row: &Constraint, own: &Responses, ones: &[f64]) -> f64 {
        let by_law = match own.is_plain(row.characteristic) {
            true => None,
            false => value_by_laws(&[row.characteristic], self.target(row, own), own),
        };
        by_law.unwrap_or_else(|| known_or_infinite(self.value_at(row, own, ones)))
    }

    fn option_uses(&self, row: &Constraint, options: &ProcessOptions<'_>) -> Option<OptionUses> {
        let c = row.characteristic;
        if !options.responses.is_plain(c) && !options.all_normal() || !options.means_stay(c) {
            return None;
        }
        let found = options.moments(c)?;
        self.squares_in_slack(row, options, &Moments::new(found.mean(), found.sigma(), 0.0, 0.0))
    }
}

/// Value of a yield by the surface distributions of these characteristics, as a ratio of normal scores. Returns None if
/// one of them has no surface distribution.
pub(super) fn value_by_laws(characteristics: &[usize], target: f64, own: &Responses) -> Option<f64> {
    let laws: Vec<_> = characteristics.iter().map(|&c| Some((own.law(c)?, own.of[c].limits))).collect::<Option<_>>()?;
    let (tails, twice) = rejected(&laws);
    Some(of_scores((tails - twice.value).max(0.0), 1.0 - target))
}
