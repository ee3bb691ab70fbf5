//! Conditions under which a batch is evaluated.

use crate::assembly::Responses;
use crate::summary::StopReason;

/// Callback for rows that are final, with the responses that hold them.
type Finished<'a> = dyn Fn(&[usize], &Responses) + Sync + 'a;

/// Callback for rows whose answers are not trusted any more.
type Withdrawn<'a> = dyn Fn(&[usize]) + Sync + 'a;

/// Callback that returns the reason to stop, or None while there is none.
type Stop<'a> = dyn Fn() -> Option<StopReason> + Sync + 'a;

/// Points that a costly model has finished, as they come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Progress {
    /// Points that are answered, by the model or from known answers.
    pub points: usize,
    /// Answered points with an output that has no value.
    pub failed: usize,
    /// Answered points that were known already.
    pub reused: usize,
}

/// Conditions under which a batch is evaluated: callbacks for finished rows, and a stop.
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

    /// Sets the callback for rows that become final.
    pub fn telling(self, finished: &'a Finished<'a>) -> Self {
        Self { finished: Some(finished), ..self }
    }

    /// Stops as soon as `stop` returns a reason. From then on it must keep returning one.
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

    /// Stops at once if `abandon` returns true, without waiting for points in progress.
    #[doc(hidden)]
    pub fn abandoning_when(self, abandon: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { abandon: Some(abandon), ..self }
    }

    /// Sets the callback for the progress of costly models. Cheap models do not report progress.
    pub fn showing(self, progress: &'a (dyn Fn(Progress) + Sync)) -> Self {
        Self { progress: Some(progress), ..self }
    }

    /// Sets the callback for rows that were final and are not trusted any more. Rows that are answered again are reported as final again.
    pub fn withdrawing(self, withdrawn: &'a Withdrawn<'a>) -> Self {
        Self { withdrawn: Some(withdrawn), ..self }
    }

    /// Removes the reports: a part of an answer is not an answer yet.
    pub(crate) fn quiet(self) -> Self {
        Self { finished: None, ..self }
    }

    /// Removes the reports of points that are not those of the caller: their rows are others.
    pub(crate) fn apart(self) -> Self {
        Self { finished: None, withdrawn: None, ..self }
    }

    /// Removes the stop, for quick work that follows from costly answers.
    pub(crate) fn unstopped(self) -> Self {
        Self { stop: None, ..self }
    }

    /// True if finished rows are reported.
    pub(crate) fn tells(&self) -> bool {
        self.finished.is_some()
    }

    /// Reports that these rows of `out` are final: values or errors, for every requested output.
    pub fn finished(&self, rows: &[usize], out: &Responses) {
        if let Some(finished) = self.finished {
            finished(rows, out);
        }
    }

    /// Reports that these rows, which were final, are not trusted any more.
    pub fn withdraw(&self, rows: &[usize]) {
        if let Some(withdrawn) = self.withdrawn {
            withdrawn(rows);
        }
    }

    /// Reports that a costly model has finished more points.
    pub fn progressed(&self, progress: Progress) {
        if let Some(show) = self.progress {
            show(progress);
        }
    }

    /// True if the function must return at once, without waiting for points in progress.
    pub fn abandoned(&self) -> bool {
        self.abandon.is_some_and(|abandon| abandon())
    }

    /// Returns the conditions of a part of the work, which reports to `finished` and is stopped by `stop`.
    pub fn within<'b>(&'b self, finished: &'b Finished<'b>, stop: &'b Stop<'b>) -> Run<'b> {
        Run { finished: Some(finished), stop: Some(stop), withdrawn: None, ..*self }
    }

    /// True if the function must return now, with the answers so far.
    pub fn stopped(&self) -> bool {
        self.stop_reason().is_some()
    }

    /// Returns the reason to return now, or None while there is none.
    pub fn stop_reason(&self) -> Option<StopReason> {
        self.stop.and_then(|stop| stop())
    }

    /// Returns the reason why open points were not evaluated. A run that was stopped without a reason was stopped on request.
    pub(crate) fn why_open(&self) -> StopReason {
        self.stop_reason().unwrap_or(if self.abandoned() { StopReason::Interrupted } else { StopReason::Requested })
    }
}
