//! End of an allocation: the cheapest tolerances that keep everything by the analysis itself. The tolerances of the
//! study are among the candidates.
//!
//! Derivatives lead a search to its end, which is then tried ([`Trial`]). Requirements that it misses by little are
//! made stricter, and the search is repeated. If derivatives are wrong, a [search by trials](crate::allocation::search::trial_search)
//! follows. The tolerances before are tried too. An allocation is therefore never dearer than its start, and has a
//! result if the start keeps everything.

use crate::allocation::cost::priced_group::Priced;
use std::rc::Rc;

use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::requirement::registry::form_of;
use crate::allocation::result::allocation::{AllocationSolver, Attainable, Proof, Status};
use crate::allocation::result::solver_result::{Chosen, Solved, Starts};
use crate::allocation::search::driver::Driver;
use crate::allocation::search::end_choice::{AfterSearch, Origin, SAME, Standing, cheapest};
use crate::allocation::search::linearization_point::{LinearizationPoint, Seen};
use crate::allocation::search::search_state::Ended;
use crate::allocation::search::trial::{Trial, is_offered};
use crate::allocation::search::trial_search::{Tolerances, VerifiedSearch};
use crate::allocation::surface::uncertainty::Uncertainty;
use crate::allocation::task::{AllocateError, Goal};
use crate::problem::Problem;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::verdict::Verdict;

/// Greatest number of repeated searches with stricter requirements.
const STRICTER: usize = 3;
/// Factor of a miss by which a requirement is made stricter. The excess over 1 makes sure that the miss is made up for.
const MARGIN: f64 = 1.01;
/// Parts of the way back from tolerances that keep everything, but not with their written digits.
const BACK: [f64; 4] = [1e-4, 1e-3, 1e-2, 1e-1];

/// Result of a search.
pub(in crate::allocation) struct Searched {
    /// End of the search. None if nothing was found.
    pub(in crate::allocation) end: Option<SearchEnd>,
    pub(in crate::allocation) failure: SearchFailure,
}

/// Reason why a search found nothing.
pub(in crate::allocation) struct SearchFailure {
    pub(in crate::allocation) status: Status,
    /// Best value of the requirement that cannot be kept.
    pub(in crate::allocation) attainable: Option<Attainable>,
}

impl SearchFailure {
    /// State before any search has failed.
    pub(in crate::allocation) fn none() -> Self {
        Self { status: Status::OutOfTime, attainable: None }
    }

    /// End with this status and without a value of a requirement, since some tolerances keep it.
    fn without_attainable(self) -> Self {
        Self { attainable: None, ..self }
    }
}

pub(in crate::allocation) struct SearchEnd {
    pub(in crate::allocation) station: Rc<LinearizationPoint>,
    /// Tolerances found. None if only nominal values were to be chosen.
    pub(in crate::allocation) last: Option<Chosen>,
    /// Requirements, including the level that is sought for a given cost.
    pub(in crate::allocation) constraints: Vec<Constraint>,
    pub(in crate::allocation) ended: Ended,
    /// Trial of the tolerances found, if one was made.
    pub(in crate::allocation) trial: Option<Trial>,
    /// True for the study's own tolerances and nominal values.
    pub(in crate::allocation) is_start: bool,
}

/// Tolerances of the study at the start.
pub(in crate::allocation) struct AllocationStart {
    pub(in crate::allocation) station: Rc<LinearizationPoint>,
    pub(in crate::allocation) trial: Option<Trial>,
    /// True if the costs offer these tolerances.
    pub(in crate::allocation) offered: bool,
}

impl SearchEnd {
    /// Half bands and offers of the end.
    fn tolerances(&self) -> Option<Tolerances> {
        self.last.as_ref().map(|(solved, offers, _)| (solved.at.clone(), offers.clone()))
    }

    fn is_kept(&self) -> bool {
        self.trial.as_ref().is_some_and(Trial::is_kept)
    }
}

impl Driver<'_> {
    /// Judges the study's own tolerances. They are tried if the model is cheap.
    pub(in crate::allocation) fn start(
        &mut self,
        problem: &Problem,
        station: &Rc<LinearizationPoint>,
    ) -> AllocationStart {
        let at: Vec<f64> = self.task.priced.iter().map(|group| group.tightest_member(problem)).collect();
        let held = self.holding(problem);
        let made = held.as_ref().is_some_and(|offers| is_made(problem, &self.task.priced, offers));
        let offered = made && is_offered(&self.task.priced, &at);
        let offers = held.unwrap_or_else(|| vec![0; at.len()]);
        let known = self.stations_are_trials() || !self.is_cheap(problem);
        let tolerances = (at, offers);
        let trial = match known {
            true => Some(self.trial_of(problem.clone(), tolerances, station.analysis.clone(), None)),
            false => self
                .checked(problem)
                .map(|(analysis, findings)| self.trial_of(problem.clone(), tolerances, analysis, Some(findings))),
        };
        // A process that holds a tighter tolerance than the written one keeps its own cost.
        let trial = trial.map(|trial| {
            let (at, offers) = self.offered(&trial);
            Trial { cost: self.held_cost(&at, &offers) + trial.loss, ..trial }
        });
        AllocationStart { station: Rc::clone(station), trial, offered }
    }

    /// Returns the better of the end of a search and the start.
    pub(in crate::allocation) fn best_end(
        &mut self,
        original: &Problem,
        start: AllocationStart,
        Searched { end, failure }: Searched,
    ) -> Result<Searched, AllocateError> {
        let Searched { end, failure } = match end {
            Some(end) if end.ended.within_budget && !self.spent.stopped => self.tried(original, end, failure)?,
            // A search that ended on its budget leaves nothing to judge.
            Some(end) => return Ok(Searched { end: Some(end), failure }),
            None => Searched { end, failure },
        };
        let free_to_choose = self.task.goal == Goal::LeastCost && !self.spent.stopped;
        let unknown = end.as_ref().is_some_and(|end| end.trial.as_ref().is_none_or(Trial::is_unknown));
        if !free_to_choose || unknown {
            return Ok(Searched { end, failure });
        }
        let chosen = |end: &SearchEnd| end.last.is_some() || self.task.priced.is_empty();
        let end = end.filter(chosen);
        if self.task.basis.is_proportion() {
            return Ok(Searched { end: self.best_in_proportion(end)?, failure });
        }
        let standing = self.standing(failure.status, &start, end.as_ref());
        match standing.next() {
            AfterSearch::TakeEnd => Ok(Searched { end, failure }),
            AfterSearch::TakeNothing => Ok(Searched { end: None, failure }),
            AfterSearch::SearchByTrials => self.cheapest_result(start, Searched { end, failure }, standing),
        }
    }

    /// Facts that decide if the end of a search is the result.
    fn standing(&mut self, status: Status, start: &AllocationStart, end: Option<&SearchEnd>) -> Standing {
        let nothing_to_choose = self.task.priced.is_empty();
        let start_kept = start.trial.as_ref().is_some_and(Trial::is_kept)
            && (start.offered || nothing_to_choose)
            && self.start_is_kept(start, end);
        Standing {
            start_kept,
            end_exists: end.is_some(),
            end_kept: end.is_some_and(|end| end.is_kept() && self.is_kept_as_written(&end.station.problem)),
            end_agreed: end.is_some_and(|end| end.ended.agreed || nothing_to_choose),
            end_dearer: start_kept && end.is_some_and(|end| self.dearer_than_start(start, end)),
            infeasible: status == Status::Infeasible,
        }
    }

    /// Cheapest of the end, the start, and the result of a search by trials.
    fn cheapest_result(
        &mut self,
        start: AllocationStart,
        Searched { end, failure }: Searched,
        Standing { start_kept, end_kept, .. }: Standing,
    ) -> Result<Searched, AllocateError> {
        let seen = self.spent.seen.take();
        let found = match self.is_cheap(&start.station.problem) {
            true => self.search_by_trials(&start, start_kept, (end.as_ref(), seen.as_ref())),
            false => self.tried_again(seen, end.as_ref()),
        };
        let end_cost = end.as_ref().filter(|_| end_kept).and_then(|end| Some(end.trial.as_ref()?.cost));
        let start_trial = start.trial.filter(|_| start_kept);
        let costs = [found.as_ref(), start_trial.as_ref()].map(|trial| Some(trial?.cost));
        match (cheapest(costs[0], costs[1], end_cost), found, start_trial) {
            (Origin::Trials, Some(trial), _) => {
                let constraints = self.constraints(&trial.problem, &self.task.requirements);
                let station = self.station(trial.problem.clone())?;
                let proof = Proof { solver: Some(AllocationSolver::VerifiedSearch), ..Proof::default() };
                let end = station.map(|station| ended_at(Rc::new(station), constraints, trial, proof, false));
                Ok(Searched { end, failure: failure.without_attainable() })
            }
            (Origin::Start, _, Some(trial)) => {
                let constraints = self.constraints(&start.station.problem, &self.task.requirements);
                let proof = Proof { residual: Some(f64::INFINITY), ..Proof::default() };
                let end = Some(ended_at(start.station, constraints, trial, proof, true));
                Ok(Searched { end, failure: failure.without_attainable() })
            }
            _ => Ok(Searched { end, failure }),
        }
    }

    /// Tries an end, and repeats the search while its trial misses only requirements that can be made stricter.
    fn tried(
        &mut self,
        original: &Problem,
        end: SearchEnd,
        mut failure: SearchFailure,
    ) -> Result<Searched, AllocateError> {
        let mut end = self.with_trial(end);
        for _ in 0..STRICTER {
            if !self.may_be_stricter(&end) || !self.require_more(&end) {
                break;
            }
            let again = self.searched_again(original, &end, failure)?;
            failure = again.failure;
            match again.end {
                Some(next) => end = self.with_trial(next),
                None => break,
            }
        }
        Ok(Searched { end: Some(end), failure })
    }

    /// True if an end misses a requirement, and a cheap model allows another search.
    fn may_be_stricter(&self, end: &SearchEnd) -> bool {
        let Some(trial) = &end.trial else { return false };
        let confirmed = end.ended.agreed && end.last.is_some();
        let repeatable = self.task.goal == Goal::LeastCost && !self.task.basis.is_proportion();
        let missed = !trial.is_kept() && !trial.is_unknown();
        confirmed && repeatable && missed && self.is_cheap(&trial.problem)
    }

    /// Repeats the search from an end, with requirements that were made stricter. If it finds nothing more, the last end
    /// stays.
    fn searched_again(
        &mut self,
        original: &Problem,
        end: &SearchEnd,
        failure: SearchFailure,
    ) -> Result<Searched, AllocateError> {
        let at = end.last.as_ref().map(|(solved, ..)| solved.at.clone()).unwrap_or_default();
        let constraints = self.constraints(&end.station.problem, &self.task.requirements);
        let Some(station) = self.station(end.station.problem.clone())? else {
            return Ok(Searched { end: None, failure });
        };
        let next = self.search(original, Rc::new(station), (&constraints, &at), failure)?;
        let end = next.end.filter(|next| next.ended.within_budget && !self.spent.stopped);
        let failure = if end.is_none() { next.failure.without_attainable() } else { next.failure };
        Ok(Searched { end, failure })
    }

    /// Adds the trial to an end. It is the analysis of the linearization point, if this was made as a trial is.
    fn with_trial(&mut self, end: SearchEnd) -> SearchEnd {
        let problem = end.station.problem.clone();
        let tolerances = end.tolerances().unwrap_or_default();
        let known = self.stations_are_trials();
        let of_station = || (end.station.analysis.clone(), None);
        let found = match known {
            true => Some(of_station()),
            false => self.checked(&problem).map(|(analysis, findings)| (analysis, Some(findings))),
        };
        // If the budget does not allow a trial, the linearization point is judged.
        let (analysis, findings) = found.unwrap_or_else(of_station);
        let trial = self.trial_of(problem, tolerances, analysis, findings);
        SearchEnd { trial: Some(trial), ..end }
    }

    /// Makes those requirements stricter that a trial misses although its linearization point keeps them. Returns false
    /// if there is none, or another one is missed.
    fn require_more(&mut self, end: &SearchEnd) -> bool {
        let Some(trial) = &end.trial else { return false };
        let kept_by_station = self.judged_by(&end.station.analysis);
        let (mut more, mut joint) = (vec![Uncertainty::default(); end.station.responses.of.len()], 0.0);
        for (place, (judged, station)) in trial.judged.iter().zip(&kept_by_station).enumerate() {
            if judged.verdict == Verdict::Met {
                continue;
            }
            let Some(interval) = judged.interval.filter(|_| station.verdict == Verdict::Met) else { return false };
            let requirement = judged.requirement;
            let Some(miss) = form_of(&requirement).missed(requirement.amount(), interval) else { return false };
            match self.required.get(place) {
                Some(&(c, _)) => more[c].set(&requirement, MARGIN * miss),
                // The joint yield stands after those of the characteristics.
                None => joint = MARGIN * miss,
            }
        }
        self.spent.require_more(&more, joint);
        true
    }

    /// True if the start keeps everything by `analyze --check`. A costly model is analysed only if the search found
    /// nothing better.
    fn start_is_kept(&mut self, start: &AllocationStart, end: Option<&SearchEnd>) -> bool {
        let problem = &start.station.problem;
        if self.is_cheap(problem) || self.stations_are_trials() {
            return true;
        }
        if end.is_some_and(|end| end.is_kept() && !self.dearer_than_start(start, end)) {
            return true;
        }
        self.checked(problem).is_some_and(|(analysis, _)| self.keeps_everything(&analysis))
    }

    fn dearer_than_start(&self, start: &AllocationStart, end: &SearchEnd) -> bool {
        let costs = end.trial.as_ref().zip(start.trial.as_ref());
        costs.is_some_and(|(end, start)| end.cost > start.cost * (1.0 + SAME))
    }

    /// Returns the cheapest linearization point of a costly model that kept everything. Returns None if it is the end
    /// itself, and if its trial misses a requirement.
    fn tried_again(&mut self, seen: Option<Seen>, end: Option<&SearchEnd>) -> Option<Trial> {
        let Seen { station, chosen: (solved, offers, _), .. } = seen?;
        if end.is_some_and(|end| Rc::ptr_eq(&end.station, &station)) {
            return None;
        }
        let (analysis, findings) = match self.stations_are_trials() {
            true => (station.analysis.clone(), None),
            false => self.checked(&station.problem).map(|(analysis, findings)| (analysis, Some(findings)))?,
        };
        Some(self.trial_of(station.problem.clone(), (solved.at, offers), analysis, findings)).filter(Trial::is_kept)
    }

    /// Best result of a search by trials that also keeps everything with its written digits.
    fn search_by_trials(
        &mut self,
        start: &AllocationStart,
        kept_start: bool,
        (end, seen): (Option<&SearchEnd>, Option<&Seen>),
    ) -> Option<Trial> {
        let base = end.map_or(&start.station.problem, |end| &end.station.problem).clone();
        if self.task.priced.is_empty() {
            return None;
        }
        let aim = end.and_then(SearchEnd::tolerances);
        let seen = seen.map(|seen| (seen.chosen.0.at.clone(), seen.chosen.1.clone()));
        let own = start.trial.as_ref().filter(|_| start.offered).map(|trial| self.offered(trial));
        let starts: Vec<Tolerances> = seen.into_iter().chain(own).collect();
        let found = VerifiedSearch::new(self, base.clone()).run(&starts, aim)?;
        if self.is_kept_as_written(&found.problem) {
            return Some(found);
        }
        // Cutting off the last digits may move a sample's point past a limit, so the tolerances go back a little.
        let back = start.trial.as_ref().filter(|trial| kept_start && trial.offers == found.offers);
        let tight: Vec<f64> = found.at.iter().map(|t| 0.5 * t).collect();
        let back = back.map_or(tight, |trial| trial.at.clone());
        for part in BACK {
            let way = found.at.iter().zip(&back).map(|(t, to)| t * libm::exp(part * libm::log(to / t)));
            let at: Vec<f64> = way.collect();
            let trial = self.trial(&base, &at, &found.offers)?;
            if trial.is_kept() && self.is_kept_as_written(&trial.problem) {
                return Some(trial);
            }
        }
        None
    }

    /// Tolerances of the study clamped to their offers. For a list it is the tolerance of the process that holds it.
    fn offered(&self, trial: &Trial) -> Tolerances {
        let of = |((group, &t), &offer): ((&Priced, &f64), &usize)| {
            t.clamp(group.offers[offer].min, group.offers[offer].max)
        };
        (self.task.priced.iter().zip(&trial.at).zip(&trial.offers).map(of).collect(), trial.offers.clone())
    }

    /// Better of the end and a search by trials for tolerances in fixed proportions.
    fn best_in_proportion(&mut self, end: Option<SearchEnd>) -> Result<Option<SearchEnd>, AllocateError> {
        let Some(end) = end else { return Ok(None) };
        let base = end.station.problem.clone();
        let settled = end.is_kept() && end.ended.agreed;
        let Some((at, offers)) = end.tolerances().filter(|_| !settled && self.is_cheap(&base)) else {
            return Ok(Some(end));
        };
        let Some(trial) = VerifiedSearch::new(self, base).in_proportion(&at, &offers) else { return Ok(Some(end)) };
        let constraints = self.constraints(&trial.problem, &self.task.requirements);
        let station = self.station(trial.problem.clone())?;
        let proof = Proof { solver: Some(AllocationSolver::VerifiedSearch), ..Proof::default() };
        Ok(station.map(|station| ended_at(Rc::new(station), constraints, trial, proof, false)))
    }
}

/// End of a search at a trial, without a proof.
fn ended_at(
    station: Rc<LinearizationPoint>,
    constraints: Vec<Constraint>,
    trial: Trial,
    proof: Proof,
    is_start: bool,
) -> SearchEnd {
    let solved = Solved {
        at: trial.at.clone(),
        cost: trial.cost,
        multipliers: vec![0.0; constraints.len()],
        residual: f64::INFINITY,
        value: trial.use_(),
        closed: false,
        converged: false,
        sequential: false,
        starts: Starts::default(),
    };
    let last = Some((solved, trial.offers.clone(), proof));
    let ended = Ended { agreed: false, within_budget: true, at_rest: None };
    SearchEnd { station, last, constraints, ended, trial: Some(trial), is_start }
}

/// True if the dimensions of the problem are those that the offers make of them. Two processes of one tolerance may
/// differ in mean and sigma.
fn is_made(problem: &Problem, priced: &[Priced], offers: &[usize]) -> bool {
    let present = problem.dimensions();
    let alike = |own: &Dimension, made: &Dimension| {
        let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(own.half_band());
        same(own.mean(), made.mean()) && same(own.sigma(), made.sigma()) && same(own.half_band(), made.half_band())
    };
    priced.iter().zip(offers).all(|(group, &offer)| {
        let mut offered = group.offered(&group.offers[offer], present, |own, _| own.half_band());
        offered.all(|(d, made)| made.is_some_and(|made| made.is_ok_and(|made| alike(&present[d], &made))))
    })
}

/// Status of an end that misses a requirement.
pub(in crate::allocation) fn status_of_missed(verdict: Verdict) -> Status {
    match verdict {
        Verdict::Missed => Status::NoFeasiblePointFound,
        Verdict::Met | Verdict::Inconclusive => Status::Inconclusive,
    }
}
