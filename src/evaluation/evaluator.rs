//! Evaluations of the model: the only place that makes them, with the ledger of their cost.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::assembly::{NonRepeatable, Points, Request, Responses, Run};
use crate::problem::Problem;
use crate::summary::{RunSummary, StopReason};
use sensitol_numeric::time::Instant;

/// Ledger of questions to a model: points, batches and time, the reason for an early end, and answers that were not repeatable.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Ledger {
    /// Counts, times, and the reason for an early end.
    pub run: RunSummary,
    /// Points at which the model gave different answers.
    pub non_repeatable: Vec<NonRepeatable>,
}

impl Ledger {
    /// Reason for an early end. None if every point that was asked has an answer, and every answer its check.
    pub fn stopped(&self) -> Option<StopReason> {
        self.run.stopped
    }

    /// Number of evaluations.
    pub fn evaluations(&self) -> usize {
        usize::try_from(self.run.evaluations).unwrap_or(usize::MAX)
    }

    /// Ledger without a question, with the reason for an early end.
    pub(crate) fn stopped_by(stopped: Option<StopReason>) -> Self {
        Self { run: RunSummary { stopped, ..RunSummary::default() }, non_repeatable: Vec::new() }
    }

    /// Adds the ledger of later questions.
    pub fn add(&mut self, later: Self) {
        self.run = self.run.and(&later.run);
        self.non_repeatable.extend(later.non_repeatable);
    }

    /// Ledger of batches that were evaluated side by side, as one batch.
    pub fn of_batch(parts: impl IntoIterator<Item = Self>) -> Self {
        let mut batch = Self::default();
        parts.into_iter().for_each(|part| batch.add(part));
        batch.run.stages = 1;
        batch
    }

    /// Ledger of one batch: the points of these responses, which took the model this long.
    fn of_responses(out: &Responses, run: &Run<'_>, in_model: Duration) -> Self {
        let open = out.has_open_entries();
        // A row with some open outputs was sent, a row that is open in all outputs was not.
        let answered = if open { out.answered().count() } else { out.rows() };
        Self {
            run: RunSummary {
                evaluations: (answered as u64).saturating_add_signed(out.extra()),
                cached: out.count_reused() as u64,
                retried: out.count_retried() as u64,
                failed: out.failed_rows() as u64,
                stages: 1,
                in_model,
                // Answers whose check was cut off decide nothing, like points that were not evaluated.
                stopped: (open || out.count_unchecked() > 0).then(|| run.why_open()),
                ..RunSummary::default()
            },
            non_repeatable: out.non_repeatable().to_vec(),
        }
    }
}

/// The model of a problem with all that a question to it needs: run, budget and seed. It keeps the ledger, so that callers count nothing.
///
/// ```
/// use sensitol::assembly::{Points, Run};
/// use sensitol::evaluation::Evaluator;
/// use sensitol::{Closure, Dimension, Problem};
/// let width = Dimension::normal("width", 20.0, 0.3)?;
/// let square = Problem::new([width], Closure::scalar("area", |x| x[0] * x[0]))?;
/// let evaluator = Evaluator::new(&square, &Run::to_the_end()).with_budget(Some(3));
/// let out = evaluator.ask(&Points::from_rows(&[[20.0], [21.0]]));
/// assert_eq!((out.value(1, 0), evaluator.remaining()), (Some(441.0), Some(1)));
/// assert_eq!((evaluator.summary().evaluations, evaluator.summary().stages), (2, 1));
/// # Ok::<(), sensitol::Error>(())
/// ```
pub struct Evaluator<'a> {
    problem: &'a Problem,
    run: Run<'a>,
    /// Greatest number of evaluations in the ledger. None if there is no limit.
    budget: Option<usize>,
    seed: u64,
    ledger: Mutex<Ledger>,
}

impl<'a> Evaluator<'a> {
    /// Creates the evaluator of a problem, without a budget, with the seed 0 and an empty ledger.
    pub fn new(problem: &'a Problem, run: &Run<'a>) -> Self {
        Self { problem, run: *run, budget: None, seed: 0, ledger: Mutex::default() }
    }

    /// Sets the greatest number of evaluations; None for no limit.
    #[must_use]
    pub fn with_budget(self, budget: Option<usize>) -> Self {
        Self { budget, ..self }
    }

    /// Sets the greatest number of points; None for no limit.
    #[must_use]
    pub fn with_points(self, points: Option<usize>) -> Self {
        let budget = points.map(|points| points.saturating_mul(self.problem.evaluations_per_point()));
        self.with_budget(budget)
    }

    /// Sets the seed of random points.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Continues a ledger: its evaluations use up the budget.
    #[must_use]
    pub fn with_ledger(self, ledger: Ledger) -> Self {
        Self { ledger: Mutex::new(ledger), ..self }
    }

    /// Evaluator with the remaining budget and an empty ledger, for a part of the work. [`merge`](Self::merge) adds its ledger.
    pub fn part(&self) -> Self {
        Self {
            problem: self.problem,
            run: self.run,
            budget: self.remaining_evaluations(),
            seed: self.seed,
            ledger: Mutex::default(),
        }
    }

    /// Problem whose model is evaluated.
    pub fn problem(&self) -> &'a Problem {
        self.problem
    }

    /// Conditions under which points are evaluated.
    pub fn run(&self) -> &Run<'a> {
        &self.run
    }

    /// Seed of random points.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Number of points that the evaluations left of the budget allow. None if there is no limit. A point takes several evaluations if a
    /// value is chosen from stock for it, or if the assembly moves.
    pub fn remaining(&self) -> Option<usize> {
        self.remaining_evaluations().map(|left| left / self.problem.evaluations_per_point())
    }

    fn remaining_evaluations(&self) -> Option<usize> {
        self.budget.map(|budget| budget.saturating_sub(self.locked().evaluations()))
    }

    /// Number of these points that the budget allows. If it is smaller, the ledger names the budget as the reason for an early end.
    pub fn affordable(&self, points: usize) -> usize {
        let allowed = self.remaining().map_or(points, |left| left.min(points));
        if allowed < points {
            self.locked().run.stopped.get_or_insert(StopReason::Budget);
        }
        allowed
    }

    /// Number of evaluations so far.
    pub fn evaluations(&self) -> usize {
        self.locked().evaluations()
    }

    /// Counts, times, and the reason for an early end so far.
    pub fn summary(&self) -> RunSummary {
        self.locked().run
    }

    /// Reason for an early end so far.
    pub fn stopped(&self) -> Option<StopReason> {
        self.summary().stopped
    }

    /// Copy of the ledger so far.
    pub fn ledger(&self) -> Ledger {
        self.locked().clone()
    }

    /// Ledger of all questions.
    pub fn into_ledger(self) -> Ledger {
        self.ledger.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds the ledger of a part of the work.
    pub fn merge(&self, ledger: Ledger) {
        self.locked().add(ledger);
    }

    /// Evaluates all characteristics of the problem at some points, as one batch.
    pub fn ask(&self, points: &Points) -> Responses {
        self.ask_outputs(points, self.problem.outputs())
    }

    /// Evaluates some outputs of the function at some points, as one batch.
    pub fn ask_outputs(&self, points: &Points, outputs: &[usize]) -> Responses {
        let mut out = Responses::open(0, 0);
        self.ask_into(points, outputs, &mut out);
        out
    }

    /// Evaluates like [`ask_outputs`](Self::ask_outputs), in the memory of earlier responses.
    pub fn ask_into(&self, points: &Points, outputs: &[usize], out: &mut Responses) {
        out.reopen(points.rows(), outputs.len());
        let begun = Instant::now();
        self.problem.function().evaluate(&Request::values(points, outputs), &self.run, out);
        self.merge(Ledger::of_responses(out, &self.run, begun.elapsed()));
    }

    fn locked(&self) -> MutexGuard<'_, Ledger> {
        self.ledger.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::{AssemblyFunction, Signature};
    use crate::{Closure, Dimension};

    fn problem(function: impl AssemblyFunction + 'static) -> Problem {
        Problem::new([Dimension::normal("a", 0.0, 1.0).unwrap()], function).unwrap()
    }

    fn points(a: &[f64]) -> Points {
        Points::from_rows(&a.iter().map(|&a| [a]).collect::<Vec<_>>())
    }

    /// Function with two outputs that answers its first point and one output of the second, and leaves the rest open.
    struct Interrupted(Signature);

    impl AssemblyFunction for Interrupted {
        fn signature(&self) -> &Signature {
            &self.0
        }

        fn evaluate(&self, _: &Request<'_>, _: &Run<'_>, out: &mut Responses) {
            out.set(0, 0, 1.0);
            out.set(0, 1, f64::NAN);
            out.set(1, 0, 2.0);
            out.spent(3);
            out.retried(2);
        }
    }

    /// A point that is open in all outputs was not evaluated, and has not failed.
    #[test]
    fn open_points_are_neither_evaluations_nor_failures() {
        let problem = problem(Interrupted(Signature::of_names(["a"], ["y", "z"])));
        let evaluator = Evaluator::new(&problem, &Run::to_the_end());
        evaluator.ask(&points(&[0.0, 1.0, 2.0, 3.0]));
        let run = evaluator.summary();
        assert_eq!((run.evaluations, run.retried, run.failed, run.stages), (2 + 3, 2, 1, 1));
        assert_eq!(run.stopped, Some(StopReason::Requested));
    }

    #[test]
    fn a_budget_is_a_reason_only_if_points_are_left_out() {
        let problem = problem(Closure::scalar("y", |x| x[0]));
        let evaluator = Evaluator::new(&problem, &Run::to_the_end()).with_budget(Some(5));
        assert_eq!((evaluator.affordable(5), evaluator.stopped()), (5, None));
        evaluator.ask(&points(&[0.0, 1.0, 2.0]));
        assert_eq!((evaluator.remaining(), evaluator.affordable(4)), (Some(2), 2));
        assert_eq!(evaluator.stopped(), Some(StopReason::Budget));
        // A continued ledger has used up its part of the budget.
        let later = Evaluator::new(&problem, &Run::to_the_end()).with_budget(Some(5)).with_ledger(evaluator.ledger());
        assert_eq!((later.remaining(), later.part().remaining()), (Some(2), Some(2)));
    }

    /// Parts of a batch have ledgers of their own, which add up to one stage.
    #[test]
    fn parts_add_up_to_one_batch() {
        let problem = problem(Closure::scalar("y", |x| if x[0] > 1.5 { f64::NAN } else { x[0] }));
        let evaluator = Evaluator::new(&problem, &Run::to_the_end()).with_seed(7);
        let part = |a: &[f64]| {
            let part = evaluator.part();
            part.ask(&points(a));
            assert_eq!(part.seed(), 7);
            part.into_ledger()
        };
        evaluator.merge(Ledger::of_batch([part(&[0.0, 1.0]), part(&[2.0, 3.0, 1.0])]));
        let run = evaluator.summary();
        assert_eq!((run.evaluations, run.failed, run.stages, run.stopped), (5, 2, 1, None));
    }
}
