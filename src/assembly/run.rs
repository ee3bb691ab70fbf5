//! The conditions under which a batch is evaluated.

use super::Responses;
use crate::summary::StopReason;

/// Called with rows that are final, and the responses that hold them.
type Finished<'a> = dyn Fn(&[usize], &Responses) + Sync + 'a;

/// Called with rows whose answers are not trusted any more.
type Withdrawn<'a> = dyn Fn(&[usize]) + Sync + 'a;

/// Says why to stop, and None as long as there is no reason.
type Stop<'a> = dyn Fn() -> Option<StopReason> + Sync + 'a;

/// Points that a costly model has done with, as they come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Progress {
    /// Points that are answered, by the model or from what is known.
    pub points: usize,
    /// Those of them with an output that has no value.
    pub failed: usize,
    /// Those of them that were known already.
    pub reused: usize,
}

/// How a batch is to be evaluated: whom to tell of finished rows, and whether to stop.
///
/// ```
/// use sensitol::assembly::Run;
/// assert!(!Run::to_the_end().stopped());
/// ```
#[derive(Clone, Copy, Default)]
pub struct Run<'a> {
    finished: Option<&'a Finished<'a>>,
    stop: Option<&'a Stop<'a>>,
    abandon: Option<&'a (dyn Fn() -> bool + Sync)>,
    progress: Option<&'a (dyn Fn(Progress) + Sync)>,
    withdrawn: Option<&'a Withdrawn<'a>>,
}

impl<'a> Run<'a> {
    /// Evaluates everything and reports nothing.
    pub fn to_the_end() -> Self {
        Self::default()
    }

    /// Tells `finished` of rows as they become final.
    pub fn telling(self, finished: &'a Finished<'a>) -> Self {
        Self { finished: Some(finished), ..self }
    }

    /// Stops as soon as `stop` says why; from then on it must go on saying so.
    ///
    /// ```
    /// use sensitol::StopReason;
    /// use sensitol::assembly::Run;
    /// let stop = || Some(StopReason::TimeLimit);
    /// assert!(Run::to_the_end().stopping_when(&stop).stopped());
    /// ```
    pub fn stopping_when(self, stop: &'a Stop<'a>) -> Self {
        Self { stop: Some(stop), ..self }
    }

    /// Gives up at once, with what is under way, when `abandon` says so.
    #[doc(hidden)]
    pub fn abandoning_when(self, abandon: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { abandon: Some(abandon), ..self }
    }

    /// Tells `progress` of the points of costly models, which others keep to themselves.
    pub fn showing(self, progress: &'a (dyn Fn(Progress) + Sync)) -> Self {
        Self { progress: Some(progress), ..self }
    }

    /// Tells `withdrawn` of rows that were final and are not trusted any more; those that are answered again are told anew.
    pub fn withdrawing(self, withdrawn: &'a Withdrawn<'a>) -> Self {
        Self { withdrawn: Some(withdrawn), ..self }
    }

    /// The same, without reports: for a part of an answer that is not an answer yet.
    pub(crate) fn quiet(self) -> Self {
        Self { finished: None, ..self }
    }

    /// The same, without a stop: for what follows quickly from answers that were paid for.
    pub(crate) fn unstopped(self) -> Self {
        Self { stop: None, ..self }
    }

    /// Whether anybody is told of finished rows.
    pub(crate) fn tells(&self) -> bool {
        self.finished.is_some()
    }

    /// These rows of `out` are final: values or errors, for every output asked.
    pub fn finished(&self, rows: &[usize], out: &Responses) {
        if let Some(finished) = self.finished {
            finished(rows, out);
        }
    }

    /// These rows, told of as final, are not trusted any more.
    pub fn withdraw(&self, rows: &[usize]) {
        if let Some(withdrawn) = self.withdrawn {
            withdrawn(rows);
        }
    }

    /// A costly model has done with more points.
    pub fn progressed(&self, progress: Progress) {
        if let Some(show) = self.progress {
            show(progress);
        }
    }

    /// Whether to return at once: even what is under way is not waited for.
    pub fn abandoned(&self) -> bool {
        self.abandon.is_some_and(|abandon| abandon())
    }

    /// The conditions of a part of the work: told to `finished` rather than to whom this one tells, and stopped by `stop`.
    pub fn within<'b>(&'b self, finished: &'b Finished<'b>, stop: &'b Stop<'b>) -> Run<'b> {
        Run { finished: Some(finished), stop: Some(stop), withdrawn: None, ..*self }
    }

    /// Whether to return now, with what is answered so far.
    pub fn stopped(&self) -> bool {
        self.stop_reason().is_some()
    }

    /// Why to return now; None as long as there is no reason.
    pub fn stop_reason(&self) -> Option<StopReason> {
        self.stop.and_then(|stop| stop())
    }

    /// Why what is open was not evaluated: whoever stopped a run without a reason asked for its end.
    pub(crate) fn why_open(&self) -> StopReason {
        self.stop_reason().unwrap_or(if self.abandoned() { StopReason::Interrupted } else { StopReason::Requested })
    }
}
