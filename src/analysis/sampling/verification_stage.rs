//! Verification after any method: estimates the error of every figure from points of the model.
//!
//! `../verification` computes it. This module turns it into error estimates and warnings. Figures of a method that was chosen by name stay,
//! and the model's are shown beside them. `auto` takes the model's figure if its own lies beyond two standard errors of it. Within them
//! both agree, and the figures of one surface stay together.

use std::sync::Arc;

use crate::analysis::CharacteristicAnalysis;
use crate::analysis::result::stage_figures::{MomentFigures, VerificationFigures};
use crate::analysis::result::verification::{
    TRUSTED, UNTRUSTED, VarianceShare, Verification, VerificationKind, VerifiedFigures,
};
use crate::analysis::result::yield_error::of_yield;
use crate::analysis::sampling::accuracy_target::{MORE, PART};
use crate::analysis::sampling::sample_budget::SampleBudget;
use crate::assembly::Run;
use crate::evaluation::{Evaluator, Ledger};
use crate::method::{ErrorEstimate, ErrorSource, Method, Options, Outcome, interpolated};
use crate::plan::{AtNode, Point};
use crate::problem::Problem;
use crate::summary::RunSummary;
use crate::verification::{
    BESIDE, Checked, CheckedFigures, PlanNode, SampleQuantile, SampledFigures, Target, Verified, check_points,
    core_within, most_points, most_points_of_shares, unexplained, variance_shares_during, verify_by_checks,
    verify_characteristic,
};
use crate::warning::Warning;
use sensitol_numeric::capability::Law;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::surrogate::Surrogate;

/// Greatest error of a share, as a part of the reject rate that the target allows (of 1e-4: 1e-5). Above it a larger sample is drawn.
const TARGET: f64 = 0.1;
/// Greatest number of points in the core of a sample.
const MOST: usize = 1 << 19;
/// Standard errors beyond which a figure contradicts the model.
const OFF: f64 = 3.0;
/// Smallest deviation of a figure that matters: as a part of sigma for mean and sigma, of the value (at least 1) for skewness and kurtosis.
const MATTERS: f64 = 0.01;
/// Standard errors beyond which `auto` takes the model's figure.
const AGREES: f64 = 2.0;
/// Error of sigma, as a part of sigma, above which the surface does not follow the model.
const UNKNOWN: f64 = 0.1;
/// Assumed share of the variance of a correlated dimension, for methods that integrate and have no share of it. Any value serves that lies
/// between 1e-4 (an input is not idle) and 0.03 (an input gets check points of its own).
const ORDINARY: f64 = 0.01;
/// Largest error of a difference, in roundings of the value at the means.
const ROUNDINGS: f64 = 8.0;

/// Verifications of the characteristics, by their places. Empty if that is switched off (see [`Options::verifies`]). Points of a costly model
/// enter the ledger, those of a cheap one use up `left`.
pub(in crate::analysis) fn verify(
    evaluator: &Evaluator<'_>,
    outcome: &Outcome,
    options: &Options,
    (kinked, left): (&[usize], &mut SampleBudget),
    characteristics: &[CharacteristicAnalysis],
) -> Vec<(usize, VerificationFigures)> {
    let (problem, run, seed) = (evaluator.problem(), evaluator.run(), evaluator.seed());
    let costly = problem.function().signature().costly;
    if !options.verifies(problem.function().signature())
        || outcome.evaluated.stopped().is_some()
        || costly && run.stopped()
    {
        return Vec::new();
    }
    // Points of the model have replaced a surface with a kink at the nominal point. Their errors need no surface. Nor has a characteristic one
    // that follows a choice from stock.
    let replaced = |c: usize, one: &CharacteristicAnalysis| {
        one.evidence.model_sampled.is_some() && kinked.contains(&c) || problem.follows_costly_choice(c)
    };
    let (mut found, mut open) = (Vec::new(), Vec::new());
    for (c, one) in characteristics.iter().enumerate().filter(|&(c, one)| !replaced(c, one)) {
        match proven(outcome, c, one) {
            Some(proven) => found.push((c, proven)),
            None => open.push(c),
        }
    }
    if open.is_empty() {
        return found;
    }
    // A budget that is too small for a sample of each characteristic may suffice for check points.
    let each = left.each(open.len());
    let cores: Option<Vec<usize>> = open.iter().map(|&c| core_within(problem, c, each)).collect();
    let Some(cores) = cores.filter(|_| !costly) else {
        found.extend(check(evaluator, outcome, options.verify, &open, characteristics));
        return found;
    };
    // A long formula takes a while for each of some 45 000 points. Characteristics that are not reached in time have no verification, and
    // the report states it.
    let of = |(&c, &core): (&usize, &usize)| {
        sample(problem, outcome, (options, each), (c, core), &characteristics[c], (seed, run))
    };
    let sampled: Vec<Option<(usize, Option<VerificationFigures>)>> = open.par_iter().zip(&cores).map(of).collect();
    left.spend(sampled.iter().flatten().map(|(spent, _)| spent).sum());
    let stopped = sampled.iter().any(Option::is_none).then(|| run.why_open());
    evaluator.merge(Ledger::stopped_by(stopped));
    found.extend(open.into_iter().zip(sampled).filter_map(|(c, sampled)| Some((c, sampled?.1?))));
    found
}

/// Verification by a proof that the surface equals the function. Its errors are roundings then. Returns None without a proof.
fn proven(outcome: &Outcome, c: usize, one: &CharacteristicAnalysis) -> Option<VerificationFigures> {
    let (proof, moments) = (outcome.fitted[c].proof?, one.moments?);
    let sampled = one.evidence.sampled.is_some() || one.evidence.model_sampled.is_some();
    if sampled || one.missing.without_value > 0 {
        return None;
    }
    let sigma = moments.sigma();
    let [of_mean, of_sigma] = [proof.mean, proof.sigma + f64::EPSILON * sigma].map(|rounding| ROUNDINGS * rounding);
    let part = if sigma > 0.0 { of_sigma / sigma } else { 0.0 };
    let known = |error: f64| moments.skewness().is_some().then_some(error);
    let estimate = ErrorEstimate {
        mean: Some(of_mean),
        sigma: Some(of_sigma),
        skewness: known(4.0 * part),
        kurtosis: known(8.0 * part),
        yield_: None,
        sources: vec![ErrorSource::Proven { degree: proof.degree }],
    };
    let yield_ = of_yield(&estimate, &moments, one.characteristic.limits());
    let verification = Verification {
        kind: VerificationKind::Exact,
        degree: Some(proof.degree),
        points: 0,
        failed: 0,
        far_residual: None,
        lost_share: None,
        valid: None,
        left: Some(0.0),
        figures: VerifiedFigures::default(),
        point: 0.0,
        difference: None,
        switches: Some(Vec::new()),
        unseen: None,
        shares: None,
        tails: None,
        replaced: false,
        quantiles: [None; 7],
        sample: None,
    };
    let error_estimate = ErrorEstimate { yield_, ..estimate };
    Some(VerificationFigures::complete(None, error_estimate, verification))
}

/// Verifies one characteristic by a sample with `core` points in its core, within the evaluations that are left for it. Returns the
/// evaluations that it took and the verification, which is None without moments. Returns None if the run was stopped before there was a
/// sample.
fn sample(
    problem: &Problem,
    outcome: &Outcome,
    (options, left): (&Options, Option<usize>),
    (c, mut core): (usize, usize),
    one: &CharacteristicAnalysis,
    (seed, run): (u64, &Run<'_>),
) -> Option<(usize, Option<VerificationFigures>)> {
    let surrogate = outcome.fitted[c].surrogate.as_ref();
    let beside = surrogate.map(|surrogate| (outcome.plan.varying(), surrogate));
    let mut found = verify_characteristic(problem, c, (seed, core), beside, run)?;
    // The sample must resolve sigma to the accuracy, and the yield to its target.
    let climbed = outcome.climbed.as_ref();
    let wanted = climbed.map(|climbed| climbed.accuracy);
    // If the target allows few rejects, the weight of a single point may exceed them.
    let rejected = one.characteristic.target_yield().map(|target| 1.0 - target);
    let coarse = |found: &SampledFigures| {
        let sigma = wanted.zip(found.sigma).is_some_and(|(wanted, sigma)| sigma.error > PART * wanted * sigma.value);
        let error = found.difference.map(|[within, ..]| within.error).or(found.yield_.map(|share| share.error));
        sigma || rejected.zip(error).is_some_and(|(rejected, error)| error > TARGET * rejected)
    };
    let mut spent = found.points;
    let affords = |spent: usize, more: usize| left.is_none_or(|left| spent + more <= left);
    while core < MOST && coarse(&found) && !run.stopped() && affords(spent, most_points(MORE * core)) {
        core *= MORE;
        // If there is no time for a larger sample, the smaller one stays.
        let Some(more) = verify_characteristic(problem, c, (seed, core), beside, run) else { break };
        found = more;
        spent += found.points;
    }
    let open = beside.and_then(|beside| unexplained(problem, c, beside, seed, run));
    spent += open.map_or(0, |_| BESIDE);
    // Shares of variance cost many points: they are computed only if the surface leaves too much of the variance unexplained.
    let shares_are_due =
        |share: f64| share > UNTRUSTED && affords(spent, most_points_of_shares(outcome.plan.varying().len()));
    let shares = open.filter(|&share| shares_are_due(share)).and_then(|_| named_shares(problem, c, seed, run));
    spent += shares.as_ref().map_or(0, |_| most_points_of_shares(outcome.plan.varying().len()) - BESIDE);
    // With `model_figures`, a surface that is not trusted gives way to the model's figures.
    let refuted = options.model_figures && open.is_none_or(|share| share > TRUSTED);
    let replacing = options.method == Method::Auto || refuted;
    let replacement = if replacing { model_moments(one, &found) } else { None };
    let Some(moments) = replacement.as_ref().map(|of| of.moments).or(one.moments) else { return Some((spent, None)) };
    let error = |of: Option<Verified>, value: Option<f64>| Some(of?.error_of(value?));
    let law = replacement.as_ref().map_or(one.distribution.capability, |of| of.capability).and_then(|of| of.yield_());
    let limits = one.characteristic.limits();
    let sides = [limits.lower().is_some(), limits.upper().is_some()];
    let error_estimate = ErrorEstimate {
        mean: error(found.mean, Some(moments.mean())),
        sigma: error(found.sigma, Some(moments.sigma())),
        skewness: error(found.skewness, moments.skewness()),
        kurtosis: error(found.kurtosis, moments.kurtosis()),
        yield_: error(found.yield_, law),
        sources: vec![ErrorSource::Sampled { points: found.points as u64 }],
    };
    let quantiles = reported_quantiles(&found);
    let verification = Verification {
        kind: VerificationKind::Sample,
        degree: None,
        points: found.points,
        failed: 0,
        far_residual: None,
        lost_share: None,
        valid: Some(found.valid),
        left: open,
        figures: sampled_figures(&found),
        point: found.point,
        difference: found.difference,
        switches: found.switches.filter(|found| {
            !found.is_empty() || problem.function().switches(problem.outputs()[c]).is_some_and(|of| of.complete)
        }),
        unseen: None,
        shares,
        tails: found.sample.as_ref().filter(|_| limits.exist()).map(|sample| sample.tails(sides)),
        replaced: replacement.is_some(),
        quantiles,
        sample: found.sample.filter(|_| is_kept(one, options, open)).map(Arc::new),
    };
    Some((spent, Some(VerificationFigures::complete(replacement, error_estimate, verification))))
}

/// Figures of the model itself.
fn sampled_figures(found: &SampledFigures) -> VerifiedFigures {
    let moments = [found.mean, found.sigma, found.skewness, found.kurtosis];
    VerifiedFigures { moments, yield_: found.yield_, beyond: found.beyond }
}

/// Quantiles of a sample at the probabilities of reports. None if nothing varies: a single value is no sample of a distribution.
fn reported_quantiles(found: &SampledFigures) -> [Option<SampleQuantile>; 7] {
    let varies = found.sigma.is_some_and(|sigma| sigma.value > 0.0);
    found.sample.as_ref().filter(|_| varies).map_or([None; 7], |sample| sample.reported_quantiles())
}

/// True if points of the sample are needed later: for inspection risks, coverage intervals, or the density of an untrusted surface.
fn is_kept(one: &CharacteristicAnalysis, options: &Options, open: Option<f64>) -> bool {
    let drawn = options.densities && open.is_none_or(|share| share > TRUSTED);
    one.characteristic.inspection().is_some() || options.coverage.is_some() || drawn
}

/// Returns the shares of the variance with the names of their dimensions. Returns None if the run was stopped before.
fn named_shares(problem: &Problem, c: usize, seed: u64, run: &Run<'_>) -> Option<Vec<VarianceShare>> {
    if run.stopped() {
        return None;
    }
    let dimension = |d: usize| problem.dimensions()[d].name().to_owned();
    let share = |(d, [first, total]): (usize, [Verified; 2])| VarianceShare { dimension: dimension(d), first, total };
    variance_shares_during(problem, c, seed, run).map(|shares| shares.into_iter().map(share).collect())
}

/// Moments with the model's figures in place of those that it contradicts. Returns None if it contradicts none.
fn model_moments(one: &CharacteristicAnalysis, found: &SampledFigures) -> Option<MomentFigures> {
    let (mean, sigma, moments) = (found.mean?, found.sigma?, one.moments?);
    let sampled = |of: Verified| Some(of.value);
    let apart = |of: Option<Verified>, value: Option<f64>| {
        of.zip(value).is_some_and(|(of, value)| (value - of.value).abs() > AGREES * of.error)
    };
    let off = [
        apart(Some(mean), Some(moments.mean())),
        apart(Some(sigma), Some(moments.sigma())),
        apart(found.skewness, moments.skewness()),
        apart(found.kurtosis, moments.kurtosis()),
    ];
    if !off.contains(&true) {
        return None;
    }
    let own = [Some(moments.mean()), Some(moments.sigma()), moments.skewness(), moments.kurtosis()];
    let other = [sampled(mean), sampled(sigma), found.skewness.and_then(sampled), found.kurtosis.and_then(sampled)];
    let pick = |take: &dyn Fn(usize) -> bool| -> Option<Moments> {
        let of = |i: usize| if take(i) { other[i] } else { own[i] };
        Some(Moments::new(of(0)?, of(1)?, of(2)?, of(3)? - 3.0))
    };
    // Moments of two origins need not belong to any distribution. All are the sample's in that case.
    let mixed = pick(&|i| off[i]).filter(|mixed| Law::fit(mixed).is_ok());
    let moments = mixed.or_else(|| pick(&|_| true))?;
    Some(MomentFigures::of(moments, one.characteristic.limits()))
}

/// Verifications of the `open` characteristics of a costly model at check points, `asked` if they were requested by number.
fn check(
    evaluator: &Evaluator<'_>,
    outcome: &Outcome,
    asked: Option<usize>,
    open: &[usize],
    characteristics: &[CharacteristicAnalysis],
) -> Vec<(usize, VerificationFigures)> {
    let varying = outcome.plan.varying();
    let integrated: Vec<Option<Surrogate>> = (0..characteristics.len()).map(|c| interpolated(outcome, c)).collect();
    let surface = |c: usize| outcome.fitted[c].surrogate.as_ref().or(integrated[c].as_ref());
    let shares = |(one, integrated): (&CharacteristicAnalysis, &Option<Surrogate>)| -> Vec<f64> {
        let unknown = if integrated.is_some() { ORDINARY } else { 0.0 };
        varying.iter().map(|&d| one.share(d).unwrap_or(unknown)).collect()
    };
    let shares: Vec<Vec<f64>> = characteristics.iter().zip(&integrated).map(shares).collect();
    let nodes: Vec<Vec<PlanNode>> = (0..characteristics.len()).map(|c| plan_nodes(outcome, c)).collect();
    let targets: Vec<Target<'_>> = (shares.iter().zip(&nodes).enumerate())
        .map(|(c, (shares, nodes))| Target { surrogate: surface(c).filter(|_| open.contains(&c)), shares, nodes })
        .collect();
    let most = check_points(asked, varying.len());
    // A number that was requested is kept. Within it, and without one, a refuted surface takes up to `MOST_LOCATING` points more.
    let points = match (asked, evaluator.remaining()) {
        (Some(asked), left) => Some(left.map_or(asked, |left| left.min(asked))),
        (None, left) => left,
    };
    let part = evaluator.part().with_points(points);
    let Some(checked) = verify_by_checks(&part, varying, &targets, most) else { return Vec::new() };
    // Points without an answer give no information.
    let answered = open.iter().copied().filter(|&c| !checked.unanswered[c]);
    let found = answered.filter_map(|c| {
        let exact = surface(c).and_then(|of| Some(of.contributions(outcome.plan.inputs())?.moments));
        Some((c, of_checks(&characteristics[c], &checked, &checked.characteristics[c], exact)?))
    });
    let found = found.collect();
    let ledger = part.into_ledger();
    // Open check points leave the figures of the method complete.
    evaluator.merge(Ledger { run: RunSummary { stopped: None, ..ledger.run }, ..ledger });
    found
}

/// Points of the plan without a value of a characteristic, and those of a single input. None if all have a value.
fn plan_nodes(outcome: &Outcome, c: usize) -> Vec<PlanNode> {
    let (plan, known) = (&outcome.plan, &outcome.evaluated.known);
    let varying = plan.varying();
    let node = |point: &Point, has_value: bool| {
        let place = |at: &AtNode| {
            let d = at.dimension as usize;
            Some((varying.binary_search(&d).ok()?, plan.axis(d).nodes[at.node as usize].u))
        };
        Some(PlanNode::new(point.at().iter().map(place).collect::<Option<Vec<_>>>()?, has_value))
    };
    let failed: Vec<PlanNode> =
        known.errors().filter(|(_, of, _)| *of == c).filter_map(|(point, ..)| node(point, false)).collect();
    if failed.is_empty() {
        return failed;
    }
    let single = known.points().iter().filter(|point| point.at().len() == 1 && known.value(point, c).is_some());
    failed.into_iter().chain(single.filter_map(|point| node(point, true))).collect()
}

/// Errors of a method's figures: the error of the surface, and the difference between method and surface. Returns None without moments.
fn of_checks(
    one: &CharacteristicAnalysis,
    checked: &Checked,
    found: &CheckedFigures,
    surface: Option<Moments>,
) -> Option<VerificationFigures> {
    let moments = one.moments?;
    let errors = found.errors;
    let error =
        |index: usize, own: Option<f64>, surface: Option<f64>| Some(libm::hypot(own? - surface?, errors?[index]));
    let of = |part: fn(&Moments) -> Option<f64>| (part(&moments), surface.as_ref().and_then(part));
    let (mean, sigma) = (of(|m| Some(m.mean())), of(|m| Some(m.sigma())));
    let (skewness, kurtosis) = (of(Moments::skewness), of(Moments::kurtosis));
    let law = one.distribution.capability.and_then(|capability| capability.yield_());
    let error_estimate = ErrorEstimate {
        mean: error(0, mean.0, mean.1),
        sigma: error(1, sigma.0, sigma.1),
        skewness: error(2, skewness.0, skewness.1),
        kurtosis: error(3, kurtosis.0, kurtosis.1),
        yield_: found.yield_.zip(law).map(|(share, law)| share.error_of(law)),
        sources: vec![ErrorSource::Checked { points: checked.count }],
    };
    let verification = Verification {
        kind: VerificationKind::Checks,
        degree: None,
        points: checked.count,
        failed: found.failed,
        far_residual: found.far.clone(),
        lost_share: Some(found.lost),
        valid: None,
        left: found.left,
        figures: VerifiedFigures { moments: [None; 4], yield_: found.yield_, beyond: found.beyond },
        point: 0.0,
        difference: None,
        switches: None,
        unseen: Some(checked.unseen()),
        shares: None,
        tails: None,
        replaced: false,
        quantiles: [None; 7],
        sample: None,
    };
    let refuted = found.refuted.clone();
    Some(VerificationFigures { moments: None, error_estimate, verification, without_value: found.failed, refuted })
}

/// Warnings that follow from the verification of one characteristic.
pub(in crate::analysis) fn warnings(one: &CharacteristicAnalysis, wanted: Option<f64>) -> Vec<Warning> {
    let Some(verification) = &one.evidence.verification else { return Vec::new() };
    let characteristic = || one.characteristic.name().to_owned();
    let mut warnings = Vec::new();
    if verification.failed > 0 {
        let (failed, points) = (verification.failed, verification.points);
        let share = verification.lost_share;
        warnings.push(Warning::DomainEdgeWithin { characteristic: characteristic(), failed, points, share });
    }
    if let Some(far) = &verification.far_residual
        && let Some(residual) = far.residual
    {
        let directions = far.directions.iter().map(|&(d, up)| (one.sensitivities[d].dimension.clone(), up));
        warnings.push(Warning::FarResidual {
            characteristic: characteristic(),
            directions: directions.collect(),
            residual,
            from: far.from,
            share: far.share,
        });
    }
    let switches = verification.switches.iter().flatten();
    warnings.extend(switches.filter_map(|found| found.warning(&characteristic(), None)));
    let Some(moments) = one.moments else { return warnings };
    let sigma = moments.sigma();
    let error = one.error_estimate.as_ref().and_then(|estimate| estimate.sigma);
    if sigma > 0.0
        && error.is_some_and(|error| error > UNKNOWN * sigma)
        && !verification.replaced
        && let Some(share) = verification.left.map(|left| left.min(1.0))
        && share > TRUSTED
    {
        warnings.push(Warning::UntrustedSurrogate { characteristic: characteristic(), share, sampled: None });
    }
    let matters = wanted.unwrap_or(0.0).max(MATTERS);
    let values = [Some(moments.mean()), Some(sigma), moments.skewness(), moments.kurtosis()];
    let units = |model: f64| [sigma, sigma, model.abs().max(1.0), model.abs().max(1.0)];
    let names = ["mean", "sigma", "skewness", "kurtosis"];
    for (index, figure) in names.into_iter().enumerate() {
        let Some((value, model)) = values[index].zip(verification.figures.moments[index]) else { continue };
        let unit = units(model.value)[index];
        let off = (value - model.value).abs();
        if off > OFF * model.error && off > matters * unit {
            let (characteristic, error, model) = (characteristic(), model.error, model.value);
            warnings.push(Warning::FigureOff { characteristic, figure, value, model, error });
        }
    }
    warnings
}
