//! Summary of a run of any kind: points, time, seed, and the reason for an early end.

use std::fmt;
use std::time::Duration;

use serde::Serialize;

use sensitol_numeric::json_form::seconds;

/// Reason for the end of a run before all planned points were evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StopReason {
    /// The time limit has passed.
    TimeLimit,
    /// The budget of evaluations is used up. A result from fewer points is complete: no planned point is open.
    Budget,
    /// A person interrupted the run.
    Interrupted,
    /// The calling program requested the end, without another reason.
    Requested,
}

impl StopReason {
    /// True if planned points are open. A budget is part of the plan. All other reasons cut it short.
    pub(crate) fn leaves_points_open(self) -> bool {
        self != Self::Budget
    }
}

/// Text that completes the words `stopped by`.
impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TimeLimit => "the time limit",
            Self::Budget => "the budget",
            Self::Interrupted => "an interruption",
            Self::Requested => "its caller",
        })
    }
}

/// Cost of a run and the reason for its end. Every result has one.
///
/// ```
/// use sensitol::{Closure, Dimension, Method, Problem, analyze};
/// let dimensions = [Dimension::normal("a", 10.0, 0.3)?, Dimension::normal("b", 5.0, 0.4)?];
/// let gap = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1]))?;
/// let run = analyze(&gap, &Method::Full.into())?.run;
/// assert_eq!((run.evaluations, run.failed, run.stopped), (7, 0, None));
/// # Ok::<(), sensitol::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RunSummary {
    /// Points sent to the model, including those sent again.
    pub evaluations: u64,
    /// Points whose answers were known from an earlier run.
    pub cached: u64,
    /// Points sent again, because an answer was a failure or was not trusted.
    pub retried: u64,
    /// Points without a value of at least one characteristic.
    pub failed: u64,
    /// Batches in which points were sent.
    pub stages: u64,
    /// Time from the first evaluation to the result.
    #[serde(rename = "wall_s", serialize_with = "seconds")]
    #[cfg_attr(feature = "schema", schemars(with = "f64"))]
    pub wall: Duration,
    /// Time within the model, of all threads together.
    #[serde(rename = "in_model_s", serialize_with = "seconds")]
    #[cfg_attr(feature = "schema", schemars(with = "f64"))]
    pub in_model: Duration,
    /// The seed, if random numbers were drawn.
    pub seed: Option<u64>,
    /// Reason for an early end. None if the run was completed.
    pub stopped: Option<StopReason>,
    /// Starts, crashes and retries of the processes of an external model. None if there is no external model.
    pub evaluator: Option<EvaluatorSummary>,
}

/// Starts, crashes and retries of the processes of an external model since it was made.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EvaluatorSummary {
    /// Processes that were started, including the first one of every worker.
    pub starts: u64,
    /// Processes that ended while points were under way, or before they were ready.
    pub crashes: u64,
    /// Deadlines that were missed.
    pub timeouts: u64,
    /// Lines that were not valid answers.
    pub garbage: u64,
    /// Points that were sent again.
    pub retried: u64,
    /// Seconds from the last answer of each failed process until its replacement was ready.
    pub lost_s: f64,
    /// Answers that no fresh process confirmed: they depend on the points before them, or the run ended before their check. They have no
    /// value, or entered results before that was known.
    pub unconfirmed: u64,
}

impl EvaluatorSummary {
    /// Sum with the counts of another model.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            starts: self.starts + other.starts,
            crashes: self.crashes + other.crashes,
            timeouts: self.timeouts + other.timeouts,
            garbage: self.garbage + other.garbage,
            retried: self.retried + other.retried,
            lost_s: self.lost_s + other.lost_s,
            unconfirmed: self.unconfirmed + other.unconfirmed,
        }
    }

    /// Failures of processes of every kind.
    pub(crate) fn failures(&self) -> u64 {
        self.crashes + self.timeouts + self.garbage
    }
}

impl RunSummary {
    /// Sum with another part of the same work. Counts and times add up. The first stop reason that leaves points open is kept.
    pub(crate) fn and(self, other: &Self) -> Self {
        let open = |stopped: &Option<StopReason>| stopped.is_some_and(StopReason::leaves_points_open);
        Self {
            evaluations: self.evaluations + other.evaluations,
            cached: self.cached + other.cached,
            retried: self.retried + other.retried,
            failed: self.failed + other.failed,
            stages: self.stages + other.stages,
            wall: self.wall + other.wall,
            in_model: self.in_model + other.in_model,
            seed: self.seed.or(other.seed),
            stopped: if open(&other.stopped) && !open(&self.stopped) {
                other.stopped
            } else {
                self.stopped.or(other.stopped)
            },
            // Use the later of two parts: it counts from the start of the model, and includes the earlier part.
            evaluator: match (self.evaluator, other.evaluator) {
                (Some(a), Some(b)) => Some(if b.starts >= a.starts && b.retried >= a.retried { b } else { a }),
                (a, b) => a.or(b),
            },
        }
    }

    /// True if results may rest on answers that a fresh process should have confirmed and did not.
    pub fn unconfirmed(&self) -> bool {
        self.evaluator.is_some_and(|evaluator| evaluator.unconfirmed > 0)
    }

    /// True if the run was stopped before all planned points were evaluated. There is no verdict then.
    pub fn unfinished(&self) -> bool {
        self.stopped.is_some_and(StopReason::leaves_points_open)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A budget that ended one part must not hide an interruption of another.
    #[test]
    fn the_reason_that_leaves_points_open_is_kept() {
        let of = |stopped| RunSummary { evaluations: 2, stopped, ..RunSummary::default() };
        let budget = of(Some(StopReason::Budget));
        let time = of(Some(StopReason::TimeLimit));
        for both in [budget.and(&time), time.and(&budget)] {
            assert_eq!((both.stopped, both.evaluations, both.unfinished()), (Some(StopReason::TimeLimit), 4, true));
        }
        assert!(!budget.and(&of(None)).unfinished() && of(None).stopped.is_none());
    }
}
