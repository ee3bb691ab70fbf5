//! Evaluation of the points of a plan, with counts and times.

mod any_size;
pub mod history;

pub(crate) use any_size::{Restoration, Restore, at_any_size};
pub use history::history;

use std::collections::HashMap;
use std::time::Duration;

use crate::assembly::{NonRepeatable, Points, Request, Responses, Run, near_rows};
use crate::plan::{KnownAnswers, Plan, Point, Purpose, Stage};
use crate::problem::Problem;
use crate::summary::{RunSummary, StopReason};
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::parallel::{Rooms, join};
use sensitol_numeric::time::Instant;

/// Greatest number of coordinates in one batch: 64 MiB. A million points in a thousand dimensions are divided into batches.
pub(crate) const BATCH: usize = 1 << 23;

/// Results of the evaluation of a plan.
#[derive(Debug, Clone)]
pub struct Evaluated {
    /// Answers by point and characteristic.
    pub known: KnownAnswers,
    /// Derivatives by every dimension that the model returned, by point and characteristic.
    pub gradients: HashMap<(Point, usize), Vec<f64>>,
    /// Points sent to the model.
    pub evaluations: usize,
    /// Points whose answers were known from an earlier run.
    pub reused: usize,
    /// Changed answers of the model to the nominal point.
    pub non_repeatable: Vec<NonRepeatable>,
    /// Stages evaluated.
    pub stages: usize,
    /// Points sent again because an answer was a failure, or was not trusted.
    pub retried: usize,
    /// Reason for the stop before the plan was done. None if it was not stopped.
    pub stopped: Option<StopReason>,
    /// Time within the model.
    pub in_model: Duration,
}

/// Evaluates stage after stage until the plan needs no more points, or the run is stopped.
///
/// Evaluations: those of [`Plan::cost`], and more only if the model fails.
pub(crate) fn evaluate(problem: &Problem, plan: &dyn Plan, run: &Run<'_>) -> Evaluated {
    let mut evaluated = Evaluated::nothing(problem);
    while let Some(stage) = plan.next(&evaluated.known) {
        evaluated.add(problem, plan, &stage, run);
        if evaluated.stopped.is_some() {
            break;
        }
    }
    evaluated
}

impl Evaluated {
    /// Result without any evaluation.
    pub(crate) fn nothing(problem: &Problem) -> Self {
        Self {
            known: KnownAnswers::nothing(problem.characteristics().len()),
            gradients: HashMap::new(),
            evaluations: 0,
            reused: 0,
            non_repeatable: Vec::new(),
            stages: 0,
            retried: 0,
            stopped: None,
            in_model: Duration::ZERO,
        }
    }

    /// Counts and times as a summary.
    pub(crate) fn summary(&self) -> RunSummary {
        RunSummary {
            evaluations: self.evaluations as u64,
            cached: self.reused as u64,
            retried: self.retried as u64,
            failed: self.known.failed_points() as u64,
            stages: self.stages as u64,
            in_model: self.in_model,
            stopped: self.stopped,
            ..RunSummary::default()
        }
    }

    /// Evaluates one stage, whose points refer to the nodes of this plan.
    pub(crate) fn add(&mut self, problem: &Problem, plan: &dyn Plan, stage: &Stage, run: &Run<'_>) {
        self.stages += 1;
        self.known.reserve(stage.points.len());
        let desk = StageEvaluation { problem, plan, centre: plan.centre(), run };
        let many = stage.points.len() > near_rows(desk.centre.len());
        match many && problem.function().signature().cheap && !run.tells() {
            true => self.add_side_by_side(&desk, &stage.points),
            false => self.add_in_batches(&desk, &stage.points),
        }
    }

    /// Evaluates points in the largest batches, for a costly model.
    fn add_in_batches(&mut self, desk: &StageEvaluation<'_>, points: &[(Point, Purpose)]) {
        let rows = (BATCH / desk.centre.len()).max(1);
        let mut room = Points::repeated(&[], 0);
        for batch in points.chunks(rows) {
            let begun = Instant::now();
            let out = desk.answers(&mut room, batch);
            self.in_model += begun.elapsed();
            self.take_in(batch, &out, desk.run);
            if self.stopped.is_some() {
                return;
            }
        }
    }

    /// Evaluates points of a cheap function in small batches in parallel. Answers of one group of batches are stored while the next group
    /// is evaluated.
    fn add_side_by_side(&mut self, desk: &StageEvaluation<'_>, points: &[(Point, Purpose)]) {
        /// Batches between two checks of the stop of the run.
        const TASKS: usize = 64;
        let rows = near_rows(desk.centre.len());
        let rooms = Rooms::none();
        let mut waiting: (&[(Point, Purpose)], Vec<Responses>) = (&[], Vec::new());
        for tasks in points.chunks(rows * TASKS).chain([&points[..0]]) {
            let tasks = if self.stopped.is_some() { &points[..0] } else { tasks };
            let answers = || {
                let begun = Instant::now();
                let one =
                    |batch| rooms.within(|| Points::repeated(&[], 0), |room: &mut Points| desk.answers(room, batch));
                let answers: Vec<Responses> = tasks.par_chunks(rows).map(one).collect();
                (answers, begun.elapsed())
            };
            let (before, answered) = std::mem::take(&mut waiting);
            let take_in = || {
                before.chunks(rows).zip(answered).for_each(|(batch, out)| self.take_in(batch, &out, desk.run));
            };
            let ((), (answers, took)) = join(take_in, answers);
            self.in_model += took;
            waiting = (tasks, answers);
        }
    }

    /// Stores the answers of a batch.
    fn take_in(&mut self, batch: &[(Point, Purpose)], out: &Responses, run: &Run<'_>) {
        for (row, (point, _)) in batch.iter().enumerate() {
            self.learn(point, row, out, run);
            for characteristic in 0..out.outputs() {
                if let Some(gradient) = out.gradient(row, characteristic) {
                    self.gradients.insert((point.clone(), characteristic), gradient.to_vec());
                }
            }
        }
        self.evaluations = self.evaluations.saturating_add_signed(out.extra() as isize);
        self.reused += out.count_reused();
        self.retried += out.count_retried();
        self.non_repeatable.extend(out.non_repeatable().iter().cloned());
    }

    /// Adds the cost of evaluations for another plan, whose answers are not used here.
    pub(crate) fn add_spent(&mut self, spent: Self) {
        self.evaluations += spent.evaluations;
        self.reused += spent.reused;
        self.retried += spent.retried;
        self.stages += spent.stages;
        self.in_model += spent.in_model;
        self.non_repeatable.extend(spent.non_repeatable);
    }

    /// Adds the cost of an evaluation outside the plan.
    pub(crate) fn count(&mut self, out: &Responses, run: &Run<'_>) {
        let rows = out.answered().count();
        if rows < out.rows() {
            self.stopped.get_or_insert_with(|| run.why_open());
        }
        self.stages += 1;
        self.evaluations = (self.evaluations + rows).saturating_add_signed(out.extra() as isize);
        self.reused += out.count_reused();
        self.retried += out.count_retried();
        self.non_repeatable.extend(out.non_repeatable().iter().cloned());
    }

    /// Stores the answers of a row. An open row was not finished: it counts as evaluated only if some of its outputs have an answer.
    fn learn(&mut self, point: &Point, row: usize, out: &Responses, run: &Run<'_>) {
        let mut place = None;
        for characteristic in 0..out.outputs() {
            if let Some(value) = out.value(row, characteristic) {
                let place = *place.get_or_insert_with(|| self.known.place(point));
                self.known.set(place, characteristic, value);
            } else if let Some(error) = out.error(row, characteristic) {
                let place = *place.get_or_insert_with(|| self.known.place(point));
                self.known.fail(place, characteristic, error.clone());
            } else {
                self.stopped.get_or_insert_with(|| run.why_open());
            }
        }
        self.evaluations += usize::from(place.is_some());
    }
}

/// Model, plan and run that evaluate the points of a stage.
struct StageEvaluation<'a> {
    problem: &'a Problem,
    plan: &'a dyn Plan,
    centre: Vec<f64>,
    run: &'a Run<'a>,
}

impl StageEvaluation<'_> {
    /// Answers at some points. `room` holds copies of the centre before and after the call.
    fn answers(&self, room: &mut Points, batch: &[(Point, Purpose)]) -> Responses {
        let Self { problem, plan, centre, run } = self;
        if room.rows() != batch.len() {
            // Drop the old buffer before the new one is allocated, to save memory.
            *room = Points::repeated(&[], 0);
            *room = Points::repeated(centre, batch.len());
        }
        for (row, (point, _)) in batch.iter().enumerate() {
            for at in point.at() {
                let dimension = at.dimension as usize;
                room.set(row, dimension, plan.axis(dimension).nodes[at.node as usize].x);
            }
        }
        let mut out = Responses::open(batch.len(), problem.outputs().len());
        problem.function().evaluate(&Request::values(room, problem.outputs()), run, &mut out);
        for (row, (point, _)) in batch.iter().enumerate() {
            point.at().iter().for_each(|at| room.set(row, at.dimension as usize, centre[at.dimension as usize]));
        }
        out
    }
}
