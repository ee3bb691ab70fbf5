//! Order of one allocation: analysis, search, best end, conclusion.

use std::rc::Rc;
use std::sync::atomic::Ordering;

use crate::allocation::result::allocation::{Allocation, JointKept, Proof, Status};
use crate::allocation::search::best_trial::{SearchFailure, Searched};
use crate::allocation::search::common_factor::loosest;
use crate::allocation::search::conclusion::doubts;
use crate::allocation::search::driver::{AsWritten, Driver, Spent};
use crate::allocation::search::linearization_point::required;
use crate::allocation::search::trial::required_of;
use crate::allocation::surface::joint_yield::joint;
use crate::allocation::task::{AllocateError, AllocationOptions, AllocationTask, Goal};
use crate::assembly::Run;
use crate::evaluation::at_any_size;
use crate::problem::Problem;
use crate::simulation::SimulationError;
use crate::summary::RunSummary;
use sensitol_numeric::sampling::{Draws, Sampler, all_known};
use sensitol_numeric::time::Instant;

/// Allocates tolerances once, with the choices of the task as they are.
pub(in crate::allocation) fn allocate_once(
    problem: &Problem,
    task: &AllocationTask,
    options: &AllocationOptions,
    run: &Run<'_>,
    written: Option<AsWritten<'_>>,
) -> Result<Allocation, AllocateError> {
    all_known(problem.dimensions()).map_err(SimulationError::from)?;
    if options.confirm.is_some() {
        Draws::new(problem.dimensions(), problem.correlation(), Sampler::Random, options.seed)
            .map_err(SimulationError::from)?;
    }
    at_any_size(problem, run, |problem, run| {
        let task = &task.divided(problem)?;
        let required = match task.goal {
            Goal::LeastCost => required_of(problem, &task.requirements),
            // The level sought for a given cost replaces the other requirements.
            _ => task.requirements.iter().enumerate().filter_map(|(c, one)| Some((c, (*one)?))).collect(),
        };
        Driver { task, options, run, required, written, spent: Spent::default() }.run(problem)
    })
}

impl Driver<'_> {
    fn run(mut self, problem: &Problem) -> Result<Allocation, AllocateError> {
        let begun = Instant::now();
        let first = Rc::new(self.analysed(problem.clone())?);
        let constraints = self.constraints(problem, &self.task.requirements);
        for constraint in &constraints {
            let known = first.analysis.characteristics[constraint.characteristic].moments.is_some();
            if !known && !self.spent.stopped {
                let characteristic = problem.characteristics()[constraint.characteristic].name().to_owned();
                return Err(AllocateError::NoMoments { characteristic });
            }
        }
        // The present tolerances are judged first, for comparison and in case nothing better is found.
        let before: Vec<f64> = self.task.priced.iter().map(|group| group.present(problem.dimensions())).collect();
        let loosest_before = loosest(&first.responses, &constraints);
        let joint_before = joint(problem, &first.responses, self.options.seed);
        let start = self.start(problem, &first);
        let own = start.trial.as_ref().map_or(&first.analysis, |trial| &trial.analysis);
        let mut allocation = Allocation {
            status: Status::OutOfTime,
            problem: problem.clone(),
            before: match &start.trial {
                Some(trial) => self.completed_trial(trial, &first.findings),
                None => self.completed(first.analysis.clone(), &first.findings, problem),
            },
            after: None,
            confirmed: false,
            cost_before: self.cost_to_hold(problem).and_then(|held| Some(held + self.loss_at(&first)?)),
            cost_after: None,
            loss: [self.loss_at(&first).filter(|_| !self.task.losses.is_empty()), None],
            cost_unrounded: None,
            setups: Vec::new(),
            goal: self.task.goal,
            cost_basis: self.task.basis,
            tolerances: self.unchanged(problem),
            moved: Vec::new(),
            requirements: required(&self.required, own),
            joint_requirement: self.task.joint_target(problem, self.options).and_then(|_| {
                let before = own.joint_requirement?;
                Some(JointKept { requirement: before.requirement, before, after: None, sampled: None })
            }),
            prices: Vec::new(),
            proof: Proof::default(),
            attainable: None,
            loosest_before,
            loosest_after: None,
            joint: [joint_before, None],
            front: Vec::new(),
            confirmation: None,
            run: RunSummary::default(),
            rounds: 0,
            model_points: 0,
            warnings: Vec::new(),
        };
        if !self.spent.stopped {
            let searched = self.search(problem, first, (&constraints, &before), SearchFailure::none())?;
            let Searched { end, failure: SearchFailure { status, attainable } } =
                self.best_end(problem, start, searched)?;
            allocation = Allocation { status, attainable, ..allocation };
            if let Some(end) = end {
                self.conclude(&mut allocation, problem, end)?;
            }
        }
        let stopped = (self.spent.stopped || self.run.stopped()).then(|| self.run.why_open());
        let (wall, seed) = (begun.elapsed(), Some(self.options.seed));
        let budget = self.spent.run.stopped;
        allocation.run =
            RunSummary { wall, seed, stopped: stopped.or(budget), evaluator: problem.evaluator(), ..self.spent.run };
        allocation.rounds = self.spent.rounds;
        allocation.model_points = self.spent.points.load(Ordering::Relaxed);
        allocation.warnings = doubts(problem, &self.task.priced, &allocation);
        Ok(allocation)
    }
}
