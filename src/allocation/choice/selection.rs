//! Cheapest tolerances at fixed derivatives: free ones, processes, or both.

use crate::allocation::choice::branch_and_bound::{Chosen, branch};
pub(in crate::allocation) use crate::allocation::choice::outcome::Choice;
use crate::allocation::choice::process_selection::{choose_processes, have_distributions};
use crate::allocation::choice::single_offer::Setting;
use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::{Constraint, kept};
use crate::allocation::result::allocation::{AllocationSolver, Attainable, Proof};
use crate::allocation::result::solver_result::{Chosen as ChosenOffers, Solved, Starts};

/// Cheapest tolerances at fixed derivatives, without set-up costs.
pub(in crate::allocation) fn choose_alone(setting: &Setting<'_>, start: &[f64]) -> Choice {
    if have_distributions(setting.priced) {
        return choose_processes(setting);
    }
    let tight: Vec<f64> = setting.priced.iter().map(Priced::tightest).collect();
    let free = setting.priced.iter().all(|group| group.offers.len() == 1);
    // A limit that the start keeps can be kept. If means move with tolerances, the tightest ones may be the worst.
    let here = free && within_bounds(setting.priced, start) && kept(setting.value(start));
    for constraint in setting.constraints.iter().filter(|_| !here) {
        // The tightest tolerances nearly always keep every constraint that any tolerances keep.
        if kept(constraint.value(setting.responses, setting.priced, &tight)) {
            continue;
        }
        let (value, at) = setting.attainable(constraint);
        if !kept(value) {
            return Choice::Infeasible(unattainable(setting, constraint, &at), at);
        }
    }
    let found = if free { choose_free(setting, start) } else { choose_listed(setting, start) };
    match found {
        Some((solved, offers, proof)) => Choice::Found { solved, offers, proof },
        None if (setting.stopped)() => Choice::Stopped,
        // Nothing cheaper is found: the start itself, of which nothing is proven.
        None if here => unproven(setting, start),
        // Each can be kept by itself: the one that is farthest off where all are tightest.
        None => {
            let value = |one: &&Constraint| one.value(setting.responses, setting.priced, &tight);
            let worst = setting.constraints.iter().max_by(|a, b| value(a).total_cmp(&value(b)));
            worst.map_or(Choice::Stopped, |worst| {
                let attainable = Attainable { together: true, ..unattainable(setting, worst, &tight) };
                Choice::Infeasible(attainable, tight)
            })
        }
    }
}

/// The cheapest tolerances where every group has one offer.
fn choose_free(setting: &Setting<'_>, start: &[f64]) -> Option<ChosenOffers> {
    setting.solve(start).map(|solved| {
        let fixed = setting.priced.iter().all(|group| group.tightest() == group.loosest());
        let residual = if solved.converged { solved.residual } else { solved.residual.max(f64::MIN_POSITIVE) };
        let Starts { begun, reached, other } = solved.starts;
        let several = (begun > 1).then_some((begun, reached));
        let exact = setting.is_exact();
        let proof = Proof {
            solver: Some(match solved.sequential {
                true => AllocationSolver::SequentialQuadratic,
                false if exact => AllocationSolver::DualNewton,
                false => AllocationSolver::Separable,
            }),
            residual: (!fixed).then_some(residual),
            closed_form: solved.closed,
            starts: several.map(|(begun, _)| begun),
            reached: several.map(|(_, reached)| reached),
            other_optimum: other,
            ..Proof::default()
        };
        (solved, vec![0; setting.priced.len()], proof)
    })
}

/// The cheapest choice of processes where groups have several offers.
fn choose_listed(setting: &Setting<'_>, start: &[f64]) -> Option<ChosenOffers> {
    branch(*setting, start).map(|Chosen { solved, offers, bound, nodes, rigorous }| {
        let curved = setting.priced.iter().zip(&offers).any(|(group, &o)| group.offers[o].min < group.offers[o].max);
        let residual = curved.then_some(solved.residual);
        let bound = bound.is_finite().then_some(bound);
        let solver = Some(AllocationSolver::BranchAndBound);
        let bound_is_exact = bound.map(|_| rigorous);
        let proof = Proof { solver, residual, bound, bound_is_exact, nodes, ..Proof::default() };
        (solved, offers, proof)
    })
}

/// The start as a choice without a proof.
fn unproven(setting: &Setting<'_>, start: &[f64]) -> Choice {
    Choice::Found {
        solved: Solved {
            at: start.to_vec(),
            cost: setting.cost(start),
            multipliers: vec![0.0; setting.constraints.len()],
            residual: f64::INFINITY,
            value: setting.value(start),
            closed: false,
            converged: false,
            sequential: false,
            starts: Starts::default(),
        },
        offers: vec![0; setting.priced.len()],
        proof: Proof { residual: Some(f64::INFINITY), ..Proof::default() },
    }
}

/// True if each group has a process that may hold these half bands.
pub(in crate::allocation) fn within_bounds(priced: &[Priced], at: &[f64]) -> bool {
    priced.iter().zip(at).all(|(group, t)| (group.tightest()..=group.loosest()).contains(t))
}

/// Best attainable value of a constraint. The caller adds the unit.
fn unattainable(setting: &Setting<'_>, constraint: &Constraint, at: &[f64]) -> Attainable {
    let responses = setting.responses;
    let factors = responses.factors(setting.priced, at);
    Attainable {
        characteristic: constraint.characteristic,
        unit: None,
        requirement: constraint.requirement,
        joint: constraint.is_joint(),
        best: constraint.measured(responses, setting.priced, at),
        because: constraint.without_the_priced(responses, setting.priced, &factors),
        together: false,
    }
}
