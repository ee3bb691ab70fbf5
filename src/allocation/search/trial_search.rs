//! Search by trials alone, if derivatives do not follow the model: at kinks, jumps, and distributions that four moments
//! do not represent.
//!
//! ```text
//! u_k(ln T) <= 1          the part of requirement k that is used, by the analysis itself
//! ```
//!
//! The search stays among tolerances that keep everything. A step goes to the solution of the separable problem with
//! the values and slopes of the uses. These come from differences of trials with the same random numbers, and the step
//! stays within a reach. If the solution misses a requirement, the step ends between. If no slope helps, each tolerance
//! is opened alone. Lists are searched by exchanges of one or two processes. Each trial is a whole analysis, so that
//! the result has the verdict of `analyze --check`.
//!
//! Sources: A. R. Conn, N. I. M. Gould, P. L. Toint, Trust-Region Methods (2000), for steps on verified values within a
//! reach; R. Hooke, T. A. Jeeves, "Direct search solution of numerical and statistical problems", J. ACM 8 (1961), for
//! opening one tolerance after the other.
//!
//! Cost: at most [`MOST`] analyses of a cheap model.

use std::sync::atomic::Ordering;

use crate::allocation::cost::priced_group::{Offer, Priced};
use crate::allocation::requirement::form::Basis;
use crate::allocation::requirement::linearised::Linearised;
use crate::allocation::requirement::registry::form_of;
use crate::allocation::search::driver::Driver;
use crate::allocation::search::trial::Trial;
use crate::problem::Problem;
use sensitol_numeric::optimise::separable::{PowerRow, SeparableProblem};

/// Greatest number of trials of one search.
const MOST: usize = 300;
/// Greatest number of values of dimensions at all points of these trials: some seconds of a formula.
const MOST_VALUES: u64 = 1 << 27;
/// Greatest number of rounds of steps, each with slopes of its own.
const ROUNDS: usize = 16;
/// Half of the difference in `ln T`: wide enough for a slope from samples of the model, and narrow beside a reach.
const STEP: f64 = 0.05;
/// Greatest number of free tolerances for slopes, each of which takes two trials.
const SLOPES: usize = 16;
/// First and last reach of a step in `ln T`.
const REACH: [f64; 2] = [0.5, 0.005];
/// Least relative saving for another round.
const GAIN: f64 = 2e-4;
/// Step in `ln T` below which a search has converged.
const STILL: f64 = 1e-3;
/// Greatest number of places to which slopes are followed. Each corrects the values at the one before.
const CORRECTIONS: usize = 4;
/// Trials between a place that keeps everything and one that does not, after a step by slopes, which ends near it.
const BETWEEN: usize = 3;
/// Trials between the best place and the result of the search by derivatives.
const APPROACH: usize = 5;
/// Greatest number of exchanges that are tried before a list is left unchanged.
const EXCHANGES: usize = 24;
/// Greatest number of exchanges of one process for which those of two are tried.
const PAIRED: usize = 60;
/// First step of the common factor, and its halvings, down to a ten-thousandth.
const FACTOR: (f64, usize) = (0.01, 7);

/// Search among trials, with the cheapest that keeps everything.
pub(in crate::allocation) struct VerifiedSearch<'s, 'a> {
    driver: &'s mut Driver<'a>,
    /// Problem with the nominal values and the dimensions without a cost.
    base: Problem,
    asked: usize,
    values: u64,
    best: Option<Trial>,
}

/// Half bands and offers of the groups.
pub(in crate::allocation) type Tolerances = (Vec<f64>, Vec<usize>);

impl<'s, 'a> VerifiedSearch<'s, 'a> {
    pub(in crate::allocation) fn new(driver: &'s mut Driver<'a>, base: Problem) -> Self {
        Self { driver, base, asked: 0, values: 0, best: None }
    }

    /// Cheapest trial found that keeps everything. The search begins at `starts`, which may or may not keep everything,
    /// and goes towards `aim`, the result of the search by derivatives.
    pub(in crate::allocation) fn run(mut self, starts: &[Tolerances], aim: Option<Tolerances>) -> Option<Trial> {
        starts.iter().chain(&aim).for_each(|(at, offers)| _ = self.ask(at, offers));
        if self.best.is_none() {
            self.enter(aim.as_ref().or(starts.first()));
        }
        let mut phase = Phase::Approach { cost: self.best.as_ref()?.cost };
        while phase != Phase::Done {
            match phase {
                Phase::Approach { .. } => self.approach(aim.as_ref()),
                Phase::Descend { .. } => self.descend(),
                Phase::Exchange { .. } => while self.exchange() {},
                Phase::Open => self.open_all(),
                Phase::Done => {}
            }
            phase = phase.next(self.best.as_ref()?.cost, self.is_over());
        }
        self.best
    }

    /// Largest common factor of tolerances in fixed proportions that keeps everything.
    pub(in crate::allocation) fn in_proportion(mut self, at: &[f64], offers: &[usize]) -> Option<Trial> {
        let scaled = |factor: f64| at.iter().map(|t| t * factor).collect::<Vec<f64>>();
        let mut factor = 1.0;
        while !self.is_over() && self.ask(&scaled(factor), offers).is_none_or(|kept| !kept) {
            factor *= 0.7;
        }
        self.open_all();
        self.best
    }

    fn is_over(&self) -> bool {
        self.asked >= MOST || self.values >= MOST_VALUES || self.driver.spent.stopped || self.driver.run.stopped()
    }

    fn priced(&self) -> &'a [Priced] {
        &self.driver.task.priced
    }

    /// Tries tolerances, and returns true if they keep everything. The cheapest of these are stored. Returns None if
    /// there is no answer.
    fn ask(&mut self, at: &[f64], offers: &[usize]) -> Option<bool> {
        let trial = self.trial(at, offers)?;
        let kept = trial.is_kept();
        self.remember(trial);
        Some(kept)
    }

    fn trial(&mut self, at: &[f64], offers: &[usize]) -> Option<Trial> {
        if self.is_over() {
            return None;
        }
        self.asked += 1;
        let trial = self.driver.trial(&self.base, at, offers)?;
        let verified = trial
            .analysis
            .characteristics
            .iter()
            .filter_map(|one| Some(one.evidence.verification.as_ref()?.points as u64));
        let points = trial.analysis.run.evaluations + verified.sum::<u64>();
        self.values += points * self.base.dimensions().len() as u64;
        self.driver.spent.points.fetch_add(points, Ordering::Relaxed);
        Some(trial)
    }

    fn remember(&mut self, trial: Trial) {
        let cheaper = self.best.as_ref().is_none_or(|best| trial.cost < best.cost);
        if cheaper && trial.is_kept() {
            self.best = Some(trial);
        }
    }

    /// Searches a place that keeps everything: the tightest tolerances, and places on the way to them.
    fn enter(&mut self, from: Option<&Tolerances>) {
        let tightest = |group: &Priced| {
            let all = group.offers.iter().enumerate();
            let (place, offer) = all.min_by(|a, b| a.1.min.total_cmp(&b.1.min)).expect("a group has an offer");
            (offer.min, place)
        };
        let (tight, offers): Tolerances = self.priced().iter().map(tightest).unzip();
        let from = from.filter(|from| from.1 == offers).map_or(&tight, |from| &from.0).clone();
        for part in [0.1, 0.25, 0.5, 0.75, 1.0] {
            let _: Option<bool> = self.ask(&between(&from, &tight, part), &offers);
            if self.best.is_some() {
                return;
            }
        }
        self.relax((tight, offers));
    }

    /// Lowers the largest use by moving one tolerance after the other. Both directions count, because a wide tolerance may move a mean
    /// favourably.
    fn relax(&mut self, (mut at, offers): Tolerances) {
        let Some(mut use_) = self.trial(&at, &offers).map(|trial| trial.use_()) else { return };
        for step in [1.0, 0.5, 0.25] {
            for g in 0..at.len() {
                for sign in [1.0, -1.0] {
                    let mut next = at.clone();
                    next[g] = self.within(g, offers[g], at[g] * libm::exp(sign * step));
                    let Some(trial) = self.trial(&next, &offers).filter(|_| next[g] != at[g]) else { continue };
                    if trial.use_() < use_ {
                        (at, use_) = (next, trial.use_());
                    }
                    self.remember(trial);
                    if self.best.is_some() {
                        return;
                    }
                }
            }
        }
    }

    fn within(&self, g: usize, offer: usize, t: f64) -> f64 {
        let Offer { min, max, .. } = &self.priced()[g].offers[offer];
        t.clamp(*min, *max)
    }

    /// Goes towards the result of the search by derivatives, as far as everything is kept.
    fn approach(&mut self, aim: Option<&Tolerances>) {
        let Some((best, (at, offers))) = self.best.as_ref().zip(aim) else { return };
        if best.offers == *offers
            && self.driver.held_cost(at, offers) < best.cost
            && let Some(outside) = self.trial(at, offers).map(|trial| self.remembered(trial))
        {
            self.interpolate(outside, APPROACH);
        }
    }

    /// Stores a trial if it is the best. Returns its values for the model of the uses.
    fn remembered(&mut self, trial: Trial) -> Measured {
        let measured = Measured::of(&trial);
        self.remember(trial);
        measured
    }

    /// Searches a place where a requirement is just kept, between the best tolerances and others outside.
    fn interpolate(&mut self, mut outside: Measured, trials: usize) {
        for _ in 0..trials {
            let Some(inside) = self.best.as_ref().map(Measured::of) else { return };
            if outside.kept || outside.cost >= inside.cost {
                return;
            }
            let part = (1.0 - inside.use_()) / (outside.use_() - inside.use_());
            let part = if part.is_finite() { part.clamp(0.1, 0.9) } else { 0.5 };
            let offers = self.best.as_ref().map(|best| best.offers.clone()).unwrap_or_default();
            let Some(trial) = self.trial(&between(&inside.at, &outside.at, part), &offers) else { return };
            let middle = self.remembered(trial);
            if !middle.kept {
                outside = middle;
            }
        }
    }

    /// Takes steps by slopes of the uses. If there are none or they do not help, it opens each tolerance alone.
    fn descend(&mut self) {
        let mut reach = REACH[0];
        for _ in 0..ROUNDS {
            if reach < REACH[1] {
                return;
            }
            let Some([before, after]) = self.step(reach) else { return };
            reach = next_reach(reach, is_worth_it(before, after));
        }
    }

    /// Takes one step within a reach. Returns the least cost before and after it, or None if no tolerance is free or the
    /// search is over.
    fn step(&mut self, reach: f64) -> Option<[f64; 2]> {
        let best = self.best.as_ref()?;
        let (offers, cost) = (&best.offers, best.cost);
        let free: Vec<usize> = (0..offers.len()).filter(|&g| self.is_free(g, offers[g])).collect();
        if free.is_empty() || self.is_over() {
            return None;
        }
        let slopes = if free.len() <= SLOPES { self.slopes(&free) } else { None };
        let followed = slopes.is_some_and(|slopes| self.follow(&slopes, reach));
        if !followed {
            self.poll(&free, reach);
        }
        Some([cost, self.best.as_ref().map_or(cost, |best| best.cost)])
    }

    fn is_free(&self, g: usize, offer: usize) -> bool {
        let Offer { min, max, .. } = &self.priced()[g].offers[offer];
        min < max
    }

    /// Slopes of the uses at the best tolerances, by differences of trials.
    fn slopes(&mut self, free: &[usize]) -> Option<Slopes> {
        let best = self.best.as_ref()?;
        let (centre, offers) = (Measured::of(best), best.offers.clone());
        let linear: Vec<bool> = best.judged.iter().map(|one| form_of(&one.requirement).basis() == Basis::Box).collect();
        let (groups, rows) = (centre.at.len(), centre.uses.len());
        let mut slopes =
            Slopes { centre, offers, linear, of_uses: vec![vec![0.0; groups]; rows], of_loss: vec![0.0; groups] };
        for &g in free {
            let mut side = |sign: f64| {
                let mut at = slopes.centre.at.clone();
                at[g] = self.within(g, slopes.offers[g], at[g] * libm::exp(sign * STEP));
                let trial = self.trial(&at, &slopes.offers)?;
                let measured = self.remembered(trial);
                // Without a value on one side the other side alone gives the slope.
                Some(if measured.is_known() { measured } else { slopes.centre.clone() })
            };
            let (up, down) = (side(1.0)?, side(-1.0)?);
            let apart = libm::log(up.at[g] / down.at[g]);
            if apart > 0.0 {
                for (k, row) in slopes.of_uses.iter_mut().enumerate() {
                    row[g] = (up.uses[k] - down.uses[k]) / apart;
                }
                slopes.of_loss[g] = (up.loss - down.loss) / apart;
            }
        }
        Some(slopes)
    }

    /// Follows slopes within a reach. Each place corrects the values from which the next step starts. Returns true if
    /// the result is cheaper.
    fn follow(&mut self, slopes: &Slopes, reach: f64) -> bool {
        let Some(before) = self.best.as_ref().map(|best| best.cost) else { return false };
        let (mut here, mut outside) = (slopes.centre.clone(), None);
        for _ in 0..CORRECTIONS {
            let Some(next) = self.corrected(slopes, &here, reach) else { break };
            here = next;
            if !here.kept {
                outside = Some(here.clone());
            }
            if !here.is_known() {
                break;
            }
        }
        if let Some(outside) = outside {
            self.interpolate(outside, BETWEEN);
        }
        self.best.as_ref().is_some_and(|best| best.cost < before - 0.1 * GAIN * before.abs())
    }

    /// Tries the solution by slopes with the values of a place. Returns None if it is that place, or has no answer.
    fn corrected(&mut self, slopes: &Slopes, here: &Measured, reach: f64) -> Option<Measured> {
        let to = slopes.solved(self.priced(), here, reach, !self.driver.task.losses.is_empty())?;
        let far = to.iter().zip(&here.at).map(|(to, t)| libm::log(to / t).abs()).fold(0.0, f64::max);
        if far < STILL {
            return None;
        }
        let trial = self.trial(&to, &slopes.offers)?;
        Some(self.remembered(trial))
    }

    /// Opens each free tolerance alone.
    fn poll(&mut self, free: &[usize], reach: f64) {
        for &g in free {
            let Some(best) = self.best.as_ref() else { return };
            let (mut at, offers, cost) = (best.at.clone(), best.offers.clone(), best.cost);
            let from = at[g];
            at[g] = self.within(g, offers[g], from * libm::exp(reach));
            if at[g] > from && self.driver.held_cost(&at, &offers) < cost {
                let _: Option<bool> = self.ask(&at, &offers);
            }
        }
    }

    /// Exchanges one process, or two. Returns true if an exchange is cheaper and keeps everything.
    fn exchange(&mut self) -> bool {
        let Some(cost) = self.best.as_ref().map(|best| best.cost) else { return false };
        for (_, (at, offers)) in self.cheaper_exchanges().into_iter().take(EXCHANGES) {
            let _: Option<bool> = self.ask(&at, &offers);
            let found = self.best.as_ref().is_some_and(|best| best.cost < cost);
            if found || self.is_over() {
                return found && !self.is_over();
            }
        }
        false
    }

    /// Exchanges of one and of two processes with their predicted costs, if these are less than the present cost, the
    /// cheapest first.
    fn cheaper_exchanges(&self) -> Vec<(f64, Tolerances)> {
        let Some(best) = self.best.as_ref() else { return Vec::new() };
        let (at, offers, cost) = (&best.at, &best.offers, best.cost);
        let single = self.exchanges(at, offers);
        let mut all: Vec<(f64, Tolerances)> = single.iter().map(|to| (self.held_and_lost(to), to.clone())).collect();
        // Long lists have too many exchanges of two.
        let pairs = if single.len() <= PAIRED { &single[..] } else { &[] };
        for (place, first) in pairs.iter().enumerate() {
            for second in &pairs[place + 1..] {
                let to = both_exchanges((at, offers), first, second);
                all.push((self.held_and_lost(&to), to));
            }
        }
        all.retain(|(predicted, _)| *predicted < cost - 1e-9 * cost.abs());
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    }

    /// Cost of an exchange with the present losses.
    fn held_and_lost(&self, (at, offers): &Tolerances) -> f64 {
        self.driver.held_cost(at, offers) + self.best.as_ref().map_or(0.0, |best| best.loss)
    }

    /// Every exchange of one process for another.
    fn exchanges(&self, at: &[f64], offers: &[usize]) -> Vec<Tolerances> {
        let mut all = Vec::new();
        for (g, group) in self.priced().iter().enumerate() {
            for other in (0..group.offers.len()).filter(|&other| other != offers[g]) {
                let (mut at, mut offers) = (at.to_vec(), offers.to_vec());
                (at[g], offers[g]) = (self.within(g, other, at[g]), other);
                all.push((at, offers));
            }
        }
        all
    }

    /// Opens all free tolerances by a common factor, as far as everything is kept.
    fn open_all(&mut self) {
        let (mut step, halvings) = FACTOR;
        for _ in 0..=halvings {
            while self.open(step) {}
            step *= 0.5;
        }
    }

    /// Opens all free tolerances by a step in `ln T`. Returns true if everything is kept at a lower cost.
    fn open(&mut self, step: f64) -> bool {
        let Some(best) = self.best.as_ref() else { return false };
        let (from, offers, cost) = (best.at.clone(), best.offers.clone(), best.cost);
        let at: Vec<f64> = (0..from.len()).map(|g| self.within(g, offers[g], from[g] * libm::exp(step))).collect();
        let kept = at != from && !self.is_over() && self.ask(&at, &offers) == Some(true);
        kept && self.best.as_ref().is_some_and(|best| best.cost < cost)
    }
}

/// Phase of a search among trials. `cost` is the least cost before the round.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    /// Way towards the result of the search by derivatives.
    Approach {
        cost: f64,
    },
    /// Steps of free tolerances.
    Descend {
        cost: f64,
    },
    /// Exchanges of processes.
    Exchange {
        cost: f64,
    },
    /// Common factor of all free tolerances.
    Open,
    Done,
}

impl Phase {
    /// Phase that follows, with the least cost `now`. Another round begins if this one was worth it.
    fn next(self, now: f64, is_over: bool) -> Self {
        match self {
            Self::Approach { cost } => Self::Descend { cost },
            Self::Descend { cost } => Self::Exchange { cost },
            Self::Exchange { cost } if now <= cost - GAIN * cost.abs() && !is_over => Self::Approach { cost: now },
            Self::Exchange { .. } => Self::Open,
            Self::Open | Self::Done => Self::Done,
        }
    }
}

/// True if a step saves enough for another one.
fn is_worth_it(before: f64, after: f64) -> bool {
    after < before - GAIN * before.abs()
}

/// Reach of the next step: wider after one that was worth it, and much narrower after another.
fn next_reach(reach: f64, worth_it: bool) -> f64 {
    if worth_it { (1.5 * reach).min(1.0) } else { 0.3 * reach }
}

/// Tolerances after two exchanges at once. The first counts where both exchange the same process.
fn both_exchanges((at, offers): (&[f64], &[usize]), first: &Tolerances, second: &Tolerances) -> Tolerances {
    let of_group = |g: usize| match g {
        g if first.1[g] != offers[g] => (first.0[g], first.1[g]),
        g if second.1[g] != offers[g] => (second.0[g], second.1[g]),
        _ => (at[g], offers[g]),
    };
    (0..at.len()).map(of_group).unzip()
}

/// Values of a trial at its tolerances.
#[derive(Clone)]
struct Measured {
    at: Vec<f64>,
    uses: Vec<f64>,
    loss: f64,
    cost: f64,
    kept: bool,
}

impl Measured {
    fn of(trial: &Trial) -> Self {
        let (at, uses) = (trial.at.clone(), trial.uses());
        Self { at, uses, loss: trial.loss, cost: trial.cost, kept: trial.is_kept() }
    }

    /// Largest used part of a requirement.
    fn use_(&self) -> f64 {
        self.uses.iter().copied().fold(0.0, f64::max)
    }

    fn is_known(&self) -> bool {
        self.uses.iter().all(|use_| use_.is_finite()) && self.loss.is_finite()
    }
}

/// Slopes of uses and losses by `ln T` of every group.
struct Slopes {
    centre: Measured,
    offers: Vec<usize>,
    /// True for each use that is a sum of tolerances, false for a sum of squares.
    linear: Vec<bool>,
    of_uses: Vec<Vec<f64>>,
    of_loss: Vec<f64>,
}

impl Slopes {
    /// Solution of the separable problem with these slopes and the values of a place, within a reach of the centre.
    fn solved(&self, priced: &[Priced], here: &Measured, reach: f64, with_loss: bool) -> Option<Vec<f64>> {
        let row = |(k, slopes): (usize, &Vec<f64>)| {
            Linearised::of_uses(here.uses[k], slopes.clone(), self.linear[k]).row(&here.at)
        };
        let rows: Vec<PowerRow> = self.of_uses.iter().enumerate().map(row).collect();
        let lost = with_loss.then(|| Linearised::of_squares(here.loss, self.of_loss.clone()).row(&here.at));
        let losses: Vec<PowerRow> = lost.into_iter().collect();
        let near = |(g, group): (usize, &Priced)| {
            let mut offer = group.offers[self.offers[g]].clone();
            let t = self.centre.at[g].clamp(offer.min, offer.max);
            (offer.min, offer.max) = (offer.min.max(t * libm::exp(-reach)), offer.max.min(t * libm::exp(reach)));
            Priced { offers: vec![offer], ..group.clone() }
        };
        let priced: Vec<Priced> = priced.iter().enumerate().map(near).collect();
        let separable = SeparableProblem { unknowns: &priced, rows: &rows, losses: &losses };
        let (_, to) = separable.solve(&vec![0.0; rows.len()]);
        to.iter().all(|t| t.is_finite() && *t > 0.0).then_some(to)
    }
}

/// Half bands at a part of the way between two others, in logarithms.
fn between(from: &[f64], to: &[f64], part: f64) -> Vec<f64> {
    from.iter().zip(to).map(|(from, to)| libm::exp((1.0 - part) * libm::log(*from) + part * libm::log(*to))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_follow_each_other_as_long_as_they_save() {
        let start = Phase::Approach { cost: 10.0 };
        let end_of_round = start.next(9.0, false).next(9.0, false);
        assert_eq!(end_of_round, Phase::Exchange { cost: 10.0 });
        assert_eq!(end_of_round.next(9.0, false), Phase::Approach { cost: 9.0 });
        // A saving below a five-thousandth, and the end of all trials, leave the common factor alone.
        assert_eq!(end_of_round.next(9.9999, false), Phase::Open);
        assert_eq!(end_of_round.next(9.0, true), Phase::Open);
        assert_eq!(Phase::Open.next(9.0, false), Phase::Done);
    }

    #[test]
    fn a_phase_in_a_round_does_not_end_it() {
        assert_eq!(Phase::Approach { cost: 10.0 }.next(1.0, true), Phase::Descend { cost: 10.0 });
    }

    #[test]
    fn the_reach_follows_the_saving() {
        assert!(is_worth_it(10.0, 9.9) && !is_worth_it(10.0, 9.999) && is_worth_it(-10.0, -10.1));
        assert_eq!([next_reach(0.5, true), next_reach(0.9, true), next_reach(0.5, false)], [0.75, 1.0, 0.15]);
    }

    #[test]
    fn two_exchanges_change_two_processes() {
        let (at, offers) = ([0.1, 0.2, 0.3], [0, 0, 0]);
        let first = (vec![0.5, 0.2, 0.3], vec![1, 0, 0]);
        let second = (vec![0.1, 0.2, 0.7], vec![0, 0, 2]);
        assert_eq!(both_exchanges((&at, &offers), &first, &second), (vec![0.5, 0.2, 0.7], vec![1, 0, 2]));
        let same_process = (vec![0.9, 0.2, 0.3], vec![2, 0, 0]);
        assert_eq!(both_exchanges((&at, &offers), &first, &same_process), first);
    }
}
