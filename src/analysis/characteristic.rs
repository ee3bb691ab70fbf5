//! The results of one characteristic.

use serde::{Serialize, Serializer};

use super::coverage_intervals::CoverageIntervals;
use super::errors::of_yield;
use super::interactions::{dimensions_of, mixed_of, pairs_of, share_of};
use super::linear::Linear;
use super::remainder::Remainder;
use super::shares::Shares;
use super::sobol::SobolIndices;
use super::{
    InteractionList, SampledModel, SamplingInterval, SurfaceShares, Verification, VerificationKind, YieldSource,
};
use crate::extremes::{Extremes, ExtremesProof};
use crate::method::{ErrorEstimate, Order, Outcome, Residual, estimate};
use crate::problem::Problem;
use sensitol_numeric::capability::{Capability, CapabilityShape, EstimatedShare, InspectionRisks, Law};
use sensitol_numeric::characteristic::{Characteristic, SpecLimits};
use sensitol_numeric::moments::{Moments, Sampled};
use sensitol_numeric::pearson::PearsonError;
use sensitol_numeric::power::{Rescale, Rescaling, Wide, rescale};
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::shape::{Four, RejectIntervals, through};
use sensitol_numeric::surrogate::DerivativeOrigin;
use sensitol_numeric::verdict::{self, Judged, Verdict};

/// Moments, sensitivities and contributions of one characteristic. Unknown values are None.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
pub struct CharacteristicAnalysis {
    /// The characteristic, with its limits.
    #[serde(flatten)]
    pub characteristic: Characteristic,
    /// Its value at the nominal dimensions.
    pub nominal: Option<f64>,
    /// Its first four moments.
    #[serde(flatten, serialize_with = "through::<Four<Option<f64>>, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Four<Option<f64>>"))]
    pub moments: Option<Moments>,
    /// Their uncertainty from sampling the surrogate of correlated inputs; None where they are exact.
    #[serde(rename = "surrogate_sampling")]
    pub sampled: Option<Sampled>,
    /// Points of the model that the moments rest on, in place of a surrogate that was not trusted.
    #[serde(rename = "model_sampling")]
    pub model_sampled: Option<SampledModel>,
    /// The verification of these results by the model itself; None where they were not verified.
    #[cfg_attr(feature = "schema", schemars(with = "Option<super::verified::VerificationShape>"))]
    pub verification: Option<Verification>,
    /// The results of its surface distribution; None where its moments follow from no surface.
    #[cfg_attr(feature = "schema", schemars(with = "Option<super::surface_law::SurfaceLawShape>"))]
    pub surface_law: Option<SurfaceShares>,
    /// The density of that law as `[y, density, error]`, to be drawn; None unless [asked for](crate::Options::densities), and where the
    /// law has none.
    #[serde(skip)]
    pub density: Option<Vec<[f64; 3]>>,
    /// The source of its yield; None without a yield.
    pub yield_source: Option<YieldSource>,
    /// Whether planned points were not evaluated because the run was stopped: no verdict follows from the others.
    pub unfinished: bool,
    /// Evaluated points at which it has no value.
    pub without_value: usize,
    /// How far these results may be off; None without moments.
    pub error_estimate: Option<ErrorEstimate>,
    /// How far a fitted surface misses the values that it was fitted to; None where nothing was fitted.
    #[serde(rename = "least_squares")]
    pub residual: Option<Residual>,
    /// The distribution that has these moments, or why none has.
    #[serde(rename = "distribution", serialize_with = "fitted")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<Law>"))]
    pub law: Option<Result<Law, PearsonError>>,
    /// How the limits are kept, by the best that is known ([`yield_source`](Self::yield_source)); quantiles by the law of the
    /// surface, where there is one.
    #[serde(flatten, serialize_with = "through::<CapabilityShape, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "CapabilityShape"))]
    pub capability: Option<Capability>,
    /// The 95 % intervals of the shares below and above the limits, each by itself: 0 to 0 where a proof excludes a side, None without that
    /// limit and where it is not known.
    #[serde(flatten, serialize_with = "through::<RejectIntervals, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "RejectIntervals"))]
    pub reject_intervals: [Option<[f64; 2]>; 2],
    /// How the distribution with its moments keeps them: the Pearson fit.
    #[serde(rename = "pearson_fit")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<CapabilityShape>"))]
    pub pearson: Option<Capability>,
    /// How the normal distribution with the same mean and sigma would.
    #[serde(rename = "normal_fit")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<CapabilityShape>"))]
    pub normal: Option<Capability>,
    /// Intervals that hold the share of assemblies that was asked for; None where none was.
    pub coverage: Option<CoverageIntervals>,
    /// The risks of its inspection; None without a gauge.
    pub inspection: Option<InspectionRisks>,
    /// How far the results may be off because measured dimensions are known by samples; None where there are none.
    #[serde(rename = "sampling_interval")]
    pub sampling: Option<SamplingInterval>,
    /// The interval that no assembly of a linear model leaves: around the nominal, every dimension at the end of its
    /// band that hurts, and a point of a circular zone ([`Dimension::within_zone`](crate::Dimension::within_zone)) at its edge.
    #[serde(skip)]
    pub worst_case: Option<[f64; 2]>,
    /// The most that curvatures and interactions add to the worst case, by the surface; None where a curvature is missing.
    #[serde(skip)]
    pub curved: Option<f64>,
    /// The least and the greatest value in the box of the tolerance bands, where they were searched and found.
    #[serde(skip)]
    pub extremes: Option<Extremes>,
    /// An interval that no assembly leaves, by interval arithmetic; of formulas that are verified, where no extremes were searched.
    #[serde(skip)]
    pub bounds: Option<ExtremesProof>,
    /// The value of a linear model with every dimension in the middle of its band: the middle of the worst case, of the RSS and of
    /// the two inflations of it. The nominal where all bands are symmetric.
    pub middle: Option<f64>,
    /// `sqrt(t'R t)` with `t` = slope x half band (three sigma where a dimension has no band) and the correlation `R`:
    /// without correlation the root of the sum of squares.
    pub rss: Option<f64>,
    /// 1.5 times the RSS (Bender 1962, 1968), or by the factors of the study.
    pub inflated_rss: Option<f64>,
    /// RSS with means that are off by half their half bands, 1.5 sigma of 3, all the wrong way:
    /// `0.5 sum of |slope| x half band + 0.5 rss` (Greenwood and Chase 1987 with m = 0.5).
    pub mean_shift_rss: Option<f64>,
    /// `sqrt(sum of (slope x sigma/(1 - k))^2)` with sigma of a lot and the shift `k` of its mean in half bands, by `cpk`, `drift` or `shift`
    /// (Harry and Stewart 1988): a sigma, not an interval. None where every mean is in the middle of its band, or one at its end.
    pub six_sigma: Option<f64>,
    /// For every dimension of the problem, in order.
    pub sensitivities: Vec<Sensitivity>,
    /// The interactions examined, strongest first.
    #[cfg_attr(feature = "schema", schemars(with = "Vec<super::Interaction<'_>>"))]
    pub interactions: InteractionList,
    /// The sum of the interactions that are not listed one by one; None where all are.
    pub interactions_remainder: Option<Remainder>,
    /// How many interactions it can have.
    pub possible_interactions: usize,
    /// How many of them were examined, or are known from its formula.
    pub examined_interactions: usize,
    /// The share of the variance that no contribution accounts for; None where it is unknown.
    pub left_out_share: Option<f64>,
    /// The source of the Sobol' indices of its [`sensitivities`](Self::sensitivities); None where it does not vary.
    #[serde(rename = "sobol")]
    pub indices: Option<SobolIndices>,
    /// Whether it can depend on nothing that varies, so that its one value is all that there is.
    pub constant: bool,
}

/// The effect of one dimension on a characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sensitivity {
    /// The dimension.
    pub dimension: String,
    /// First derivative at the mean, in units of the characteristic per unit of the dimension.
    pub first: Option<f64>,
    /// Second derivative at the mean.
    pub second: Option<f64>,
    /// Whether both are exact rather than differences.
    pub exact: bool,
    /// The source of its shares: `exact`, `evaluated`, or `screened` where an estimate has a part in them. None where it has no shares.
    pub origin: Option<DerivativeOrigin>,
    /// The largest effect of a rounding error of the characteristic's own size on the two derivatives: at the steps taken, over a
    /// sigma where they are exact.
    pub rounding: Option<[f64; 2]>,
    /// Where the model was evaluated along it, off its mean and in its unit, ascending: the nodes that answered; empty where none
    /// was asked.
    pub steps: Vec<f64>,
    /// Share of the variance that the best straight line through its own part explains.
    pub linear_share: Option<f64>,
    /// Share of the variance that its curvature adds.
    pub curvature_share: Option<f64>,
    /// How far its curvature moves the mean.
    pub mean_shift: Option<f64>,
    /// First-order Sobol' index: the part of the variance that it explains by itself; None of a dimension that varies together with others.
    pub first_order: Option<EstimatedShare>,
    /// Total Sobol' index: with every interaction in which it has a part.
    pub total: Option<EstimatedShare>,
}

rescale!(CharacteristicAnalysis {
    nominal, moments, sampled, model_sampled, verification, surface_law, error_estimate, residual, law, coverage, inspection, sampling,
    worst_case, curved, extremes, bounds, middle, rss, inflated_rss, mean_shift_rss, six_sigma, sensitivities, interactions,
} without {
    characteristic, yield_source, unfinished, without_value, capability, pearson, normal, reject_intervals, interactions_remainder, possible_interactions, examined_interactions,
    left_out_share, indices, constant, density,
});

impl Rescale for Sensitivity {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.first.rescale(by);
        // That of the second derivative is in the characteristic's unit already, as the derivative itself.
        self.rounding.iter_mut().for_each(|[first, _]| first.rescale(by));
        self.mean_shift.rescale(by);
    }
}

/// The distribution that has the moments; null where there is none.
fn fitted<S: Serializer>(law: &Option<Result<Law, PearsonError>>, serializer: S) -> Result<S::Ok, S::Error> {
    law.as_ref().and_then(|law| law.as_ref().ok()).serialize(serializer)
}

impl CharacteristicAnalysis {
    /// All shares of its dimension: straight line and curvature.
    pub fn share(&self, dimension: usize) -> Option<f64> {
        let sensitivity = &self.sensitivities[dimension];
        Some(sensitivity.linear_share? + sensitivity.curvature_share.unwrap_or(0.0))
    }

    /// The bounds of its worst case by interval arithmetic: beside the extremes where these were searched.
    pub fn proof(&self) -> Option<&ExtremesProof> {
        self.extremes.as_ref().map_or(self.bounds.as_ref(), |found| found.proof.as_ref())
    }

    /// Within which the yield is known: the estimate and two of its errors, with what measured samples leave open, and down to 0 where
    /// there are assemblies without a value and they were not counted. None where an error is unknown.
    pub fn yield_interval(&self) -> Option<[f64; 2]> {
        let value = self.capability?.yield_()?;
        let error = if self.constant { Some(0.0) } else { self.error_estimate.as_ref().and_then(|of| of.yield_) };
        let around = verdict::about(value, error)?;
        let around = match &self.sampling {
            Some(measured) => {
                measured.rejected.map(|[low, high]| verdict::joined(value, around, [1.0 - high, 1.0 - low]))?
            }
            None => around,
        };
        // How many assemblies have no value, only samples tell.
        let counted =
            self.verification.as_ref().filter(|of| of.kind == VerificationKind::Sample).and_then(|of| of.valid);
        let lost = match &self.model_sampled {
            _ if let Some(valid) = counted => Some(match valid.value < 1.0 {
                true => (1.0 - valid.value + verdict::ERRORS * valid.error).min(1.0),
                false => 0.0,
            }),
            _ if self.without_value == 0 => Some(0.0),
            Some(sampled) => Some(sampled.failed as f64 / (sampled.failed + sampled.samples) as f64),
            None => None,
        };
        Some(verdict::share(verdict::losing(around, lost)))
    }

    /// How a requirement is kept, whether or not it is the characteristic's own.
    ///
    /// The interval of a yield is [`yield_interval`](Self::yield_interval); that of a Cpk and of sigma follows from the estimated
    /// errors of mean and sigma, and from what measured samples leave open of them; rss is what it is by the slopes, without an error; the
    /// worst case lies between what was found and what interval arithmetic excludes.
    pub(crate) fn judge(&self, requirement: Requirement) -> Judged {
        let limits = self.characteristic.limits();
        let error = |of: fn(&ErrorEstimate) -> Option<f64>| match self.constant {
            true => Some(0.0),
            false => self.error_estimate.as_ref().and_then(of),
        };
        let (mean, sigma) = (error(|of| of.mean), error(|of| of.sigma));
        let part = |value: Option<f64>| (value, value.map(|value| [value; 2]));
        // Of measured samples whose uncertainty is unknown there is no interval.
        let measured =
            |value: Option<f64>, own: Option<[f64; 2]>, of: fn(&SamplingInterval) -> Option<[f64; 2]>| match &self
                .sampling
            {
                Some(sampling) => Some(verdict::joined(value?, own?, of(sampling)?)),
                None => own,
            };
        let (value, interval) = match requirement {
            Requirement::Yield(_) => (self.capability.and_then(|of| of.yield_()), self.yield_interval()),
            Requirement::Cpk(_) => {
                let value = self.capability.and_then(|of| of.cpk);
                let own = self.moments.and_then(|of| verdict::of_cpk((of.mean(), mean), (of.sigma(), sigma), limits));
                (value, measured(value, own, |of| of.cpk))
            }
            Requirement::Sigma(_) => {
                let value = self.moments.map(|of| of.sigma());
                let own = value.and_then(|value| verdict::about(value, sigma));
                (value, measured(value, own, |of| of.sigma).map(|[low, high]| [low.max(0.0), high]))
            }
            Requirement::Rss => {
                part(self.middle.zip(self.rss).and_then(|(middle, rss)| taken(limits, middle, [rss; 2])))
            }
            Requirement::WorstCase => {
                self.worst_case_taken().map_or((None, None), |(value, within)| (Some(value), within))
            }
        };
        Judged::of(requirement, value, interval).unless(self.unfinished)
    }

    /// The part of the room that the worst case takes, and within which that is known: between values that exist and what interval arithmetic
    /// excludes where the formula has bounds; by the slopes where it is proven to be linear; by the surface otherwise.
    fn worst_case_taken(&self) -> Option<(f64, Option<[f64; 2]>)> {
        let (nominal, linear) = self.nominal.zip(self.worst_case)?;
        let part = |[low, high]: [f64; 2], more: f64| {
            let reach = [nominal - low, high - nominal].map(|reach| (reach + more).max(0.0));
            taken(self.characteristic.limits(), nominal, reach)
        };
        let by_slopes = part(linear, 0.0)?;
        if self.constant {
            return Some((by_slopes, Some([by_slopes; 2])));
        }
        if let Some(proof) = self.proof().filter(|proof| proof.proven) {
            let ([low, high], [below, above]) = (proof.bounds, proof.slack);
            let most = part(proof.bounds, 0.0)?;
            let reached = part([low + below, high - above], 0.0)?;
            return Some((most, Some([reached.min(most), most])));
        }
        if self.is_proven_linear() {
            return Some((by_slopes, Some([by_slopes; 2])));
        }
        let found = self.extremes.as_ref().and_then(|found| part([found.least.value, found.greatest.value], 0.0));
        if let Some(proof) = self.proof() {
            let most = part(proof.bounds, 0.0)?;
            let least = found.unwrap_or(0.0).min(most);
            return Some((found.unwrap_or(by_slopes), Some([least, most])));
        }
        let around = self.curved.and_then(|curved| Some([part(linear, -curved)?, part(linear, curved)?]));
        Some(match found {
            // A search that proves nothing shows what is reached, and no more.
            Some(found) => (found, around.map(|[_, most]| [found, found.max(most)])),
            None => (by_slopes, around),
        })
    }

    /// Whether the formula's own degree proves that the slopes tell everything.
    pub fn is_proven_linear(&self) -> bool {
        let kind = self.verification.as_ref().map(|of| of.kind);
        matches!(kind, Some(VerificationKind::Exact { degree: 0 | 1 }))
    }

    /// How everything is kept that is required of it: its target yield, and what else there is.
    pub fn requirements(&self) -> Vec<Judged> {
        verdict::judged(&self.characteristic, |requirement| self.judge(requirement))
    }

    /// The verdict on its target yield; None without one.
    pub fn verdict(&self) -> Option<Verdict> {
        self.characteristic.target_yield().map(|target| self.judge(Requirement::Yield(target)).verdict)
    }

    /// Whether its target yield is met; None where it has none, and where that is not known.
    pub fn met(&self) -> Option<bool> {
        self.verdict()?.met()
    }

    /// Without the list of its interactions, and what [`listed`](super::interactions::listed) makes that of.
    pub(super) fn of(problem: &Problem, outcome: &Outcome, c: usize) -> (Self, Option<Shares>) {
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
            nominal: fitted.nominal,
            moments,
            sampled,
            residual: fitted.residual,
            capability: law.as_ref().and_then(|law| capability(law.as_ref().ok()?)),
            normal,
            reject_intervals: [None; 2],
            law,
            sampling: None,
            coverage: None,
            inspection: None,
            characteristic,
            worst_case: middle
                .zip(linear)
                .map(|(middle, linear)| [middle - linear.worst_case, middle + linear.worst_case]),
            curved: curved(problem, outcome, c),
            middle,
            rss: linear.map(|linear| linear.rss),
            inflated_rss: linear.map(|linear| linear.inflated_rss),
            mean_shift_rss: linear.map(|linear| linear.mean_shift_rss),
            six_sigma: linear.and_then(|linear| linear.six_sigma),
            extremes: None,
            bounds: None,
            sensitivities,
            interactions: InteractionList::default(),
            interactions_remainder: None,
            possible_interactions: plan.pairs_of(c),
            examined_interactions: fitted.known_pairs,
            left_out_share,
            indices: None,
            error_estimate,
            model_sampled: None,
            verification: None,
            surface_law: None,
            density: None,
            yield_source: None,
            pearson: None,
            unfinished: false,
            constant: plan.varying().iter().all(|&d| !plan.depends(c, d)),
            without_value: outcome.evaluated.known.errors().filter(|&(_, of, _)| of == c).count(),
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

/// The greatest part of the room between a value and the limits that is taken below and above it; infinite where there is no room.
fn taken(limits: SpecLimits, from: f64, [below, above]: [f64; 2]) -> Option<f64> {
    // Where a nominal value lies at its limit, and nothing reaches beyond, nothing is taken.
    let part = |reach: f64, room: f64| match room > 0.0 {
        true => reach / room,
        false if room == 0.0 && reach <= 4.0 * f64::EPSILON * from.abs() => 0.0,
        false => f64::INFINITY,
    };
    let below = limits.lower().map(|lower| part(below, from - lower));
    let above = limits.upper().map(|upper| part(above, upper - from));
    below.into_iter().chain(above).reduce(f64::max)
}

/// The exact first and second derivative by a dimension; None where one of them is unknown.
fn exact_derivatives(outcome: &Outcome, c: usize, d: usize) -> Option<[Wide; 2]> {
    let exact = outcome.fitted[c].exact.as_ref()?;
    match outcome.plan.depends(c, d) {
        true => exact.slope(d).zip(exact.curvature(d)).map(<[Wide; 2]>::from),
        false => Some([Wide::of(0.0); 2]),
    }
}

/// The second derivative by a dimension: exact where that is known, a difference elsewhere.
pub(super) fn curvature(outcome: &Outcome, c: usize, d: usize) -> Option<Wide> {
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

fn sensitivity(problem: &Problem, outcome: &Outcome, c: usize, d: usize, shares: Option<&Shares>) -> Sensitivity {
    let (plan, dimension) = (&outcome.plan, &problem.dimensions()[d]);
    let part = outcome.fitted[c].parts[d];
    let axis = plan.axis(d);
    let scale = axis.scale;
    let exact = exact_derivatives(outcome, c, d);
    // Second derivatives by a dimension of extreme size are so only in the characteristic's own unit.
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

/// The source of the part that a varying dimension has in the surface, or in the variance where there is no surface.
fn origin(outcome: &Outcome, c: usize, position: Option<usize>) -> Option<DerivativeOrigin> {
    let (fitted, position) = (&outcome.fitted[c], position?);
    match &fitted.integrated {
        Some(integrated) => integrated.own[position].map(|_| DerivativeOrigin::Evaluated),
        None => fitted.surrogate.as_ref()?.parts[position].map(|part| part.origin()),
    }
}

/// The linear results, from slopes and bands; None where a slope is missing.
fn linear(problem: &Problem, varying: &[usize], sensitivities: &[Sensitivity]) -> Option<Linear> {
    let slopes: Option<Vec<(f64, usize)>> = varying.iter().map(|&d| Some((sensitivities[d].first?, d))).collect();
    Some(Linear::of(problem, &slopes?))
}
