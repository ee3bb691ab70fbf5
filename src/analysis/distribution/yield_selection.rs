//! Choice of the source of a yield: the best available one. No other module decides it.
//!
//! | source | condition | error |
//! |---|---|---|
//! | proof | nothing varies; or no input is measured, and the extremes are proven to keep the limits, or the formula's degree proves that the surface is the function, and the distribution of the surface is exact | that of the distribution |
//! | samples | points of the model itself, with the surface distribution as control variate if there is one; importance samples in a refuted tail | the sample's |
//! | surface law | a surface, verified at check points or not at all; a proven surface of measured inputs | distribution and checks as the root of the sum of squares; without checks, the change of the tails by the errors of the moments |
//! | Pearson fit | only moments are known | change by the errors of the moments |
//!
//! The distribution of a surface is tested before it is used (`law_guard`). If points contradict it, counts of them replace it, and a
//! sample has no control variate. With the surface distribution as control variate a share is `P = P_law + mean(1_model - 1_surface)` over
//! the sample. The points on which model and surface agree contribute exactly, and only the difference is sampled.
//!
//! Measured inputs prove nothing: measured values that keep the limits are a fact about these parts, and not about the process.
//!
//! Each side of the limits has an interval of its own. It follows from the error of that side, and for a sample from the number of points
//! that would scatter as much. It is 0 to 0 if a proof excludes the side, regardless of the other side.

use crate::analysis::CharacteristicAnalysis;
use crate::analysis::distribution::coverage::covered;
use crate::analysis::distribution::inspection::inspected;
use crate::analysis::distribution::moment_shift::error_of_shares;
use crate::analysis::distribution::quantile_selection::QuantileSelection;
use crate::analysis::distribution::surface_law::{GuardedLaw, LawRequest};
use crate::analysis::result::quantile_estimates::QuantileEstimates;
use crate::analysis::result::stage_figures::{QuantileFigures, YieldFigures};
use crate::analysis::result::verification::{Verification, VerificationKind};
use crate::analysis::result::yield_error::of_sides;
use crate::analysis::result::yield_source::YieldSource;
use crate::analysis::sampling::measured_interval::samples_of;
use crate::analysis::sampling::sample_budget::SampleBudget;
use crate::estimate::{Verified, common_rejects, most_points_together};
use crate::extremes::keeps_by_proof;
use crate::method::{Options, Outcome};
use crate::problem::Problem;
use sensitol_numeric::capability::{Capability, Law};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::law::{Branch, SurfaceLaw, joint_yield};
use sensitol_numeric::law::{LawFigure, joint_bounds};
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::{one_error, weighted_interval};
use sensitol_numeric::verdict;

/// Error of a joint yield from surface distributions above which points of the model are evaluated too.
const CORRECTED: f64 = 1e-3;

/// Shares beyond each limit with their errors.
struct Rejected {
    source: YieldSource,
    beyond: [Option<f64>; 2],
    /// Error of the share of all rejects. None if it is unknown.
    error: Option<f64>,
    /// Error of the share on either side. None if it is unknown.
    errors: [Option<f64>; 2],
    /// 95 % interval of the share on either side. None if it is unknown.
    intervals: [Option<[f64; 2]>; 2],
}

impl Rejected {
    /// Creates it with intervals of two errors on either side.
    fn new(source: YieldSource, beyond: [Option<f64>; 2], error: Option<f64>, errors: [Option<f64>; 2]) -> Self {
        let interval = |side: usize| Some(verdict::share(verdict::about(beyond[side]?, errors[side])?));
        Self { source, beyond, error, errors, intervals: [interval(0), interval(1)] }
    }

    /// Sets the rejects of the sides that are proven to have none to zero.
    fn excluding(mut self, proven: [bool; 2]) -> Self {
        let limited = self.beyond.map(|share| share.is_some());
        let excluded = [0, 1].map(|side| limited[side] && proven[side]);
        for side in (0..2).filter(|&side| excluded[side]) {
            (self.beyond[side], self.errors[side], self.intervals[side]) = (Some(0.0), Some(0.0), Some([0.0; 2]));
        }
        // The error of all rejects is that of the other side then.
        match excluded {
            [false, false] => {}
            _ if excluded == limited => (self.source, self.error) = (YieldSource::Proof, Some(0.0)),
            [true, _] => self.error = self.errors[1].or(self.error),
            [_, true] => self.error = self.errors[0].or(self.error),
        }
        self
    }

    /// Limits the interval of each side to the greatest share of all rejects.
    fn bounded(mut self) -> Self {
        let all: f64 = self.beyond.iter().flatten().sum();
        if let Some([_, most]) = verdict::about(all, self.error) {
            for (interval, share) in self.intervals.iter_mut().zip(self.beyond) {
                let ends = interval.zip(share).map(|([low, high], share)| [low, high.min(most).max(share)]);
                *interval = ends;
            }
        }
        self
    }
}

/// Distribution of a surface after its tests, with its density if that is requested.
pub(in crate::analysis) struct SharesByLaw {
    law: GuardedLaw,
    density: Option<Vec<[f64; 3]>>,
}

/// Distribution of the surface of every characteristic whose moments follow from one. Evaluates nothing of the model.
pub(in crate::analysis) fn laws(
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
    LawRequest { problem, outcome, c, seed, fit: fit(one), verification: one.evidence.verification.as_ref() }
}

/// Characteristics with quantiles, yields and risks of inspections, and the surface distributions. Evaluates nothing of the model.
pub(in crate::analysis) fn with_distributions(
    problem: &Problem,
    outcome: &Outcome,
    options: &Options,
    characteristics: Vec<CharacteristicAnalysis>,
    found: Vec<Option<SharesByLaw>>,
) -> (Vec<CharacteristicAnalysis>, Vec<Option<SurfaceLaw>>) {
    let all = characteristics.into_iter().enumerate().zip(found);
    all.map(|((c, one), found)| with_distribution(problem, outcome, options, (c, one), found)).unzip()
}

/// Characteristic with the quantiles, the yield and the risks of the inspection of its best sources.
fn with_distribution(
    problem: &Problem,
    outcome: &Outcome,
    options: &Options,
    (c, one): (usize, CharacteristicAnalysis),
    found: Option<SharesByLaw>,
) -> (CharacteristicAnalysis, Option<SurfaceLaw>) {
    if one.moments.is_none() {
        return (one, None);
    }
    let (quantiles, guarded) = quantile_figures(problem, outcome, options, (c, &one), found);
    let one = one.with_quantiles(quantiles);
    let (law, points) = guarded.map_or((None, None), |GuardedLaw { law, points, .. }| (law, points));
    let Some(found) = rejected(problem, outcome, c, &one, law.as_ref()) else { return (one, law) };
    // A side without rejects by proof needs no estimate.
    let proven = proven_sides(problem, outcome, c, &one, &found);
    let found = found.excluding(proven).bounded();
    let yield_ = YieldFigures {
        source: one.characteristic.limits().exist().then_some(found.source),
        capability: capability(&one, found.beyond),
        reject_intervals: found.intervals,
        error: found.error.filter(|error| error.is_finite()),
    };
    let one = one.with_yield(yield_);
    let inspection = inspected(&one, problem.kept_limits(c), law.as_ref(), points.as_ref());
    (one.with_inspection(inspection), law)
}

/// Quantiles and coverage intervals with the distribution of the surface that they do not refute.
fn quantile_figures(
    problem: &Problem,
    outcome: &Outcome,
    options: &Options,
    (c, one): (usize, &CharacteristicAnalysis),
    found: Option<SharesByLaw>,
) -> (QuantileFigures, Option<GuardedLaw>) {
    let (mut guarded, density) = found.map_or((None, None), |SharesByLaw { law, density }| (Some(law), density));
    let measured = !samples_of(problem, outcome, c).is_empty();
    let mut coverage = None;
    if let Some(probability) = options.coverage {
        let found = QuantileSelection::of(one, guarded.as_ref(), measured).map(|of| covered(&of, probability));
        // Quantiles that give no intervals refute the distribution: points of the surface replace it.
        coverage = found.and_then(|found| {
            found.unwrap_or_else(|faulty| {
                guarded = GuardedLaw::without(request(problem, outcome, options, (c, one)), &faulty);
                let of = QuantileSelection::of(one, guarded.as_ref(), measured);
                of.and_then(|of| covered(&of, probability).unwrap_or(None))
            })
        });
    }
    let limits = one.characteristic.limits();
    let quantiles = QuantileSelection::of(one, guarded.as_ref(), measured)
        .map(|of| QuantileEstimates::new(of.source(), of.reported(), limits));
    let density = sampled_density(one, options).or(density);
    let surface_law = guarded.as_ref().map(|law| law.shares);
    (QuantileFigures { coverage, quantiles, density, surface_law }, guarded)
}

/// Share of assemblies that keep the limits of all characteristics:
///
/// ```text
/// P(all kept) = 1 - sum of all rejects + E[(number of broken limits - 1)+]
/// ```
///
/// The rejects are those of each characteristic's own source. Their common part follows from the surface distributions if these are
/// trusted, and otherwise from points of a cheap model. Without either it is the middle of its possible range, and its error is half of the
/// range. Returns None with fewer than two characteristics with limits, and if the rejects of one or their error are unknown.
pub(in crate::analysis) fn joint(
    problem: &Problem,
    options: &Options,
    left: &mut SampleBudget,
    characteristics: &[CharacteristicAnalysis],
    laws: &[Option<SurfaceLaw>],
) -> Option<Verified> {
    if !have_joint_yield(characteristics) {
        return None;
    }
    let limited: Vec<usize> =
        (0..characteristics.len()).filter(|&c| characteristics[c].characteristic.limits().exist()).collect();
    joint_of(problem, options, left, characteristics, laws, &limited)
}

/// Share of assemblies that keep the limits of these characteristics.
pub(in crate::analysis) fn joint_of(
    problem: &Problem,
    options: &Options,
    left: &mut SampleBudget,
    characteristics: &[CharacteristicAnalysis],
    laws: &[Option<SurfaceLaw>],
    limited: &[usize],
) -> Option<Verified> {
    let (mut rejects, mut square) = (Vec::new(), 0.0);
    for &c in limited {
        let one = &characteristics[c];
        rejects.push(one.distribution.capability?.rejected()?);
        let exact = one.evidence.verification.as_ref().is_some_and(|of| of.kind == VerificationKind::Exact);
        square += match one.distribution.yield_source? {
            // Limits outside of the proven range have no error. The same holds for an exact surface of measured inputs.
            YieldSource::Proof => one.error_estimate.as_ref().and_then(|of| of.yield_).unwrap_or(0.0),
            YieldSource::SurfaceLaw if exact => one.error_estimate.as_ref().and_then(|of| of.yield_).unwrap_or(0.0),
            _ => one.error_estimate.as_ref()?.yield_?,
        }
        .powi(2);
    }
    let [least, most] = joint_bounds(&rejects);
    let by_laws = by_laws(characteristics, laws, limited);
    let found = match by_laws {
        Some(found) if found.error <= CORRECTED => by_laws,
        // If model and surface keep different assemblies, the surface gives little information about the common rejects.
        _ => {
            let by_points = by_points(problem, options, left, characteristics, limited, &rejects);
            by_laws.into_iter().chain(by_points).min_by(|a, b| a.error.total_cmp(&b.error))
        }
    };
    let middle = || Verified { value: 0.5 * (least + most), error: 0.5 * (most - least) };
    let Verified { value, error } = found.unwrap_or_else(middle);
    Some(Verified { value: value.max(least).min(most), error: (error * error + square).sqrt() })
}

/// Joint yield from the surface distributions, corrected by the difference of each characteristic's reject rate to that of its own source.
/// The correction counts as an error of the common rejects. Returns None if one of them has no distribution, and if a sample of the model
/// refutes one of the surfaces.
fn by_laws(
    characteristics: &[CharacteristicAnalysis],
    laws: &[Option<SurfaceLaw>],
    limited: &[usize],
) -> Option<Verified> {
    let refuted = |one: &CharacteristicAnalysis| {
        is_sampled(one) && !one.evidence.verification.as_ref().is_some_and(Verification::follows_surface)
    };
    if limited.iter().any(|&c| refuted(&characteristics[c])) {
        return None;
    }
    let law = |&c: &usize| Some((laws.get(c)?.as_ref()?, characteristics[c].characteristic.limits()));
    let laws: Vec<(&SurfaceLaw, SpecLimits)> = limited.iter().map(law).collect::<Option<_>>()?;
    let found = joint_yield(&laws);
    let (mut value, mut error) = (found.value, found.error);
    for one in limited.iter().map(|&c| &characteristics[c]) {
        let corrected = one.evidence.surface_law?.rejected()? - one.distribution.capability?.rejected()?;
        (value, error) = (value + corrected, libm::hypot(error, corrected));
    }
    Some(Verified { value, error })
}

/// Joint yield from points of a cheap model, if its verification evaluates points anyway or there is no budget. Returns None for a costly
/// model.
fn by_points(
    problem: &Problem,
    options: &Options,
    left: &mut SampleBudget,
    characteristics: &[CharacteristicAnalysis],
    limited: &[usize],
    rejects: &[f64],
) -> Option<Verified> {
    let free = options.budget.is_none() || characteristics.iter().any(is_sampled);
    if problem.function().signature().costly || !free || !left.take(most_points_together(limited.len())) {
        return None;
    }
    let common = common_rejects(problem, limited, options.seed.unwrap_or(Options::SEED))?;
    Some(Verified { value: 1.0 - rejects.iter().sum::<f64>() + common.value, error: common.error })
}

/// Interval of the joint yield `value` by the uncertainty of measured samples. At least as many assemblies are rejected as by one
/// characteristic, and at most as many as by all of them one after the other. Returns None if there are no measured samples, and Some(None)
/// if one of them leaves it unknown.
pub(in crate::analysis) fn joint_sampling(
    characteristics: &[CharacteristicAnalysis],
    value: f64,
) -> Option<Option<[f64; 2]>> {
    let limited = || characteristics.iter().filter(|one| one.characteristic.limits().exist());
    limited().find(|one| one.evidence.sampling.is_some())?;
    let (mut most, mut least) = (1.0 - value, 0.0f64);
    for one in limited() {
        let Some(measured) = &one.evidence.sampling else { continue };
        let rejected = one.distribution.capability.and_then(|of| of.rejected());
        let Some((rejected, [low, high])) = rejected.zip(measured.rejected) else { return Some(None) };
        most += (high - rejected).max(0.0);
        least = least.max(low);
    }
    Some(Some([1.0 - most, 1.0 - least.min(1.0 - value)]))
}

/// True if at least two characteristics have limits.
pub(in crate::analysis) fn have_joint_yield(characteristics: &[CharacteristicAnalysis]) -> bool {
    characteristics.iter().filter(|one| one.characteristic.limits().exist()).count() > 1
}

/// True if the moments are those of a surface, or the model's in place of those of a surface that is trusted nevertheless.
fn follows_from_a_surface(one: &CharacteristicAnalysis) -> bool {
    let replaced = |of: &Verification| of.replaced && !of.follows_surface();
    one.evidence.model_sampled.is_none() && !one.evidence.verification.as_ref().is_some_and(replaced)
}

fn is_sampled(one: &CharacteristicAnalysis) -> bool {
    one.evidence.verification.as_ref().is_some_and(|of| of.kind == VerificationKind::Sample)
}

fn fit(one: &CharacteristicAnalysis) -> Option<&Law> {
    one.evidence.law.as_ref()?.as_ref().ok()
}

/// Rejects from the best available source. Returns None if nothing is known.
fn rejected(
    problem: &Problem,
    outcome: &Outcome,
    c: usize,
    one: &CharacteristicAnalysis,
    law: Option<&SurfaceLaw>,
) -> Option<Rejected> {
    proof(problem, outcome, c, one).or_else(|| samples(one)).or_else(|| surface(one, law)).or_else(|| pearson(one))
}

/// Rejects that are proven: of a constant, by proven extremes, or by a proven surface.
fn proof(problem: &Problem, outcome: &Outcome, c: usize, one: &CharacteristicAnalysis) -> Option<Rejected> {
    let limits = one.characteristic.limits();
    let exactly = |beyond| Rejected::new(YieldSource::Proof, beyond, Some(0.0), [Some(0.0); 2]);
    if one.constant {
        let own = one.evidence.pearson?;
        return Some(exactly([own.below, own.above]));
    }
    let measured = !samples_of(problem, outcome, c).is_empty();
    if !measured && limits.exist() && kept_by_extremes(problem, outcome, c, one) == [true; 2] {
        return Some(exactly([limits.lower().map(|_| 0.0), limits.upper().map(|_| 0.0)]));
    }
    let exact = one.evidence.verification.as_ref().is_some_and(|of| of.kind == VerificationKind::Exact);
    let law = one.evidence.surface_law.as_ref().filter(|law| exact && law.branch != Branch::Sampled)?;
    let beyond = [law.below, law.above];
    let outside = beyond.iter().flatten().all(|figure| figure.proven);
    // A limit outside of the proven range stays outside with any rounding, because the range includes rounding errors.
    let rounding = if outside { 0.0 } else { one.error_estimate.as_ref()?.yield_? };
    let error = Some(libm::hypot(law.error(), rounding));
    let source = if measured { YieldSource::SurfaceLaw } else { YieldSource::Proof };
    let of_moments = by_moments(one);
    let errors = [0, 1].map(|side| match beyond[side]? {
        LawFigure { proven: true, .. } => Some(0.0),
        figure => Some(libm::hypot(figure.error, of_moments[side]?)),
    });
    Some(Rejected::new(source, beyond.map(|of| of.map(|of| of.value)), error, errors))
}

/// Errors of the shares below and above the limits by the errors of the moments.
fn by_moments(one: &CharacteristicAnalysis) -> [Option<f64>; 2] {
    let known = one.error_estimate.as_ref().zip(one.moments.as_ref());
    known.map_or([None; 2], |(estimate, moments)| of_sides(estimate, moments, one.characteristic.limits()))
}

/// True for each limit that the proven extremes keep, or that does not exist. False if an input can leave the box in which the extremes
/// were searched.
fn kept_by_extremes(problem: &Problem, outcome: &Outcome, c: usize, one: &CharacteristicAnalysis) -> [bool; 2] {
    let Some(proof) = one.proof() else { return [false; 2] };
    let bounded = |&d: &usize| {
        let dimension = &problem.dimensions()[d];
        let [lower, upper] = dimension.reach().map(|deviation| dimension.nominal() + deviation);
        let slack = 4.0 * f64::EPSILON * dimension.nominal().abs().max(dimension.mean().abs());
        // Coordinates of a circle that vary independently of each other reach the corners of the box around it.
        let blocks = |d: usize| problem.correlation().is_some_and(|of| of.block_of(d).is_some());
        let alone = dimension.zone().is_none() || blocks(d);
        alone
            && dimension.distribution().is_some_and(|law| {
                let [least, most] = law.support();
                least >= lower - slack && most <= upper + slack
            })
    };
    let all = one.missing.without_value == 0
        && outcome.plan.varying().iter().filter(|&&d| outcome.plan.depends(c, d)).all(bounded);
    let kept = problem.kept_limits(c);
    [0, 1].map(|side| all && !kept.broken(proof.bounds[side])[side])
}

/// True for each side that is proven to have no rejects, by interval arithmetic.
///
/// A further proof is tried for a side that the known bounds leave open, if its interval of rejects contains 0.
fn proven_sides(
    problem: &Problem,
    outcome: &Outcome,
    c: usize,
    one: &CharacteristicAnalysis,
    found: &Rejected,
) -> [bool; 2] {
    if one.constant || one.missing.without_value > 0 || !samples_of(problem, outcome, c).is_empty() {
        return [false; 2];
    }
    let known = kept_by_extremes(problem, outcome, c, one);
    let open = |side: usize| match found.intervals[side] {
        _ if known[side] || found.beyond[side].is_none() => false,
        Some([low, high]) => low <= 0.0 && high > 0.0,
        None => true,
    };
    let more = keeps_by_proof(problem, c, [open(0), open(1)]);
    [0, 1].map(|side| known[side] || more[side])
}

/// Rejects from points of the model, with the surface distribution as control variate if that lowers the error.
fn samples(one: &CharacteristicAnalysis) -> Option<Rejected> {
    let source = YieldSource::Samples;
    if let Some(sampled) = &one.evidence.model_sampled {
        let (value, interval) = sampled.yield_.zip(sampled.yield_interval)?;
        let error = |side: usize| Some(one_error(sampled.beyond[side]?, sampled.intervals[side]?));
        let (error, errors) = (Some(one_error(value, interval)), [error(0), error(1)]);
        return Some(Rejected { source, beyond: sampled.beyond, error, errors, intervals: sampled.intervals });
    }
    if let Some(tail) = &one.evidence.tail_sampled {
        let error = |side: usize| Some(one_error(tail.beyond[side]?, tail.intervals[side]?));
        let (error, errors) = (Some(one_error(tail.yield_, tail.interval)), [error(0), error(1)]);
        return Some(Rejected { source, beyond: tail.beyond, error, errors, intervals: tail.intervals });
    }
    let verification = one.evidence.verification.as_ref().filter(|of| of.kind == VerificationKind::Sample)?;
    let (own, point) = (verification.figures.yield_?, verification.point);
    let interval = |share: f64, error: f64| weighted_interval(share, scatter(error, point), point);
    let plain = || Rejected {
        source,
        beyond: verification.figures.beyond.map(value),
        error: Some(own.error),
        errors: verification.figures.beyond.map(|of| of.map(|of| of.error)),
        intervals: verification.figures.beyond.map(|of| of.map(|of| interval(of.value, of.error))),
    };
    // Counts of the surface are no control variate: the sample is as accurate.
    let control = one.evidence.surface_law.as_ref().filter(|law| law.counted.is_none());
    let (Some([within, differences @ ..]), Some(law)) = (verification.difference, control) else {
        return Some(plain());
    };
    let error = libm::hypot(within.error, law.error());
    let of_law = [law.below, law.above];
    let beyond = [0, 1].map(|side| of_law[side].map(|of| of.value + differences[side].value));
    let errors = [0, 1].map(|side| of_law[side].map(|of| libm::hypot(of.error, differences[side].error)));
    // Half-width: scatter of the differences of model and surface, and the share that no point may have shown.
    let [_, unseen] = weighted_interval(0.0, 0.0, point);
    let reach = |side: usize| {
        let scattered = libm::hypot(scatter(differences[side].error, point), of_law[side]?.error);
        Some(libm::hypot(verdict::ERRORS * scattered, unseen))
    };
    let interval = |side: usize| Some(verdict::share([beyond[side]? - reach(side)?, beyond[side]? + reach(side)?]));
    match error < own.error && beyond.iter().flatten().all(|&share| share >= 0.0) {
        true => Some(Rejected { source, beyond, error: Some(error), errors, intervals: [interval(0), interval(1)] }),
        false => Some(plain()),
    }
}

/// Part of a sample's error that comes from the scatter of its points, without the allowance for rejects that no point has shown.
fn scatter(error: f64, point: f64) -> f64 {
    (error * error - point * point).max(0.0).sqrt()
}

fn value(of: Option<Verified>) -> Option<f64> {
    of.map(|of| of.value)
}

/// Rejects from the surface distribution, with the errors of check points, or of moments and tails without them.
fn surface(one: &CharacteristicAnalysis, whole: Option<&SurfaceLaw>) -> Option<Rejected> {
    let law = one.evidence.surface_law.as_ref().filter(|_| one.characteristic.limits().exist())?;
    let beyond = [law.below, law.above];
    let checked = one.evidence.verification.as_ref().filter(|of| of.kind == VerificationKind::Checks);
    let (surface, sides) = match checked {
        Some(of) => (of.figures.yield_.map(|of| of.error), of.figures.beyond.map(|of| of.map(|of| of.error))),
        None => {
            let of_fit = one.error_estimate.as_ref().and_then(|of| of.yield_);
            let of_tails = whole.and_then(|whole| error_of_shares(one, whole)).unwrap_or([0.0; 2]);
            let [below, above] = by_moments(one);
            let sides = [below.map(|of| of.max(of_tails[0])), above.map(|of| of.max(of_tails[1]))];
            (of_fit.map(|of_fit| of_fit.max(libm::hypot(of_tails[0], of_tails[1]))), sides)
        }
    };
    let errors = [0, 1].map(|side| Some(libm::hypot(sides[side]?, beyond[side]?.error)));
    let error = surface.map(|error| libm::hypot(error, law.error()));
    Some(Rejected::new(YieldSource::SurfaceLaw, beyond.map(|of| of.map(|of| of.value)), error, errors))
}

/// Rejects from the Pearson fit, if nothing better is known.
fn pearson(one: &CharacteristicAnalysis) -> Option<Rejected> {
    let own = one.evidence.pearson?;
    let error = one.error_estimate.as_ref().and_then(|of| of.yield_);
    Some(Rejected::new(YieldSource::Pearson, [own.below, own.above], error, by_moments(one)))
}

/// Capability with the rejects of the chosen source, and the indices by the quantiles.
fn capability(one: &CharacteristicAnalysis, [below, above]: [Option<f64>; 2]) -> Option<Capability> {
    let moments = one.moments?;
    let limits = one.characteristic.limits();
    let [cp_percentile, cpk_percentile] = one.distribution.quantiles.map_or([None; 2], |of| of.indices(limits));
    let base = Capability::of_moments(moments.mean(), moments.sigma(), limits);
    Some(Capability { below, above, cp_percentile, cpk_percentile, ..base })
}

/// Density from points of the model, if these are the source of the quantiles and the surface is not trusted. Returns None if none is
/// requested.
fn sampled_density(one: &CharacteristicAnalysis, options: &Options) -> Option<Vec<[f64; 3]>> {
    let verification =
        one.evidence.verification.as_ref().filter(|of| of.kind == VerificationKind::Sample && options.densities)?;
    verification.sample.as_deref().filter(|_| !verification.follows_surface())?.density()
}
