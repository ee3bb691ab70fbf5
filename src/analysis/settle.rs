//! Where a yield comes from: the best of what is known, decided here only.
//!
//! | source | when | its error |
//! |---|---|---|
//! | proof | nothing varies; the extremes are proven to keep the limits; or the formula's degree proves that the surface is the function, and the law of the surface is exact | that of the law |
//! | samples | points of the model itself, with the law of a surface as control where there is one | the sample's |
//! | surface law | a surface, verified at check points or not at all | law and checks as the root of the sum of squares; without checks, what the errors of the moments move the tails |
//! | Pearson fit | moments are all that is known | what the errors of the moments move it |
//!
//! The law of a surface is tested before it is used (`law_guard`): where points contradict it, these take its place, and a sample has no control.
//! With the law of a surface as control a share is `P = P_law + mean(1_model - 1_surface)` over the sample: what model and surface
//! agree on is exact, and only what they differ by is sampled.

use super::CharacteristicAnalysis;
use super::coverage::covered;
use super::inspected::inspected;
use super::surface_law::{GuardedLaw, LawRequest, SurfaceShares};
use super::unverified::error_of_shares;
use super::verified::{TRUSTED, Verification, VerificationKind};
use super::yield_source::YieldSource;
use crate::capability::{Capability, Law, percentiles};
use crate::characteristic::SpecLimits;
use crate::law::{Branch, SurfaceLaw, joint_yield};
use crate::method::{ErrorEstimate, Options, Outcome};
use crate::parallel::prelude::*;
use crate::problem::Problem;
use crate::sampling::one_error;
use crate::verification::Verified;

/// A share beyond each limit, and the error of all of it.
struct Rejected {
    source: YieldSource,
    beyond: [Option<f64>; 2],
    /// None where it is unknown.
    error: Option<f64>,
}

/// The law of a surface after its tests, with its density where that is asked for.
pub(super) struct SharesByLaw {
    law: GuardedLaw,
    density: Option<Vec<[f64; 3]>>,
}

/// The law of the surface of every characteristic whose moments follow from one. Evaluates nothing of the model.
pub(super) fn laws(
    problem: &Problem,
    outcome: &Outcome,
    options: &Options,
    characteristics: &[CharacteristicAnalysis],
) -> Vec<Option<SharesByLaw>> {
    let of = |(c, one): (usize, &CharacteristicAnalysis)| {
        let surface = one.moments.is_some() && follows_from_a_surface(one);
        let request = request(problem, outcome, options, (c, one));
        let law = surface.then(|| GuardedLaw::of(request)).flatten()?;
        let density = options.densities.then(|| law.density()).flatten();
        Some(SharesByLaw { law, density })
    };
    characteristics.par_iter().enumerate().map(of).collect()
}

fn request<'a>(
    problem: &'a Problem,
    outcome: &'a Outcome,
    options: &Options,
    (c, one): (usize, &'a CharacteristicAnalysis),
) -> LawRequest<'a> {
    let seed = options.seed.unwrap_or(Options::SEED);
    LawRequest { problem, outcome, c, seed, fit: fit(one), verification: one.verification.as_ref() }
}

/// Decides for every characteristic what its yield comes from, and sets capability and the error of the yield accordingly; the
/// laws of the surfaces. Evaluates nothing of the model.
pub(super) fn settle(
    problem: &Problem,
    outcome: &Outcome,
    options: &Options,
    characteristics: &mut [CharacteristicAnalysis],
    found: Vec<Option<SharesByLaw>>,
) -> Vec<Option<SurfaceLaw>> {
    let mut laws: Vec<Option<SurfaceLaw>> = Vec::new();
    for ((c, one), found) in characteristics.iter_mut().enumerate().zip(found) {
        one.pearson = one.capability;
        laws.push(None);
        if one.moments.is_none() {
            continue;
        }
        let (mut guarded, density) = found.map_or((None, None), |SharesByLaw { law, density }| (Some(law), density));
        one.density = density;
        if let Some(probability) = options.coverage {
            one.coverage = covered(one, guarded.as_ref(), probability).unwrap_or_else(|faulty| {
                guarded = GuardedLaw::without(request(problem, outcome, options, (c, one)), &faulty);
                covered(one, guarded.as_ref(), probability).unwrap_or(None)
            });
        }
        one.surface_law = guarded.as_ref().map(|law| law.shares);
        let points = guarded.as_mut().and_then(|law| law.points.take());
        laws[c] = guarded.and_then(|law| law.law);
        let Some(found) = rejected(problem, outcome, c, one, laws[c].as_ref()) else { continue };
        one.yield_source = one.characteristic.limits().exist().then_some(found.source);
        one.capability = capability(one, found.beyond);
        if let Some(estimate) = one.error_estimate.take() {
            one.error_estimate =
                Some(ErrorEstimate { yield_: found.error.filter(|error| error.is_finite()), ..estimate });
        }
        one.inspection = inspected(one, laws[c].as_ref(), points.as_deref());
    }
    laws
}

/// The share of assemblies that keep the limits of all characteristics, `1 - sum of all rejects + E[(number of broken limits - 1)+]`: the rejects by their sources, what they have in common by the laws of
/// the surfaces. None with fewer than two characteristics with limits, and where a law or an error is not known.
pub(super) fn joint(characteristics: &[CharacteristicAnalysis], laws: &[Option<SurfaceLaw>]) -> Option<Verified> {
    if !have_joint_yield(characteristics) {
        return None;
    }
    let limited = || characteristics.iter().zip(laws).filter(|(one, _)| one.characteristic.limits().exist());
    let laws: Vec<(&SurfaceLaw, SpecLimits)> =
        limited().map(|(one, law)| Some((law.as_ref()?, one.characteristic.limits()))).collect::<Option<_>>()?;
    let by_laws = joint_yield(&laws);
    let (mut value, mut square) = (by_laws.value, by_laws.error.powi(2));
    for (one, _) in limited() {
        value += one.surface_law?.rejected()? - one.capability?.rejected()?;
        square += match one.yield_source? {
            YieldSource::Proof => one.error_estimate.as_ref().and_then(|of| of.yield_).unwrap_or(0.0),
            _ => one.error_estimate.as_ref()?.yield_?,
        }
        .powi(2);
    }
    Some(Verified { value: value.clamp(0.0, 1.0), error: square.sqrt() })
}

/// Whether two of them have limits, which can be kept together or not.
pub(super) fn have_joint_yield(characteristics: &[CharacteristicAnalysis]) -> bool {
    characteristics.iter().filter(|one| one.characteristic.limits().exist()).count() > 1
}

/// Whether the moments are those of a surface, or the model's in place of those of a surface that is trusted all the same.
fn follows_from_a_surface(one: &CharacteristicAnalysis) -> bool {
    let replaced = |of: &Verification| of.replaced && of.left.is_none_or(|left| left > TRUSTED);
    one.model_sampled.is_none() && !one.verification.as_ref().is_some_and(replaced)
}

fn fit(one: &CharacteristicAnalysis) -> Option<&Law> {
    one.law.as_ref()?.as_ref().ok()
}

/// The rule. None where nothing is known.
fn rejected(
    problem: &Problem,
    outcome: &Outcome,
    c: usize,
    one: &CharacteristicAnalysis,
    law: Option<&SurfaceLaw>,
) -> Option<Rejected> {
    proof(problem, outcome, c, one).or_else(|| samples(one)).or_else(|| surface(one, law)).or_else(|| pearson(one))
}

fn proof(problem: &Problem, outcome: &Outcome, c: usize, one: &CharacteristicAnalysis) -> Option<Rejected> {
    let limits = one.characteristic.limits();
    if one.constant {
        let own = one.pearson?;
        return Some(Rejected { source: YieldSource::Proof, beyond: [own.below, own.above], error: Some(0.0) });
    }
    if kept_by_extremes(problem, outcome, c, one) {
        let beyond = [limits.lower().map(|_| 0.0), limits.upper().map(|_| 0.0)];
        return Some(Rejected { source: YieldSource::Proof, beyond, error: Some(0.0) });
    }
    let exact = one.verification.as_ref().is_some_and(|of| matches!(of.kind, VerificationKind::Exact { .. }));
    let law = one.surface_law.as_ref().filter(|law| exact && law.branch != Branch::Sampled)?;
    let beyond = [law.below, law.above];
    let outside = beyond.iter().flatten().all(|figure| figure.proven);
    // A limit outside of the proven range lies there by any rounding: the range has room for that.
    let rounding = if outside { 0.0 } else { one.error_estimate.as_ref()?.yield_? };
    let error = Some(libm::hypot(law.error(), rounding));
    Some(Rejected { source: YieldSource::Proof, beyond: beyond.map(|of| of.map(|of| of.value)), error })
}

/// Whether the proven extremes lie within the limits, and no input leaves the box in which they were searched.
fn kept_by_extremes(problem: &Problem, outcome: &Outcome, c: usize, one: &CharacteristicAnalysis) -> bool {
    let limits = one.characteristic.limits();
    let Some(proof) = one.proof().filter(|_| limits.exist()) else { return false };
    let bounded = |&d: &usize| {
        let dimension = &problem.dimensions()[d];
        let [lower, upper] = dimension.reach().map(|deviation| dimension.nominal() + deviation);
        let slack = 4.0 * f64::EPSILON * dimension.nominal().abs().max(dimension.mean().abs());
        dimension.distribution().is_some_and(|law| {
            let [least, most] = law.support();
            least >= lower - slack && most <= upper + slack
        })
    };
    let inside = proof.bounds.iter().all(|&bound| limits.contains(bound));
    inside
        && one.without_value == 0
        && outcome.plan.varying().iter().filter(|&&d| outcome.plan.depends(c, d)).all(bounded)
}

fn samples(one: &CharacteristicAnalysis) -> Option<Rejected> {
    let source = YieldSource::Samples;
    if let Some(sampled) = &one.model_sampled {
        let (value, interval) = sampled.yield_?;
        return Some(Rejected { source, beyond: sampled.beyond, error: Some(one_error(value, interval)) });
    }
    let verification = one.verification.as_ref().filter(|of| of.kind == VerificationKind::Sample)?;
    let own = verification.yield_?;
    let plain = || Rejected { source, beyond: verification.beyond.map(value), error: Some(own.error) };
    // Counts of the surface are no control: the sample counts as well.
    let control = one.surface_law.as_ref().filter(|law| law.counted.is_none());
    let (Some([within, differences @ ..]), Some(law)) = (verification.difference, control) else {
        return Some(plain());
    };
    let error = libm::hypot(within.error, law.error());
    let with = |share: Option<f64>, difference: Verified| share.map(|share| share + difference.value);
    let beyond =
        [with(law.below.map(|of| of.value), differences[0]), with(law.above.map(|of| of.value), differences[1])];
    match error < own.error && beyond.iter().flatten().all(|&share| share >= 0.0) {
        true => Some(Rejected { source, beyond, error: Some(error) }),
        false => Some(plain()),
    }
}

fn value(of: Option<Verified>) -> Option<f64> {
    of.map(|of| of.value)
}

fn surface(one: &CharacteristicAnalysis, whole: Option<&SurfaceLaw>) -> Option<Rejected> {
    let law = one.surface_law.as_ref().filter(|_| one.characteristic.limits().exist())?;
    let beyond = [law.below, law.above].map(|of| of.map(|of| of.value));
    let checked = one.verification.as_ref().filter(|of| of.kind == VerificationKind::Checks);
    let surface = match checked {
        Some(of) => of.yield_.map(|of| of.error),
        None => {
            let of_fit = one.error_estimate.as_ref().and_then(|of| of.yield_);
            let of_tails = whole.and_then(|whole| error_of_shares(one, whole));
            of_fit.map(|of_fit| of_fit.max(of_tails.unwrap_or(0.0)))
        }
    };
    Some(Rejected {
        source: YieldSource::SurfaceLaw,
        beyond,
        error: surface.map(|error| libm::hypot(error, law.error())),
    })
}

fn pearson(one: &CharacteristicAnalysis) -> Option<Rejected> {
    let own = one.pearson?;
    let error = one.error_estimate.as_ref().and_then(|of| of.yield_);
    Some(Rejected { source: YieldSource::Pearson, beyond: [own.below, own.above], error })
}

/// How the best law keeps the limits: shares beyond them by the source, quantiles by the surface law where there is one.
fn capability(one: &CharacteristicAnalysis, [below, above]: [Option<f64>; 2]) -> Option<Capability> {
    let moments = one.moments?;
    let limits = one.characteristic.limits();
    let own = one.pearson;
    let quantiles = one.surface_law.as_ref().and_then(SurfaceShares::capability_quantiles);
    let [cp_percentile, cpk_percentile] = match (quantiles, own) {
        (Some(quantiles), _) => percentiles(quantiles, limits),
        (None, own) => [own.and_then(|own| own.cp_percentile), own.and_then(|own| own.cpk_percentile)],
    };
    let base = Capability::of_moments(moments.mean(), moments.sigma(), limits);
    Some(Capability { below, above, cp_percentile, cpk_percentile, ..base })
}
