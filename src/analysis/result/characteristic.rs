//! Results of one characteristic.

use serde::Serialize;

#[cfg(feature = "schema")]
use crate::analysis::result::conclusion::CharacteristicConclusion;
use crate::analysis::result::contribution_figures::ContributionFigures;
use crate::analysis::result::distribution_figures::DistributionFigures;
use crate::analysis::result::evidence::Evidence;
use crate::analysis::result::interaction_listing::{dimensions_of, mixed_of, pairs_of, share_of};
use crate::analysis::result::linear::Linear;
use crate::analysis::result::range_figures::{LinearFigures, RangeFigures};
use crate::analysis::result::variance_share::Shares;
use crate::analysis::result::yield_error::of_yield;
use crate::analysis::{InteractionList, VerificationKind};
use crate::extremes::ExtremesProof;
use crate::method::{ErrorEstimate, Order, Outcome, estimate};
use crate::problem::Problem;
use crate::verification::Verified;
use sensitol_numeric::capability::{Capability, EstimatedShare, Law};
use sensitol_numeric::characteristic::Characteristic;
#[cfg(feature = "schema")]
use sensitol_numeric::json_form::Concluded;
use sensitol_numeric::json_form::{Four, through};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::power::{Rescale, Rescaling, Wide, rescale};
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::surrogate::DerivativeOrigin;
use sensitol_numeric::verdict::{self, Judged, Verdict, Verdicts};

/// Figures of one characteristic, with their evidence. Unknown values are None.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
pub struct CharacteristicAnalysis {
    /// Characteristic, with its limits.
    #[serde(flatten)]
    #[cfg_attr(feature = "schema", schemars(with = "Concluded<Characteristic, CharacteristicConclusion<'static>>"))]
    pub characteristic: Characteristic,
    /// Value at the nominal dimensions.
    pub nominal: Option<f64>,
    /// First four moments.
    #[serde(flatten, serialize_with = "through::<Four<Option<f64>>, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Four<Option<f64>>"))]
    pub moments: Option<Moments>,
    /// Estimated errors of these results. None if there are no moments.
    pub error_estimate: Option<ErrorEstimate>,
    /// Yield, quantiles, and derived figures.
    #[serde(flatten)]
    pub distribution: DistributionFigures,
    /// Ranges that no assembly leaves.
    #[serde(skip)]
    pub range: RangeFigures,
    /// Results of slopes and tolerance bands alone.
    #[serde(flatten)]
    pub linear: LinearFigures,
    /// Sensitivities to every dimension of the problem, in order.
    pub sensitivities: Vec<Sensitivity>,
    /// Interactions and indices of the variance.
    #[serde(flatten)]
    pub contributions: ContributionFigures,
    /// Sources from which the figures follow, or that are shown beside them.
    #[serde(flatten)]
    pub evidence: Evidence,
    /// Points without a value.
    #[serde(flatten)]
    pub missing: MissingPoints,
    /// True if the characteristic depends on nothing that varies, so that it has a single value.
    pub constant: bool,
}

/// Points that have no value of a characteristic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MissingPoints {
    /// True if the run was stopped before all planned points were evaluated. There is no verdict then.
    pub unfinished: bool,
    /// Evaluated points without a value of the characteristic.
    pub without_value: usize,
}

/// Effect of one dimension on a characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sensitivity {
    /// Name of the dimension.
    pub dimension: String,
    /// First derivative at the mean, in units of the characteristic per unit of the dimension.
    pub first: Option<f64>,
    /// Second derivative at the mean.
    pub second: Option<f64>,
    /// True if both derivatives are exact rather than differences.
    pub exact: bool,
    /// Source of the shares: `exact`, `evaluated`, or `screened` if an estimate has a part in them. None if there are no shares.
    pub origin: Option<DerivativeOrigin>,
    /// Largest effect on the two derivatives of a rounding error of the characteristic. It is computed for the steps used, and for one
    /// sigma if the derivatives are exact.
    pub rounding: Option<[f64; 2]>,
    /// Nodes along the dimension at which the model has a value, relative to the mean and in the unit of the dimension, ascending. Empty if
    /// none was evaluated.
    pub steps: Vec<f64>,
    /// Share of the variance that the best straight line through the univariate part explains.
    pub linear_share: Option<f64>,
    /// Share of the variance that the curvature adds.
    pub curvature_share: Option<f64>,
    /// Mean shift by the curvature.
    pub mean_shift: Option<f64>,
    /// First-order Sobol' index: the part of the variance that the dimension explains alone. None for a dimension that varies together with
    /// others.
    pub first_order: Option<EstimatedShare>,
    /// Total Sobol' index: the part of the variance including all interactions of the dimension.
    pub total: Option<EstimatedShare>,
}

rescale!(CharacteristicAnalysis {
    nominal, moments, error_estimate, distribution, range, linear, sensitivities, contributions, evidence,
} without { characteristic, missing, constant });

impl Rescale for Sensitivity {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.first.rescale(by);
        // The rounding of the second derivative is in the characteristic's own unit already, as the derivative itself.
        self.rounding.iter_mut().for_each(|[first, _]| first.rescale(by));
        self.mean_shift.rescale(by);
    }
}

impl CharacteristicAnalysis {
    /// Share of a dimension: straight line and curvature.
    pub fn share(&self, dimension: usize) -> Option<f64> {
        let sensitivity = &self.sensitivities[dimension];
        Some(sensitivity.linear_share? + sensitivity.curvature_share.unwrap_or(0.0))
    }

    /// Bounds of the worst case by interval arithmetic: those of the search for extremes if there was one, else `bounds`.
    pub fn proof(&self) -> Option<&ExtremesProof> {
        self.range.extremes.as_ref().map_or(self.range.bounds.as_ref(), |found| found.proof.as_ref())
    }

    /// Interval of the yield: the estimate and two of its errors, with the uncertainty of measured samples. It extends down to 0 if there
    /// are assemblies without a value that were not counted. Returns None if an error is unknown.
    pub fn yield_interval(&self) -> Option<[f64; 2]> {
        if let Some(free) = &self.distribution.distribution_free_yield {
            return free.certain_interval();
        }
        let value = self.distribution.capability?.yield_()?;
        let error = if self.constant { Some(0.0) } else { self.error_estimate.as_ref().and_then(|of| of.yield_) };
        // The interval of importance samples does not follow from an error.
        let around = match &self.evidence.tail_sampled {
            Some(tail) => tail.interval,
            None => verdict::about(value, error)?,
        };
        let around = match &self.evidence.sampling {
            Some(measured) => {
                measured.rejected.map(|[low, high]| verdict::joined(value, around, [1.0 - high, 1.0 - low]))?
            }
            None => around,
        };
        // Samples give the share of assemblies without a value, and check points a bound of it.
        let counted = self
            .evidence
            .verification
            .as_ref()
            .filter(|of| of.kind == VerificationKind::Sample)
            .and_then(|of| of.valid);
        let located = self.evidence.verification.as_ref().and_then(|of| of.lost_share).filter(|lost| *lost > 0.0);
        let lost = match &self.evidence.model_sampled {
            _ if let Some(valid) = counted => Some(match valid.value < 1.0 {
                true => (1.0 - valid.value + verdict::ERRORS * valid.error).min(1.0),
                false => 0.0,
            }),
            _ if self.missing.without_value == 0 => Some(0.0),
            Some(sampled) => Some(sampled.failed as f64 / (sampled.failed + sampled.samples) as f64),
            // Check points bound the share by the places at which the model has no value.
            None => located,
        };
        Some(verdict::share(verdict::losing(around, lost)))
    }

    /// Judges a requirement, which need not be the characteristic's own.
    pub(crate) fn judge(&self, requirement: Requirement) -> Judged {
        Judged::by(requirement, self).unless(self.missing.unfinished)
    }

    /// True if the formula's own degree proves that it is linear: the slopes are exact everywhere.
    pub fn is_proven_linear(&self) -> bool {
        self.evidence.verification.as_ref().and_then(|of| of.degree).is_some_and(|degree| degree <= 1)
    }

    /// Coefficient of variation, `sigma / |mean|`, with its error from those of mean and sigma. Returns None if one of them is unknown, and
    /// if a mean of 0 lies within three errors.
    pub fn coefficient_of_variation(&self) -> Option<Verified> {
        let (moments, estimate) = (self.moments?, self.error_estimate.as_ref()?);
        let (mean, sigma) = (moments.mean().abs(), moments.sigma());
        let [of_mean, of_sigma] = [estimate.mean?, estimate.sigma?];
        let value = sigma / mean;
        (mean > 3.0 * of_mean).then(|| Verified { value, error: libm::hypot(of_sigma, value * of_mean) / mean })
    }

    /// Verdicts on the characteristic.
    pub(super) fn verdicts(&self) -> Verdicts {
        Verdicts::by(&self.characteristic, |requirement| self.judge(requirement))
    }

    /// Verdicts on all requirements of the characteristic, its target yield included.
    pub fn requirements(&self) -> Vec<Judged> {
        self.verdicts().requirements
    }

    /// Verdict on the target yield. Returns None if there is no target.
    pub fn verdict(&self) -> Option<Verdict> {
        self.verdicts().verdict
    }

    /// True if the target yield is met. Returns None if there is no target, and if it is unknown.
    pub fn met(&self) -> Option<bool> {
        self.verdict()?.met()
    }

    /// Creates the analysis without the list of interactions. The shares are for [`listed`](crate::analysis::result::interaction_listing::listed), which makes that
    /// list.
    pub(in crate::analysis) fn of(problem: &Problem, outcome: &Outcome, c: usize) -> (Self, Option<Shares>) {
        let fitted = &outcome.fitted[c];
        let plan = &outcome.plan;
        let shares = shares_of(outcome, c);
        let sensitivities: Vec<Sensitivity> =
            (0..problem.dimensions().len()).map(|d| sensitivity(problem, outcome, c, d, shares.as_ref())).collect();
        let characteristic = problem.characteristics()[c].clone();
        let moments = shares.as_ref().map(Shares::moments);
        let sampled = shares.as_ref().and_then(Shares::sampled);
        let law = moments.map(|moments| Law::fit(&moments));
        let capability = |law: &Law| {
            moments.map(|moments| {
                let (limits, kept) = (characteristic.limits(), problem.kept_limits(c));
                Capability::of_kept(law, moments.mean(), moments.sigma(), limits, kept)
            })
        };
        let normal = moments.and_then(|moments| capability(&Law::normal(&moments).ok()?));
        let error_estimate = moments.and_then(|moments| error_estimate_of(problem, outcome, c, &moments));
        let linear = linear(problem, plan.varying(), &sensitivities);
        let middle = fitted.nominal.zip(linear).map(|(nominal, linear)| nominal + linear.middle);
        let left_out_share = left_out_share(outcome, c, shares.as_ref(), &sensitivities);
        let one = Self {
            characteristic: characteristic.clone(),
            nominal: fitted.nominal,
            moments,
            error_estimate,
            distribution: DistributionFigures::by(law.as_ref().and_then(|law| capability(law.as_ref().ok()?))),
            range: RangeFigures {
                worst_case: middle
                    .zip(linear)
                    .map(|(middle, linear)| [middle - linear.worst_case, middle + linear.worst_case]),
                curved: curved(problem, outcome, c),
                extremes: None,
                bounds: None,
            },
            linear: LinearFigures {
                middle,
                rss: linear.map(|linear| linear.rss),
                inflated_rss: linear.map(|linear| linear.inflated_rss),
                mean_shift_rss: linear.map(|linear| linear.mean_shift_rss),
                six_sigma: linear.and_then(|linear| linear.six_sigma),
            },
            sensitivities,
            contributions: ContributionFigures {
                interactions: InteractionList::default(),
                interactions_remainder: None,
                possible_interactions: plan.pairs_of(c),
                examined_interactions: fitted.known_pairs,
                left_out_share,
                indices: None,
            },
            evidence: Evidence {
                sampled,
                model_sampled: None,
                tail_sampled: None,
                verification: None,
                surface_law: None,
                density: None,
                residual: fitted.residual,
                law,
                pearson: None,
                normal,
                sampling: None,
            },
            missing: MissingPoints {
                unfinished: false,
                without_value: outcome.evaluated.known.errors().filter(|&(_, of, _)| of == c).count(),
            },
            constant: plan.varying().iter().all(|&d| !plan.depends(c, d)),
        };
        (one, shares)
    }
}

/// The shares of the variance. None if its moments are not finite.
fn shares_of(outcome: &Outcome, c: usize) -> Option<Shares> {
    let unexplained = outcome.climbed.as_ref().and_then(|climbed| climbed.unexplained(c));
    // A variance beyond the largest double is unknown; the warning `overflow` says why.
    let finite = |shares: &Shares| [shares.moments().mean(), shares.moments().sigma()].iter().all(|x| x.is_finite());
    Shares::of(&outcome.fitted[c], outcome.plan.inputs()).map(|shares| shares.beside(unexplained)).filter(finite)
}

/// The errors of the moments, with that of the yield.
fn error_estimate_of(problem: &Problem, outcome: &Outcome, c: usize, moments: &Moments) -> Option<ErrorEstimate> {
    let estimate = estimate(problem, outcome, c, moments)?;
    let yield_ = of_yield(&estimate, moments, problem.characteristics()[c].limits());
    Some(ErrorEstimate { yield_, ..estimate })
}

/// The share of the variance that no contribution explains. None if it is unknown.
fn left_out_share(outcome: &Outcome, c: usize, shares: Option<&Shares>, sensitivities: &[Sensitivity]) -> Option<f64> {
    let pair_shares = || pairs_of(outcome, c).map(|index| share_of(outcome, c, index, shares));
    let explained = || {
        let own = sensitivities.iter().flat_map(|one| [one.linear_share, one.curvature_share]).flatten().sum::<f64>();
        own + pair_shares().flatten().sum::<f64>()
    };
    let complete = || {
        let (plan, fitted) = (&outcome.plan, &outcome.fitted[c]);
        outcome.order == Order::Second
            && fitted.known_pairs == plan.pairs_of(c)
            && pair_shares().all(|share| share.is_some())
            && plan.varying().iter().all(|&d| fitted.parts[d].is_some_and(|part| part.degree() >= 2))
    };
    let unexplained = outcome.climbed.as_ref().and_then(|climbed| climbed.unexplained(c));
    match (shares?, unexplained) {
        (Shares::Integrated(integrated), _) => integrated.left_out,
        (known, Some(_)) if known.moments().sigma() > 0.0 => {
            Some(1.0 - explained()).map(|share| if share.abs() < 1e-12 { 0.0 } else { share })
        }
        _ if complete() => Some(0.0),
        _ => None,
    }
}

/// `sum of |f_jj| h_j^2/2 + sum of |f_jk| h_j h_k` over the half bands `h`: no corner of a second-order surface lies farther from the linear one.
/// None with an estimate in the place of a derivative: it bounds nothing.
fn curved(problem: &Problem, outcome: &Outcome, c: usize) -> Option<f64> {
    if outcome.fitted[c].screened > 0 {
        return None;
    }
    let half = |d: usize| problem.dimensions()[d].half_band();
    let own = |d: usize| match half(d) {
        0.0 => Some(0.0),
        half => Some(curvature(outcome, c, d)?.abs().times(0.5).times(half).times(half).value()),
    };
    let both = |index: usize| {
        let [j, k] = dimensions_of(outcome, index).map(half);
        Some(mixed_of(outcome, c, index)?.abs().times(j).times(k).value())
    };
    let own = (0..problem.dimensions().len()).map(own).sum::<Option<f64>>()?;
    Some(own + pairs_of(outcome, c).map(both).sum::<Option<f64>>()?)
}

/// Exact first and second derivative by a dimension. Returns None if one of them is unknown.
fn exact_derivatives(outcome: &Outcome, c: usize, d: usize) -> Option<[Wide; 2]> {
    let exact = outcome.fitted[c].exact.as_ref()?;
    match outcome.plan.depends(c, d) {
        true => exact.slope(d).zip(exact.curvature(d)).map(<[Wide; 2]>::from),
        false => Some([Wide::of(0.0); 2]),
    }
}

/// Second derivative of a characteristic by a dimension: exact if it is known, else a difference.
pub(in crate::analysis) fn curvature(outcome: &Outcome, c: usize, d: usize) -> Option<Wide> {
    if let Some([_, second]) = exact_derivatives(outcome, c, d) {
        return Some(second);
    }
    let (plan, second) = (&outcome.plan, outcome.fitted[c].parts[d]?.second()?);
    // A characteristic that cannot depend on a dimension has slope 0, evaluated or not.
    Some(match plan.depends(c, d) {
        true => Wide::of(second).over(plan.axis(d).scale).over(plan.axis(d).scale),
        false => Wide::of(0.0),
    })
}

/// Sensitivity of a characteristic to dimension `d`.
fn sensitivity(problem: &Problem, outcome: &Outcome, c: usize, d: usize, shares: Option<&Shares>) -> Sensitivity {
    let (plan, dimension) = (&outcome.plan, &problem.dimensions()[d]);
    let part = outcome.fitted[c].parts[d];
    let axis = plan.axis(d);
    let scale = axis.scale;
    let exact = exact_derivatives(outcome, c, d);
    // Second derivatives by a dimension of extreme size fit a double only in the characteristic's own unit.
    let in_unit = |second: Wide| second.times_power(problem.power(c)).checked();
    let rounding = outcome.fitted[c].centre.filter(|_| plan.depends(c, d)).and_then(|centre| {
        let slope = |step: f64| f64::EPSILON * centre.abs() / step;
        let second = |factor: f64, step: f64| {
            in_unit(Wide::of(f64::EPSILON * centre.abs()).over(step).times(factor).over(step)).unwrap_or(f64::NAN)
        };
        let nearest = axis.nearest_step();
        match exact {
            Some(_) => Some([slope(scale), second(1.0, scale)]),
            None if axis.slots.is_empty() => None,
            None => Some([slope(nearest), second(4.0, nearest)]),
        }
    });
    // A characteristic that cannot depend on a dimension has slope 0, evaluated or not.
    let per_unit = |value: f64| if plan.depends(c, d) { value / scale } else { 0.0 };
    let position = plan.varying().iter().position(|&varying| varying == d);
    let of = |share: fn(&Shares, usize) -> Option<f64>| match (position, shares) {
        (Some(position), Some(shares)) => share(shares, position),
        // A dimension that does not vary, or has no effect, adds nothing.
        (None, Some(_)) => Some(0.0),
        (_, None) => None,
    };
    let curved = |share: Option<f64>| match outcome.order {
        _ if matches!(shares, Some(Shares::Integrated(_))) => share,
        Order::Second if part.is_none_or(|part| part.degree() >= 2) || position.is_none() => share,
        _ => None,
    };
    Sensitivity {
        dimension: dimension.name().to_owned(),
        first: exact.map(|[first, _]| first.value()).or(part.map(|part| per_unit(part.slope()))),
        second: curvature(outcome, c, d).and_then(in_unit),
        exact: exact.is_some(),
        origin: origin(outcome, c, position),
        rounding,
        steps: match plan.depends(c, d) {
            true => plan.samples(&outcome.evaluated.known, c, d).unwrap_or_default(),
            false => Vec::new(),
        }
        .into_iter()
        .map(|(u, _)| u * scale)
        .collect(),
        linear_share: of(Shares::linear),
        curvature_share: curved(of(Shares::curvature)),
        mean_shift: curved(of(Shares::mean_shift)),
        first_order: None,
        total: None,
    }
}

/// Source of the part of a varying dimension in the surface, or in the variance if there is no surface.
fn origin(outcome: &Outcome, c: usize, position: Option<usize>) -> Option<DerivativeOrigin> {
    let (fitted, position) = (&outcome.fitted[c], position?);
    match &fitted.integrated {
        Some(integrated) => integrated.own[position].map(|_| DerivativeOrigin::Evaluated),
        None => fitted.surrogate.as_ref()?.parts[position].map(|part| part.origin()),
    }
}

/// Linear results, from slopes and bands. Returns None if a slope is missing.
fn linear(problem: &Problem, varying: &[usize], sensitivities: &[Sensitivity]) -> Option<Linear> {
    let slopes: Option<Vec<(f64, usize)>> = varying.iter().map(|&d| Some((sensitivities[d].first?, d))).collect();
    Some(Linear::of(problem, &slopes?))
}
