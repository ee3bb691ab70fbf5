//! Entry points of an allocation, and the search along derivatives.

use std::ops::ControlFlow;
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
        let mut search = DerivativeSearch::new(self, allocation.problem.clone(), first, constraints, before);
        for _ in 0..ROUNDS {
            match search.round(allocation)? {
                Next::Round => {}
                Next::End => break,
                Next::NothingFound => return Ok(None),
            }
        }
        Ok(Some(search.end()))
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

/// Transition after a round of a search.
enum Next {
    /// Another round, at the linearization point that was reached.
    Round,
    /// End of the search, with the tolerances chosen last.
    End,
    /// End without a result; the status of the allocation says why.
    NothingFound,
}

/// Linearization point that keeps everything by the model. The search returns to it if derivatives mislead.
struct Fallback {
    station: Rc<LinearizationPoint>,
    at: Vec<f64>,
    last: Option<Chosen>,
    cost: f64,
}

/// Search along derivatives: every round chooses tolerances by the derivatives of one linearization point and evaluates the model there.
struct DerivativeSearch<'s, 'd> {
    driver: &'s mut Driver<'d>,
    original: Problem,
    near: Near,
    /// The requirements of the task.
    constraints: &'s [Constraint],
    /// The requirements with the levels that are sought for a cost.
    current: Vec<Constraint>,
    station: Rc<LinearizationPoint>,
    /// Half bands of the groups at the linearization point.
    at: Vec<f64>,
    /// Choice that led to the linearization point. None if there was no choice.
    last: Option<Chosen>,
    fallback: Option<Fallback>,
    steps: Steps,
    reach: f64,
    at_tightest: bool,
    ended: Ended,
    /// Starts and reached ends of the last round that began from several places.
    searched: [Option<usize>; 2],
    /// The next cheapest end of that round.
    other: Option<f64>,
}

impl<'s, 'd> DerivativeSearch<'s, 'd> {
    /// Search that begins at a linearization point with these half bands.
    fn new(
        driver: &'s mut Driver<'d>,
        original: Problem,
        first: Rc<LinearizationPoint>,
        constraints: &'s [Constraint],
        before: &[f64],
    ) -> Self {
        Self {
            driver,
            near: Near::of(&original),
            original,
            constraints,
            current: constraints.to_vec(),
            station: first,
            at: before.to_vec(),
            last: None,
            fallback: None,
            steps: Steps::default(),
            reach: f64::INFINITY,
            at_tightest: false,
            ended: Ended { agreed: false, within_budget: true, at_rest: None },
            searched: [None; 2],
            other: None,
        }
    }

    /// Returns the last linearization point with the choice that led to it.
    fn end(self) -> SearchEnd {
        let Self { station, last, current: constraints, ended, .. } = self;
        SearchEnd { station, last, constraints, ended, trial: None, is_start: false }
    }

    /// Moves nominal values, or else chooses tolerances.
    fn round(&mut self, allocation: &mut Allocation) -> Result<Next, AllocateError> {
        let (next, still) = match self.recentre()? {
            ControlFlow::Continue(centred) => centred,
            ControlFlow::Break(next) => return Ok(next),
        };
        if self.driver.task.priced.is_empty() {
            self.ended.agreed = still;
            return Ok(Next::End);
        }
        self.choose(allocation, next, still)
    }

    /// Moves the nominal values. Continues with the problem to choose tolerances for, and true if its nominal values are at rest.
    fn recentre(&mut self) -> Result<ControlFlow<Next, (Problem, bool)>, AllocateError> {
        let next = self.station.problem.clone();
        if self.driver.options.recentre.is_empty() {
            return Ok(ControlFlow::Continue((next, true)));
        }
        let found = self.driver.recentred(&self.station, self.constraints, &self.at)?;
        self.ended.at_rest = found.residual;
        if found.far <= found.rest {
            return Ok(ControlFlow::Continue((next, true)));
        }
        let mut next = found.problem;
        let priced = &self.driver.task.priced;
        // Tolerances are chosen about the place where the nominal values come to rest.
        if found.at.is_some() || found.far > 1.0 || priced.is_empty() {
            if let Some(found) = found.at {
                (self.at, self.last) = (found, None);
                next = with_tolerances(next, priced, &self.at)?;
            }
            return self.move_to(next).map(ControlFlow::Break);
        }
        Ok(ControlFlow::Continue((next, false)))
    }

    /// Makes a problem the linearization point of the next round.
    fn move_to(&mut self, problem: Problem) -> Result<Next, AllocateError> {
        match self.driver.station(problem)? {
            Some(there) if !self.driver.spent.stopped => {
                self.station = Rc::new(there);
                Ok(Next::Round)
            }
            there => {
                self.ended.within_budget = there.is_some();
                Ok(Next::End)
            }
        }
    }

    /// Chooses tolerances by the derivatives of the linearization point. Evaluates the model there unless the choice is unchanged.
    fn choose(&mut self, allocation: &mut Allocation, next: Problem, still: bool) -> Result<Next, AllocateError> {
        let (task, run, station) = (self.driver.task, self.driver.run, Rc::clone(&self.station));
        let stopped = || run.stopped();
        let priced = within_reach(&task.priced, &self.at, self.followed_reach());
        let setting = Setting {
            responses: &station.responses,
            priced: &priced,
            constraints: self.constraints,
            losses: &task.losses,
            setups: &task.setups,
            stopped: &stopped,
            anywhere: self.last.is_none() && self.fallback.is_none(),
        };
        let Some(current) = self.with_levels(&setting) else {
            allocation.status = Status::NoFeasiblePointFound;
            return Ok(Next::NothingFound);
        };
        self.current.clone_from(&current);
        let setting = Setting { constraints: &current, ..setting };
        // Kept, by the model and within the bounds: a place to come back to.
        let here = kept_within(setting.value(&self.at), task.goal);
        let safe = here && within_bounds(&task.priced, &self.at);
        // Losses may be greater than the derivatives foretold: shorter steps from where all together was cheaper.
        let cost_here = if task.losses.is_empty() { 0.0 } else { setting.cost(&self.at) };
        if self.last.is_some()
            && self.fallback.as_ref().is_some_and(|fallback| cost_here > fallback.cost * (1.0 + DEARER))
        {
            return Ok(self.fall_back());
        }
        let (solved, offers, mut proof) = match choose(&setting, &self.at) {
            Choice::Found { solved, offers, proof } => (solved, offers, proof),
            Choice::Infeasible(attainable, tight) => {
                return self.without_choice(allocation, &setting, next, (attainable, tight));
            }
            Choice::Stopped => {
                self.driver.spent.stopped = true;
                return Ok(Next::End);
            }
        };
        self.keep_starts(&mut proof);
        // The model has been asked at these tolerances, and would not choose others.
        if still && here && self.is_chosen_again(&priced, &solved, &offers) {
            self.confirm_choice(&setting, &solved, &proof);
            return Ok(Next::End);
        }
        let chosen = self.shortened(&setting, (solved, offers, proof));
        self.ask(next, chosen, safe.then_some(cost_here))
    }

    /// Factor up to which the derivatives of the linearization point are followed. It is limited if they come from samples.
    fn followed_reach(&self) -> f64 {
        let responses = &self.station.responses;
        let sampled = self.constraints.iter().any(|one| responses.is_sampled(one.characteristic));
        if sampled { self.reach.min(SampledCorrection::REACH) } else { self.reach }
    }

    /// The requirements, with the level that is sought for a cost. None if no level is found.
    fn with_levels(&self, setting: &Setting<'_>) -> Option<Vec<Constraint>> {
        match self.driver.task.goal {
            Goal::LeastCost => Some(self.constraints.to_vec()),
            _ => self.driver.levelled(setting, &self.original, &self.at),
        }
    }

    /// Returns to the linearization point that kept everything, for shorter steps from there.
    fn fall_back(&mut self) -> Next {
        if let Some(Fallback { station, at, last, .. }) = self.fallback.take() {
            (self.station, self.at, self.last) = (station, at, last);
        }
        (self.reach, self.steps) = (shorter(self.reach), Steps::default());
        Next::Round
    }

    /// Goes on after derivatives by which no tolerances keep everything: back, to the tightest, or to the end.
    fn without_choice(
        &mut self,
        allocation: &mut Allocation,
        setting: &Setting<'_>,
        next: Problem,
        (attainable, tight): (Attainable, Vec<f64>),
    ) -> Result<Next, AllocateError> {
        // Derivatives led astray: shorter steps from where everything was kept.
        if self.fallback.is_some() {
            return Ok(self.fall_back());
        }
        // Derivatives at other tolerances may be wrong there: the model is asked first.
        if !self.at_tightest && farthest(&self.at, &tight) > libm::log(REACH) {
            (self.at, self.at_tightest, self.last) = (tight, true, None);
            return self.move_to(with_tolerances(next, &self.driver.task.priced, &self.at)?);
        }
        // Where every tolerance does harm only, the tightest are the proof.
        let exact = if choose_made::any(setting.priced) { choose_made::is_proof(setting) } else { setting.is_exact() };
        let proven = exact && self.driver.options.recentre.is_empty();
        allocation.status = if proven { Status::Infeasible } else { Status::NoFeasiblePointFound };
        let unit = unit(&self.original, attainable.characteristic);
        allocation.attainable = Some(Attainable { unit, ..attainable });
        Ok(Next::NothingFound)
    }

    /// Carries the starts of the last round that had several into the proof of a later one.
    fn keep_starts(&mut self, proof: &mut Proof) {
        if proof.starts.is_some() {
            self.searched = [proof.starts, proof.reached];
            self.other = proof.other_optimum;
        }
        (proof.starts, proof.reached, proof.other_optimum) = (self.searched[0], self.searched[1], self.other);
    }

    /// Returns true if the choice is the one that led to the linearization point.
    fn is_chosen_again(&self, priced: &[Priced], solved: &Solved, offers: &[usize]) -> bool {
        let change = farthest(&self.at, &solved.at);
        // Processes of one tolerance may differ in how their parts lie.
        let alike = !choose_made::any(priced) || self.last.as_ref().is_some_and(|(_, chosen, _)| chosen == offers);
        self.last.is_some() && alike && change <= self.near.agree
    }

    /// Keeps the tolerances at which the model was asked, with the multipliers found there.
    fn confirm_choice(&mut self, setting: &Setting<'_>, solved: &Solved, proof: &Proof) {
        self.last = self.last.take().map(|(old, offers, _)| {
            let residual = setting.residual(&old.at, &solved.multipliers).unwrap_or(solved.residual);
            let proof = Proof { residual: proof.residual.map(|_| residual), ..proof.clone() };
            (Solved { multipliers: solved.multipliers.clone(), ..old }, offers, proof)
        });
        self.ended.agreed = true;
    }

    /// The choice tightened by a margin, and as far on the way to it as the last steps advise.
    fn shortened(&mut self, setting: &Setting<'_>, (mut solved, offers, mut proof): Chosen) -> Chosen {
        if self.last.is_some() && !setting.is_exact() {
            tightened(&mut solved.at, setting.priced, 1.0 - self.near.margin);
        }
        let free = self.driver.task.priced.iter().all(|group| group.offers.len() == 1);
        if let Some(part_way) = self.steps.shortened(&self.at, &solved.at).filter(|_| free) {
            solved.at = part_way;
            solved.cost = setting.cost(&solved.at);
            proof.residual = setting.residual(&solved.at, &solved.multipliers);
        }
        (solved, offers, proof)
    }

    /// Evaluates the model at chosen tolerances. The previous linearization point is kept as fallback if it has a cost.
    fn ask(&mut self, next: Problem, chosen: Chosen, kept_at_cost: Option<f64>) -> Result<Next, AllocateError> {
        let (solved, offers, _) = &chosen;
        let from = std::mem::replace(&mut self.at, solved.at.clone());
        let problem = with_choice(next, &self.driver.task.priced, &self.at, offers)?;
        match self.driver.station(problem)? {
            Some(there) if self.driver.spent.stopped || there.answers(self.constraints) => {
                let station = std::mem::replace(&mut self.station, Rc::new(there));
                let last = self.last.replace(chosen);
                if let Some(cost) = kept_at_cost {
                    self.fallback = Some(Fallback { station, at: from, last, cost });
                }
                self.driver.see(&self.station, self.last.as_ref());
            }
            // The model fails so far out: shorter steps from where it did not.
            Some(_) => (self.at, self.reach) = (from, shorter(self.reach)),
            None => {
                (self.ended.within_budget, self.last) = (false, Some(chosen));
                return Ok(Next::End);
            }
        }
        Ok(if self.driver.spent.stopped { Next::End } else { Next::Round })
    }
}

/// The largest change of a half band, in logarithms.
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
