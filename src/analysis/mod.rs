//! The main job: from a problem to moments, sensitivities, contributions and warnings.

mod account;
mod bootstrap;
mod characteristic;
mod counted;
mod errors;
mod fallback;
mod interval;
mod linear;
mod settle;
mod shapes;
mod shares;
mod surface;
mod surface_law;
mod trust;
mod verification;
mod verified;
mod warnings;
mod yield_source;

pub use account::Account;
pub use bootstrap::SamplingInterval;
pub use characteristic::{CharacteristicAnalysis, Interaction, Missing, Sensitivity};
pub use fallback::SampledModel;
pub use surface::{Fit, NoFit, Surface};
pub use surface_law::{QUANTILES, SurfaceShares};
pub(crate) use surface_law::{law_over, surface_law};
pub use verified::{Verification, VerificationKind};
pub use yield_source::YieldSource;

use crate::assembly::Run;
use crate::extremes::{SearchedExtremes, search};
use crate::method::{Basis, ClimbEnd, DerivativeSource, Method, MethodError, Options, Outcome, climb_until};
use crate::problem::Problem;
use crate::summary::{RunSummary, StopReason};
use crate::time::Instant;
use crate::verification::Verified;
use crate::warning::Warning;

/// What an analysis found out.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Analysis {
    /// The method that was run: for `auto`, what it stands for.
    pub method: Method,
    /// Dimensions that vary and on which some characteristic can depend, N.
    pub varying: usize,
    /// What it came to in points and time, and why it ended early; the seed, where one was given or random numbers were drawn.
    pub run: RunSummary,
    /// What is known of every characteristic, in the problem's order.
    pub characteristics: Vec<CharacteristicAnalysis>,
    /// The share of assemblies that keep the limits of all characteristics at once, and its error; None with fewer than two that have
    /// limits, and where it is not known.
    pub joint: Option<Verified>,
    /// What `auto` found, and what its points went to; None for any other method.
    pub account: Option<Account>,
    /// What the moments rest on.
    pub basis: Basis,
    /// What the moments follow from.
    pub surface: Surface,
    /// Where an assumption fails.
    pub warnings: Vec<Warning>,
}

/// Analyses a problem.
///
/// Evaluations: as the method says ([`Procedure::count`](crate::method::Procedure::count)), one more when some mean is not
/// the nominal, and more only where the model fails; with [`Options::extremes`] those of the [search](crate::extremes) too.
///
/// # Errors
/// When the options do not fit the problem; nothing is evaluated then. A model that fails is no error: what it costs is
/// missing from the result and named in the warnings.
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
    analyze_within(problem, options, &Run::to_the_end())
}

/// [`analyze`], telling of finished points and stopping when told to.
pub fn analyze_within(problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Analysis, MethodError> {
    analyze_keeping(problem, options, run).map(|(analysis, _)| analysis)
}

/// [`analyze_within`], with what the method found out, for who goes on from there.
pub(crate) fn analyze_keeping(
    problem: &Problem,
    options: &Options,
    run: &Run<'_>,
) -> Result<(Analysis, Outcome), MethodError> {
    let begun = Instant::now();
    let mut outcome = run_method(problem, options, run)?;
    let left = options.budget.map(|budget| budget.saturating_sub(outcome.evaluated.evaluations));
    let found = if options.extremes { search(problem, &outcome, left, run) } else { SearchedExtremes::default() };
    outcome.evaluated.non_repeatable.extend(found.spent.non_repeatable);
    let mut characteristics = of_all(problem, &outcome);
    let left = left.map(|left| left.saturating_sub(found.spent.run.evaluations as usize));
    // A cheap model that is verified is sampled anyway, and by points that need no surface.
    let signature = problem.function().signature();
    let sampled = options.verification(signature) > 0 && !signature.costly;
    let fallback = match sampled {
        true => fallback::Spent::default(),
        false => fallback::fall_back(problem, &outcome, left, &mut characteristics, run),
    };
    outcome.evaluated.non_repeatable.extend(fallback.non_repeatable);
    for (characteristic, extremes) in characteristics.iter_mut().zip(found.extremes) {
        characteristic.extremes = extremes;
    }
    let left = left.map(|left| left.saturating_sub(fallback.run.evaluations as usize));
    let verified = verification::verify(problem, &outcome, options, left, &mut characteristics, run);
    let joint = settle::settle(problem, &outcome, &mut characteristics);
    let spent = spent(&outcome, options).and(&fallback.run).and(&verified);
    // The extremes say nothing of a share.
    characteristics.iter_mut().for_each(|one| one.unfinished = spent.unfinished());
    let warnings = warnings::of(problem, &outcome, &characteristics);
    let account = Account::of(problem, &outcome, &characteristics, outcome.evaluated.evaluations);
    let seed = options.seed.unwrap_or(Options::SEED);
    let drawn = bootstrap::intervals(problem, &outcome, &mut characteristics, seed);
    let analysis = Analysis {
        method: outcome.method,
        varying: outcome.plan.varying().len(),
        run: RunSummary {
            wall: begun.elapsed(),
            seed: options.seed.or(drawn.then_some(seed)),
            ..spent.and(&found.spent.run)
        },
        account,
        basis: outcome.basis,
        surface: Surface::of(&outcome, &characteristics),
        characteristics,
        joint,
        warnings,
    };
    Ok((analysis, outcome))
}

/// What the method came to; its budget ended it where that is why it asked for no more.
fn spent(outcome: &Outcome, options: &Options) -> RunSummary {
    let spent = outcome.evaluated.summary();
    let rest = outcome.climbed.as_ref().map(|climbed| climbed.rest);
    let budget = options.budget.filter(|_| rest == Some(ClimbEnd::Budget)).map(|_| StopReason::Budget);
    RunSummary { stopped: spent.stopped.or(budget), ..spent }
}

/// Runs the method, `auto` until the errors of other results than sigma are what is wanted too.
fn run_method(problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Outcome, MethodError> {
    let climbs = options.method == Method::Auto && options.derivatives != Some(DerivativeSource::Exact);
    if !climbs || !options.accuracies.any() {
        return options.method.procedure().run(problem, options, run);
    }
    climb_until(problem, options, run, &|outcome| {
        let excess = |one: &CharacteristicAnalysis| errors::excess(one, &options.accuracies);
        of_all(problem, outcome).iter().map(excess).fold(0.0, f64::max)
    })
}

fn of_all(problem: &Problem, outcome: &Outcome) -> Vec<CharacteristicAnalysis> {
    (0..problem.characteristics().len()).map(|c| CharacteristicAnalysis::of(problem, outcome, c)).collect()
}
