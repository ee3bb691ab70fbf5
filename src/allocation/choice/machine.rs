//! Set-up costs of machines that several dimensions share.
//!
//! ```text
//! min over sets S of machines  [ sum_m in S setup_m + least cost with processes of machines in S, and of none ]
//! ```
//!
//! Each choice is charged only for the machines that it uses, so that the least over all sets is the least cost. Sets
//! are examined in the order of their set-up costs. The search ends where these and the least cost with all machines
//! exceed the best choice.

use crate::allocation::choice::selection::{Choice, choose_alone};
use crate::allocation::choice::single_offer::Setting;
use crate::allocation::cost::priced_group::{Offer, Priced};
use crate::allocation::cost::setup_cost::{SetUp, needed};
use crate::allocation::result::allocation::Proof;

/// Relative difference of costs within which they are the same.
const SAME: f64 = 1e-12;

/// Cheapest tolerances at fixed derivatives, including set-up costs.
pub(in crate::allocation) fn choose(setting: &Setting<'_>, start: &[f64]) -> Choice {
    if any(setting.priced) { choose_machines(setting, start) } else { choose_alone(setting, start) }
}

/// True if some process needs a machine.
fn any(priced: &[Priced]) -> bool {
    priced.iter().flat_map(|group| &group.offers).any(|offer| offer.machine.is_some())
}

/// Cheapest choice including the set-up costs of its machines.
fn choose_machines(setting: &Setting<'_>, start: &[f64]) -> Choice {
    let every: Vec<&Offer> = setting.priced.iter().flat_map(|group| &group.offers).collect();
    let setups = needed(setting.setups, &every);
    let (least, first) = match choose_alone(setting, start) {
        Choice::Found { solved, offers, proof } => {
            let least = proof.bound.unwrap_or(solved.cost).min(solved.cost);
            (least, used(setting, &setups, &offers))
        }
        none => return none,
    };
    let of = |set: usize| -> f64 {
        setups.iter().enumerate().filter(|(m, _)| set >> m & 1 == 1).map(|(_, setup)| setup.cost).sum()
    };
    let mut sets: Vec<usize> = (0..1usize << setups.len()).collect();
    sets.sort_by(|&a, &b| of(a).total_cmp(&of(b)));
    // The choice without set-up costs is a good one to begin with.
    sets.insert(0, first);
    let (mut best, mut bound, mut nodes, mut rigorous) = (None, f64::INFINITY, 0, true);
    for (place, &set) in sets.iter().enumerate() {
        let known = best.as_ref().map_or(f64::INFINITY, |(cost, ..): &(f64, _, _, _)| *cost);
        if place > 0 && (set == first || of(set) + least >= known * (1.0 - SAME)) {
            continue;
        }
        let Some((priced, places)) = restricted(setting, &setups, set) else { continue };
        match choose_alone(&Setting { priced: &priced, ..*setting }, start) {
            Choice::Found { mut solved, offers, proof } => {
                let offers: Vec<usize> = offers.iter().zip(&places).map(|(&offer, places)| places[offer]).collect();
                let below = proof.bound.unwrap_or(solved.cost).min(solved.cost);
                bound = bound.min(below + of(set));
                nodes += proof.nodes;
                // Lists with a single offer left are a bound by themselves.
                rigorous &= proof.bound_is_exact == Some(true) || proof.bound.is_none() && setting.is_convex();
                solved.cost += of(used(setting, &setups, &offers));
                if solved.cost < known {
                    best = Some((solved.cost, solved, offers, proof));
                }
            }
            Choice::Infeasible(..) => {}
            Choice::Stopped => return Choice::Stopped,
        }
    }
    match best {
        Some((cost, solved, offers, proof)) => {
            let proof = Proof { bound: Some(bound.min(cost)), nodes, bound_is_exact: Some(rigorous), ..proof };
            Choice::Found { solved, offers, proof }
        }
        None => choose_alone(setting, start),
    }
}

/// Set of machines that a choice needs, as bits.
fn used(setting: &Setting<'_>, setups: &[&SetUp], offers: &[usize]) -> usize {
    let chosen = setting.priced.iter().zip(offers).map(|(group, &offer)| &group.offers[offer]);
    let machines: Vec<&String> = chosen.filter_map(|offer| offer.machine.as_ref()).collect();
    (0..setups.len()).filter(|&m| machines.contains(&&setups[m].machine)).map(|m| 1 << m).sum()
}

/// Groups with the offers of a set of machines, and the positions of these offers. Returns None if a group has none.
fn restricted(setting: &Setting<'_>, setups: &[&SetUp], set: usize) -> Option<(Vec<Priced>, Vec<Vec<usize>>)> {
    let allowed = |offer: &Offer| match &offer.machine {
        Some(machine) => (0..setups.len()).any(|m| set >> m & 1 == 1 && setups[m].machine == *machine),
        None => true,
    };
    let of = |group: &Priced| {
        let places: Vec<usize> = (0..group.offers.len()).filter(|&i| allowed(&group.offers[i])).collect();
        let offers: Vec<Offer> = places.iter().map(|&i| group.offers[i].clone()).collect();
        (!offers.is_empty()).then(|| (Priced { offers, ..group.clone() }, places))
    };
    let all: Vec<(Priced, Vec<usize>)> = setting.priced.iter().map(of).collect::<Option<_>>()?;
    Some(all.into_iter().unzip())
}
