//! The main job: from a problem to moments, sensitivities, contributions and warnings.

pub mod distribution;
mod evaluation_summary;
mod interaction_truncation;
mod likely_mistakes;
mod output_correlation;
mod result;
mod sampling;
mod sobol_estimate;
mod warnings;

use std::cell::OnceCell;

use crate::analysis::distribution::conditional::conditional_yields;
use crate::analysis::distribution::distribution_free::distribution_free_yields;
pub use crate::analysis::distribution::law_guard::{LawRefutation, LawTest};
pub use crate::analysis::distribution::moment_basis::{Fit, NoFit, Surface};
pub use crate::analysis::distribution::surface_law::SurfaceShares;
pub(crate) use crate::analysis::distribution::surface_law::{law_over, surface_law};
use crate::analysis::distribution::yield_selection;
pub use crate::analysis::evaluation_summary::Account;
pub use crate::analysis::result::characteristic::{CharacteristicAnalysis, MissingPoints, Sensitivity};
pub use crate::analysis::result::conclusion::CharacteristicConclusion;
pub use crate::analysis::result::contribution_figures::ContributionFigures;
pub use crate::analysis::result::coverage_intervals::CoverageIntervals;
pub use crate::analysis::result::distribution_figures::DistributionFigures;
pub use crate::analysis::result::evidence::Evidence;
pub use crate::analysis::result::figure_basis::{FigureBases, FigureBasis};
pub use crate::analysis::result::interaction::{Interaction, InteractionList, Missing};
use crate::analysis::result::interaction_listing;
pub use crate::analysis::result::interaction_remainder::Remainder;
pub use crate::analysis::result::points_to_decide::points_to_decide;
pub use crate::analysis::result::quantile_estimates::QuantileEstimates;
pub use crate::analysis::result::range_figures::{LinearFigures, RangeFigures};
pub use crate::analysis::result::sampled_model::SampledModel;
pub use crate::analysis::result::sampled_tail::SampledTail;
pub use crate::analysis::result::sobol_indices::{FactorIndices, IndexSource, SobolIndices};
use crate::analysis::result::stage_figures::with_stage;
pub(crate) use crate::analysis::result::verification::TRUSTED;
pub use crate::analysis::result::verification::{VarianceShare, Verification, VerificationKind, VerifiedFigures};
pub use crate::analysis::result::yield_source::YieldSource;
use crate::analysis::sampling::accuracy_target;
pub use crate::analysis::sampling::choice_sample::choice_points;
use crate::analysis::sampling::choice_sample::choice_samples;
use crate::analysis::sampling::jump;
use crate::analysis::sampling::measured_interval::sampling_intervals;
use crate::analysis::sampling::model_sample::model_samples;
use crate::analysis::sampling::nominal_kink;
use crate::analysis::sampling::recorded_failures::recorded_failures;
use crate::analysis::sampling::sample_budget::SampleBudget;
pub use crate::analysis::sampling::tail_sample::most_tail_points;
use crate::analysis::sampling::{tail_sample, verification_stage};
pub use crate::estimate::{ConditionalYield, DistributionFreeYield};
pub use crate::extremes::{Coordinate, Extreme, Extremes, ExtremesProof, Place};
pub use crate::verification::{Crossing, FoundSwitch, OutputCorrelation, Share, Verified};
pub use sensitol_numeric::capability::{EstimatedShare, InspectionRisks};
pub use sensitol_numeric::law::{Branch, LawError, LawFigure};
pub use sensitol_numeric::moments::{Contributions, Sampled};
pub use sensitol_numeric::sampling::SamplingInterval;
pub use sensitol_numeric::surrogate::DerivativeOrigin;
pub use sensitol_numeric::surrogate::Relocation;

use serde::Serialize;

use crate::analysis::result::variance_share::Shares;
use crate::assembly::Run;
use crate::evaluation::{Evaluator, Ledger, Restoration, Restore, at_any_size};
use crate::extremes::{SearchedExtremes, enclose, search};
use crate::method::{
    Basis, ClimbEnd, DerivativeSource, Method, MethodError, Options, Outcome, ReducedInputs, ReducedSurface,
    climb_until,
};
use crate::problem::Problem;
use crate::rare::RefutedTail;
use crate::summary::{RunSummary, StopReason};
use crate::warning::Warning;
use sensitol_numeric::law::SurfaceLaw;
use sensitol_numeric::parallel::join;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::power::{Rescale, Rescaling};
use sensitol_numeric::time::Instant;
use sensitol_numeric::verdict::{self, Judged};

/// The results of an analysis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(remote = "Self")]
pub struct Analysis {
    /// Method that was run. For `auto`, the method that it chose.
    pub method: Method,
    /// Dimensions that vary and on which some characteristic can depend, N.
    pub varying: usize,
    /// Points, time, and the reason of an early end. The seed, if one was given or random numbers were drawn.
    #[serde(flatten)]
    pub run: RunSummary,
    /// The results of every characteristic, in the problem's order.
    pub characteristics: Vec<CharacteristicAnalysis>,
    /// Share of assemblies that keep the limits of all characteristics at once, with its error. None if fewer than two characteristics have
    /// limits, or if it is unknown.
    #[serde(rename = "joint_yield")]
    pub joint: Option<Verified>,
    /// Interval of the joint yield: two errors on either side, widened by the uncertainty of measured samples. None if it is unknown.
    #[serde(rename = "joint_yield_interval")]
    pub joint_interval: Option<[f64; 2]>,
    /// Verdict on the target for the joint yield. None if there is no such target.
    pub joint_requirement: Option<Judged>,
    /// Correlations of every two characteristics. Empty with one characteristic, and with more than 40.
    #[serde(rename = "characteristic_correlation")]
    pub correlations: Vec<OutputCorrelation>,
    /// The findings of `auto` and the use of its points; None for any other method.
    pub account: Option<Account>,
    /// Source of the derivatives from which the moments follow. None if they follow from none.
    pub derivatives: Option<DerivativeSource>,
    /// The basis of the moments.
    pub basis: Basis,
    /// Surface from which the moments follow.
    #[serde(skip)]
    pub surface: Surface,
    /// Assumptions that fail.
    #[serde(skip)]
    pub warnings: Vec<Warning>,
}

/// Analyses a problem.
///
/// Evaluations: as [`Options::cost`] states, one more if some mean is not the nominal, and more only if the model fails. With
/// [`Options::extremes`], those of the search are added.
///
/// # Errors
/// Returns an error if the options do not fit the problem; nothing is evaluated then. A model that fails is not an error: the figures that
/// it prevents are missing from the result and named in the warnings.
///
/// ```
/// use sensitol::{Closure, Dimension, Method, Problem, analyze};
/// let dimensions = [Dimension::normal("width", 20.0, 0.3)?, Dimension::normal("height", 10.0, 0.3)?];
/// let area = Problem::new(dimensions, Closure::scalar("area", |x| x[0] * x[1]))?;
/// let analysis = analyze(&area, &Method::Full.into())?;
/// assert_eq!(analysis.run.evaluations, 7); // N^2 + N + 1
/// let moments = analysis.characteristics[0].moments.unwrap();
/// let exact = (2.0f64.powi(2) + 1.0 + 0.01f64.powi(2)).sqrt(); // (20 x 0.1)^2 + (10 x 0.1)^2 + (0.1 x 0.1)^2
/// assert!((moments.sigma() - exact).abs() < 1e-12);
/// # Ok::<(), sensitol::Error>(())
/// ```
pub fn analyze(problem: &Problem, options: &Options) -> Result<Analysis, MethodError> {
    analyze_with(problem, options, &Run::to_the_end())
}

/// [`analyze`] with reports of progress and a way to stop.
pub fn analyze_with(problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Analysis, MethodError> {
    at_any_size(problem, run, |problem, run| {
        let (analysis, findings) = analyze_keeping(problem, options, run)?;
        Ok(analysis.completed(&findings, problem, options, run))
    })
}

impl Restore for Analysis {
    fn restore(&mut self, back: &Restoration<'_>) {
        back.add_time(&mut self.run);
        self.rescale(back);
    }
}

impl Analysis {
    /// Multiplies every figure in the unit of a characteristic.
    pub(crate) fn rescale(&mut self, back: &Restoration<'_>) {
        if back.is_nothing() {
            return;
        }
        for (c, one) in self.characteristics.iter_mut().enumerate() {
            let mut rescaling = Rescaling::by(back.power(c));
            one.characteristic = back.problem.characteristics()[c].clone();
            one.rescale(&mut rescaling);
            // Values of the characteristic, and densities per unit of it.
            for [at, density, error] in one.evidence.density.iter_mut().flatten() {
                at.rescale(&mut rescaling);
                rescaling.divide(density);
                rescaling.divide(error);
            }
            self.surface.characteristics[c].rescale(&mut rescaling);
            let lost = Warning::Unrepresentable { characteristic: one.characteristic.name().to_owned() };
            if rescaling.has_lost() && !self.warnings.contains(&lost) {
                self.warnings.push(lost);
            }
        }
        self.warnings.iter_mut().for_each(|warning| warning.rescale(|name| back.power_of(name)));
    }
}

/// Intermediate results of an analysis, for later steps.
pub(crate) struct Findings {
    pub(crate) outcome: Outcome,
    /// Distributions of the surfaces by characteristic, if the yields use them.
    laws: Vec<Option<SurfaceLaw>>,
    /// Rest of the budget for points of a cheap model.
    left: SampleBudget,
}

/// Figures of the method after their comparison with the model.
struct Checked {
    characteristics: Vec<CharacteristicAnalysis>,
    /// Shares of the variance by characteristic, for the list of interactions.
    shares: Vec<Option<Shares>>,
    /// Ledger of the search for extremes.
    extremes: Ledger,
    /// Warnings of jumps and of failures in the journal.
    found: Vec<Warning>,
    /// Rest of the budget for points of a cheap model.
    left: SampleBudget,
    /// Ledger of the method and of all other questions.
    ledger: Ledger,
}

/// Compares the figures of a method with the model: extremes, sampled points, jumps, verification, and failures in the journal.
fn check(problem: &Problem, outcome: &Outcome, options: &Options, run: &Run<'_>) -> Checked {
    let seed = options.seed.unwrap_or(Options::SEED);
    let method = outcome.evaluated.ledger.clone();
    let left = options.budget.map(|budget| budget.saturating_sub(method.evaluations()));
    let SearchedExtremes { extremes: searched, ledger: extremes } = match options.extremes {
        true => search(&Evaluator::new(problem, run).with_budget(left).with_seed(seed), outcome),
        false => SearchedExtremes::default(),
    };
    // All further questions continue the ledger of the method. The budget is what the extremes leave of it.
    let budget = options.budget.map(|budget| budget.saturating_sub(extremes.evaluations()));
    let evaluator = Evaluator::new(problem, run).with_budget(budget).with_seed(seed).with_ledger(method);
    let (characteristics, shares): (Vec<_>, Vec<_>) = of_all(problem, outcome).into_iter().unzip();
    let signature = problem.function().signature();
    let verified = options.verifies(signature);
    let chosen = choice_samples(&evaluator, outcome, options, &characteristics);
    let characteristics = with_stage(characteristics, chosen, CharacteristicAnalysis::with_model_sample);
    // A cheap model that is verified is sampled anyway, at points that need no surface: no fallback is needed.
    let kinks = match signature.costly && verified {
        true => nominal_kink::find(&evaluator, outcome, &characteristics),
        false => Vec::new(),
    };
    let kinked: Vec<usize> = kinks.iter().map(|kink| kink.characteristic).collect();
    let sampled = match signature.costly || !verified {
        true => model_samples(&evaluator, outcome, &kinked, &characteristics),
        false => Vec::new(),
    };
    let characteristics = with_stage(characteristics, sampled, CharacteristicAnalysis::with_model_sample);
    let searched = searched.into_iter().enumerate();
    let characteristics = with_stage(characteristics, searched, CharacteristicAnalysis::with_extremes);
    let mut found = match signature.costly && verified {
        true => jump::find(&evaluator, outcome, &characteristics),
        false => Vec::new(),
    };
    found.extend(kinks.into_iter().map(|kink| kink.warning));
    let mut left = SampleBudget::new(evaluator.remaining());
    let verified = verification_stage::verify(&evaluator, outcome, options, (&kinked, &mut left), &characteristics);
    let refuted: Vec<RefutedTail> = (verified.iter())
        .filter_map(|(c, of)| Some(RefutedTail { characteristic: *c, points: of.refuted.clone()? }))
        .collect();
    let characteristics = with_stage(characteristics, verified, CharacteristicAnalysis::with_verification);
    let tails = tail_sample::decide(&evaluator, outcome, options, &refuted, &characteristics);
    let characteristics = with_stage(characteristics, tails, CharacteristicAnalysis::with_tail_sample);
    let recorded = recorded_failures(problem);
    let failures: Vec<(usize, usize)> = recorded.iter().map(|(c, of)| (*c, of.failed)).collect();
    let characteristics = with_stage(characteristics, failures, CharacteristicAnalysis::with_failures);
    found.extend(recorded.into_iter().map(|(_, of)| of.warning));
    Checked { characteristics, shares, extremes, found, left, ledger: evaluator.into_ledger() }
}

/// The part of [`analyze_with`] that a search of tolerances needs for each of its trials. [`Analysis::completed`] adds the rest.
pub(crate) fn analyze_keeping(
    problem: &Problem,
    options: &Options,
    run: &Run<'_>,
) -> Result<(Analysis, Findings), MethodError> {
    let begun = Instant::now();
    let outcome = run_method(problem, options, run)?;
    let seed = options.seed.unwrap_or(Options::SEED);
    let Checked { characteristics, shares, extremes, found, mut left, ledger } = check(problem, &outcome, options, run);
    let bounded = options.verifies(problem.function().signature()) && !run.stopped();
    let bounds = || if bounded { bounds(problem, &outcome, &characteristics, run) } else { Vec::new() };
    let laws = || yield_selection::laws(problem, &outcome, options, &characteristics);
    // Both need matrices of all inputs. From four megabytes on they are computed one after the other, so that only one is in memory.
    let large = outcome.plan.varying().len().pow(2) * size_of::<f64>() > 4 << 20;
    let (bounds, laws) = if large { (bounds(), laws()) } else { join(bounds, laws) };
    let bounds = bounds.into_iter().enumerate();
    let characteristics = with_stage(characteristics, bounds, CharacteristicAnalysis::with_bounds);
    let (characteristics, mut laws) =
        yield_selection::with_distributions(problem, &outcome, options, characteristics, laws);
    if !yield_selection::have_joint_yield(&characteristics) {
        // Nothing uses the distributions again, and with many inputs they are large.
        laws.clear();
    }
    // The list needs much memory with many inputs: it is made after the distributions were dropped.
    let interactions = (shares.into_iter().enumerate())
        .map(|(c, shares)| (c, interaction_listing::listed(problem, &outcome, c, shares.as_ref())));
    let characteristics = with_stage(characteristics, interactions, CharacteristicAnalysis::with_interactions);
    let free = distribution_free_yields(problem, &outcome, options, &mut left, &characteristics);
    let characteristics = with_stage(characteristics, free, CharacteristicAnalysis::with_distribution_free_yield);
    let joint = (options.target_joint_yield)
        .and_then(|_| yield_selection::joint(problem, options, &mut left, &characteristics, &laws));
    let conditional = conditional_yields(problem, options, &mut left, &characteristics, &laws);
    let characteristics = with_stage(characteristics, conditional, CharacteristicAnalysis::with_conditional_yield);
    let spent = spent(&outcome, options, ledger.run);
    // The extremes do not affect shares: only the other questions decide whether a share is unfinished.
    let unfinished = spent.unfinished();
    let characteristics: Vec<CharacteristicAnalysis> =
        characteristics.into_iter().map(|one| one.with_open_points(unfinished)).collect();
    let non_repeatable = [ledger.non_repeatable, extremes.non_repeatable].concat();
    let warnings = warnings::of(problem, &outcome, &characteristics, &non_repeatable, found);
    let account = Account::of(problem, &outcome, &characteristics, outcome.evaluated.ledger.evaluations());
    let (measured, drawn) = sampling_intervals(problem, &outcome, &characteristics, seed);
    let characteristics = with_stage(characteristics, measured, CharacteristicAnalysis::with_sampling);
    let surface = Surface::of(&outcome, &characteristics);
    let analysis = Analysis {
        method: outcome.method,
        varying: outcome.plan.varying().len(),
        run: RunSummary {
            wall: begun.elapsed(),
            seed: options.seed.or(drawn.then_some(seed)),
            evaluator: problem.evaluator(),
            ..spent.and(&extremes.run)
        },
        account,
        derivatives: outcome.basis.derivatives(),
        basis: outcome.basis,
        surface,
        joint_requirement: joint_requirement(problem, options, joint, &characteristics),
        joint_interval: joint.and_then(|joint| joint_interval(joint, &characteristics)),
        characteristics,
        joint,
        correlations: Vec::new(),
        warnings,
    };
    Ok((analysis, Findings { outcome, laws, left }))
}

impl Analysis {
    /// Adds the results that no other one needs: the joint yield, the correlations of characteristics, and Sobol' indices.
    pub(crate) fn completed(self, findings: &Findings, problem: &Problem, options: &Options, run: &Run<'_>) -> Self {
        let begun = Instant::now();
        let Findings { outcome, laws, left } = findings;
        let mut left = *left;
        let Self { characteristics, joint, joint_interval: interval, run: spent, .. } = self;
        let (joint, joint_interval) = match joint {
            Some(_) => (joint, interval),
            None => {
                let joint = yield_selection::joint(problem, options, &mut left, &characteristics, laws);
                (joint, joint.and_then(|joint| joint_interval(joint, &characteristics)))
            }
        };
        let correlations = output_correlation::correlations(problem, outcome, options, &mut left, &characteristics);
        // Last, because warnings and accounts also read the contributions of a surface that is not trusted.
        let indices = sobol_estimate::indices(problem, outcome, options, &mut left, &characteristics, run);
        let characteristics = with_stage(characteristics, indices, CharacteristicAnalysis::with_indices);
        let run = RunSummary { wall: spent.wall + begun.elapsed(), ..spent };
        Self { characteristics, joint, joint_interval, correlations, run, ..self }
    }
}

/// Verdict on the joint yield, from its value, two errors on either side, and the uncertainty of measured samples.
fn joint_requirement(
    problem: &Problem,
    options: &Options,
    joint: Option<Verified>,
    characteristics: &[CharacteristicAnalysis],
) -> Option<Judged> {
    let target = options.target_joint_yield?;
    if problem.characteristics().iter().filter(|one| one.limits().exist()).count() < 2 {
        return None;
    }
    let interval = joint.and_then(|joint| joint_interval(joint, characteristics));
    let judged = Judged::of_yield(target, joint.map(|joint| joint.value), interval);
    Some(judged.unless(characteristics.iter().any(|one| one.missing.unfinished)))
}

/// Interval that contains a joint yield. Returns None if measured samples leave it unknown.
fn joint_interval(joint: Verified, characteristics: &[CharacteristicAnalysis]) -> Option<[f64; 2]> {
    let own = verdict::about(joint.value, Some(joint.error))?;
    let interval = match yield_selection::joint_sampling(characteristics, joint.value) {
        Some(measured) => verdict::joined(joint.value, own, measured?),
        None => own,
    };
    Some(verdict::share(interval))
}

/// Bounds by interval arithmetic, for characteristics with a formula whose extremes were not searched.
fn bounds(
    problem: &Problem,
    outcome: &Outcome,
    characteristics: &[CharacteristicAnalysis],
    run: &Run<'_>,
) -> Vec<Option<ExtremesProof>> {
    /// Accuracy of the bounds, as a part of sigma: nearer ends look the same in print.
    const NEAR: f64 = 1e-3;
    let of = |(c, one): (usize, &CharacteristicAnalysis)| {
        let sigma = one.moments.filter(|_| one.range.extremes.is_none() && !one.constant)?.sigma();
        if sigma > 0.0 { enclose(problem, outcome, c, NEAR * sigma, run) } else { None }
    };
    characteristics.par_iter().enumerate().map(of).collect()
}

/// Points and time of all questions, with the budget as stop reason if the method ended because of it.
fn spent(outcome: &Outcome, options: &Options, spent: RunSummary) -> RunSummary {
    let rest = outcome.climbed.as_ref().map(|climbed| climbed.rest);
    let budget = options.budget.filter(|_| rest == Some(ClimbEnd::Budget)).map(|_| StopReason::Budget);
    RunSummary { stopped: spent.stopped.or(budget), ..spent }
}

/// Runs the method of the options. `auto` continues until the errors of results other than sigma also meet their accuracies.
pub(crate) fn run_method(problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError> {
    let narrow = if options.accuracies.any() { None } else { ReducedInputs::of(problem, options) };
    if let Some(narrow) = narrow {
        let spent = match narrow.run(problem, options, run)? {
            ReducedSurface::Fitted(outcome) => return Ok(*outcome),
            ReducedSurface::Spent(spent) => spent,
        };
        let budget = options.budget.map(|budget| budget.saturating_sub(spent.ledger.evaluations()).max(1));
        let mut outcome = options.method.procedure().run(problem, &Options { budget, ..options.clone() }, run)?;
        outcome.evaluated.add_spent(*spent);
        return Ok(outcome);
    }
    let climbs = options.method == Method::Auto && options.derivatives != Some(DerivativeSource::Exact);
    if !climbs || !options.accuracies.any() {
        return options.method.procedure().run(problem, options, run);
    }
    climb_until(problem, options, run, &|outcome| {
        let excess = |one: &CharacteristicAnalysis| accuracy_target::excess(one, &options.accuracies);
        of_all(problem, outcome).iter().map(|(one, _)| excess(one)).fold(0.0, f64::max)
    })
}

fn of_all(problem: &Problem, outcome: &Outcome) -> Vec<(CharacteristicAnalysis, Option<Shares>)> {
    // Only a choice from stock needs it, and it is large with many dimensions and characteristics.
    let dependence = OnceCell::new();
    let of = |c: usize| {
        let (one, shares) = CharacteristicAnalysis::of(problem, outcome, c);
        match problem.choice(c) {
            Some(_) => {
                let one = one.without_linear(&dependence.get_or_init(|| problem.dependence())[c]);
                let by_points = problem.follows_costly_choice(c) && !one.constant;
                if by_points { (one.without_surface(), None) } else { (one, shares) }
            }
            None => (one, shares),
        }
    };
    (0..problem.characteristics().len()).map(of).collect()
}
