//! Conclusions from the tolerances at the end of a search: status, prices, front, and confirmation by a sample.

use crate::allocation::choice::machine::choose;
use crate::allocation::choice::selection::Choice;
use crate::allocation::choice::single_offer::Setting;
use crate::allocation::cost::priced_group::holder;
use crate::allocation::cost::priced_group::{Offer, Priced};
use crate::allocation::cost::setup_cost::needed;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::requirement::form::Basis;
use crate::allocation::requirement::registry::form_of;
use crate::allocation::result::allocation::{
    Allocated, AllocatedZone, Allocation, AllocationSolver, Attainable, Bound, Kept, Moved, Proof, Status,
};
use crate::allocation::result::solver_result::Solved;
use crate::allocation::search::best_trial::{SearchEnd, status_of_missed};
use crate::allocation::search::box_sample::worst_in_box;
use crate::allocation::search::common_factor::loosest;
use crate::allocation::search::driver::{Driver, cost, kept_within, unit, with_choice};
use crate::allocation::search::linearization_point::{LinearizationPoint, prices};
use crate::allocation::search::pareto_front::front;
use crate::allocation::search::trial::Trial;
use crate::allocation::surface::joint_yield::joint;
use crate::allocation::task::{AllocateError, Goal};
use crate::analysis::{Analysis, CharacteristicAnalysis, Findings, TRUSTED};
use crate::problem::Problem;
use crate::simulation::{SimulatedCharacteristic, SimulationOptions, simulate_with};
use crate::summary::StopReason;
use crate::warning::Warning;
use sensitol_numeric::verdict::worst;
use sensitol_numeric::verdict::{Judged, Verdict};

/// Greatest residual of tolerances that are reported as optimal.
const OPTIMAL: f64 = 1e-6;
/// Smallest number of points of a confirmation.
const FEWEST_CONFIRM: u64 = 2;
/// Greatest gap of a choice of processes that is reported as optimal.
pub(in crate::allocation) const NO_GAP: f64 = 1e-9;

impl Driver<'_> {
    /// Fills in the allocation from the last tolerances.
    pub(in crate::allocation) fn conclude(
        &mut self,
        allocation: &mut Allocation,
        original: &Problem,
        end: SearchEnd,
    ) -> Result<(), AllocateError> {
        allocation.moved = moved(original, &end.station.problem);
        if end.last.is_none() && allocation.moved.is_empty() {
            let finished = self.task.priced.is_empty() && end.ended.agreed;
            if !finished {
                return Ok(());
            }
        }
        let judged = JudgedEnd::of(allocation, &end);
        self.conclude_tolerances(allocation, original, &end);
        allocation.confirmed = end.ended.within_budget && !self.spent.stopped;
        allocation.status = self.status(&end, &judged);
        if allocation.status == Status::Infeasible {
            allocation.attainable = judged.farthest_missed(original, &end);
        }
        // A budget that ended before the model was asked at these tolerances leaves nothing to say of them.
        if let (false, Some((solved, offers, _))) = (end.ended.within_budget, &end.last) {
            allocation.problem = with_choice(end.station.problem.clone(), &self.task.priced, &solved.at, offers)?;
            return Ok(());
        }
        allocation.requirements.iter_mut().zip(judged.requirements).for_each(|(one, judged)| one.after = Some(judged));
        allocation.joint_requirement.iter_mut().for_each(|one| one.after = judged.joint);
        self.conclude_alternatives(allocation, original, &end);
        if let (Some(samples), false) = (self.options.confirm, self.spent.stopped) {
            self.confirm(allocation, &end.station.problem, &judged.analysis.characteristics, samples)?;
        }
        let station = &end.station;
        allocation.after = Some(match &end.trial {
            Some(trial) => self.completed_trial(trial, &station.findings),
            None => self.completed(station.analysis.clone(), &station.findings, &station.problem),
        });
        allocation.problem = station.problem.clone();
        Ok(())
    }

    /// Requirements at a linearization point, on the tolerances of the task.
    fn setting<'s>(
        &'s self,
        station: &'s LinearizationPoint,
        constraints: &'s [Constraint],
        stopped: &'s (dyn Fn() -> bool + Sync),
    ) -> Setting<'s> {
        let (responses, priced) = (&station.responses, &self.task.priced);
        let (losses, setups) = (&self.task.losses, &self.task.setups);
        Setting { responses, priced, constraints, losses, setups, stopped, anywhere: false }
    }

    /// The tolerances chosen, with their proof, their cost, and the prices of the active constraints.
    fn conclude_tolerances(&self, allocation: &mut Allocation, original: &Problem, end: &SearchEnd) {
        let Some((solved, offers, proof)) = &end.last else { return };
        let loss = self.loss_at(&end.station);
        let cost =
            cost(&self.task.priced, &solved.at, offers) + loss.unwrap_or(f64::NAN) + self.set_up(allocation, offers);
        let gap = |bound: f64| ((cost - bound) / cost.abs().max(f64::MIN_POSITIVE)).max(0.0);
        let together = end.ended.at_rest.map(|_| AllocationSolver::AugmentedLagrangian);
        let solver = together.or(proof.solver);
        allocation.proof = Proof { solver, gap: proof.bound.map(gap), ..proof.clone() };
        allocation.cost_after = Some(cost).filter(|cost| cost.is_finite());
        allocation.loss[1] = loss.filter(|_| !self.task.losses.is_empty());
        allocation.tolerances = self.allocated(original, &solved.at, offers);
        if end.is_start {
            // Nothing has changed, whatever process holds it.
            (allocation.cost_after, allocation.loss[1]) = (allocation.cost_before, allocation.loss[0]);
            allocation.tolerances = self.unchanged(original);
            allocation.tolerances.iter_mut().for_each(|one| one.cost_after = one.cost_before);
        }
        let free = self.task.priced.iter().all(|group| group.offers.len() == 1);
        // Of a level that is sought, and of proportions that are fixed, multipliers are not what a limit costs.
        if free && self.task.goal == Goal::LeastCost && !self.task.basis.is_proportion() {
            let stopped = || self.run.stopped();
            let setting = self.setting(&end.station, &end.constraints, &stopped);
            allocation.prices = prices(&setting, solved);
            self.price_bounds(allocation, &setting, solved);
        }
    }

    /// The status of an end by the way that it ended, its verdict and its proof.
    fn status(&self, end: &SearchEnd, judged: &JudgedEnd<'_>) -> Status {
        let met = judged.values.iter().all(|&value| kept_within(value, self.task.goal));
        // Where no error is known nothing could be met, and nothing is said against it.
        let open = end.trial.as_ref().is_some_and(|trial| !trial.is_kept() && !trial.is_unknown());
        let open = open && self.task.goal == Goal::LeastCost || judged.verdict == Verdict::Missed;
        match &end.last {
            _ if self.spent.stopped => Status::OutOfTime,
            // Only nominal values were to be chosen. What they cannot reach needs tighter tolerances.
            None if !met => Status::Infeasible,
            Some(_) | None if open && end.ended.within_budget => status_of_missed(judged.verdict),
            None if end.ended.agreed => Status::Optimal,
            None => Status::AlmostOptimal,
            Some((solved, _, proof)) => self.status_by_proof(end, met, (solved, proof)),
        }
    }

    /// The status of tolerances that nothing speaks against.
    fn status_by_proof(&self, end: &SearchEnd, met: bool, (solved, proof): (&Solved, &Proof)) -> Status {
        let proven = self.has_true_slopes(&end.station, &end.constraints)
            && proof.residual.is_none_or(|residual| residual <= OPTIMAL)
            && proof.bound.is_none_or(|bound| {
                proof.bound_is_exact == Some(true)
                    && solved.cost - bound <= NO_GAP * solved.cost.abs().max(f64::MIN_POSITIVE)
            });
        let at_rest = end.ended.at_rest.is_none_or(|residual| residual <= OPTIMAL);
        let recentred = !self.options.recentre.is_empty();
        match proven && at_rest && end.ended.agreed && met {
            true if recentred && end.ended.at_rest.is_none() => Status::AlmostOptimal,
            true if self.is_certified(&end.station, &end.constraints, (solved, proof), recentred) => Status::Optimal,
            true => Status::LocalOptimum,
            false => Status::AlmostOptimal,
        }
    }

    /// Returns true if the slopes of everything that is required and lost are those of the model.
    fn has_true_slopes(&self, station: &LinearizationPoint, constraints: &[Constraint]) -> bool {
        // Slopes of a surface that the model refutes, and those of samples, prove nothing.
        let followed = |c: usize| {
            let left = station.analysis.characteristics[c].evidence.verification.as_ref().and_then(|of| of.left);
            !station.responses.is_sampled(c) && left.is_none_or(|left| left <= TRUSTED)
        };
        constraints.iter().all(|one| {
            one.characteristics(&station.responses).into_iter().all(followed) || one.form().basis() == Basis::Box
        }) && self.task.losses.iter().all(|loss| followed(loss.characteristic))
    }

    /// The cost without steps and grades, the common factors that are left, and the front of costs.
    fn conclude_alternatives(&self, allocation: &mut Allocation, original: &Problem, end: &SearchEnd) {
        let station = &end.station;
        let solved = end.last.as_ref().map(|(solved, ..)| solved).filter(|_| !self.spent.stopped);
        let stopped = || self.run.stopped();
        let setting = self.setting(station, &end.constraints, &stopped);
        if let Some(solved) = solved {
            allocation.cost_unrounded = unrounded(&setting, solved);
        }
        // Derivatives that the search did not follow do not give the remaining slack.
        let followed = allocation.proof.solver != Some(AllocationSolver::VerifiedSearch);
        allocation.loosest_after = loosest(&station.responses, &end.constraints).filter(|_| followed);
        allocation.joint[1] = joint(&station.problem, &station.responses, self.options.seed);
        if let (Some(points), Some(solved)) = (self.options.front, solved) {
            let joint = self.task.joint_target(original, self.options);
            allocation.front = front(&setting, original, &self.task.requirements, joint, points, &solved.at);
            let group = |d: usize| self.task.priced.iter().position(|group| group.members.contains(&d));
            for point in &mut allocation.front {
                let of_groups = point.tolerances.take();
                point.tolerances = of_groups.map(|of_groups| {
                    allocation.tolerances.iter().filter_map(|one| Some(of_groups[group(one.dimension)?])).collect()
                });
            }
        }
    }

    /// Analysis of a trial, with the results that are only reported.
    pub(in crate::allocation) fn completed_trial(&self, trial: &Trial, of_station: &Findings) -> Analysis {
        let Some(findings) = &trial.findings else {
            return self.completed(trial.analysis.clone(), of_station, &trial.problem);
        };
        trial.analysis.clone().completed(findings, &trial.problem, &self.options.analysis, self.run)
    }

    /// True if the conditions of an optimum are sufficient.
    ///
    /// That is so if every tolerance is at its loosest, if no choice of processes can cost less, or if the problem is
    /// convex. Linear worst cases and roots of sums of squares about fixed means are convex in the tolerances, as are
    /// all costs except some formulas and tables. With a moving mean they are convex in both, except for a yield.
    fn is_certified(
        &self,
        station: &LinearizationPoint,
        constraints: &[Constraint],
        (solved, proof): (&Solved, &Proof),
        recentred: bool,
    ) -> bool {
        let priced = &self.task.priced;
        let free = priced.iter().all(|group| group.offers.len() == 1);
        let loosest =
            self.task.losses.is_empty() && priced.iter().zip(&solved.at).all(|(group, &t)| t >= group.loosest());
        let stopped = || false;
        let setting = self.setting(station, constraints, &stopped);
        let bilinear = recentred && constraints.iter().any(|one| one.form().basis() == Basis::Distribution);
        free && loosest
            || free && setting.is_convex() && !bilinear
            || !free && proof.bound_is_exact == Some(true) && !recentred && setting.costs_are_convex()
    }

    /// Evaluates the model by Monte Carlo at the tolerances found, with as many points as the budget leaves.
    fn confirm(
        &mut self,
        allocation: &mut Allocation,
        problem: &Problem,
        analysed: &[CharacteristicAnalysis],
        samples: u64,
    ) -> Result<(), AllocateError> {
        let budget = self.options.analysis.budget.map_or(u64::MAX, |budget| budget as u64);
        let samples = samples.min(budget.saturating_sub(self.spent.run.evaluations));
        if samples < FEWEST_CONFIRM {
            self.spent.run.stopped.get_or_insert(StopReason::Budget);
            return Ok(());
        }
        let target_joint_yield = allocation.joint_requirement.as_ref().map(|one| one.requirement.amount());
        let seed = self.options.seed;
        let options = SimulationOptions { samples, seed, target_joint_yield, ..SimulationOptions::default() };
        let simulation = simulate_with(problem, &options, self.run, &|_| {})?;
        self.spent.run = self.spent.run.and(&simulation.run);
        let cheap = !problem.function().signature().costly && self.options.analysis.budget.is_none();
        let worst = allocation.requirements.iter().any(|one| form_of(&one.requirement).basis() == Basis::Box) && cheap;
        let in_box = match worst {
            true => worst_in_box(problem, analysed, self.options.seed, self.run),
            false => vec![None; analysed.len()],
        };
        for one in &mut allocation.requirements {
            let found = &simulation.characteristics[one.characteristic];
            one.sampled = match form_of(&one.requirement).basis() {
                Basis::Bands => None,
                Basis::Box => in_box[one.characteristic],
                Basis::Moments | Basis::Distribution => Some(found.judge_widely(one.requirement)),
            };
        }
        let joint = simulation.joint_requirement.map(Judged::widely);
        allocation.joint_requirement.iter_mut().for_each(|one| one.sampled = joint);
        // Points without a value leave a requirement open unless it is met even if all of them are rejects.
        let open = |judged: Option<Judged>| judged.is_some_and(|judged| judged.verdict == Verdict::Inconclusive);
        let failed = |c: usize| simulation.characteristics[c].failed > 0;
        let mut requirements = allocation.requirements.iter();
        let undecided = requirements.any(|one| failed(one.characteristic) && open(one.sampled))
            || open(joint) && simulation.characteristics.iter().any(|one| one.failed > 0);
        if undecided && is_found(allocation.status) {
            allocation.status = Status::Inconclusive;
        }
        allocation.confirmation = Some(simulation);
        Ok(())
    }

    /// Quality loss and scrap at a linearization point, 0 if the task has none. Returns None if they are unknown.
    pub(in crate::allocation) fn loss_at(&self, station: &LinearizationPoint) -> Option<f64> {
        let ones = vec![1.0; station.problem.dimensions().len()];
        self.task.losses.iter().map(|loss| loss.at(&station.responses, &ones, None)).sum()
    }

    /// Lists the machines that a choice needs, and returns their set-up costs.
    fn set_up(&self, allocation: &mut Allocation, offers: &[usize]) -> f64 {
        let chosen: Vec<&Offer> =
            self.task.priced.iter().zip(offers).map(|(group, &offer)| &group.offers[offer]).collect();
        allocation.setups = needed(&self.task.setups, &chosen).into_iter().cloned().collect();
        allocation.setups.iter().map(|setup| setup.cost).sum()
    }

    /// Adds the prices of the bounds that tolerances have met.
    fn price_bounds(&self, allocation: &mut Allocation, setting: &Setting<'_>, solved: &Solved) {
        // If limits of several requirements are active alike, no single multiplier is a price.
        if allocation.prices.iter().any(|price| price.widen != price.narrow) {
            return;
        }
        let prices = setting.bound_prices(&solved.at, &solved.multipliers);
        for one in &mut allocation.tolerances {
            let group = setting.priced.iter().position(|group| group.members.contains(&one.dimension));
            one.bound_price = group.and_then(|g| prices[g]).filter(|_| one.bound.is_some());
        }
    }

    pub(in crate::allocation) fn cost_to_hold(&self, problem: &Problem) -> Option<f64> {
        let of = |group| Priced::holding(group, group.tightest_member(problem));
        let held: Vec<(f64, &Offer)> = self.task.priced.iter().map(of).collect::<Option<_>>()?;
        let offers: Vec<&Offer> = held.iter().map(|(_, offer)| *offer).collect();
        let setups: f64 = needed(&self.task.setups, &offers).iter().map(|setup| setup.cost).sum();
        Some(held.iter().map(|(cost, _)| cost).sum::<f64>() + setups)
    }

    pub(in crate::allocation) fn unchanged(&self, problem: &Problem) -> Vec<Allocated> {
        let of = |group: &Priced, (dimension, zone): (usize, Option<AllocatedZone>)| {
            let before = present(group, dimension, problem);
            let each = group.parts / rows(group).len() as f64;
            Allocated {
                dimension,
                zone,
                before,
                after: before,
                cost_before: held(group, dimension, before)
                    .or_else(|| group.cost_to_hold(before).map(|cost| cost / group.parts * each)),
                cost_after: None,
                process: None,
                bound: None,
                bound_price: None,
            }
        };
        self.task.priced.iter().flat_map(|group| rows(group).into_iter().map(move |row| of(group, row))).collect()
    }

    fn allocated(&self, original: &Problem, at: &[f64], offers: &[usize]) -> Vec<Allocated> {
        let mut all = Vec::new();
        for ((group, &t), &offer) in self.task.priced.iter().zip(at).zip(offers) {
            let offer = &group.offers[offer];
            let rows = rows(group);
            let each = group.parts / rows.len() as f64;
            let near = |bound: f64| (t / bound - 1.0).abs() <= 1e-6 && offer.min < offer.max;
            let bound = if near(offer.min) {
                Some(Bound::Least)
            } else if near(offer.max) {
                Some(Bound::Greatest)
            } else {
                None
            };
            for (dimension, zone) in rows {
                let before = present(group, dimension, original);
                all.push(Allocated {
                    dimension,
                    zone,
                    before,
                    after: t,
                    cost_before: held(group, dimension, before)
                        .or_else(|| group.cost_to_hold(before).map(|cost| cost / group.parts * each)),
                    cost_after: held(group, dimension, t).or(Some(each * offer.curve.cost(t))),
                    process: offer.process.clone(),
                    bound,
                    bound_price: None,
                });
            }
        }
        all.sort_by_key(|one| one.dimension);
        all
    }
}

/// Rows of a group in a report: its zones, or its dimensions.
fn rows(group: &Priced) -> Vec<(usize, Option<AllocatedZone>)> {
    match &group.zone {
        None => group.members.iter().map(|&d| (d, None)).collect(),
        Some(zone) => (zone.parts.iter())
            .map(|part| {
                let members: Vec<usize> = group.members[part.members.clone()].to_vec();
                (members[0], Some(AllocatedZone { name: part.name.clone(), unit: part.unit.clone(), members }))
            })
            .collect(),
    }
}

/// Cost of a zone that has one of its own in its group.
fn held(group: &Priced, dimension: usize, t: f64) -> Option<f64> {
    let place = group.members.iter().position(|&d| d == dimension)?;
    let part = group.zone.as_ref()?.parts.iter().find(|part| part.members.contains(&place))?;
    part.cost.as_ref().map(|(parts, curve)| parts * curve.cost(t))
}

/// Present tolerance of a row of a group.
fn present(group: &Priced, dimension: usize, problem: &Problem) -> f64 {
    let share = holder(std::slice::from_ref(group), dimension).map_or(1.0, |(_, share)| share);
    problem.dimensions()[dimension].half_band() / share
}

/// The requirements at the end of a search.
struct JudgedEnd<'e> {
    /// Analysis of the trial, or of the linearization point if there was no trial.
    analysis: &'e Analysis,
    /// The values of the constraints; a constraint is kept if its value is at most 1.
    values: Vec<f64>,
    /// The requirements of the allocation, in its order.
    requirements: Vec<Judged>,
    joint: Option<Judged>,
    /// The worst verdict of all.
    verdict: Verdict,
}

impl<'e> JudgedEnd<'e> {
    /// Judges the requirements of an allocation where its search ended.
    fn of(allocation: &Allocation, end: &'e SearchEnd) -> Self {
        let ones = vec![1.0; end.station.problem.dimensions().len()];
        let values = end.constraints.iter().map(|one| one.value_at(&end.station.responses, &ones)).collect();
        let analysis = end.trial.as_ref().map_or(&end.station.analysis, |trial| &trial.analysis);
        let judged = |one: &Kept| analysis.characteristics[one.characteristic].judge(one.requirement);
        let requirements: Vec<Judged> = allocation.requirements.iter().map(judged).collect();
        let joint = allocation.joint_requirement.as_ref().and(analysis.joint_requirement);
        let verdict = worst(requirements.iter().chain(&joint).map(|judged| judged.verdict)).unwrap_or(Verdict::Met);
        Self { analysis, values, requirements, joint, verdict }
    }

    /// The best of the constraint that is farthest from being kept.
    fn farthest_missed(&self, original: &Problem, end: &SearchEnd) -> Option<Attainable> {
        let worst = self.values.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).map(|(k, _)| k);
        worst.map(|k| {
            let one = &end.constraints[k];
            Attainable {
                characteristic: one.characteristic,
                unit: unit(original, one.characteristic),
                requirement: one.requirement,
                joint: one.is_joint(),
                best: match one.is_joint() {
                    true => self.joint.and_then(|joint| joint.value),
                    false => self.analysis.characteristics[one.characteristic].judge(one.requirement).value,
                },
                because: Vec::new(),
                together: false,
            }
        })
    }
}

/// Cost of the cheapest tolerances without steps and grades. Returns None if no group has steps or grades, or nothing is found.
fn unrounded(setting: &Setting<'_>, solved: &Solved) -> Option<f64> {
    if setting.priced.iter().all(|group| group.rounded.is_none()) {
        return None;
    }
    let free = |group: &Priced| match &group.rounded {
        Some(offer) => Priced { offers: vec![offer.clone()], ..group.clone() },
        None => group.clone(),
    };
    let priced: Vec<Priced> = setting.priced.iter().map(free).collect();
    match choose(&Setting { priced: &priced, ..*setting }, &solved.at) {
        Choice::Found { solved: found, .. } if found.cost <= solved.cost * (1.0 + NO_GAP) => Some(found.cost),
        _ => None,
    }
}

/// Warnings about doubts in the result.
pub(in crate::allocation) fn doubts(problem: &Problem, priced: &[Priced], allocation: &Allocation) -> Vec<Warning> {
    let is_bent = |group: &&Priced| {
        let mut offers = group.offers.iter().chain(&group.rounded);
        offers.any(|offer| !offer.curve.is_convex(offer.min, offer.max))
    };
    let name = |group: &Priced| match &group.zone {
        Some(zone) => zone.parts[0].name.clone(),
        None => problem.dimensions()[group.members[0]].name().to_owned(),
    };
    let bent: Vec<String> = priced.iter().filter(is_bent).map(name).collect();
    let not_confirmed = (!allocation.confirmed && is_found(allocation.status)).then_some(Warning::NotConfirmed);
    let refuted = |kept: &Kept| {
        let Judged { interval: Some(interval), verdict: Verdict::Missed, .. } = kept.sampled? else { return None };
        let characteristic = problem.characteristics()[kept.characteristic].name().to_owned();
        let (requirement, required) = (kept.requirement.key(), kept.requirement.amount());
        // For a worst case the points give only the least part of the slack that it uses.
        let interval = if interval[1].is_finite() { interval } else { [interval[0]; 2] };
        Some(Warning::ConfirmationMisses { characteristic, requirement, required, interval })
    };
    let bent = (!bent.is_empty()).then_some(Warning::CostNotConvex { dimensions: bent });
    let together = allocation.joint_requirement.as_ref().and_then(|one| {
        let Judged { interval: Some(interval), verdict: Verdict::Missed, .. } = one.sampled? else { return None };
        Some(Warning::JointConfirmationMisses { required: one.requirement.amount(), interval })
    });
    let refuted = allocation.requirements.iter().filter_map(refuted).chain(together);
    let sampled = allocation.confirmation.iter().flat_map(|simulation| &simulation.characteristics);
    let failed = sampled.filter_map(SimulatedCharacteristic::failures);
    not_confirmed.into_iter().chain(bent).chain(refuted).chain(failed).collect()
}

/// True for a status with tolerances.
pub(in crate::allocation) fn is_found(status: Status) -> bool {
    matches!(status, Status::Optimal | Status::LocalOptimum | Status::AlmostOptimal)
}

fn moved(before: &Problem, after: &Problem) -> Vec<Moved> {
    let pairs = before.dimensions().iter().zip(after.dimensions()).enumerate();
    pairs
        // A width of a zone moves with its tolerance, and is no nominal value of a part.
        .filter(|(_, (before, after))| before.nominal() != after.nominal() && before.sigma() > 0.0)
        .map(|(dimension, (before, after))| Moved { dimension, before: before.nominal(), after: after.nominal() })
        .collect()
}
