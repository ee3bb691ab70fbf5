//! Branch and bound over zones that refine others.
//!
//! Each node is a task without the condition `inner <= outer`, whose optimum bounds what lies below it. An optimum that
//! breaks the condition is split into tasks that exclude it and together hold all tolerances that keep the condition.

use crate::allocation::result::allocation::{Allocation, Proof, Status};
use crate::allocation::search::conclusion::{NO_GAP, is_found};
use crate::allocation::search::driver::AsWritten;
use crate::allocation::search::refinement::Split;
use crate::allocation::search::run::allocate_once;
use crate::allocation::task::{AllocateError, AllocationOptions, AllocationTask, Goal};
use crate::assembly::Run;
use crate::problem::Problem;

/// Greatest number of searches. Two lists of ten processes take at most 20, and each search analyses the model anew.
const MOST_SEARCHES: usize = 60;

/// Task that is not searched yet, with the least objective that it can reach.
struct OpenTask {
    task: AllocationTask,
    bound: f64,
}

/// Allocation that keeps every refinement, with the task that gave it.
struct BestRefined {
    task: AllocationTask,
    found: Allocation,
    objective: f64,
}

/// Problem and options of the searches.
pub(in crate::allocation) struct RefinementSearch<'s> {
    pub(in crate::allocation) problem: &'s Problem,
    pub(in crate::allocation) task: &'s AllocationTask,
    pub(in crate::allocation) options: &'s AllocationOptions,
    pub(in crate::allocation) run: &'s Run<'s>,
    pub(in crate::allocation) written: Option<AsWritten<'s>>,
    open: Vec<OpenTask>,
    best: Option<BestRefined>,
    /// Lower bound of the objective in the part that is not searched.
    left_out: f64,
    /// Weakest status among the bounds; `Optimal` if all of them are proven.
    weakest: Status,
    nodes: usize,
}

impl<'s> RefinementSearch<'s> {
    /// Creates a search for the refinements of a task.
    pub(in crate::allocation) fn new(
        problem: &'s Problem,
        task: &'s AllocationTask,
        (options, run): (&'s AllocationOptions, &'s Run<'s>),
        written: Option<AsWritten<'s>>,
    ) -> Self {
        let (open, best, left_out, weakest, nodes) = (Vec::new(), None, f64::INFINITY, Status::Optimal, 0);
        Self { problem, task, options, run, written, open, best, left_out, weakest, nodes }
    }

    /// Cheapest allocation that keeps every refinement, from the one found without them.
    pub(in crate::allocation) fn refined(mut self, found: Allocation) -> Result<Allocation, AllocateError> {
        if found.after.is_none() || self.run.stopped() || !self.task.breaks_refinement(&found) {
            return Ok(found);
        }
        // Samples and fronts are for the result alone.
        let options = AllocationOptions { confirm: None, front: None, ..self.options.clone() };
        let mut refused: Option<Allocation> = None;
        let first = match is_found(found.status) {
            true => found.clone(),
            // A sample may have left it open.
            false => allocate_once(self.problem, self.task, &options, self.run, self.written)?,
        };
        if first.after.is_none() || first.status == Status::Infeasible {
            return Ok(found);
        }
        self.take(self.task.clone(), first);
        while let Some(next) = self.next() {
            if self.nodes >= MOST_SEARCHES || self.run.stopped() {
                self.left_out = self.open.iter().map(|open| open.bound).fold(self.left_out.min(next.bound), f64::min);
                break;
            }
            self.nodes += 1;
            let one = allocate_once(self.problem, &next.task, &options, self.run, self.written)?;
            if one.after.is_none() || !is_found(one.status) {
                if one.status != Status::Infeasible {
                    self.weakest = weaker(self.weakest, Status::AlmostOptimal);
                }
                if refused.as_ref().is_none_or(|refused| is_settled(refused.status)) {
                    refused = Some(one);
                }
                continue;
            }
            self.take(next.task, one);
        }
        let Some(best) = self.best.take() else { return Ok(self.without_result(found, refused)) };
        let mut last = best.found;
        if self.options.confirm.is_some() || self.options.front.is_some() {
            last = allocate_once(self.problem, &best.task, self.options, self.run, self.written)?;
        }
        Ok(self.concluded(&found, last, best.objective))
    }

    /// Open task with the least bound. Returns None if no open task can be better than the best one.
    fn next(&mut self) -> Option<OpenTask> {
        let least = (0..self.open.len()).min_by(|&a, &b| self.open[a].bound.total_cmp(&self.open[b].bound))?;
        let next = self.open.swap_remove(least);
        let can_be_better =
            self.best.as_ref().is_none_or(|best| next.bound < best.objective - NO_GAP * best.objective.abs());
        can_be_better.then_some(next)
    }

    /// Keeps an allocation that keeps every refinement, and splits the task of another one.
    fn take(&mut self, task: AllocationTask, found: Allocation) {
        let objective = objective(&found);
        if !task.breaks_refinement(&found) {
            if is_found(found.status) {
                self.weakest = weaker(self.weakest, found.status);
            }
            if self.best.as_ref().is_none_or(|best| objective < best.objective) {
                self.best = Some(BestRefined { task, found, objective });
            }
            return;
        }
        self.weakest = weaker(self.weakest, found.status);
        let Split { tasks, is_exact } = task.split(&found);
        if !is_exact {
            self.left_out = self.left_out.min(objective);
        }
        self.open.extend(tasks.into_iter().map(|task| OpenTask { task, bound: objective }));
    }

    /// Allocation with the figures that are those of the whole task.
    fn concluded(&self, found: &Allocation, mut last: Allocation, objective: f64) -> Allocation {
        let is_bounded = self.weakest == Status::Optimal;
        let is_proven = is_bounded && self.left_out >= objective - NO_GAP * objective.abs();
        if last.status == Status::Optimal && !is_proven {
            last.status = if is_bounded { Status::AlmostOptimal } else { self.weakest };
        }
        let lists = self.task.priced.iter().any(|group| group.offers.len() > 1);
        if lists && self.task.goal == Goal::LeastCost {
            let bound = is_bounded.then_some(self.left_out.min(objective));
            let gap = bound.map(|bound| ((objective - bound) / objective.abs().max(f64::MIN_POSITIVE)).max(0.0));
            let nodes = last.proof.nodes + self.nodes;
            let bound_is_exact = bound.map(|_| true);
            last.proof = Proof { bound, gap, bound_is_exact, nodes, ..last.proof };
        }
        last.cost_before = found.cost_before;
        for row in &mut last.tolerances {
            if let Some(own) = found.tolerances.iter().find(|own| own.dimension == row.dimension) {
                row.cost_before = own.cost_before;
            }
        }
        last
    }

    /// Result without tolerances that keep every refinement: nothing is changed.
    fn without_result(&self, found: Allocation, refused: Option<Allocation>) -> Allocation {
        let is_proven = self.weakest == Status::Optimal && self.left_out == f64::INFINITY;
        let status = if is_proven { Status::Infeasible } else { Status::NoFeasiblePointFound };
        match refused {
            Some(refused) => {
                let status = if is_settled(refused.status) { status } else { refused.status };
                Allocation { status, cost_before: found.cost_before, ..refused }
            }
            None => {
                let mut found = found;
                for row in &mut found.tolerances {
                    (row.after, row.cost_after, row.process) = (row.before, None, None);
                    (row.bound, row.bound_price) = (None, None);
                }
                found.requirements.iter_mut().for_each(|one| (one.after, one.sampled) = (None, None));
                found.joint_requirement.iter_mut().for_each(|one| (one.after, one.sampled) = (None, None));
                let problem = self.problem.clone();
                let (after, cost_after, confirmation) = (None, None, None);
                let (prices, setups, front, proof) = (Vec::new(), Vec::new(), Vec::new(), Proof::default());
                let loss = [found.loss[0], None];
                let joint = [found.joint[0], None];
                Allocation {
                    status,
                    problem,
                    after,
                    cost_after,
                    confirmation,
                    prices,
                    setups,
                    front,
                    proof,
                    loss,
                    joint,
                    confirmed: false,
                    loosest_after: None,
                    ..found
                }
            }
        }
    }
}

/// Amount that the goal makes least: the cost, the negative of the least Cpk, or the rejects.
fn objective(found: &Allocation) -> f64 {
    if found.goal == Goal::LeastCost {
        return found.cost_after.unwrap_or(f64::INFINITY);
    }
    let after = found.after.iter().flat_map(|after| &after.characteristics);
    let capabilities = after.filter_map(|one| one.distribution.capability.as_ref());
    match found.goal {
        Goal::FewestRejects { .. } => {
            capabilities.filter_map(|one| one.rejected()).reduce(f64::max).unwrap_or(f64::INFINITY)
        }
        _ => -capabilities.filter_map(|one| one.cpk).fold(f64::INFINITY, f64::min),
    }
}

/// True for a status of missed requirements.
fn is_settled(status: Status) -> bool {
    matches!(status, Status::Infeasible | Status::NoFeasiblePointFound)
}

/// Weaker of two statuses as evidence of a bound.
fn weaker(a: Status, b: Status) -> Status {
    match (a, b) {
        (Status::Optimal, Status::Optimal) => Status::Optimal,
        (Status::Optimal | Status::LocalOptimum, Status::Optimal | Status::LocalOptimum) => Status::LocalOptimum,
        _ => Status::AlmostOptimal,
    }
}
