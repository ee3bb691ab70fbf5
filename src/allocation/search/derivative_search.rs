//! Search along derivatives: every round chooses tolerances by the derivatives of one linearization point, and evaluates
//! the model there. The [state](crate::allocation::search::search_state) decides what follows.

use std::rc::Rc;

use crate::allocation::choice::machine::choose;
use crate::allocation::choice::process_selection::{have_distributions, is_proof};
use crate::allocation::choice::selection::{Choice, within_bounds};
use crate::allocation::choice::single_offer::{Setting, tightened};
use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::result::allocation::{Attainable, Status};
use crate::allocation::result::solver_result::Chosen;
use crate::allocation::search::best_trial::{SearchEnd, SearchFailure, Searched};
use crate::allocation::search::driver::{Driver, Near, ROUNDS, kept_within, unit, with_choice, with_tolerances};
use crate::allocation::search::linearization_point::{LinearizationPoint, Seen};
use crate::allocation::search::nominal::Recentred;
use crate::allocation::search::search_state::{Answer, Finish, Next, Question, Recentring, SearchState};
use crate::allocation::surface::sampled_moments::SampledCorrection;
use crate::allocation::task::{AllocateError, Goal};
use crate::problem::Problem;

impl Driver<'_> {
    /// Searches along the derivatives of successive linearization points, from the half bands `before`. `failure` is that
    /// of an earlier search.
    pub(in crate::allocation) fn search(
        &mut self,
        original: &Problem,
        first: Rc<LinearizationPoint>,
        (constraints, before): (&[Constraint], &[f64]),
        failure: SearchFailure,
    ) -> Result<Searched, AllocateError> {
        if self.task.basis.is_proportion() {
            return self.in_proportion(original, first, constraints, failure);
        }
        let search = DerivativeSearch {
            near: Near::of(original),
            original: original.clone(),
            constraints,
            current: constraints.to_vec(),
            base: first.problem.clone(),
            state: SearchState::new(first, before.to_vec()),
            driver: self,
        };
        search.run(failure)
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

/// Search along derivatives.
struct DerivativeSearch<'s, 'd> {
    driver: &'s mut Driver<'d>,
    original: Problem,
    near: Near,
    /// Requirements of the task.
    constraints: &'s [Constraint],
    /// Requirements with the levels that are sought for a cost.
    current: Vec<Constraint>,
    /// Problem of the round, with its nominal values.
    base: Problem,
    state: SearchState<Rc<LinearizationPoint>>,
}

impl DerivativeSearch<'_, '_> {
    /// Runs rounds to the end of the search.
    fn run(mut self, failure: SearchFailure) -> Result<Searched, AllocateError> {
        for _ in 0..ROUNDS {
            let finish = match self.round()? {
                Next::Ask(question) => self.ask(question)?,
                Next::Shorten => {
                    self.state.shorten();
                    None
                }
                Next::Done(finish) => Some(finish),
            };
            match finish {
                None => {}
                Some(Finish::LastChoice) => break,
                Some(Finish::Nothing { status, attainable }) => {
                    let attainable = attainable.or(failure.attainable);
                    return Ok(Searched { end: None, failure: SearchFailure { status, attainable } });
                }
            }
        }
        let SearchState { point: station, last, ended, .. } = self.state;
        let end = SearchEnd { station, last, constraints: self.current, ended, trial: None, is_start: false };
        Ok(Searched { end: Some(end), failure })
    }

    /// Moves nominal values, or else chooses tolerances.
    fn round(&mut self) -> Result<Next, AllocateError> {
        self.base = self.state.point.problem.clone();
        let mut still = true;
        if !self.driver.options.recentre.is_empty() {
            let Recentred { problem, far, rest, at, residual } =
                self.driver.recentred(&self.state.point, self.constraints, &self.state.at)?;
            self.state.ended.at_rest = residual;
            let priced = !self.driver.task.priced.is_empty();
            match SearchState::<()>::recentring([far, rest], at.is_some(), priced) {
                Recentring::AtRest => {}
                Recentring::Together => (self.base, still) = (problem, false),
                Recentring::First => {
                    self.base = problem;
                    return Ok(Next::Ask(at.map_or(Question::MovedNominals, Question::Tolerances)));
                }
            }
        }
        if self.driver.task.priced.is_empty() {
            self.state.ended.agreed = still;
            return Ok(Next::Done(Finish::LastChoice));
        }
        Ok(self.choose(still))
    }

    /// Chooses tolerances by the derivatives of the linearization point. `still` is true if nominal values are at rest.
    fn choose(&mut self, still: bool) -> Next {
        let (task, run, station) = (self.driver.task, self.driver.run, Rc::clone(&self.state.point));
        let stopped = || run.stopped();
        let priced = within_reach(&task.priced, &self.state.at, self.followed_reach());
        let setting = Setting {
            responses: &station.responses,
            priced: &priced,
            constraints: self.constraints,
            losses: &task.losses,
            setups: &task.setups,
            stopped: &stopped,
            anywhere: self.state.is_fresh(),
        };
        let Some(current) = self.with_levels(&setting) else {
            return Next::Done(Finish::Nothing { status: Status::NoFeasiblePointFound, attainable: None });
        };
        self.current.clone_from(&current);
        let setting = Setting { constraints: &current, ..setting };
        // Kept by the model and within the bounds: a place to come back to.
        let here = kept_within(setting.value(&self.state.at), task.goal);
        let safe = here && within_bounds(&task.priced, &self.state.at);
        let cost_here = if task.losses.is_empty() { 0.0 } else { setting.cost(&self.state.at) };
        if self.state.is_dearer_than_fallback(cost_here) {
            return Next::Shorten;
        }
        let mut chosen = match choose(&setting, &self.state.at) {
            Choice::Found { solved, offers, proof } => (solved, offers, proof),
            Choice::Infeasible(attainable, tightest) => {
                let next = self.state.without_choice(tightest);
                return next.unwrap_or_else(|| Next::Done(self.infeasible(&setting, attainable)));
            }
            Choice::Stopped => {
                self.driver.spent.stopped = true;
                return Next::Done(Finish::LastChoice);
            }
        };
        self.state.keep_starts(&mut chosen.2);
        // The model has been asked at these tolerances, and would not choose others.
        if still && here && self.state.is_chosen_again(&chosen, self.near.agree, have_distributions(&priced)) {
            let (multipliers, otherwise) = (chosen.0.multipliers.clone(), chosen.0.residual);
            self.state.confirm(chosen, |at| setting.residual(at, &multipliers).unwrap_or(otherwise));
            return Next::Done(Finish::LastChoice);
        }
        self.shortened(&setting, &mut chosen);
        Next::Ask(Question::Choice { chosen: Box::new(chosen), kept_at_cost: safe.then_some(cost_here) })
    }

    /// Factor up to which the derivatives of the linearization point are followed. It is limited if they come from samples.
    fn followed_reach(&self) -> f64 {
        let responses = &self.state.point.responses;
        let sampled = self.constraints.iter().any(|one| responses.is_sampled(one.characteristic));
        if sampled { self.state.reach.min(SampledCorrection::REACH) } else { self.state.reach }
    }

    /// Requirements with the level that is sought for a cost. Returns None if no level is found.
    fn with_levels(&self, setting: &Setting<'_>) -> Option<Vec<Constraint>> {
        match self.driver.task.goal {
            Goal::LeastCost => Some(self.constraints.to_vec()),
            _ => self.driver.levelled(setting, &self.original, &self.state.at),
        }
    }

    /// End without tolerances that keep everything.
    fn infeasible(&self, setting: &Setting<'_>, attainable: Attainable) -> Finish {
        // If every tolerance does harm only, the tightest are the proof.
        let exact = if have_distributions(setting.priced) { is_proof(setting) } else { setting.is_exact() };
        let proven = exact && self.driver.options.recentre.is_empty();
        let status = if proven { Status::Infeasible } else { Status::NoFeasiblePointFound };
        let unit = unit(&self.original, attainable.characteristic);
        Finish::Nothing { status, attainable: Some(Attainable { unit, ..attainable }) }
    }

    /// Tightens a choice by a margin, and goes as far on the way to it as the last steps advise.
    fn shortened(&mut self, setting: &Setting<'_>, (solved, _, proof): &mut Chosen) {
        if self.state.last.is_some() && !setting.is_exact() {
            tightened(&mut solved.at, setting.priced, 1.0 - self.near.margin);
        }
        let free = self.driver.task.priced.iter().all(|group| group.offers.len() == 1);
        if let Some(part_way) = self.state.part_way(&solved.at).filter(|_| free) {
            solved.at = part_way;
            solved.cost = setting.cost(&solved.at);
            proof.residual = setting.residual(&solved.at, &solved.multipliers);
        }
    }

    /// Evaluates the model, and gives its answer to the state. Returns the end, if this is one.
    fn ask(&mut self, question: Question) -> Result<Option<Finish>, AllocateError> {
        let (base, priced) = (self.base.clone(), &self.driver.task.priced);
        let problem = match &question {
            Question::MovedNominals => base,
            Question::Tolerances(at) => with_tolerances(base, priced, at)?,
            Question::Choice { chosen, .. } => with_choice(base, priced, &chosen.0.at, &chosen.1)?,
        };
        let answer = match self.driver.station(problem)?.map(Rc::new) {
            None => Answer::OverBudget,
            Some(point) if self.driver.spent.stopped => Answer::Stopped(point),
            Some(point) if point.answers(self.constraints) => Answer::Point(point),
            Some(point) => Answer::Failed(point),
        };
        let chosen_kept = matches!((&question, &answer), (Question::Choice { .. }, Answer::Point(_)));
        let finish = self.state.take(question, answer);
        if chosen_kept {
            self.driver.see(&self.state.point, self.state.last.as_ref());
        }
        Ok(finish)
    }
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
