//! Entry points of an allocation, and the search along derivatives.

use std::rc::Rc;
use std::sync::atomic::Ordering;

use crate::allocation::choice::machine::choose;
use crate::allocation::choice::process_selection as choose_made;
use crate::allocation::choice::selection::{Choice, within_bounds};
use crate::allocation::choice::single_offer::{Setting, tightened};
use crate::allocation::cost::cost_curve::Priced;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::result::allocation::{Allocation, Attainable, JointKept, Proof, Status};
use crate::allocation::result::solver_result::{Chosen, Solved};
use crate::allocation::search::best_trial::SearchEnd;
use crate::allocation::search::common_factor::loosest;
use crate::allocation::search::conclusion::doubts;
use crate::allocation::search::driver::{
    AsWritten, Driver, Ended, Near, ROUNDS, Spent, kept_within, unit, with_choice, with_tolerances,
};
use crate::allocation::search::linearization_point::{LinearizationPoint, Seen, required};
use crate::allocation::search::step::Steps;
use crate::allocation::search::trial::required_of;
use crate::allocation::surface::joint_yield::joint;
use crate::allocation::surface::sampled_moments::SampledCorrection;
use crate::allocation::task::{AllocateError, AllocationOptions, AllocationTask, Goal};
use crate::assembly::Run;
use crate::evaluation::at_any_size;
use crate::problem::Problem;
use crate::simulation::SimulationError;
use crate::summary::RunSummary;
use sensitol_numeric::sampling::{Draws, Sampler};
use sensitol_numeric::time::Instant;

/// Greatest factor of a tolerance within which derivatives are trusted when they say that nothing is possible. It is
/// also the factor by which tolerances may move in a step after the model has failed farther out.
const REACH: f64 = 1.5;
/// Greatest relative rise of the cost that counts as rounding, or as an effect of the margin of tolerances.
const DEARER: f64 = 1e-8;

/// Allocates tolerances.
///
/// Cost: one analysis at the present tolerances, one at those found, and one for every time that the two disagree. With
/// [`Method::Auto`](crate::Method::Auto) one more analysis at those found gives the verdict. A confirmation takes
/// `confirm` more points by Monte Carlo.
///
/// # Errors
///
/// If task, options and problem do not fit. Nothing is evaluated then. Requirements that cannot be kept are no error
/// but a [`Status`].
///
/// ```
/// use sensitol::{Characteristic, Closure, Dimension, Problem, Requirement, SpecLimits};
/// use sensitol::allocation::{AllocationOptions, AllocationTask, Curve, Offer, Priced, Status, allocate};
/// let dimensions = [Dimension::normal("a", 10.0, 0.1)?, Dimension::normal("b", 6.0, 0.1)?];
/// let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(3.8), Some(4.2))?);
/// let problem = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1]))?.asking([gap])?;
/// let cost = |d, b| Priced::new(vec![d], vec![Offer::between(Curve::reciprocal(1.0, b)?, 0.01, 1.0)?]);
/// let task = AllocationTask::new(vec![cost(0, 0.1)?, cost(1, 0.4)?], vec![Some(Requirement::WorstCase)]);
/// let found = allocate(&problem, &task, &AllocationOptions::default())?;
/// assert_eq!(found.status, Status::Optimal);
/// // Lagrange: tolerances as the roots of the costs, 0.2 together.
/// let [a, b] = [0, 1].map(|g| found.tolerances[g].after);
/// assert!((a - 0.2 / 3.0).abs() < 1e-12 && (b - 0.4 / 3.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn allocate(
    problem: &Problem,
    task: &AllocationTask,
    options: &AllocationOptions,
) -> Result<Allocation, AllocateError> {
    allocate_with(problem, task, options, &Run::to_the_end())
}

/// Runs [`allocate`] with reports of finished points, and stops when `run` is stopped.
pub fn allocate_with(
    problem: &Problem,
    task: &AllocationTask,
    options: &AllocationOptions,
    run: &Run<'_>,
) -> Result<Allocation, AllocateError> {
    allocate_as(problem, task, options, run, None)
}

/// Runs [`allocate_with`] with the dimensions as they would stand in the file of the study. The result keeps every
/// requirement with these written digits too.
pub fn allocate_written(
    problem: &Problem,
    task: &AllocationTask,
    options: &AllocationOptions,
    run: &Run<'_>,
    written: AsWritten<'_>,
) -> Result<Allocation, AllocateError> {
    allocate_as(problem, task, options, run, Some(written))
}

fn allocate_as(
    problem: &Problem,
    task: &AllocationTask,
    options: &AllocationOptions,
    run: &Run<'_>,
    written: Option<AsWritten<'_>>,
) -> Result<Allocation, AllocateError> {
    task.check(problem, options)?;
    if options.confirm.is_some() {
        Draws::new(problem.dimensions(), problem.correlation(), Sampler::Random, options.seed)
            .map_err(SimulationError::from)?;
    }
    at_any_size(problem, run, |problem, run| {
        let task = &task.divided(problem)?;
        let required = match task.goal {
            Goal::LeastCost => required_of(problem, &task.requirements),
            // The level sought for a given cost replaces the other requirements.
            _ => task.requirements.iter().enumerate().filter_map(|(c, one)| Some((c, (*one)?))).collect(),
        };
        Driver { task, options, run, required, written, spent: Spent::default() }.run(problem)
    })
}

impl Driver<'_> {
    fn run(mut self, problem: &Problem) -> Result<Allocation, AllocateError> {
        let begun = Instant::now();
        let first = Rc::new(self.analysed(problem.clone())?);
        let constraints = self.constraints(problem, &self.task.requirements);
        for constraint in &constraints {
            let known = first.analysis.characteristics[constraint.characteristic].moments.is_some();
            if !known && !self.spent.stopped {
                let characteristic = problem.characteristics()[constraint.characteristic].name().to_owned();
                return Err(AllocateError::NoMoments { characteristic });
            }
        }
        // The present tolerances are judged first, for comparison and in case nothing better is found.
        let before: Vec<f64> =
            self.task.priced.iter().map(|group| problem.dimensions()[group.members[0]].half_band()).collect();
        let loosest_before = loosest(&first.responses, &constraints);
        let joint_before = joint(problem, &first.responses, self.options.seed);
        let start = self.start(problem, &first);
        let own = start.trial.as_ref().map_or(&first.analysis, |trial| &trial.analysis);
        let mut allocation = Allocation {
            status: Status::OutOfTime,
            problem: problem.clone(),
            before: match &start.trial {
                Some(trial) => self.completed_trial(trial, &first.findings),
                None => self.completed(first.analysis.clone(), &first.findings, problem),
            },
            after: None,
            confirmed: false,
            cost_before: self.cost_to_hold(problem).and_then(|held| Some(held + self.loss_at(&first)?)),
            cost_after: None,
            loss: [self.loss_at(&first).filter(|_| !self.task.losses.is_empty()), None],
            cost_unrounded: None,
            setups: Vec::new(),
            goal: self.task.goal,
            cost_basis: self.task.basis,
            tolerances: self.unchanged(problem),
            moved: Vec::new(),
            requirements: required(&self.required, own),
            joint_requirement: self.task.joint_target(problem, self.options).and_then(|_| {
                let before = own.joint_requirement?;
                Some(JointKept { requirement: before.requirement, before, after: None, sampled: None })
            }),
            prices: Vec::new(),
            proof: Proof::default(),
            attainable: None,
            loosest_before,
            loosest_after: None,
            joint: [joint_before, None],
            front: Vec::new(),
            confirmation: None,
            run: RunSummary::default(),
            rounds: 0,
            model_points: 0,
            warnings: Vec::new(),
        };
        if !self.spent.stopped {
            let end = self.search(&mut allocation, first, &constraints, &before)?;
            if let Some(end) = self.best_end(&mut allocation, start, end)? {
                self.conclude(&mut allocation, problem, end)?;
            }
        }
        let stopped = (self.spent.stopped || self.run.stopped()).then(|| self.run.why_open());
        let (wall, seed) = (begun.elapsed(), Some(self.options.seed));
        let budget = self.spent.run.stopped;
        allocation.run =
            RunSummary { wall, seed, stopped: stopped.or(budget), evaluator: problem.evaluator(), ..self.spent.run };
        allocation.rounds = self.spent.rounds;
        allocation.model_points = self.spent.points.load(Ordering::Relaxed);
        allocation.warnings = doubts(problem, &self.task.priced, &allocation);
        Ok(allocation)
    }

    /// Searches along the derivatives of successive linearization points. Returns None if nothing was found. The status
    /// gives the reason.
    pub(in crate::allocation) fn search(
        &mut self,
        allocation: &mut Allocation,
        first: Rc<LinearizationPoint>,
        constraints: &[Constraint],
        before: &[f64],
    ) -> Result<Option<SearchEnd>, AllocateError> {
        if self.task.basis.is_proportion() {
            return self.in_proportion(allocation, first, constraints);
        }
        let original = &allocation.problem.clone();
        let near = Near::of(original);
        let mut station = first;
        let mut at = before.to_vec();
        let mut last: Option<Chosen> = None;
        let mut haven: Option<(Rc<LinearizationPoint>, Vec<f64>, Option<Chosen>)> = None;
        let mut haven_cost = f64::INFINITY;
        let mut steps = Steps::default();
        let free = self.task.priced.iter().all(|group| group.offers.len() == 1);
        let (mut agreed, mut within_budget, mut at_tightest, mut reach) = (false, true, false, f64::INFINITY);
        let (mut at_rest, mut searched, mut other) = (None, [None; 2], None);
        let mut current = constraints.to_vec();
        for _ in 0..ROUNDS {
            // Nominal values move before tolerances, because a better middle leaves more slack to them.
            let mut next = station.problem.clone();
            let mut still = true;
            if !self.options.recentre.is_empty() {
                let found = self.recentred(&station, constraints, &at)?;
                still = found.far <= found.rest;
                at_rest = found.residual;
                if !still {
                    next = found.problem;
                }
                // Tolerances are chosen only about the place where the nominal values come to rest.
                if !still && (found.at.is_some() || found.far > 1.0 || self.task.priced.is_empty()) {
                    if let Some(found) = found.at {
                        (at, last) = (found, None);
                        next = with_tolerances(next, &self.task.priced, &at)?;
                    }
                    match self.station(next)? {
                        Some(there) if !self.spent.stopped => station = Rc::new(there),
                        there => {
                            within_budget = there.is_some();
                            break;
                        }
                    }
                    continue;
                }
            }
            if self.task.priced.is_empty() {
                agreed = still;
                break;
            }
            let stopped = || self.run.stopped();
            // Derivatives are followed only as far as they are trusted.
            let sampled = constraints.iter().any(|one| station.responses.is_sampled(one.characteristic));
            let followed = if sampled { reach.min(SampledCorrection::REACH) } else { reach };
            let priced = within_reach(&self.task.priced, &at, followed);
            let (responses, anywhere) = (&station.responses, last.is_none() && haven.is_none());
            let (losses, setups) = (&self.task.losses, &self.task.setups);
            let setting =
                Setting { responses, priced: &priced, constraints, losses, setups, stopped: &stopped, anywhere };
            let levels = match self.task.goal {
                Goal::LeastCost => None,
                _ => match self.levelled(&setting, original, &at) {
                    Some(levels) => Some(levels),
                    None => {
                        allocation.status = Status::NoFeasiblePointFound;
                        return Ok(None);
                    }
                },
            };
            current = levels.unwrap_or_else(|| constraints.to_vec());
            let setting = Setting { constraints: &current, ..setting };
            // Tolerances that the model keeps within the bounds are a place to return to.
            let here = kept_within(setting.value(&at), self.task.goal);
            let safe = here && within_bounds(&self.task.priced, &at);
            // Losses may be greater than the derivatives predicted. The search then takes shorter steps from the
            // cheaper tolerances before.
            let cost_here = if self.task.losses.is_empty() { 0.0 } else { setting.cost(&at) };
            if last.is_some() && haven.is_some() && cost_here > haven_cost * (1.0 + DEARER) {
                (station, at, last) = haven.take().unwrap_or((station, at, last));
                (reach, steps) = (shorter(reach), Steps::default());
                continue;
            }
            let (mut solved, offers, mut proof) = match choose(&setting, &at) {
                Choice::Found { solved, offers, proof } => (solved, offers, proof),
                // Derivatives were wrong: shorter steps from the last tolerances that kept everything.
                Choice::Infeasible(..) if haven.is_some() => {
                    (station, at, last) = haven.take().unwrap_or((station, at, last));
                    (reach, steps) = (shorter(reach), Steps::default());
                    continue;
                }
                // Derivatives from other tolerances may be wrong at the tightest ones, so the model is evaluated there
                // first.
                Choice::Infeasible(_, tight) if !at_tightest && farthest(&at, &tight) > libm::log(REACH) => {
                    (at, at_tightest, last) = (tight, true, None);
                    match self.station(with_tolerances(next, &self.task.priced, &at)?)? {
                        Some(there) if !self.spent.stopped => station = Rc::new(there),
                        there => {
                            within_budget = there.is_some();
                            break;
                        }
                    }
                    continue;
                }
                Choice::Infeasible(attainable, _) => {
                    // If every tolerance only does harm, the tightest ones are the proof.
                    let exact = if choose_made::any(setting.priced) {
                        choose_made::is_proof(&setting)
                    } else {
                        setting.is_exact()
                    };
                    let proven = exact && self.options.recentre.is_empty();
                    allocation.status = if proven { Status::Infeasible } else { Status::NoFeasiblePointFound };
                    let unit = unit(original, attainable.characteristic);
                    allocation.attainable = Some(Attainable { unit, ..attainable });
                    return Ok(None);
                }
                Choice::Stopped => {
                    self.spent.stopped = true;
                    break;
                }
            };
            if proof.starts.is_some() {
                searched = [proof.starts, proof.reached];
                other = proof.other_optimum;
            }
            (proof.starts, proof.reached, proof.other_optimum) = (searched[0], searched[1], other);
            let change = farthest(&at, &solved.at);
            // Processes of one tolerance may differ in their distributions.
            let alike = !choose_made::any(&priced) || last.as_ref().is_some_and(|(_, chosen, _)| *chosen == offers);
            // The model has been analysed at these tolerances, and its derivatives give the same ones.
            if still && here && last.is_some() && alike && change <= near.agree {
                last = last.map(|(old, offers, _)| {
                    let residual = setting.residual(&old.at, &solved.multipliers).unwrap_or(solved.residual);
                    let proof = Proof { residual: proof.residual.map(|_| residual), ..proof };
                    (Solved { multipliers: solved.multipliers.clone(), ..old }, offers, proof)
                });
                agreed = true;
                break;
            }
            if last.is_some() && !setting.is_exact() {
                tightened(&mut solved.at, &priced, 1.0 - near.margin);
            }
            if let Some(part_way) = steps.shortened(&at, &solved.at).filter(|_| free) {
                solved.at = part_way;
                solved.cost = setting.cost(&solved.at);
                proof.residual = setting.residual(&solved.at, &solved.multipliers);
            }
            let from = std::mem::replace(&mut at, solved.at.clone());
            match self.station(with_choice(next, &self.task.priced, &at, &offers)?)? {
                Some(there) if self.spent.stopped || there.answers(constraints) => {
                    let left = (std::mem::replace(&mut station, Rc::new(there)), from, last.take());
                    (haven, haven_cost) = if safe { (Some(left), cost_here) } else { (haven, haven_cost) };
                    last = Some((solved, offers, proof));
                    self.see(&station, last.as_ref());
                }
                // The model fails so far out: shorter steps from the last tolerances that it accepts.
                Some(_) => (at, reach) = (from, shorter(reach)),
                None => {
                    (within_budget, last) = (false, Some((solved, offers, proof)));
                    break;
                }
            }
            if self.spent.stopped {
                break;
            }
        }
        let ended = Ended { agreed, within_budget, at_rest };
        Ok(Some(SearchEnd { station, last, constraints: current, ended, trial: None, is_start: false }))
    }

    /// Stores the cheapest linearization point that keeps everything.
    fn see(&mut self, station: &Rc<LinearizationPoint>, last: Option<&Chosen>) {
        let Some(chosen) = last.filter(|_| self.task.goal == Goal::LeastCost && !self.spent.stopped) else { return };
        let Some(loss) = self.loss_at(station) else { return };
        let cost = self.held_cost(&chosen.0.at, &chosen.1) + loss;
        let cheaper = self.spent.seen.as_ref().is_none_or(|seen| cost < seen.cost);
        if cheaper && self.keeps_everything(&station.analysis) {
            self.spent.seen = Some(Seen { station: Rc::clone(station), chosen: chosen.clone(), cost });
        }
    }
}

/// Largest change of a half band, in logarithms.
fn farthest(from: &[f64], to: &[f64]) -> f64 {
    from.iter().zip(to).map(|(a, b)| libm::log(b / a).abs()).fold(0.0, f64::max)
}

/// Reach for shorter steps.
fn shorter(reach: f64) -> f64 {
    if reach.is_finite() { reach.sqrt() } else { REACH }
}

/// Groups with their free tolerances limited to within a factor of these half bands.
fn within_reach(priced: &[Priced], at: &[f64], reach: f64) -> Vec<Priced> {
    let mut priced = priced.to_vec();
    for (group, &t) in priced.iter_mut().zip(at).filter(|(group, _)| reach.is_finite() && group.offers.len() == 1) {
        let offer = &mut group.offers[0];
        let t = t.clamp(offer.min, offer.max);
        (offer.min, offer.max) = (offer.min.max(t / reach), offer.max.min(t * reach));
    }
    priced
}
