//! Cheapest choice of processes: branch and bound on the dual of the convex relaxation.
//!
//! A node allows a range of processes for every group. Its bound is a dual value ([`separable`](sensitol_numeric::optimise::separable)). No
//! choice from these ranges can cost less, for any multipliers. Rounding and unfinished searches of multipliers make
//! the bound weaker, never wrong. Each split takes the group whose two best processes are nearest in priced value, and
//! divides its range between them. Source of the relaxation: A. M. Geoffrion, "Lagrangean relaxation for integer
//! programming", Mathematical Programming Study 2 (1974).
//!
//! Lists of single half bands with such sums are solved separately ([`knapsack`](crate::allocation::choice::knapsack)).
//!
//! Bounds are exact for worst cases and sums of squares. Other second-order moments are replaced by such sums with a
//! reserve: twice the greatest excess on random choices. Optimality then rests on that sample, and is not reported as
//! proven.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::Range;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::allocation::choice::knapsack::cheapest;
use crate::allocation::choice::option_list::ListOption;
use crate::allocation::choice::single_offer::Setting;
use crate::allocation::cost::priced_group::{Offer, Priced};
use crate::allocation::requirement::constraint::{KEPT, kept};
use crate::allocation::requirement::quality_loss::losses_at;
use crate::allocation::result::solver_result::{Solved, Starts};
use sensitol_numeric::optimise::separable::{BestOption, PowerRow, SeparableProblem};

/// Cheapest choice found.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::allocation) struct Chosen {
    pub(in crate::allocation) solved: Solved,
    /// Offer of every group.
    pub(in crate::allocation) offers: Vec<usize>,
    /// Lower bound of the cost of every choice.
    pub(in crate::allocation) bound: f64,
    /// Number of nodes examined.
    pub(in crate::allocation) nodes: usize,
    /// True if the bound is exact, false if it rests on a sample of choices.
    pub(in crate::allocation) rigorous: bool,
}

struct Node {
    bound: f64,
    ranges: Vec<Range<usize>>,
    multipliers: Vec<f64>,
}

impl PartialEq for Node {
    fn eq(&self, other: &Self) -> bool {
        self.bound == other.bound
    }
}

impl Eq for Node {}

impl PartialOrd for Node {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Node {
    /// Orders nodes so that the one with the lowest bound is the greatest, and leaves the heap first.
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound)
    }
}

/// Greatest number of nodes, which take a few seconds.
const NODES: usize = 400_000;
/// Greatest number of choices that are all examined if bounds would rest on a sample.
const ALL: usize = 20_000;
/// Number of random choices that measure the error of sums of squares.
const SAMPLE: usize = 400;
/// Steps of the multipliers at the root, and at every other node.
const STEPS: [usize; 2] = [400, 40];
/// Relative difference of costs within which they are the same.
const SAME: f64 = 1e-12;

struct Search<'a> {
    setting: Setting<'a>,
    rows: Vec<PowerRow>,
    losses: Vec<PowerRow>,
    incumbent: Option<(Solved, Vec<usize>)>,
    nodes: usize,
}

/// Cheapest choice of an offer for every group. Returns None if no choice was found that keeps the constraints.
pub(in crate::allocation) fn branch(setting: Setting<'_>, start: &[f64]) -> Option<Chosen> {
    let exact = setting.is_exact();
    let reference = reference(&setting, start)?;
    let mut rows: Vec<PowerRow> = setting.linearised(&reference)?.iter().map(|one| one.row(&reference)).collect();
    rows.iter_mut().for_each(|row| row.constant -= KEPT);
    let losses = setting.loss_rows(&reference)?;
    let mut search = Search { setting, rows, losses, incumbent: None, nodes: 0 };
    let discrete = setting.priced.iter().all(|group| group.offers.iter().all(|offer| offer.min == offer.max));
    let choices = setting.priced.iter().fold(1usize, |count, group| count.saturating_mul(group.offers.len()));
    if !exact && discrete && choices <= ALL {
        return search.everything();
    }
    if !exact {
        search.relax();
    }
    if let Some(lists) = search.lists().filter(|_| exact && discrete) {
        return search.chosen_of(&lists);
    }
    search.run(exact)
}

/// Tolerances near the start at which the constraints are finite.
fn reference(setting: &Setting<'_>, start: &[f64]) -> Option<Vec<f64>> {
    let bounds = setting.bounds();
    let parts = [0.0, 0.25, 0.5, 0.75, 1.0];
    let toward = |part: f64| -> Vec<f64> {
        start
            .iter()
            .zip(&bounds)
            .map(|(t, &[low, high])| libm::pow(t.clamp(low, high), 1.0 - part) * libm::pow(low, part))
            .collect()
    };
    parts.iter().map(|&part| toward(part)).find(|at| setting.linearised(at).is_some())
}

impl Search<'_> {
    /// Lists of single half bands with the use of every row by each. Returns None if a row has no slack or a negative
    /// use.
    fn lists(&self) -> Option<Vec<Vec<ListOption>>> {
        let room: Vec<f64> = self.rows.iter().map(|row| 1.0 - row.constant).collect();
        if room.iter().any(|&room| room <= 0.0) {
            return None;
        }
        let list = |(g, group): (usize, &Priced)| {
            let option = |(place, offer): (usize, &Offer)| {
                let t = offer.min;
                let lost: f64 = self.losses.iter().map(|row| row.terms[g].value(t)).sum();
                let uses = self.rows.iter().zip(&room).map(|(row, room)| row.terms[g].value(t) / room).collect();
                ListOption { cost: group.parts * offer.curve.cost(t) + lost, uses, place }
            };
            group.offers.iter().enumerate().map(option).collect()
        };
        let lists: Vec<Vec<ListOption>> = self.setting.priced.iter().enumerate().map(list).collect();
        lists.iter().flatten().all(|one| one.uses.iter().all(|&use_| use_ >= 0.0)).then_some(lists)
    }

    /// Cheapest choice from lists.
    fn chosen_of(&self, lists: &[Vec<ListOption>]) -> Option<Chosen> {
        let found = cheapest(lists, self.setting.stopped)?;
        let (solved, value) = self.judged(&found.places)?;
        let lost: f64 = self.losses.iter().map(|row| row.constant).sum();
        let bound = (found.bound + lost).min(solved.cost);
        kept(value).then_some(Chosen { solved, offers: found.places, bound, nodes: found.nodes, rigorous: true })
    }

    fn run(mut self, rigorous: bool) -> Option<Chosen> {
        let whole: Vec<Range<usize>> = self.setting.priced.iter().map(|group| 0..group.offers.len()).collect();
        let mut open = BinaryHeap::new();
        open.push(Node { bound: f64::NEG_INFINITY, ranges: whole, multipliers: vec![0.0; self.rows.len()] });
        let mut bound = f64::INFINITY;
        while let Some(mut node) = open.pop() {
            let known = self.known();
            if node.bound >= known * (1.0 - SAME) {
                bound = known;
                break;
            }
            if self.nodes >= NODES || self.nodes.is_multiple_of(16) && self.nodes > 0 && (self.setting.stopped)() {
                bound = node.bound;
                break;
            }
            let steps = STEPS[usize::from(self.nodes > 0)];
            self.nodes += 1;
            if !self.possible(&node.ranges) {
                continue;
            }
            let priced = self.setting.priced;
            let (rows, losses) = (std::mem::take(&mut self.rows), std::mem::take(&mut self.losses));
            let problem = SeparableProblem { unknowns: priced, rows: &rows, losses: &losses };
            let (value, best) = problem.bounded(&node.ranges, &mut node.multipliers, known, steps);
            node.bound = node.bound.max(value);
            let split = split(&problem, &node, &best);
            (self.rows, self.losses) = (rows, losses);
            self.try_from(&best);
            if node.bound >= self.known() * (1.0 - SAME) {
                continue;
            }
            let Some((g, at)) = split else {
                // Only one choice is left, and its own optimum was tried.
                continue;
            };
            let Range { start, end } = node.ranges[g];
            for part in [start..at, at..end] {
                let mut ranges = node.ranges.clone();
                ranges[g] = part;
                open.push(Node { bound: node.bound, ranges, multipliers: node.multipliers.clone() });
            }
        }
        let nodes = self.nodes;
        let (solved, offers) = self.incumbent?;
        Some(Chosen { bound: bound.min(solved.cost), solved, offers, nodes, rigorous })
    }

    fn known(&self) -> f64 {
        self.incumbent.as_ref().map_or(f64::INFINITY, |(solved, _)| solved.cost)
    }

    /// True if every constraint alone could be kept with the best offer of every group for it.
    fn possible(&self, ranges: &[Range<usize>]) -> bool {
        self.rows.iter().all(|row| {
            let least = row.terms.iter().zip(ranges).zip(self.setting.priced).map(|((term, range), group)| {
                let ends = group.offers[range.clone()].iter().flat_map(|offer| [offer.min, offer.max]);
                ends.map(|t| term.value(t)).fold(f64::INFINITY, f64::min)
            });
            row.constant + least.sum::<f64>() <= 1.0 + 1e-9
        })
    }

    /// Repairs a choice, and keeps it if it is better than the best so far. It is tightened until it keeps the
    /// constraints, then loosened as far as it does.
    fn try_from(&mut self, best: &[BestOption]) {
        let mut offers: Vec<usize> = best.iter().map(|best| best.option).collect();
        let mut value = self.judged(&offers).map_or_else(|| self.quick(&offers).max(1.0 + 1e-9), |(_, value)| value);
        while !kept(value) {
            let mut better: Option<(f64, usize, usize, f64)> = None;
            for g in 0..offers.len() {
                let present = offers[g];
                for offer in 0..self.setting.priced[g].offers.len() {
                    if offer == present {
                        continue;
                    }
                    offers[g] = offer;
                    let now = self.quick(&offers);
                    if now < value {
                        let gain = (value.min(1e6) - now.max(1.0)).max(1e-12);
                        let price = (self.price(g, offer) - self.price(g, present)).max(1e-12);
                        if better.is_none_or(|(ratio, ..)| gain / price > ratio) {
                            better = Some((gain / price, g, offer, now));
                        }
                    }
                }
                offers[g] = present;
            }
            let Some((_, g, offer, _)) = better else { return };
            offers[g] = offer;
            let now = self.judged(&offers).map_or(f64::INFINITY, |(_, value)| value);
            if now >= value && !kept(now) {
                return;
            }
            value = now;
        }
        self.consider(offers.clone());
        for g in 0..offers.len() {
            let present = offers[g];
            let mut cheaper: Vec<usize> = (0..self.setting.priced[g].offers.len())
                .filter(|&offer| self.price(g, offer) < self.price(g, present))
                .collect();
            cheaper.sort_by(|&a, &b| self.price(g, a).total_cmp(&self.price(g, b)));
            for offer in cheaper {
                offers[g] = offer;
                if kept(self.quick(&offers)) {
                    break;
                }
                offers[g] = present;
            }
        }
        self.consider(offers);
    }

    /// Keeps the optimum with these offers if it is the best so far.
    fn consider(&mut self, offers: Vec<usize>) {
        let better = |(solved, value): &(Solved, f64)| kept(*value) && solved.cost < self.known() * (1.0 - SAME);
        if let Some((solved, _)) = self.judged(&offers).filter(better) {
            self.incumbent = Some((solved, offers));
        }
    }

    /// Approximate cost of an offer of a group: that of its loosest half band.
    fn price(&self, g: usize, offer: usize) -> f64 {
        let offer = &self.setting.priced[g].offers[offer];
        offer.curve.cost(offer.max)
    }

    /// Largest constraint with every offer at its tightest.
    fn quick(&self, offers: &[usize]) -> f64 {
        let at: Vec<f64> =
            offers.iter().zip(self.setting.priced).map(|(&offer, group)| group.offers[offer].min).collect();
        self.setting.value(&at)
    }

    /// Optimum with these offers, and its largest constraint.
    fn judged(&self, offers: &[usize]) -> Option<(Solved, f64)> {
        let priced: Vec<Priced> = (self.setting.priced.iter().zip(offers))
            .map(|(group, &offer)| Priced { offers: vec![group.offers[offer].clone()], ..group.clone() })
            .collect();
        let setting = Setting { priced: &priced, ..self.setting };
        let tight: Vec<f64> = priced.iter().map(Priced::tightest).collect();
        if priced.iter().all(|group| group.tightest() == group.loosest()) {
            let value = setting.value(&tight);
            let cost = setting.cost(&tight);
            let multipliers = vec![0.0; setting.constraints.len()];
            let starts = Starts::default();
            let solved = Solved {
                at: tight,
                cost,
                multipliers,
                residual: 0.0,
                value,
                closed: false,
                converged: true,
                sequential: false,
                starts,
            };
            return Some((solved, value));
        }
        match setting.solve(&tight) {
            Some(solved) => {
                let value = setting.value(&solved.at);
                Some((solved, value))
            }
            None => None,
        }
    }

    /// Examines every choice, if there are few.
    fn everything(mut self) -> Option<Chosen> {
        let counts: Vec<usize> = self.setting.priced.iter().map(|group| group.offers.len()).collect();
        let mut offers = vec![0; counts.len()];
        loop {
            self.nodes += 1;
            let held: f64 = (self.setting.priced.iter().zip(&offers))
                .map(|(group, &offer)| group.parts * group.offers[offer].curve.cost(group.offers[offer].min))
                .sum();
            let at: Vec<f64> =
                offers.iter().zip(self.setting.priced).map(|(&offer, group)| group.offers[offer].min).collect();
            let cost = held + losses_at(self.setting.losses, self.setting.responses, self.setting.priced, &at);
            if cost < self.known() * (1.0 - SAME) && kept(self.quick(&offers)) {
                let (solved, _) = self.judged(&offers)?;
                self.incumbent = Some((solved, offers.clone()));
            }
            let Some(g) = (0..counts.len()).find(|&g| offers[g] + 1 < counts[g]) else { break };
            offers[g] += 1;
            offers[..g].fill(0);
            if (self.setting.stopped)() {
                let nodes = self.nodes;
                let (solved, offers) = self.incumbent?;
                return Some(Chosen { bound: f64::NEG_INFINITY, solved, offers, nodes, rigorous: true });
            }
        }
        let nodes = self.nodes;
        let (solved, offers) = self.incumbent?;
        Some(Chosen { bound: solved.cost, solved, offers, nodes, rigorous: true })
    }

    /// Gives every row a reserve: twice its greatest excess over the true value on random choices.
    fn relax(&mut self) {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut reserve = vec![0.0f64; self.rows.len()];
        for _ in 0..SAMPLE {
            let at: Vec<f64> = (self.setting.priced.iter())
                .map(|group| {
                    let offer = &group.offers[rng.random_range(0..group.offers.len())];
                    let part: f64 = rng.random();
                    (libm::pow(offer.min, 1.0 - part) * libm::pow(offer.max, part)).clamp(offer.min, offer.max)
                })
                .collect();
            for (k, constraint) in self.setting.constraints.iter().enumerate() {
                let value = constraint.value(self.setting.responses, self.setting.priced, &at);
                // A constraint far beyond its limit needs no accurate row.
                if value.is_finite() && value < 4.0 {
                    reserve[k] = reserve[k].max(self.rows[k].value(&at) - value);
                }
            }
        }
        self.rows.iter_mut().zip(reserve).for_each(|(row, reserve)| row.constant -= 2.0 * reserve);
    }
}

/// Group whose two best processes are nearest in priced value, and the place of the split in its range. Returns None if
/// every group has a single one.
fn split(problem: &SeparableProblem<'_, Priced>, node: &Node, best: &[BestOption]) -> Option<(usize, usize)> {
    let mut nearest: Option<(f64, usize, usize)> = None;
    for (g, range) in node.ranges.iter().enumerate().filter(|(_, range)| range.len() > 1) {
        for offer in range.clone().filter(|&offer| offer != best[g].option) {
            let other = problem.best(g, &node.multipliers, offer..offer + 1);
            let regret = other.value - best[g].value;
            if nearest.is_none_or(|(least, ..)| regret < least) {
                nearest = Some((regret, g, offer.max(best[g].option)));
            }
        }
    }
    nearest.map(|(_, g, at)| (g, at))
}
