//! From a problem with costs to tolerances that the model confirms.

use super::choose::{Choice, choose, within_bounds};
use super::constraint::{Constraint, kept};
use super::cost::Priced;
use super::front::front;
use super::joint::joint;
use super::recentre::shifts;
use super::response::Responses;
use super::result::{Allocated, Allocation, Attainable, Bound, Kept, Moved, Proof, Status};
use super::sampled::SampledCorrection;
use super::scaling::loosest;
use super::solve::{Setting, Solved, tightened};
use super::station::{Station, prices, required};
use super::steps::Steps;
use super::task::{AllocateError, AllocationOptions, AllocationTask};
use crate::analysis::{Analysis, CharacteristicAnalysis, TRUSTED, analyze_keeping};
use crate::assembly::Run;
use crate::dimension::Dimension;
use crate::method::{MethodError, Options};
use crate::moments::Moments;
use crate::problem::Problem;
use crate::requirement::Requirement;
use crate::sampling::{Draws, Sampler};
use crate::simulation::{SimulationError, SimulationOptions, simulate_with};
use crate::summary::{RunSummary, StopReason};
use crate::time::Instant;
use crate::verdict::{Judged, Verdict};
use crate::warning::Warning;

/// Rounds of derivatives, at most.
const ROUNDS: usize = 20;
/// The factor up to which derivatives are trusted when they say that nothing is possible, and by which tolerances may move in a
/// step after the model has failed farther out.
const REACH: f64 = 1.5;
/// Nominal values are at rest when they move by fewer sigmas.
const REST: f64 = 1e-3;
/// A step of a nominal value, in sigmas, that derivatives are trusted for.
const FAR: f64 = 30.0;
/// A residual up to which tolerances are called optimal.
const OPTIMAL: f64 = 1e-6;
/// A gap up to which a choice of processes is called optimal.
const NO_GAP: f64 = 1e-9;

/// Allocates tolerances.
///
/// Evaluations: one analysis at the present tolerances, one at those found, and one for every time that the two disagree; `confirm`
/// more by Monte Carlo.
///
/// # Errors
/// When task, options and problem do not fit; nothing is evaluated then. Requirements that cannot be kept are no error but a
/// [`Status`].
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

/// The unit of a characteristic.
fn unit(problem: &Problem, characteristic: usize) -> Option<String> {
    problem.characteristics()[characteristic].unit().map(str::to_owned)
}

/// [`allocate`], telling of finished points and stopping when told to.
pub fn allocate_with(
    problem: &Problem,
    task: &AllocationTask,
    options: &AllocationOptions,
    run: &Run<'_>,
) -> Result<Allocation, AllocateError> {
    task.check(problem, options)?;
    if options.confirm.is_some() {
        Draws::new(problem.dimensions(), problem.correlation(), Sampler::Random, options.seed)
            .map_err(SimulationError::from)?;
    }
    Driver { task, options, run, spent: Spent::default() }.run(problem)
}

/// What was evaluated so far.
#[derive(Default)]
struct Spent {
    run: RunSummary,
    rounds: usize,
    stopped: bool,
}

struct Driver<'a> {
    task: &'a AllocationTask,
    options: &'a AllocationOptions,
    run: &'a Run<'a>,
    spent: Spent,
}

/// Tolerances, the offer of every group, and what proves them.
type Chosen = (Solved, Vec<usize>, Proof);

/// How near is near enough: every round asks the model.
#[derive(Clone, Copy)]
struct Near {
    /// Tolerances that change by less than this part agree.
    agree: f64,
    /// By what part tolerances are tightened for what the model may say differently where it is asked next.
    margin: f64,
}

impl Near {
    fn of(problem: &Problem) -> Self {
        match problem.function().signature().costly {
            true => Self { agree: 1e-3, margin: 1e-7 },
            false => Self { agree: 1e-7, margin: 1e-9 },
        }
    }
}

impl Driver<'_> {
    fn run(mut self, problem: &Problem) -> Result<Allocation, AllocateError> {
        let begun = Instant::now();
        let first = self.analysed(problem.clone())?;
        let constraints = self.constraints(problem, &self.task.requirements);
        for constraint in &constraints {
            let known = first.analysis.characteristics[constraint.characteristic].moments.is_some();
            if !known && !self.spent.stopped {
                let characteristic = problem.characteristics()[constraint.characteristic].name().to_owned();
                return Err(AllocateError::NoMoments { characteristic });
            }
        }
        let before: Vec<f64> =
            self.task.priced.iter().map(|group| problem.dimensions()[group.members[0]].half_band()).collect();
        let loosest_before = loosest(&first.responses, &constraints);
        let joint_before = joint(problem, &first.responses, self.options.seed);
        let mut allocation = Allocation {
            status: Status::OutOfTime,
            problem: problem.clone(),
            before: first.analysis.clone(),
            after: None,
            confirmed: false,
            cost_before: self.cost_to_hold(problem),
            cost_after: None,
            tolerances: self.unchanged(problem),
            moved: Vec::new(),
            requirements: required(&self.task.requirements, &first),
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
            warnings: Vec::new(),
        };
        if !self.spent.stopped {
            self.search(&mut allocation, first, &constraints, &before)?;
        }
        let stopped = (self.spent.stopped || self.run.stopped()).then(|| self.run.why_open());
        let (wall, seed) = (begun.elapsed(), Some(self.options.seed));
        let budget = self.spent.run.stopped;
        allocation.run =
            RunSummary { wall, seed, stopped: stopped.or(budget), evaluator: problem.evaluator(), ..self.spent.run };
        allocation.rounds = self.spent.rounds;
        allocation.warnings = doubts(problem, &allocation);
        Ok(allocation)
    }

    fn search(
        &mut self,
        allocation: &mut Allocation,
        first: Station,
        constraints: &[Constraint],
        before: &[f64],
    ) -> Result<(), AllocateError> {
        let original = allocation.problem.clone();
        let near = Near::of(&original);
        let mut station = first;
        let mut at = before.to_vec();
        let mut last: Option<Chosen> = None;
        let mut haven: Option<(Station, Vec<f64>, Option<Chosen>)> = None;
        let mut steps = Steps::default();
        let free = self.task.priced.iter().all(|group| group.offers.len() == 1);
        let (mut agreed, mut within_budget, mut at_tightest, mut reach) = (false, true, false, f64::INFINITY);
        for _ in 0..ROUNDS {
            let mut next = station.problem.clone();
            let mut still = true;
            if !self.options.recentre.is_empty() {
                let (moved, far) = self.recentred(&station)?;
                still = far <= REST;
                if !still {
                    next = moved;
                }
                // Tolerances are chosen about the place where the nominal values come to rest.
                if !still && (far > 1.0 || self.task.priced.is_empty()) {
                    match self.station(next)? {
                        Some(there) if !self.spent.stopped => station = there,
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
            let priced = within_reach(&self.task.priced, &at, reach);
            let setting = Setting { responses: &station.responses, priced: &priced, constraints, stopped: &stopped };
            // Kept, by the model and within the bounds: a place to come back to.
            let here = kept(setting.value(&at));
            let safe = here && within_bounds(&self.task.priced, &at);
            let (mut solved, offers, mut proof) = match choose(&setting, &at) {
                Choice::Found { solved, offers, proof } => (solved, offers, proof),
                // Derivatives led astray: shorter steps from where everything was kept.
                Choice::Infeasible(..) if haven.is_some() => {
                    (station, at, last) = haven.take().unwrap_or((station, at, last));
                    (reach, steps) = (shorter(reach), Steps::default());
                    continue;
                }
                // Derivatives at other tolerances may be wrong there: the model is asked first.
                Choice::Infeasible(_, tight) if !at_tightest && farthest(&at, &tight) > REACH.ln() => {
                    (at, at_tightest, last) = (tight, true, None);
                    match self.station(with_tolerances(next, &self.task.priced, &at)?)? {
                        Some(there) if !self.spent.stopped => station = there,
                        there => {
                            within_budget = there.is_some();
                            break;
                        }
                    }
                    continue;
                }
                Choice::Infeasible(attainable, _) => {
                    allocation.status = Status::Infeasible;
                    let unit = unit(&original, attainable.characteristic);
                    allocation.attainable = Some(Attainable { unit, ..attainable });
                    return Ok(());
                }
                Choice::Stopped => {
                    self.spent.stopped = true;
                    break;
                }
            };
            let change = farthest(&at, &solved.at);
            // The model has been asked at these tolerances, and would not choose others.
            if still && here && last.is_some() && change <= near.agree {
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
            match self.station(with_tolerances(next, &self.task.priced, &at)?)? {
                Some(there) if self.spent.stopped || there.answers(constraints) => {
                    let left = (std::mem::replace(&mut station, there), from, last.take());
                    haven = if safe { Some(left) } else { haven };
                    last = Some((solved, offers, proof));
                }
                // The model fails so far out: shorter steps from where it did not.
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
        self.conclude(allocation, &original, station, last, constraints, Ended { agreed, within_budget })
    }

    /// Everything that follows from the last tolerances.
    fn conclude(
        &mut self,
        allocation: &mut Allocation,
        original: &Problem,
        station: Station,
        last: Option<Chosen>,
        constraints: &[Constraint],
        ended: Ended,
    ) -> Result<(), AllocateError> {
        allocation.moved = moved(original, &station.problem);
        if last.is_none() && allocation.moved.is_empty() {
            let finished = self.task.priced.is_empty() && ended.agreed;
            if !finished {
                return Ok(());
            }
        }
        let stopped = || self.run.stopped();
        let ones = vec![1.0; station.problem.dimensions().len()];
        let values: Vec<f64> = constraints.iter().map(|one| one.value_at(&station.responses, &ones)).collect();
        let met = values.iter().all(|&value| kept(value));
        let solved = last.as_ref().map(|(solved, ..)| solved);
        if let Some((solved, offers, proof)) = &last {
            let cost = cost(&self.task.priced, &solved.at, offers);
            let gap = |bound: f64| ((cost - bound) / cost.abs().max(f64::MIN_POSITIVE)).max(0.0);
            allocation.proof = Proof { gap: proof.bound.map(gap), ..proof.clone() };
            allocation.cost_after = Some(cost);
            allocation.tolerances = self.allocated(original, &solved.at, offers);
            let free = self.task.priced.iter().all(|group| group.offers.len() == 1);
            if free {
                allocation.prices = prices(&station, &self.task.priced, constraints, solved);
            }
        }
        let judged = |one: &Kept| station.analysis.characteristics[one.characteristic].judge(one.requirement);
        let judged: Vec<Judged> = allocation.requirements.iter().map(judged).collect();
        let missed = judged.iter().any(|judged| judged.verdict == Verdict::Missed);
        let reached = ended.within_budget && !self.spent.stopped;
        allocation.confirmed = reached;
        allocation.status = match &last {
            _ if self.spent.stopped => Status::OutOfTime,
            // Nothing but nominal values was to be chosen: what they cannot do, tolerances must.
            None if !met => Status::Infeasible,
            Some(_) if missed && ended.within_budget => Status::NoFeasiblePointFound,
            None if ended.agreed => Status::Optimal,
            None => Status::AlmostOptimal,
            Some((solved, _, proof)) => {
                // Slopes of a surface that the model refutes, and those of samples, prove nothing.
                let trusted = constraints.iter().all(|one| {
                    let c = one.characteristic;
                    let left = station.analysis.characteristics[c].verification.as_ref().and_then(|of| of.left);
                    !station.responses.is_sampled(c) && left.is_none_or(|left| left <= TRUSTED)
                        || one.requirement == Requirement::WorstCase
                });
                let proven = trusted
                    && proof.residual.is_none_or(|residual| residual <= OPTIMAL)
                    && proof.bound.is_none_or(|bound| {
                        proof.rigorous && solved.cost - bound <= NO_GAP * solved.cost.abs().max(f64::MIN_POSITIVE)
                    });
                if proven && ended.agreed && met { Status::Optimal } else { Status::AlmostOptimal }
            }
        };
        if allocation.status == Status::Infeasible {
            let worst = values.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map(|(k, _)| k);
            allocation.attainable = worst.map(|k| {
                let one = &constraints[k];
                Attainable {
                    characteristic: one.characteristic,
                    unit: unit(original, one.characteristic),
                    requirement: one.requirement,
                    best: station.analysis.characteristics[one.characteristic].judge(one.requirement).value,
                    because: Vec::new(),
                    together: false,
                }
            });
        }
        // A budget that ended before the model was asked at these tolerances leaves nothing to say of them.
        if let (false, Some((solved, ..))) = (ended.within_budget, &last) {
            allocation.problem = with_tolerances(station.problem, &self.task.priced, &solved.at)?;
            return Ok(());
        }
        allocation.requirements.iter_mut().zip(judged).for_each(|(one, judged)| one.after = Some(judged));
        allocation.loosest_after = loosest(&station.responses, constraints);
        allocation.joint[1] = joint(&station.problem, &station.responses, self.options.seed);
        if let (Some(points), Some(solved), false) = (self.options.front, solved, self.spent.stopped) {
            let setting =
                Setting { responses: &station.responses, priced: &self.task.priced, constraints, stopped: &stopped };
            allocation.front = front(&setting, original, &self.task.requirements, points, &solved.at);
            let group = |d: usize| self.task.priced.iter().position(|group| group.members.contains(&d));
            for point in &mut allocation.front {
                let of_groups = point.tolerances.take();
                point.tolerances = of_groups.map(|of_groups| {
                    allocation.tolerances.iter().filter_map(|one| Some(of_groups[group(one.dimension)?])).collect()
                });
            }
        }
        if let (Some(samples), false) = (self.options.confirm, self.spent.stopped) {
            let options = SimulationOptions { samples, seed: self.options.seed, ..SimulationOptions::default() };
            let simulation = simulate_with(&station.problem, &options, self.run, &|_| {})?;
            self.spent.run = self.spent.run.and(&simulation.run);
            allocation.confirmation = Some(simulation);
        }
        allocation.after = Some(station.analysis);
        allocation.problem = station.problem;
        Ok(())
    }

    fn constraints(&self, problem: &Problem, requirements: &[Option<Requirement>]) -> Vec<Constraint> {
        let of = |(c, one): (usize, &Option<Requirement>)| {
            Some(Constraint::of(c, (*one)?, problem.characteristics()[c].limits()))
        };
        requirements.iter().enumerate().filter_map(of).flatten().collect()
    }

    /// The model asked at a problem; an error only the first time.
    fn analysed(&mut self, problem: Problem) -> Result<Station, AllocateError> {
        let budget = self
            .options
            .analysis
            .budget
            .map(|budget| budget.saturating_sub(usize::try_from(self.spent.run.evaluations).unwrap_or(usize::MAX)));
        let options = Options { budget, ..self.options.derivatives(&problem) };
        let (analysis, outcome) = analyze_keeping(&problem, &options, self.run)?;
        self.spent.run = self.spent.run.and(&analysis.run);
        self.spent.rounds += 1;
        self.spent.stopped |= analysis.run.unfinished();
        let mut responses = Responses::of(&problem, &outcome, &analysis, &self.task.requirements);
        self.correct(&problem, &analysis, &mut responses);
        Ok(Station { problem, analysis, responses })
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
        let found = SampledCorrection::of(&verified, priced, &at, &surface, self.options.seed, self.run);
        for (c, correction) in found {
            responses.of[c].sampled = correction;
        }
    }

    /// The same further on: None where the budget does not allow it.
    fn station(&mut self, problem: Problem) -> Result<Option<Station>, AllocateError> {
        match self.analysed(problem) {
            Ok(station) => Ok(Some(station)),
            Err(AllocateError::Method(MethodError::OverBudget { .. })) => {
                self.spent.run.stopped.get_or_insert(StopReason::Budget);
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// The problem with nominal values moved, and how far at most, in sigmas.
    fn recentred(&self, station: &Station) -> Result<(Problem, f64), AllocateError> {
        let problem = &station.problem;
        let of: Vec<usize> = (self.options.recentre.iter())
            .filter_map(|name| problem.dimensions().iter().position(|dimension| dimension.name() == name))
            .collect();
        let Some(shifts) = shifts(problem, &station.responses, &of) else { return Ok((problem.clone(), 0.0)) };
        let far = shifts.iter().fold(0.0f64, |far, shift| far.max(shift.abs()));
        let part = if far > FAR { FAR / far } else { 1.0 };
        let mut dimensions = problem.dimensions().to_vec();
        for (&d, shift) in of.iter().zip(&shifts) {
            let by = part * shift * dimensions[d].sigma();
            if let Some(moved) = dimensions[d].moved(dimensions[d].nominal() + by) {
                dimensions[d] = moved?;
            }
        }
        Ok((problem.clone().with_dimensions(dimensions)?, far))
    }

    fn cost_to_hold(&self, problem: &Problem) -> Option<f64> {
        let of = |group: &Priced| group.cost_to_hold(group.tightest_member(problem));
        self.task.priced.iter().map(of).sum()
    }

    fn unchanged(&self, problem: &Problem) -> Vec<Allocated> {
        let of = |group: &Priced, d: usize| {
            let before = problem.dimensions()[d].half_band();
            let each = group.parts / group.members.len() as f64;
            Allocated {
                dimension: d,
                before,
                after: before,
                cost_before: group.cost_to_hold(before).map(|cost| cost / group.parts * each),
                cost_after: None,
                process: None,
                bound: None,
            }
        };
        self.task.priced.iter().flat_map(|group| group.members.iter().map(move |&d| of(group, d))).collect()
    }

    fn allocated(&self, original: &Problem, at: &[f64], offers: &[usize]) -> Vec<Allocated> {
        let mut all = Vec::new();
        for ((group, &t), &offer) in self.task.priced.iter().zip(at).zip(offers) {
            let offer = &group.offers[offer];
            let each = group.parts / group.members.len() as f64;
            let near = |bound: f64| (t / bound - 1.0).abs() <= 1e-6 && offer.min < offer.max;
            let bound = if near(offer.min) {
                Some(Bound::Least)
            } else if near(offer.max) {
                Some(Bound::Greatest)
            } else {
                None
            };
            for &d in &group.members {
                let before = original.dimensions()[d].half_band();
                all.push(Allocated {
                    dimension: d,
                    before,
                    after: t,
                    cost_before: group.cost_to_hold(before).map(|cost| cost / group.parts * each),
                    cost_after: Some(each * offer.curve.cost(t)),
                    process: offer.process.clone(),
                    bound,
                });
            }
        }
        all.sort_by_key(|one| one.dimension);
        all
    }
}

/// Where what was found is in doubt.
fn doubts(problem: &Problem, allocation: &Allocation) -> Vec<Warning> {
    let found = matches!(allocation.status, Status::Optimal | Status::AlmostOptimal);
    let not_confirmed = (!allocation.confirmed && found).then_some(Warning::NotConfirmed);
    let refuted = |kept: &Kept| {
        let Requirement::Yield(required) = kept.requirement else { return None };
        let [low, high] = allocation.confirmation.as_ref()?.characteristics[kept.characteristic].yield_?.interval;
        let value = allocation.confirmation.as_ref()?.characteristics[kept.characteristic].yield_?.value;
        // Half as far again as the interval reaches: three standard errors.
        let most = high + 0.5 * (high - value);
        let characteristic = problem.characteristics()[kept.characteristic].name().to_owned();
        (most < required).then_some(Warning::ConfirmationMisses { characteristic, required, interval: [low, high] })
    };
    not_confirmed.into_iter().chain(allocation.requirements.iter().filter_map(refuted)).collect()
}

/// How the rounds ended.
struct Ended {
    agreed: bool,
    within_budget: bool,
}

fn cost(priced: &[Priced], at: &[f64], offers: &[usize]) -> f64 {
    let of = |((group, &t), &offer): ((&Priced, &f64), &usize)| group.parts * group.offers[offer].curve.cost(t);
    priced.iter().zip(at).zip(offers).map(of).sum()
}

/// The largest change of a half band, in logarithms.
fn farthest(from: &[f64], to: &[f64]) -> f64 {
    from.iter().zip(to).map(|(a, b)| (b / a).ln().abs()).fold(0.0, f64::max)
}

/// A reach for shorter steps.
fn shorter(reach: f64) -> f64 {
    if reach.is_finite() { reach.sqrt() } else { REACH }
}

/// Whether every group may have its half band.
/// The groups with free tolerances no farther from these half bands than by a factor.
fn within_reach(priced: &[Priced], at: &[f64], reach: f64) -> Vec<Priced> {
    let mut priced = priced.to_vec();
    for (group, &t) in priced.iter_mut().zip(at).filter(|(group, _)| reach.is_finite() && group.offers.len() == 1) {
        let offer = &mut group.offers[0];
        let t = t.clamp(offer.min, offer.max);
        (offer.min, offer.max) = (offer.min.max(t / reach), offer.max.min(t * reach));
    }
    priced
}

/// The problem with the groups at these half bands.
fn with_tolerances(problem: Problem, priced: &[Priced], at: &[f64]) -> Result<Problem, AllocateError> {
    let dimensions: Vec<Dimension> = scaled(&problem, priced, at)?;
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

/// Nominal values that differ.
fn moved(before: &Problem, after: &Problem) -> Vec<Moved> {
    let pairs = before.dimensions().iter().zip(after.dimensions()).enumerate();
    pairs
        .filter(|(_, (before, after))| before.nominal() != after.nominal())
        .map(|(dimension, (before, after))| Moved { dimension, before: before.nominal(), after: after.nominal() })
        .collect()
}
