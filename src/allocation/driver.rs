//! The common part of all searches of tolerances: the model asked at some tolerances, within budget and time.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::choose_made::remade;
use super::constraint::{Constraint, kept};
use super::corners::Places;
use super::cost::Priced;
use super::response::Responses;
use super::sampled::SampledCorrection;
use super::station::{Seen, Station};
use super::task::{AllocateError, AllocationOptions, AllocationTask, Goal};
use super::unknown::Unknown;
use crate::analysis::{Analysis, CharacteristicAnalysis, Findings, analyze_keeping};
use crate::assembly::Run;
use crate::method::{MethodError, Options};
use crate::problem::Problem;
use crate::summary::{RunSummary, StopReason};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::requirement::Requirement;

/// Rounds of derivatives, at most.
pub(super) const ROUNDS: usize = 20;

/// The evaluations so far.
#[derive(Default)]
pub(super) struct Spent {
    pub(super) run: RunSummary,
    pub(super) rounds: usize,
    pub(super) stopped: bool,
    /// The greatest uncertainties since rounds have [settled](SETTLED), of every characteristic and of the joint yield.
    unknown: Vec<Unknown>,
    joint_unknown: f64,
    /// By how much more is required because trials missed it, of every characteristic and of the joint yield.
    stricter: Vec<Unknown>,
    joint_stricter: f64,
    /// The cheapest station that kept everything.
    pub(super) seen: Option<Seen>,
    /// Where formulas were found to reach farthest, by characteristic.
    places: BTreeMap<usize, [Places; 2]>,
    /// Points of a cheap model beside the evaluations.
    pub(super) points: Arc<AtomicU64>,
}

/// Rounds after which uncertainties only grow. Those of a sample jump as an assembly passes a limit, and stations next to each other would
/// be left for each other again and again.
const SETTLED: usize = 4;

impl Spent {
    /// Requires so much more from the next station on.
    pub(super) fn require_more(&mut self, more: &[Unknown], joint: f64) {
        self.stricter.resize(more.len(), Unknown::default());
        self.stricter.iter_mut().zip(more).for_each(|(all, more)| *all = all.and(*more));
        self.joint_stricter += joint;
    }
}

/// The dimensions of a problem as they stand in the file of its study.
pub(crate) type AsWritten<'a> = &'a dyn Fn(&Problem) -> Option<Vec<Dimension>>;

pub(super) struct Driver<'a> {
    pub(super) task: &'a AllocationTask,
    pub(super) options: &'a AllocationOptions,
    pub(super) run: &'a Run<'a>,
    /// Everything that is required of characteristics.
    pub(super) required: Vec<(usize, Requirement)>,
    pub(super) written: Option<AsWritten<'a>>,
    pub(super) spent: Spent,
}

/// How near is near enough: every round asks the model.
#[derive(Clone, Copy)]
pub(super) struct Near {
    /// Tolerances that change by less than this part agree.
    pub(super) agree: f64,
    /// By what part tolerances are tightened for what the model may say differently where it is asked next.
    pub(super) margin: f64,
    /// Nominal values that move by fewer sigmas are at rest.
    pub(super) rest: f64,
}

/// The part of the square of a change of tolerances by which a requirement that is followed along its slopes may be off: the second derivatives of
/// the [corrections](super::correction) of a room are some tenths.
const BENT: f64 = 0.1;
/// Ten times the error of moments by differences, whose steps in `ln T` know them to 1e-10.
const NOISE: f64 = 1e-9;

impl Near {
    pub(super) fn of(problem: &Problem) -> Self {
        let (agree, rest) = if problem.function().signature().costly { (1e-3, 1e-3) } else { (1e-7, 1e-6) };
        Self { agree, margin: (BENT * agree * agree).max(NOISE), rest }
    }
}

/// How the rounds ended.
pub(super) struct Ended {
    pub(super) agreed: bool,
    pub(super) within_budget: bool,
    /// The residual of nominal values and tolerances together, where both may change.
    pub(super) at_rest: Option<f64>,
}

/// Whether a constraint of this value is kept; a level that is sought, and promised to no one, within what another round would change it by.
pub(super) fn kept_within(value: f64, goal: Goal) -> bool {
    /// Of a sigma squared.
    const SOUGHT: f64 = 1e-6;
    kept(value) || goal != Goal::LeastCost && value <= 1.0 + SOUGHT
}

impl Driver<'_> {
    pub(super) fn constraints(&self, problem: &Problem, requirements: &[Option<Requirement>]) -> Vec<Constraint> {
        let of = |(c, one): (usize, &Option<Requirement>)| {
            Some(Constraint::of(c, (*one)?, problem.characteristics()[c].limits()))
        };
        let all: Vec<Constraint> = requirements.iter().enumerate().filter_map(of).flatten().collect();
        all.into_iter().chain(self.joint_constraint(problem)).collect()
    }

    /// The joint yield that is required, of the first characteristic with limits by name.
    fn joint_constraint(&self, problem: &Problem) -> Option<Constraint> {
        let least = self.task.joint_target(problem, self.options)?;
        let mut limited = problem.characteristics().iter().enumerate().filter(|(_, one)| one.limits().exist());
        limited.next().map(|(c, one)| Constraint::joint(c, least, one.limits()))
    }

    /// The model asked at a problem; an error only the first time.
    pub(super) fn analysed(&mut self, problem: Problem) -> Result<Station, AllocateError> {
        let budget = self
            .options
            .analysis
            .budget
            .map(|budget| budget.saturating_sub(usize::try_from(self.spent.run.evaluations).unwrap_or(usize::MAX)));
        let options = Options { budget, ..self.options.derivatives(&problem) };
        let (analysis, findings) = analyze_keeping(&problem, &options, self.run)?;
        self.spent.run = self.spent.run.and(&analysis.run);
        self.spent.rounds += 1;
        self.spent.stopped |= analysis.run.unfinished();
        let mut responses = Responses::of(&problem, &findings.outcome, &analysis, &self.task.requirements);
        if self.spent.rounds > SETTLED {
            self.spent.unknown.resize(responses.of.len(), Unknown::default());
            for (one, most) in responses.of.iter_mut().zip(&mut self.spent.unknown) {
                *most = most.most(one.unknown);
                one.unknown = *most;
            }
            self.spent.joint_unknown = self.spent.joint_unknown.max(responses.joint_unknown);
            responses.joint_unknown = self.spent.joint_unknown;
        }
        for (one, more) in responses.of.iter_mut().zip(&self.spent.stricter) {
            one.unknown = one.unknown.and(*more);
        }
        responses.joint_unknown += self.spent.joint_stricter;
        self.correct(&problem, &analysis, &mut responses);
        if !problem.function().signature().costly {
            let Spent { places, points, .. } = &mut self.spent;
            responses.follow_corners(&problem, places, points);
        }
        if self.task.goal == Goal::LeastCost {
            self.constraints(&problem, &self.task.requirements).par_iter().for_each(|one| one.prepare(&responses));
        }
        Ok(Station { problem, analysis, findings, responses })
    }

    /// The analysis of a station, with the results that are reported and no search reads.
    pub(super) fn completed(&self, mut analysis: Analysis, findings: &Findings, problem: &Problem) -> Analysis {
        analysis.complete(findings, problem, &self.options.derivatives(problem), self.run);
        analysis
    }

    /// Corrects by samples of the model what its own figures refute, where something is required of that and the model is cheap.
    fn correct(&self, problem: &Problem, analysis: &Analysis, responses: &mut Responses) {
        let of = |(c, one): (usize, &CharacteristicAnalysis)| {
            let refuted = one.verification.as_ref().is_some_and(|of| of.replaced);
            let moments =
                self.task.requirements[c].is_some_and(|of| !matches!(of, Requirement::Rss | Requirement::WorstCase));
            (refuted && moments).then_some((c, one.moments?))
        };
        let verified: Vec<(usize, Moments)> = analysis.characteristics.iter().enumerate().filter_map(of).collect();
        let priced = &self.task.priced;
        let many = priced.len() > SampledCorrection::MOST_GROUPS;
        if verified.is_empty() || many || problem.function().signature().costly || self.run.stopped() {
            return;
        }
        let at = |g: usize, factor: f64| {
            let half = problem.dimensions()[priced[g].members[0]].half_band();
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

    /// The same further on: None where the budget does not allow it.
    pub(super) fn station(&mut self, problem: Problem) -> Result<Option<Station>, AllocateError> {
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

/// The unit of a characteristic.
pub(super) fn unit(problem: &Problem, characteristic: usize) -> Option<String> {
    problem.characteristics()[characteristic].unit().map(str::to_owned)
}

pub(super) fn cost(priced: &[Priced], at: &[f64], offers: &[usize]) -> f64 {
    let of = |((group, &t), &offer): ((&Priced, &f64), &usize)| group.parts * group.offers[offer].curve.cost(t);
    priced.iter().zip(at).zip(offers).map(of).sum()
}

/// The problem with the groups at these half bands.
pub(super) fn with_tolerances(problem: Problem, priced: &[Priced], at: &[f64]) -> Result<Problem, AllocateError> {
    let dimensions: Vec<Dimension> = scaled(&problem, priced, at)?;
    Ok(problem.with_dimensions(dimensions)?)
}

/// The same with the distributions of the chosen processes, where these say how their parts lie.
pub(super) fn with_choice(
    problem: Problem,
    priced: &[Priced],
    at: &[f64],
    offers: &[usize],
) -> Result<Problem, AllocateError> {
    let mut dimensions: Vec<Dimension> = scaled(&problem, priced, at)?;
    remade(&problem, priced, offers).into_iter().for_each(|(d, dimension)| dimensions[d] = dimension);
    Ok(problem.with_dimensions(dimensions)?)
}

/// The dimensions with the groups at these half bands.
fn scaled(problem: &Problem, priced: &[Priced], at: &[f64]) -> Result<Vec<Dimension>, AllocateError> {
    let mut dimensions = problem.dimensions().to_vec();
    for (group, &t) in priced.iter().zip(at) {
        for &d in &group.members {
            let factor = t / dimensions[d].half_band();
            if let Some(scaled) = dimensions[d].scaled(factor) {
                dimensions[d] = scaled?;
            }
        }
    }
    Ok(dimensions)
}
