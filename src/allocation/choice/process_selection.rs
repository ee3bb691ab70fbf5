//! Choice of processes with distributions of their own: each choice has its own sigmas, means and distributions.
//!
//! If every requirement is a sum over the options, the lists are a knapsack ([`knapsack`](crate::allocation::choice::knapsack)). Such sums
//! are `s^2 T^2`, `|s| T`, or `s^2 sigma^2` about a fixed mean. Otherwise every choice is judged by the surface with
//! its distributions. All choices are examined from the cheapest on, up to the first that keeps everything. If there
//! are too many, exchanges improve the choice of the least sigmas.

use crate::allocation::choice::knapsack::cheapest;
use crate::allocation::choice::option_list::ListOption;
use crate::allocation::choice::outcome::Choice;
use crate::allocation::choice::single_offer::Setting;
use crate::allocation::cost::priced_group::{Offer, Priced};
use crate::allocation::requirement::constraint::{Constraint, kept};
use crate::allocation::requirement::form::Basis;
use crate::allocation::requirement::process_options::{OptionUses, ProcessOptions};
use crate::allocation::result::allocation::{AllocationSolver, Attainable, Proof};
use crate::allocation::result::solver_result::{Solved, Starts};
use crate::allocation::surface::response::Responses;
use sensitol_numeric::dimension::Dimension;

/// Greatest number of choices that are all examined.
const ALL: usize = 20_000;

/// True if some process has a distribution of its own.
pub(in crate::allocation) fn have_distributions(priced: &[Priced]) -> bool {
    priced.iter().flat_map(|group| &group.offers).any(|offer| offer.made.is_some())
}

/// Evaluation of choices against the requirements.
struct Judge<'s, 'a> {
    setting: &'s Setting<'a>,
    /// Dimensions of the members for every group and offer.
    options: Vec<Vec<Vec<Dimension>>>,
}

impl<'s, 'a> Judge<'s, 'a> {
    /// Returns None if an option cannot be applied to the present dimensions.
    fn of(setting: &'s Setting<'a>) -> Option<Self> {
        let dimensions = &setting.responses.dimensions;
        let option = |group: &Priced, offer: &Offer| -> Option<Vec<Dimension>> {
            group.offered(offer, dimensions, |_, share| share * offer.min).map(|(_, made)| made?.ok()).collect()
        };
        let of = |group: &Priced| group.offers.iter().map(|offer| option(group, offer)).collect();
        let options = setting.priced.iter().map(of).collect::<Option<_>>()?;
        Some(Self { setting, options })
    }

    fn at(&self, offers: &[usize]) -> Vec<f64> {
        self.setting.priced.iter().zip(offers).map(|(group, &offer)| group.offers[offer].min).collect()
    }

    /// Cost of the tolerances of a choice.
    fn held(&self, offers: &[usize]) -> f64 {
        let of = |(group, &offer): (&Priced, &usize)| {
            let offer = &group.offers[offer];
            group.parts * offer.curve.cost(offer.min)
        };
        self.setting.priced.iter().zip(offers).map(of).sum()
    }

    /// Responses with the dimensions of a choice.
    fn responses(&self, offers: &[usize]) -> Option<Responses> {
        let mut dimensions = self.setting.responses.dimensions.clone();
        for ((group, options), &offer) in self.setting.priced.iter().zip(&self.options).zip(offers) {
            for (&d, dimension) in group.members.iter().zip(&options[offer]) {
                dimensions[d] = dimension.clone();
            }
        }
        let by_law = |one: &Constraint| one.form().basis() == Basis::Distribution;
        self.setting.responses.with_dimensions(&dimensions, self.setting.constraints.iter().any(by_law))
    }

    /// Largest constraint at a choice, and its losses. Unless `whole`, the evaluation stops at the first constraint
    /// that is broken.
    fn value(&self, offers: &[usize], whole: bool) -> (f64, Option<f64>) {
        let base = self.setting.responses;
        let at = self.at(offers);
        let mut value: f64 = 0.0;
        let by_band = |one: &&Constraint| one.form().basis().is_by_band();
        for one in self.setting.constraints.iter().filter(by_band) {
            value = value.max(one.value(base, self.setting.priced, &at));
            if !whole && !kept(value) {
                return (value, None);
            }
        }
        let Some(own) = self.responses(offers) else { return (f64::INFINITY, None) };
        let ones = vec![1.0; own.dimensions.len()];
        for one in self.setting.constraints.iter().filter(|one| !by_band(one)) {
            value = value.max(one.form().value_of_choice(one, &own, &ones));
            if !whole && !kept(value) {
                return (value, None);
            }
        }
        let lost: Option<f64> = self.setting.losses.iter().map(|loss| loss.at(&own, &ones, None)).sum();
        (value, lost)
    }

    /// Lists with the use of every requirement by each option. Returns None if a requirement is not such a sum.
    fn lists(&self) -> Option<Vec<Vec<ListOption>>> {
        let Setting { responses, priced, constraints, losses, .. } = *self.setting;
        // Losses depend on the whole choice, not on a sum over its options.
        if !losses.is_empty() {
            return None;
        }
        let mut lists: Vec<Vec<ListOption>> = (priced.iter())
            .map(|group| {
                let option = |(place, offer): (usize, &Offer)| ListOption {
                    cost: group.parts * offer.curve.cost(offer.min),
                    uses: Vec::with_capacity(constraints.len()),
                    place,
                };
                group.offers.iter().enumerate().map(option).collect()
            })
            .collect();
        let options = ProcessOptions { responses, priced, dimensions: &self.options };
        for one in constraints {
            let OptionUses { slack, of_options } = one.form().option_uses(one, &options)?;
            if !(slack > 0.0 && slack.is_finite()) {
                return None;
            }
            for (list, uses) in lists.iter_mut().zip(of_options) {
                list.iter_mut().zip(uses).for_each(|(option, own)| option.uses.push(own / slack));
            }
        }
        lists.iter().flatten().all(|one| one.uses.iter().all(|&use_| use_ >= 0.0)).then_some(lists)
    }

    /// True if the surfaces represent the requirements exactly: they are straight, or slopes determine the worst case.
    fn is_exact(&self) -> bool {
        let exact = |one: &Constraint| one.form().is_exact_for_processes(one, self.setting.responses);
        self.setting.constraints.iter().all(exact)
    }

    fn found(&self, offers: Vec<usize>, lost: f64, bound: Option<f64>, nodes: usize) -> Choice {
        let at = self.at(&offers);
        let cost = self.held(&offers) + lost;
        let bound_is_exact = Some(bound.is_some() && self.is_exact());
        // No choice costs less than the cheapest option of every list.
        let least = |group: &Priced| {
            let of = group.offers.iter().map(|offer| group.parts * offer.curve.cost(offer.min));
            of.fold(f64::INFINITY, f64::min)
        };
        let bound = bound.unwrap_or_else(|| self.setting.priced.iter().map(least).sum()).min(cost);
        let solved = Solved {
            value: self.value(&offers, true).0,
            multipliers: vec![0.0; self.setting.constraints.len()],
            residual: 0.0,
            closed: false,
            converged: true,
            sequential: false,
            starts: Starts::default(),
            at,
            cost,
        };
        Choice::Found {
            solved,
            offers,
            proof: Proof {
                solver: Some(AllocationSolver::BranchAndBound),
                bound: Some(bound),
                bound_is_exact,
                nodes,
                ..Proof::default()
            },
        }
    }

    /// Examines every choice from the cheapest on. Returns None if none keeps everything, or the run was stopped.
    fn everything(&self) -> Option<Choice> {
        let counts: Vec<usize> = self.options.iter().map(Vec::len).collect();
        let picks = |mut code: usize| -> Vec<usize> {
            let digit = |&count: &usize| {
                let digit = code % count;
                code /= count;
                digit
            };
            counts.iter().map(digit).collect()
        };
        let all: usize = counts.iter().product();
        let mut choices: Vec<(f64, usize)> = (0..all).map(|code| (self.held(&picks(code)), code)).collect();
        choices.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut best: Option<(f64, Vec<usize>, f64)> = None;
        let mut nodes = 0;
        for (held, code) in choices {
            // Losses are never negative.
            if best.as_ref().is_some_and(|(cost, ..)| held >= *cost) || (self.setting.stopped)() {
                break;
            }
            nodes += 1;
            let offers = picks(code);
            let (value, lost) = self.value(&offers, false);
            let cheaper = |lost: f64| best.as_ref().is_none_or(|(cost, ..)| held + lost < *cost);
            if let Some(lost) = lost.filter(|&lost| kept(value) && cheaper(lost)) {
                best = Some((held + lost, offers, lost));
            }
        }
        let bound = |cost: f64| if (self.setting.stopped)() { None } else { Some(cost) };
        best.map(|(cost, offers, lost)| self.found(offers, lost, bound(cost), nodes))
    }

    /// Choice of the least sigmas, improved by exchanges.
    fn exchanged(&self) -> Option<Choice> {
        let mut offers = self.tightest();
        let mut nodes = 1;
        let (value, lost) = self.value(&offers, true);
        let mut cost = self.held(&offers) + lost.filter(|_| kept(value))?;
        loop {
            let mut better: Option<(f64, usize, usize)> = None;
            for g in 0..offers.len() {
                let present = offers[g];
                for i in (0..self.options[g].len()).filter(|&i| i != present) {
                    offers[g] = i;
                    let held = self.held(&offers);
                    let least = better.map_or(cost, |(least, ..)| least);
                    if held < least && !(self.setting.stopped)() {
                        nodes += 1;
                        let (value, lost) = self.value(&offers, false);
                        if let Some(lost) = lost.filter(|&lost| kept(value) && held + lost < least) {
                            better = Some((held + lost, g, i));
                        }
                    }
                }
                offers[g] = present;
            }
            let Some((now, g, i)) = better else { break };
            (offers[g], cost) = (i, now);
        }
        let lost = self.value(&offers, true).1?;
        Some(self.found(offers, lost, None, nodes))
    }

    /// Option of the least sigma of every group, and of these the tightest.
    fn tightest(&self) -> Vec<usize> {
        let size = |g: usize, i: usize| {
            let sigma = self.options[g][i].iter().map(Dimension::sigma).fold(0.0, f64::max);
            (sigma, self.setting.priced[g].offers[i].min)
        };
        let least = |g: usize| {
            let places = 0..self.options[g].len();
            places.min_by(|&a, &b| size(g, a).partial_cmp(&size(g, b)).unwrap_or(std::cmp::Ordering::Equal))
        };
        (0..self.options.len()).map(|g| least(g).unwrap_or(0)).collect()
    }

    /// Outcome without a choice: the requirement with the largest value at the choice of the least sigmas.
    fn none(&self) -> Choice {
        let offers = self.tightest();
        let at = self.at(&offers);
        let Some(own) = self.responses(&offers) else { return Choice::Stopped };
        let (base, priced) = (self.setting.responses, self.setting.priced);
        let ones = vec![1.0; own.dimensions.len()];
        let by_band = |one: &Constraint| one.form().basis().is_by_band();
        let value = |one: &&Constraint| match by_band(one) {
            true => one.value(base, priced, &at),
            false => one.form().value_of_choice(one, &own, &ones),
        };
        let worst = self.setting.constraints.iter().max_by(|a, b| value(a).total_cmp(&value(b)));
        let of = |one: &Constraint| Attainable {
            characteristic: one.characteristic,
            unit: None,
            requirement: one.requirement,
            joint: one.is_joint(),
            best: match by_band(one) {
                true => one.measured(base, priced, &at),
                false => one.measured(&own, &[], &[]),
            },
            because: Vec::new(),
            together: kept(value(&one)),
        };
        worst.map_or(Choice::Stopped, |worst| Choice::Infeasible(of(worst), at.clone()))
    }
}

/// Cheapest choice of processes with one tolerance each.
pub(in crate::allocation) fn choose_processes(setting: &Setting<'_>) -> Choice {
    let Some(judge) = Judge::of(setting) else { return Choice::Stopped };
    if let Some(lists) = judge.lists() {
        let found = cheapest(&lists, setting.stopped);
        // Sums in another order may differ by a last digit, so such a choice is judged again.
        if let Some(found) = found.filter(|found| kept(judge.value(&found.places, true).0)) {
            return judge.found(found.places, 0.0, Some(found.bound), found.nodes);
        }
    }
    let count = judge.options.iter().fold(1usize, |count, list| count.saturating_mul(list.len()));
    let found = if count <= ALL { judge.everything() } else { judge.exchanged() };
    match found {
        Some(found) => found,
        None if (setting.stopped)() => Choice::Stopped,
        None => judge.none(),
    }
}

/// True if all choices are examined, and the surfaces represent the requirements exactly.
pub(in crate::allocation) fn is_proof(setting: &Setting<'_>) -> bool {
    let count = setting.priced.iter().fold(1usize, |count, group| count.saturating_mul(group.offers.len()));
    count <= ALL && Judge::of(setting).is_some_and(|judge| judge.is_exact())
}
