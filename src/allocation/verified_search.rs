//! A search by trials alone, where derivatives do not follow the model: at kinks, jumps and laws that four moments do not tell.
//!
//! ```text
//! u_k(ln T) <= 1          the part of requirement k that is used, by the analysis itself
//! ```
//!
//! The search stays among tolerances that keep everything. A step goes to the solution of the separable problem that has the values and
//! slopes of the uses, by differences of trials with the same random numbers, no farther than a reach; where that misses a requirement, as far
//! towards it as everything is kept. Where no slope leads on, one tolerance after the other is opened. Lists are searched by exchanges of one
//! process or two. Each trial is a whole analysis, so that what is found is what `analyze --check` says.
//!
//! Sources: for steps on verified values within a reach, A. R. Conn, N. I. M. Gould, P. L. Toint, Trust-Region Methods (2000); for the polls,
//! R. Hooke, T. A. Jeeves, "Direct search solution of numerical and statistical problems", J. ACM 8 (1961).
//!
//! Cost: at most [`MOST`] analyses of a cheap model.

use std::sync::atomic::Ordering;

use super::constraint::Linearised;
use super::cost::{Offer, Priced};
use super::driver::Driver;
use super::separable::{Row, Separable};
use super::trial::Trial;
use crate::problem::Problem;
use sensitol_numeric::requirement::Requirement;

/// Trials of one search, and values of dimensions at all points of these: some seconds of a formula.
const MOST: usize = 300;
const MOST_VALUES: u64 = 1 << 27;
/// Rounds of steps, each with slopes of its own.
const ROUNDS: usize = 16;
/// Half a difference in `ln T`: wide enough that samples of the model show a slope, and narrow beside a reach.
const STEP: f64 = 0.05;
/// Free tolerances up to which slopes are taken: each takes two trials.
const SLOPES: usize = 16;
/// The first reach of a step in `ln T`, and the last.
const REACH: [f64; 2] = [0.5, 0.005];
/// A part of the cost that is worth another round.
const GAIN: f64 = 2e-4;
/// A step in `ln T` that is none.
const STILL: f64 = 1e-3;
/// Places that slopes are followed to, each of which corrects the values at the one before.
const CORRECTIONS: usize = 4;
/// Trials between a place that keeps everything and one that does not: after slopes, which end near it, and towards the end of a search.
const BETWEEN: usize = 3;
const APPROACH: usize = 5;
/// Exchanges that are tried before a list is left as it is.
const EXCHANGES: usize = 24;
/// Exchanges of one process up to which those of two are looked at.
const PAIRED: usize = 60;
/// The first step of the common factor, and its halvings: a ten-thousandth at last.
const FACTOR: (f64, usize) = (0.01, 7);

/// A search among trials, with the cheapest that keeps everything.
pub(super) struct VerifiedSearch<'s, 'a> {
    driver: &'s mut Driver<'a>,
    /// The nominal values, and what has no cost.
    base: Problem,
    asked: usize,
    values: u64,
    best: Option<Trial>,
}

/// Half bands and offers of the groups.
pub(super) type Tolerances = (Vec<f64>, Vec<usize>);

impl<'s, 'a> VerifiedSearch<'s, 'a> {
    pub(super) fn new(driver: &'s mut Driver<'a>, base: Problem) -> Self {
        Self { driver, base, asked: 0, values: 0, best: None }
    }

    /// The cheapest trial found that keeps everything: from `starts`, which do or do not, and towards `aim`, where derivatives lead.
    pub(super) fn run(mut self, starts: &[Tolerances], aim: Option<Tolerances>) -> Option<Trial> {
        starts.iter().chain(&aim).for_each(|(at, offers)| _ = self.ask(at, offers));
        if self.best.is_none() {
            self.enter(aim.as_ref().or(starts.first()));
        }
        let mut cost = self.best.as_ref()?.cost;
        loop {
            self.approach(aim.as_ref());
            self.descend();
            self.exchange();
            let now = self.best.as_ref()?.cost;
            if now > cost - GAIN * cost.abs() || self.is_over() {
                break;
            }
            cost = now;
        }
        self.open_all();
        self.best
    }

    /// The largest common factor of tolerances in fixed proportions with which everything is kept.
    pub(super) fn in_proportion(mut self, at: &[f64], offers: &[usize]) -> Option<Trial> {
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

    /// Whether tolerances keep everything; None where there is no answer. The cheapest that do are remembered.
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
        let verified =
            trial.analysis.characteristics.iter().filter_map(|one| Some(one.verification.as_ref()?.points as u64));
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

    /// Looks for a place that keeps everything: the tightest tolerances, and places on the way to them.
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

    /// Follows the largest use downward, one tolerance after the other: wide ones may move a mean the right way.
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

    /// Goes towards tolerances to which derivatives lead, as far as everything is kept.
    fn approach(&mut self, aim: Option<&Tolerances>) {
        let Some((best, (at, offers))) = self.best.as_ref().zip(aim) else { return };
        if best.offers == *offers
            && self.driver.held_cost(at, offers) < best.cost
            && let Some(outside) = self.trial(at, offers).map(|trial| self.remembered(trial))
        {
            self.interpolate(outside, APPROACH);
        }
    }

    /// Remembers a trial; what a model of the uses takes from it.
    fn remembered(&mut self, trial: Trial) -> Measured {
        let measured = Measured::of(&trial);
        self.remember(trial);
        measured
    }

    /// Looks between the best and tolerances outside for where a requirement is just kept.
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

    /// Steps by slopes of the uses, and polls where there are none or they lead nowhere.
    fn descend(&mut self) {
        let mut reach = REACH[0];
        for _ in 0..ROUNDS {
            let Some(best) = self.best.as_ref() else { return };
            let (offers, cost) = (best.offers.clone(), best.cost);
            let free: Vec<usize> = (0..offers.len()).filter(|&g| self.is_free(g, offers[g])).collect();
            if free.is_empty() || self.is_over() || reach < REACH[1] {
                return;
            }
            let slopes = if free.len() <= SLOPES { self.slopes(&free) } else { None };
            let followed = slopes.is_some_and(|slopes| self.follow(&slopes, reach));
            if !followed {
                self.poll(&free, reach);
            }
            let now = self.best.as_ref().map_or(cost, |best| best.cost);
            let worth = now < cost - GAIN * cost.abs();
            reach = if worth { (1.5 * reach).min(1.0) } else { 0.3 * reach };
        }
    }

    fn is_free(&self, g: usize, offer: usize) -> bool {
        let Offer { min, max, .. } = &self.priced()[g].offers[offer];
        min < max
    }

    /// The slopes of the uses at the best, by differences of trials.
    fn slopes(&mut self, free: &[usize]) -> Option<Slopes> {
        let best = self.best.as_ref()?;
        let (centre, offers) = (Measured::of(best), best.offers.clone());
        let linear: Vec<bool> = best.judged.iter().map(|one| one.requirement == Requirement::WorstCase).collect();
        let (groups, rows) = (centre.at.len(), centre.uses.len());
        let mut slopes =
            Slopes { centre, offers, linear, of_uses: vec![vec![0.0; groups]; rows], of_loss: vec![0.0; groups] };
        for &g in free {
            let mut side = |sign: f64| {
                let mut at = slopes.centre.at.clone();
                at[g] = self.within(g, slopes.offers[g], at[g] * libm::exp(sign * STEP));
                let trial = self.trial(&at, &slopes.offers)?;
                let measured = self.remembered(trial);
                // Without a value on one side the other one tells.
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

    /// Follows slopes within a reach: each next place corrects the values that they start from. Says whether that is cheaper.
    fn follow(&mut self, slopes: &Slopes, reach: f64) -> bool {
        let Some(before) = self.best.as_ref().map(|best| best.cost) else { return false };
        let (mut here, mut outside) = (slopes.centre.clone(), None);
        for _ in 0..CORRECTIONS {
            let Some(to) = slopes.solved(self.priced(), &here, reach, !self.driver.task.losses.is_empty()) else {
                break;
            };
            let far = to.iter().zip(&here.at).map(|(to, t)| libm::log(to / t).abs()).fold(0.0, f64::max);
            if far < STILL {
                break;
            }
            let Some(trial) = self.trial(&to, &slopes.offers) else { break };
            here = self.remembered(trial);
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

    /// Opens one free tolerance after the other.
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

    /// Exchanges of one process, then of two, as long as one of them is cheaper and keeps everything.
    fn exchange(&mut self) {
        loop {
            let Some(best) = self.best.as_ref() else { return };
            let (at, offers, cost) = (best.at.clone(), best.offers.clone(), best.cost);
            let single = self.exchanges(&at, &offers);
            let mut all: Vec<(f64, Tolerances)> =
                single.iter().map(|to| (self.held_and_lost(to), to.clone())).collect();
            // Of long lists the exchanges of two are too many.
            let pairs = if single.len() <= PAIRED { &single[..] } else { &[] };
            for (place, (first, of_first)) in pairs.iter().enumerate() {
                for (second, of_second) in &pairs[place + 1..] {
                    let both = |own: usize| match own {
                        g if of_first[g] != offers[g] => Some((first[g], of_first[g])),
                        g if of_second[g] != offers[g] => Some((second[g], of_second[g])),
                        _ => None,
                    };
                    let to: Tolerances = (0..at.len()).map(|g| both(g).unwrap_or((at[g], offers[g]))).unzip();
                    all.push((self.held_and_lost(&to), to));
                }
            }
            all.retain(|(predicted, _)| *predicted < cost - 1e-9 * cost.abs());
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut found = false;
            for (_, (at, offers)) in all.into_iter().take(EXCHANGES) {
                let _: Option<bool> = self.ask(&at, &offers);
                found = self.best.as_ref().is_some_and(|best| best.cost < cost);
                if found || self.is_over() {
                    break;
                }
            }
            if !found || self.is_over() {
                return;
            }
        }
    }

    /// The cost that an exchange would have with the losses as they are.
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

    /// Opens all free tolerances by one factor, as far as everything is kept.
    fn open_all(&mut self) {
        let (mut step, halvings) = FACTOR;
        for _ in 0..=halvings {
            while let Some(best) = self.best.as_ref() {
                let (from, offers, cost) = (best.at.clone(), best.offers.clone(), best.cost);
                let at: Vec<f64> =
                    (0..from.len()).map(|g| self.within(g, offers[g], from[g] * libm::exp(step))).collect();
                if at == from || self.is_over() || self.ask(&at, &offers) != Some(true) {
                    break;
                }
                if self.best.as_ref().is_none_or(|best| best.cost >= cost) {
                    break;
                }
            }
            step *= 0.5;
        }
    }
}

/// The findings of a trial about its tolerances.
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

    /// The largest part of a requirement that is used.
    fn use_(&self) -> f64 {
        self.uses.iter().copied().fold(0.0, f64::max)
    }

    fn is_known(&self) -> bool {
        self.uses.iter().all(|use_| use_.is_finite()) && self.loss.is_finite()
    }
}

/// The slopes of uses and losses by `ln T` of every group.
struct Slopes {
    centre: Measured,
    offers: Vec<usize>,
    /// Whether each use is a sum of tolerances, rather than of squares.
    linear: Vec<bool>,
    of_uses: Vec<Vec<f64>>,
    of_loss: Vec<f64>,
}

impl Slopes {
    /// The solution of the separable problem with these slopes and the values of a place, within a reach of the centre.
    fn solved(&self, priced: &[Priced], here: &Measured, reach: f64, with_loss: bool) -> Option<Vec<f64>> {
        let row = |(k, slopes): (usize, &Vec<f64>)| {
            Linearised::of_uses(here.uses[k], slopes.clone(), self.linear[k]).row(&here.at)
        };
        let rows: Vec<Row> = self.of_uses.iter().enumerate().map(row).collect();
        let lost = with_loss.then(|| Linearised::of_squares(here.loss, self.of_loss.clone()).row(&here.at));
        let losses: Vec<Row> = lost.into_iter().collect();
        let near = |(g, group): (usize, &Priced)| {
            let mut offer = group.offers[self.offers[g]].clone();
            let t = self.centre.at[g].clamp(offer.min, offer.max);
            (offer.min, offer.max) = (offer.min.max(t * libm::exp(-reach)), offer.max.min(t * libm::exp(reach)));
            Priced { offers: vec![offer], ..group.clone() }
        };
        let priced: Vec<Priced> = priced.iter().enumerate().map(near).collect();
        let separable = Separable { priced: &priced, rows: &rows, losses: &losses };
        let (_, to) = separable.solve(&vec![0.0; rows.len()]);
        to.iter().all(|t| t.is_finite() && *t > 0.0).then_some(to)
    }
}

/// Part of the way between half bands, in logarithms.
fn between(from: &[f64], to: &[f64], part: f64) -> Vec<f64> {
    from.iter().zip(to).map(|(from, to)| libm::exp((1.0 - part) * libm::log(*from) + part * libm::log(*to))).collect()
}
