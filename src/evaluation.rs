//! Evaluates what a plan asks for, and keeps count.

mod history;

pub(crate) use history::history;

use std::collections::HashMap;
use std::time::Duration;

use crate::assembly::{NonRepeatable, Points, Request, Responses, Run};
use crate::plan::{KnownAnswers, Plan, Point, Stage};
use crate::problem::Problem;
use crate::summary::{RunSummary, StopReason};
use crate::time::Instant;

/// Coordinates that one batch holds at most: 64 MiB. A million points in a thousand dimensions are cut into batches.
pub(crate) const BATCH: usize = 1 << 23;

/// The results of evaluating a plan.
#[derive(Debug, Clone)]
pub struct Evaluated {
    /// Every answer.
    pub known: KnownAnswers,
    /// Derivatives by every dimension that the model sent, by point and characteristic.
    pub gradients: HashMap<(Point, usize), Vec<f64>>,
    /// Points sent to the model.
    pub evaluations: usize,
    /// Points whose answers were known from an earlier run.
    pub reused: usize,
    /// Where the model answered the nominal point otherwise than before.
    pub non_repeatable: Vec<NonRepeatable>,
    /// In how many stages.
    pub stages: usize,
    /// Points sent again.
    pub retried: usize,
    /// Why it was stopped before the plan was done; None where it was not.
    pub stopped: Option<StopReason>,
    /// Time within the model.
    pub in_model: Duration,
}

/// Evaluates stage after stage until the plan lacks nothing, or the run is stopped.
///
/// Evaluations: as [`Plan::cost`] says, and more only where the model fails.
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
    /// Nothing yet.
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

    /// In numbers.
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

    /// Evaluates one stage; the points are by the nodes of this plan.
    pub(crate) fn add(&mut self, problem: &Problem, plan: &dyn Plan, stage: &Stage, run: &Run<'_>) {
        self.stages += 1;
        self.known.reserve(stage.points.len());
        let centre = plan.centre();
        let rows = (BATCH / centre.len()).max(1);
        // All batches have one buffer, in which only a few values of each point are not those of the centre.
        let mut points = Points::repeated(&centre, 0);
        for batch in stage.points.chunks(rows) {
            if points.rows() != batch.len() {
                // Two buffers would stand beside each other at the last batch, which is shorter.
                drop(points);
                points = Points::repeated(&centre, batch.len());
            }
            for (row, (point, _)) in batch.iter().enumerate() {
                for at in point.at() {
                    let dimension = at.dimension as usize;
                    points.set(row, dimension, plan.axis(dimension).nodes[at.node as usize].x);
                }
            }
            let mut out = Responses::open(batch.len(), problem.outputs().len());
            let begun = Instant::now();
            problem.function().evaluate(&Request::values(&points, problem.outputs()), run, &mut out);
            self.in_model += begun.elapsed();
            for (row, (point, _)) in batch.iter().enumerate() {
                point.at().iter().for_each(|at| points.set(row, at.dimension as usize, centre[at.dimension as usize]));
                self.learn(point, row, &out, run);
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
            if self.stopped.is_some() {
                return;
            }
        }
    }

    /// Counts what was evaluated before for another plan, whose answers are of no use here.
    pub(crate) fn add_spent(&mut self, spent: Self) {
        self.evaluations += spent.evaluations;
        self.reused += spent.reused;
        self.retried += spent.retried;
        self.stages += spent.stages;
        self.in_model += spent.in_model;
        self.non_repeatable.extend(spent.non_repeatable);
    }

    /// Counts an evaluation beside the plan.
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

    /// A row that is still open was not finished: it was sent only if some of it was answered.
    fn learn(&mut self, point: &crate::plan::Point, row: usize, out: &Responses, run: &Run<'_>) {
        let mut answered = false;
        for characteristic in 0..out.outputs() {
            let answer = match (out.value(row, characteristic), out.error(row, characteristic)) {
                (Some(value), _) => Ok(value),
                (None, Some(error)) => Err(error.clone()),
                (None, None) => {
                    self.stopped.get_or_insert_with(|| run.why_open());
                    continue;
                }
            };
            answered = true;
            self.known.learn(point, characteristic, answer);
        }
        self.evaluations += usize::from(answered);
    }
}
