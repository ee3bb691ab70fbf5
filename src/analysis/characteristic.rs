//! What is known of one characteristic.

use crate::capability::{Capability, Law};
use crate::characteristic::Characteristic;
use crate::extremes::Extremes;
use crate::method::{Order, Outcome};
use crate::moments::{Contributions, Moments};
use crate::pearson::PearsonError;
use crate::problem::Problem;

/// Moments, sensitivities and contributions of one characteristic. What is unknown is None.
#[derive(Debug, Clone, PartialEq)]
pub struct CharacteristicAnalysis {
    /// The characteristic, with its limits.
    pub characteristic: Characteristic,
    /// Its value at the nominal dimensions.
    pub nominal: Option<f64>,
    /// Its first four moments.
    pub moments: Option<Moments>,
    /// The distribution that has these moments, or why none has.
    pub law: Option<Result<Law, PearsonError>>,
    /// How that keeps the limits.
    pub capability: Option<Capability>,
    /// How the normal distribution with the same mean and sigma would.
    pub normal: Option<Capability>,
    /// The interval that no assembly of a linear model leaves: around the nominal, every dimension at the end of its
    /// band that hurts.
    pub worst_case: Option<[f64; 2]>,
    /// The least and the greatest value in the box of the tolerance bands, where they were searched and found.
    pub extremes: Option<Extremes>,
    /// `sqrt(sum of (slope x half band)^2)`; three sigma where a dimension has no band.
    pub rss: Option<f64>,
    /// For every dimension of the problem, in order.
    pub sensitivities: Vec<Sensitivity>,
    /// The interactions examined, strongest first.
    pub interactions: Vec<Interaction>,
    /// How many interactions it can have.
    pub possible_interactions: usize,
    /// The share of the variance that no contribution accounts for; None where it is unknown.
    pub left_out_share: Option<f64>,
}

/// What one dimension does to a characteristic.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// The dimension.
    pub dimension: String,
    /// First derivative at the mean, in units of the characteristic per unit of the dimension.
    pub first: Option<f64>,
    /// Second derivative at the mean.
    pub second: Option<f64>,
    /// What a rounding error of the characteristic's own size may make of the two derivatives, at the steps taken.
    pub rounding: Option<[f64; 2]>,
    /// Share of the variance that the best straight line through its own part explains.
    pub linear_share: Option<f64>,
    /// Share of the variance that its curvature adds.
    pub curvature_share: Option<f64>,
    /// How far its curvature moves the mean.
    pub mean_shift: Option<f64>,
}

/// What two dimensions do together.
#[derive(Debug, Clone, PartialEq)]
pub struct Interaction {
    /// The two dimensions.
    pub dimensions: [String; 2],
    /// Mixed second derivative at the means; None where it was lost.
    pub mixed: Option<f64>,
    /// What rounding errors of the characteristic's own size may make of it, at the steps taken.
    pub rounding: Option<f64>,
    /// Share of the variance.
    pub share: Option<f64>,
}

impl CharacteristicAnalysis {
    /// All shares of its dimension: straight line and curvature.
    pub fn share(&self, dimension: usize) -> Option<f64> {
        let sensitivity = &self.sensitivities[dimension];
        Some(sensitivity.linear_share? + sensitivity.curvature_share.unwrap_or(0.0))
    }

    /// Whether its target yield is met; None where it has none, or its yield is unknown.
    pub fn met(&self) -> Option<bool> {
        self.capability?.meets(self.characteristic.target_yield())
    }

    pub(super) fn of(problem: &Problem, outcome: &Outcome, c: usize) -> Self {
        let fitted = &outcome.fitted[c];
        let plan = &outcome.plan;
        let contributions = fitted.surrogate.as_ref().and_then(|surrogate| surrogate.contributions(plan.shapes()));
        let sensitivities: Vec<Sensitivity> = (0..problem.dimensions().len())
            .map(|d| sensitivity(problem, outcome, c, d, contributions.as_ref()))
            .collect();
        let interactions = interactions(problem, outcome, c, contributions.as_ref());
        let n = plan.varying().len();
        let possible_interactions = (0..n).map(|j| (j + 1..n).filter(|&k| plan.joint(c, j, k)).count()).sum::<usize>();
        let complete = outcome.order == Order::Second
            && interactions.len() == possible_interactions
            && interactions.iter().all(|interaction| interaction.share.is_some())
            && plan.varying().iter().all(|&d| fitted.parts[d].is_some_and(|part| part.degree() >= 2));
        let characteristic = problem.characteristics()[c].clone();
        let moments = contributions.as_ref().map(|contributions| contributions.moments);
        let law = moments.map(|moments| Law::fit(&moments));
        let capability = |law: &Law| {
            moments.map(|moments| Capability::of(law, moments.mean(), moments.sigma(), characteristic.limits()))
        };
        let normal = moments.and_then(|moments| capability(&Law::normal(&moments).ok()?));
        let (worst_case, rss) = first_order(problem, plan.varying(), &sensitivities, fitted.nominal);
        Self {
            nominal: fitted.nominal,
            moments,
            capability: law.as_ref().and_then(|law| capability(law.as_ref().ok()?)),
            normal,
            law,
            characteristic,
            worst_case,
            extremes: None,
            rss,
            sensitivities,
            interactions,
            possible_interactions,
            left_out_share: (complete && contributions.is_some()).then_some(0.0),
        }
    }
}

fn sensitivity(
    problem: &Problem,
    outcome: &Outcome,
    c: usize,
    d: usize,
    contributions: Option<&Contributions>,
) -> Sensitivity {
    let (plan, dimension) = (&outcome.plan, &problem.dimensions()[d]);
    let part = outcome.fitted[c].parts[d];
    let axis = plan.axis(d);
    let scale = axis.scale;
    let rounding = outcome.fitted[c].centre.filter(|_| !axis.slots.is_empty() && plan.depends(c, d)).map(|centre| {
        let slope = f64::EPSILON * centre.abs() / axis.nearest_step();
        [slope, 4.0 * slope / axis.nearest_step()]
    });
    // A characteristic that cannot depend on a dimension has slope 0, evaluated or not.
    let per_unit = |value: f64| if plan.depends(c, d) { value / scale } else { 0.0 };
    let position = plan.varying().iter().position(|&varying| varying == d);
    let of = |shares: fn(&Contributions) -> &Vec<f64>| match (position, contributions) {
        (Some(position), Some(contributions)) => Some(shares(contributions)[position]),
        // What does not vary, or has no effect, adds nothing.
        (None, Some(_)) => Some(0.0),
        (_, None) => None,
    };
    let curved = |share: Option<f64>| match outcome.order {
        Order::Second if part.is_none_or(|part| part.degree() >= 2) || position.is_none() => share,
        _ => None,
    };
    Sensitivity {
        dimension: dimension.name().to_owned(),
        first: part.map(|part| per_unit(part.slope())),
        second: part.and_then(|part| part.second()).map(|second| per_unit(per_unit(second))),
        rounding,
        linear_share: of(|contributions| &contributions.linear),
        curvature_share: curved(of(|contributions| &contributions.curvature)),
        mean_shift: curved(of(|contributions| &contributions.mean_shift)),
    }
}

/// Of the pairs on which the characteristic can depend, strongest first.
fn interactions(
    problem: &Problem,
    outcome: &Outcome,
    c: usize,
    contributions: Option<&Contributions>,
) -> Vec<Interaction> {
    let plan = &outcome.plan;
    let examined = outcome.pairs.iter().zip(&outcome.fitted[c].mixed).filter(|((j, k), _)| plan.joint(c, *j, *k));
    let mut interactions: Vec<Interaction> = examined
        .map(|(&(j, k), mixed)| {
            let [j, k] = [j, k].map(|position| plan.varying()[position]);
            let share = |value: f64| contributions.map(|contributions| (value * contributions.per_sigma).powi(2));
            Interaction {
                dimensions: [j, k].map(|d| problem.dimensions()[d].name().to_owned()),
                mixed: mixed.map(|mixed| mixed.value / plan.axis(j).scale / plan.axis(k).scale),
                rounding: outcome.fitted[c].centre.map(|centre| {
                    4.0 * f64::EPSILON * centre.abs() / plan.axis(j).nearest_step() / plan.axis(k).nearest_step()
                }),
                share: mixed.and_then(|mixed| share(mixed.value)),
            }
        })
        .collect();
    let strength = |interaction: &Interaction| interaction.share.unwrap_or(-1.0);
    interactions.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
    interactions
}

/// The linear worst case and the RSS; None where a slope is missing.
fn first_order(
    problem: &Problem,
    varying: &[usize],
    sensitivities: &[Sensitivity],
    nominal: Option<f64>,
) -> (Option<[f64; 2]>, Option<f64>) {
    let slopes: Option<Vec<(f64, usize)>> = varying.iter().map(|&d| Some((sensitivities[d].first?, d))).collect();
    let Some(slopes) = slopes else { return (None, None) };
    let (mut down, mut up, mut rss) = (0.0, 0.0, 0.0f64);
    for (slope, d) in slopes {
        let dimension = &problem.dimensions()[d];
        let [a, b] = dimension.reach().map(|deviation| slope * deviation);
        down += a.min(b);
        up += a.max(b);
        rss = rss.hypot(slope * dimension.half_band());
    }
    (nominal.map(|nominal| [nominal + down, nominal + up]), Some(rss))
}
