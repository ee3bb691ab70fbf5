//! Common part of all searches of tolerances: analyses of the model at given tolerances, within budget and time.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::{Constraint, kept};
use crate::allocation::requirement::form::Basis;
use crate::allocation::requirement::registry::form_of;
use crate::allocation::search::linearization_point::{LinearizationPoint, Seen};
use crate::allocation::surface::corners::Places;
use crate::allocation::surface::response::Responses;
use crate::allocation::surface::sampled_moments::SampledCorrection;
use crate::allocation::surface::uncertainty::Uncertainty;
use crate::allocation::task::{AllocateError, AllocationOptions, AllocationTask, Goal};
use crate::analysis::{Analysis, CharacteristicAnalysis, Findings, analyze_keeping, run_method};
use crate::assembly::Run;
use crate::method::{MethodError, Options, Outcome};
use crate::problem::Problem;
use crate::summary::{RunSummary, StopReason};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::requirement::Requirement;

/// Greatest number of rounds, each with an analysis for new derivatives.
pub(in crate::allocation) const ROUNDS: usize = 20;

/// Evaluations so far, and values that later rounds need.
#[derive(Default)]
pub(in crate::allocation) struct Spent {
    pub(in crate::allocation) run: RunSummary,
    pub(in crate::allocation) rounds: usize,
    pub(in crate::allocation) stopped: bool,
    /// Greatest uncertainty of every characteristic since the rounds have [settled](SETTLED).
    uncertainty: Vec<Uncertainty>,
    /// Greatest uncertainty of the joint yield since then.
    joint_uncertainty: f64,
    /// Additional requirement of every characteristic, because trials missed it.
    stricter: Vec<Uncertainty>,
    /// Additional requirement of the joint yield, because trials missed it.
    joint_stricter: f64,
    /// Cheapest linearization point that kept everything.
    pub(in crate::allocation) seen: Option<Seen>,
    /// Places of the farthest reach of formulas, by characteristic.
    places: BTreeMap<usize, [Places; 2]>,
    /// Points of a cheap model in addition to the evaluations.
    pub(in crate::allocation) points: Arc<AtomicU64>,
}

/// Rounds after which uncertainties only grow. The uncertainty of a sample jumps when an assembly passes a limit. The
/// search could otherwise alternate between two neighbouring linearization points.
const SETTLED: usize = 4;
/// Level of a goal, in sigmas. The uncertainty of a figure does not depend on the level.
const ANY_LEVEL: f64 = 3.0;

impl Spent {
    /// Adds to the requirements from the next linearization point on.
    pub(in crate::allocation) fn require_more(&mut self, more: &[Uncertainty], joint: f64) {
        self.stricter.resize(more.len(), Uncertainty::default());
        self.stricter.iter_mut().zip(more).for_each(|(all, more)| all.add(more));
        self.joint_stricter += joint;
    }
}

/// Function that returns the dimensions of a problem as they stand in the file of its study.
pub(crate) type AsWritten<'a> = &'a dyn Fn(&Problem) -> Option<Vec<Dimension>>;

/// Task, options and state of an allocation.
pub(in crate::allocation) struct Driver<'a> {
    pub(in crate::allocation) task: &'a AllocationTask,
    pub(in crate::allocation) options: &'a AllocationOptions,
    pub(in crate::allocation) run: &'a Run<'a>,
    /// Requirements of all characteristics.
    pub(in crate::allocation) required: Vec<(usize, Requirement)>,
    pub(in crate::allocation) written: Option<AsWritten<'a>>,
    pub(in crate::allocation) spent: Spent,
}

/// Distances at which a search has converged. They are larger for a costly model, because every round evaluates it.
#[derive(Clone, Copy)]
pub(in crate::allocation) struct Near {
    /// Relative change within which tolerances agree.
    pub(in crate::allocation) agree: f64,
    /// Part by which tolerances are tightened, in case the next analysis differs.
    pub(in crate::allocation) margin: f64,
    /// Move within which nominal values are at rest, in sigmas.
    pub(in crate::allocation) rest: f64,
}

/// Error of a requirement that is followed along its slopes, relative to the square of a change of tolerances. The
/// second derivatives of the [corrections](crate::allocation::surface::surface_slack) of a slack are some tenths.
const BENT: f64 = 0.1;
/// Ten times the error of moments by differences, whose steps in `ln T` give them to 1e-10.
const NOISE: f64 = 1e-9;

impl Near {
    pub(in crate::allocation) fn of(problem: &Problem) -> Self {
        let (agree, rest) = if problem.function().signature().costly { (1e-3, 1e-3) } else { (1e-7, 1e-6) };
        Self { agree, margin: (BENT * agree * agree).max(NOISE), rest }
    }
}

/// True if a constraint with this value is kept. A level that is sought for a cost is not promised, so it may differ by
/// as much as another round would change it.
pub(in crate::allocation) fn kept_within(value: f64, goal: Goal) -> bool {
    /// Tolerance of a sought level, relative to sigma squared.
    const SOUGHT: f64 = 1e-6;
    kept(value) || goal != Goal::LeastCost && value <= 1.0 + SOUGHT
}

impl Driver<'_> {
    pub(in crate::allocation) fn constraints(
        &self,
        problem: &Problem,
        requirements: &[Option<Requirement>],
    ) -> Vec<Constraint> {
        let of = |(c, one): (usize, &Option<Requirement>)| {
            Some(Constraint::of(c, (*one)?, problem.characteristics()[c].limits()))
        };
        let all: Vec<Constraint> = requirements.iter().enumerate().filter_map(of).flatten().collect();
        all.into_iter().chain(self.joint_constraint(problem)).collect()
    }

    /// Constraint of the joint yield, if one is required. It has the name of the first characteristic with limits.
    fn joint_constraint(&self, problem: &Problem) -> Option<Constraint> {
        let least = self.task.joint_target(problem, self.options)?;
        let mut limited = problem.characteristics().iter().enumerate().filter(|(_, one)| one.limits().exist());
        limited.next().map(|(c, one)| Constraint::joint(c, least, one.limits()))
    }

    /// Analyses the model for a problem, which gives a linearization point. An error is an error of the task only in
    /// the first round.
    pub(in crate::allocation) fn analysed(&mut self, problem: Problem) -> Result<LinearizationPoint, AllocateError> {
        let budget = self
            .options
            .analysis
            .budget
            .map(|budget| budget.saturating_sub(usize::try_from(self.spent.run.evaluations).unwrap_or(usize::MAX)));
        // Hundreds of points in every round would decide yields of tolerances that are not the last ones.
        let options = Options { budget, sample_tails: false, ..self.options.derivatives(&problem) };
        let (analysis, findings) = analyze_keeping(&problem, &options, self.run)?;
        self.spent.run = self.spent.run.and(&analysis.run);
        self.spent.rounds += 1;
        self.spent.stopped |= analysis.run.unfinished();
        let over_box: Vec<bool> = self.task.requirements.iter().map(is_over_box).collect();
        let mut responses = Responses::of(&problem, &findings.outcome, &analysis, &over_box);
        self.require_certainty(&analysis, &mut responses);
        self.correct(&problem, &analysis, &mut responses);
        self.correct_widths(&problem, &options, &findings, &mut responses);
        if !problem.function().signature().costly {
            let Spent { places, points, .. } = &mut self.spent;
            responses.follow_corners(&problem, places, points);
        }
        if self.task.goal == Goal::LeastCost {
            self.constraints(&problem, &self.task.requirements).par_iter().for_each(|one| one.prepare(&responses));
        }
        Ok(LinearizationPoint { problem, analysis, findings, responses })
    }

    /// Adds the uncertainty of an analysis, and misses of earlier trials, to the requirements.
    fn require_certainty(&mut self, analysis: &Analysis, responses: &mut Responses) {
        for (c, one) in responses.of.iter_mut().enumerate() {
            for requirement in self.task.requirements[c].into_iter().chain(self.task.goal.at(ANY_LEVEL)) {
                let distance = form_of(&requirement).uncertainty(requirement, &analysis.characteristics[c]);
                one.uncertainty.set(&requirement, distance);
            }
        }
        if self.spent.rounds > SETTLED {
            self.spent.uncertainty.resize(responses.of.len(), Uncertainty::default());
            for (one, most) in responses.of.iter_mut().zip(&mut self.spent.uncertainty) {
                most.raise_to(&one.uncertainty);
                one.uncertainty.clone_from(most);
            }
            self.spent.joint_uncertainty = self.spent.joint_uncertainty.max(responses.joint_uncertainty);
            responses.joint_uncertainty = self.spent.joint_uncertainty;
        }
        for (one, more) in responses.of.iter_mut().zip(&self.spent.stricter) {
            one.uncertainty.add(more);
        }
        responses.joint_uncertainty += self.spent.joint_stricter;
    }

    /// Analysis of a linearization point, with the results that are only reported.
    pub(in crate::allocation) fn completed(
        &self,
        analysis: Analysis,
        findings: &Findings,
        problem: &Problem,
    ) -> Analysis {
        analysis.completed(findings, problem, &self.options.derivatives(problem), self.run)
    }

    /// Corrects moments by samples of the model, if its verification refutes the surface, the requirement uses moments,
    /// and the model is cheap.
    fn correct(&self, problem: &Problem, analysis: &Analysis, responses: &mut Responses) {
        let of = |(c, one): (usize, &CharacteristicAnalysis)| {
            let refuted = one.evidence.verification.as_ref().is_some_and(|of| of.replaced);
            let moments = self.task.requirements[c].is_some_and(|of| !form_of(&of).basis().is_by_band());
            (refuted && moments).then_some((c, one.moments?))
        };
        let verified: Vec<(usize, Moments)> = analysis.characteristics.iter().enumerate().filter_map(of).collect();
        let priced = &self.task.priced;
        let many = priced.len() > SampledCorrection::MOST_GROUPS;
        if verified.is_empty() || many || problem.function().signature().costly || self.run.stopped() {
            return;
        }
        let at = |g: usize, factor: f64| {
            let half = priced[g].present(problem.dimensions());
            with_tolerances(problem.clone(), &priced[g..=g], &[factor * half]).ok()
        };
        let surface = |c: usize, g: usize, factor: f64| {
            let mut factors = vec![1.0; problem.dimensions().len()];
            priced[g].members.iter().for_each(|&d| factors[d] = factor);
            responses.moments(c, &factors)
        };
        let (found, points) = SampledCorrection::of(&verified, priced, &at, &surface, self.options.seed, self.run);
        self.spent.points.fetch_add(points, Ordering::Relaxed);
        for (c, correction) in found {
            responses.of[c].sampled = correction;
        }
    }

    /// Corrects the slopes by zones whose widths stand in formulas too, such as those with a bonus. Costs two analyses
    /// of the derivatives for each.
    fn correct_widths(&mut self, problem: &Problem, options: &Options, findings: &Findings, responses: &mut Responses) {
        let priced = &self.task.priced;
        let groups: Vec<(usize, usize)> = (priced.iter().enumerate())
            .filter(|(_, group)| group.zone.as_ref().is_some_and(|zone| !zone.widths.is_empty()))
            .map(|(g, group)| (g, group.members[0]))
            .collect();
        let open: Vec<usize> = (0..responses.of.len()).filter(|&c| !responses.is_sampled(c)).collect();
        if groups.is_empty() || open.is_empty() || self.run.stopped() {
            return;
        }
        let mut known: Vec<(usize, f64, Option<Outcome>)> = Vec::new();
        for &(g, _) in &groups {
            for factor in SampledCorrection::width_factors() {
                let present = priced[g].present(problem.dimensions());
                let moved = with_tolerances(problem.clone(), &priced[g..=g], &[factor * present]).ok();
                known.push((g, factor, moved.and_then(|moved| run_method(&moved, options, self.run).ok())));
            }
        }
        let moments = |outcome: &Outcome, c: usize| {
            let surrogate = outcome.fitted[c].surrogate.as_ref()?;
            Some(surrogate.contributions(outcome.plan.inputs())?.moments)
        };
        for c in open {
            let model = |g: usize, factor: f64| {
                let (.., outcome) = known.iter().find(|known| known.0 == g && known.1 == factor)?;
                moments(outcome.as_ref()?, c)
            };
            let surface = |g: usize, factor: f64| {
                let mut factors = vec![1.0; problem.dimensions().len()];
                priced[g].members.iter().for_each(|&d| factors[d] = factor);
                responses.moments(c, &factors)
            };
            let own = moments(&findings.outcome, c);
            let found = own.and_then(|own| SampledCorrection::of_widths(&own, &groups, &model, &surface));
            responses.of[c].sampled = found;
        }
    }

    /// Analyses the model in later rounds. Returns None if the budget does not allow it.
    pub(in crate::allocation) fn station(
        &mut self,
        problem: Problem,
    ) -> Result<Option<LinearizationPoint>, AllocateError> {
        match self.analysed(problem) {
            Ok(station) => Ok(Some(station)),
            Err(AllocateError::Method(MethodError::OverBudget { .. })) => {
                self.spent.run.stopped.get_or_insert(StopReason::Budget);
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }
}

/// True if a requirement needs the extremes over the box of the tolerance bands.
fn is_over_box(requirement: &Option<Requirement>) -> bool {
    requirement.is_some_and(|one| form_of(&one).basis() == Basis::Box)
}

pub(in crate::allocation) fn unit(problem: &Problem, characteristic: usize) -> Option<String> {
    problem.characteristics()[characteristic].unit().map(str::to_owned)
}

pub(in crate::allocation) fn cost(priced: &[Priced], at: &[f64], offers: &[usize]) -> f64 {
    let of = |((group, &t), &offer): ((&Priced, &f64), &usize)| group.parts * group.offers[offer].curve.cost(t);
    priced.iter().zip(at).zip(offers).map(of).sum()
}

/// Problem with the groups at these half bands, whatever offer holds them.
pub(in crate::allocation) fn with_tolerances(
    problem: Problem,
    priced: &[Priced],
    at: &[f64],
) -> Result<Problem, AllocateError> {
    let mut dimensions = problem.dimensions().to_vec();
    for (group, &t) in priced.iter().zip(at) {
        for (d, share) in group.shared() {
            let factor = share * t / dimensions[d].half_band();
            if let Some(scaled) = dimensions[d].scaled(factor) {
                dimensions[d] = scaled?;
            }
        }
        follow(&mut dimensions, group, t)?;
    }
    Ok(problem.with_dimensions(dimensions)?)
}

/// Problem with the groups at these half bands, as the chosen offers make them.
pub(in crate::allocation) fn with_choice(
    problem: Problem,
    priced: &[Priced],
    at: &[f64],
    offers: &[usize],
) -> Result<Problem, AllocateError> {
    let mut dimensions = problem.dimensions().to_vec();
    for ((group, &t), &offer) in priced.iter().zip(at).zip(offers) {
        for (d, made) in group.offered(&group.offers[offer], problem.dimensions(), |_, share| share * t) {
            if let Some(made) = made {
                dimensions[d] = made?;
            }
        }
        follow(&mut dimensions, group, t)?;
    }
    Ok(problem.with_dimensions(dimensions)?)
}

/// Sets the widths in formulas of a zone.
fn follow(dimensions: &mut [Dimension], group: &Priced, t: f64) -> Result<(), AllocateError> {
    for &(d, factor) in group.zone.iter().flat_map(|zone| &zone.widths) {
        if let Some(moved) = dimensions[d].moved(factor * t) {
            dimensions[d] = moved?;
        }
    }
    Ok(())
}
