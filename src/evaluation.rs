//! Evaluation of the points of a plan, with counts and times.

mod any_size;
mod evaluator;
pub mod history;

pub(crate) use any_size::{Restoration, Restore, at_any_size};
pub use evaluator::{Evaluator, Ledger};
pub use history::history;

use std::collections::HashMap;

use crate::assembly::{Points, Responses, near_rows};
use crate::plan::{KnownAnswers, Plan, Point, Purpose, Stage};
use crate::problem::Problem;
use crate::summary::StopReason;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::parallel::{Rooms, join};

/// Greatest number of coordinates in one batch: 64 MiB. A million points in a thousand dimensions are divided into batches.
pub(crate) const BATCH: usize = 1 << 23;

/// Results of the evaluation of a plan.
#[derive(Debug, Clone)]
pub struct Evaluated {
    /// Answers by point and characteristic.
    pub known: KnownAnswers,
    /// Derivatives by every dimension that the model returned, by point and characteristic.
    pub gradients: HashMap<(Point, usize), Vec<f64>>,
    /// Cost of the answers, and of further questions of the method.
    pub ledger: Ledger,
}

/// Evaluates stage after stage until the plan needs no more points, or the run is stopped.
///
/// Evaluations: those of [`Plan::cost`], and more only if the model fails.
pub(crate) fn evaluate(evaluator: &Evaluator<'_>, plan: &dyn Plan) -> Evaluated {
    let mut evaluated = Evaluated::nothing(evaluator.problem());
    while let Some(stage) = plan.next(&evaluated.known) {
        evaluated.add(evaluator, plan, &stage);
        if evaluator.stopped().is_some() {
            break;
        }
    }
    evaluated
}

impl Evaluated {
    /// Result without any evaluation.
    pub(crate) fn nothing(problem: &Problem) -> Self {
        let known = KnownAnswers::nothing(problem.characteristics().len());
        Self { known, gradients: HashMap::new(), ledger: Ledger::default() }
    }

    /// Reason for the stop before the plan was done. None if it was not stopped.
    pub fn stopped(&self) -> Option<StopReason> {
        self.ledger.stopped()
    }

    /// Evaluates one stage, whose points refer to the nodes of this plan.
    pub(crate) fn add(&mut self, evaluator: &Evaluator<'_>, plan: &dyn Plan, stage: &Stage) {
        self.known.reserve(stage.points.len());
        let asked = StageEvaluation { evaluator, plan, centre: plan.centre() };
        let many = stage.points.len() > near_rows(asked.centre.len());
        let parts = match many && evaluator.problem().function().signature().cheap && !evaluator.run().tells() {
            true => self.add_side_by_side(&asked, &stage.points),
            false => self.add_in_batches(&asked, &stage.points),
        };
        evaluator.merge(Ledger::of_batch(parts));
        self.ledger = evaluator.ledger();
    }

    /// Evaluates points in the largest batches, for a costly model.
    fn add_in_batches(&mut self, asked: &StageEvaluation<'_>, points: &[(Point, Purpose)]) -> Vec<Ledger> {
        let rows = (BATCH / asked.centre.len()).max(1);
        let mut room = Points::repeated(&[], 0);
        let mut parts = Vec::new();
        for batch in points.chunks(rows) {
            let (out, ledger) = asked.answers(&mut room, batch);
            self.take_in(batch, &out);
            let stopped = ledger.stopped().is_some();
            parts.push(ledger);
            if stopped {
                break;
            }
        }
        parts
    }

    /// Evaluates points of a cheap function in small batches in parallel. Answers of one group of batches are stored while the next group
    /// is evaluated.
    fn add_side_by_side(&mut self, asked: &StageEvaluation<'_>, points: &[(Point, Purpose)]) -> Vec<Ledger> {
        /// Batches between two checks of the stop of the run.
        const TASKS: usize = 64;
        let rows = near_rows(asked.centre.len());
        let rooms = Rooms::none();
        let mut waiting: (&[(Point, Purpose)], Answered) = (&[], Vec::new());
        let mut parts: Vec<Ledger> = Vec::new();
        for tasks in points.chunks(rows * TASKS).chain([&points[..0]]) {
            let stopped = waiting.1.iter().map(|(_, ledger)| ledger).chain(&parts).any(|part| part.stopped().is_some());
            let tasks = if stopped { &points[..0] } else { tasks };
            let one = |batch| rooms.within(|| Points::repeated(&[], 0), |room: &mut Points| asked.answers(room, batch));
            let (before, answered) = std::mem::take(&mut waiting);
            let take_in = || {
                for (batch, (out, ledger)) in before.chunks(rows).zip(answered) {
                    self.take_in(batch, &out);
                    parts.push(ledger);
                }
            };
            let ((), answers) = join(take_in, || tasks.par_chunks(rows).map(one).collect());
            waiting = (tasks, answers);
        }
        parts
    }

    /// Stores the answers of a batch.
    fn take_in(&mut self, batch: &[(Point, Purpose)], out: &Responses) {
        for (row, (point, _)) in batch.iter().enumerate() {
            self.learn(point, row, out);
            for characteristic in 0..out.outputs() {
                if let Some(gradient) = out.gradient(row, characteristic) {
                    self.gradients.insert((point.clone(), characteristic), gradient.to_vec());
                }
            }
        }
    }

    /// Adds the cost of evaluations for another plan, whose answers are not used here.
    pub(crate) fn add_spent(&mut self, spent: Self) {
        self.ledger.add(spent.ledger);
    }

    /// Stores the answers of a row.
    fn learn(&mut self, point: &Point, row: usize, out: &Responses) {
        let mut place = None;
        for characteristic in 0..out.outputs() {
            if let Some(value) = out.value(row, characteristic) {
                let place = *place.get_or_insert_with(|| self.known.place(point));
                self.known.set(place, characteristic, value);
            } else if let Some(error) = out.error(row, characteristic) {
                let place = *place.get_or_insert_with(|| self.known.place(point));
                self.known.fail(place, characteristic, error.clone());
            }
        }
    }
}

/// Answers of batches that were evaluated side by side, each with its ledger.
type Answered = Vec<(Responses, Ledger)>;

/// Model and plan that evaluate the points of a stage.
struct StageEvaluation<'a> {
    evaluator: &'a Evaluator<'a>,
    plan: &'a dyn Plan,
    centre: Vec<f64>,
}

impl StageEvaluation<'_> {
    /// Answers at some points, with their ledger. `room` holds copies of the centre before and after the call.
    fn answers(&self, room: &mut Points, batch: &[(Point, Purpose)]) -> (Responses, Ledger) {
        let Self { evaluator, plan, centre } = self;
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
        let part = evaluator.part();
        let out = part.ask(room);
        for (row, (point, _)) in batch.iter().enumerate() {
            point.at().iter().for_each(|at| room.set(row, at.dimension as usize, centre[at.dimension as usize]));
        }
        (out, part.into_ledger())
    }
}
