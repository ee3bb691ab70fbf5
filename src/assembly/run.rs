//! The conditions under which a batch is evaluated.

use super::Responses;

/// Called with rows that are final, and the responses that hold them.
type Finished<'a> = dyn Fn(&[usize], &Responses) + Sync + 'a;

/// How a batch is to be evaluated: whom to tell of finished rows, and whether to stop.
///
/// ```
/// use sensitol::assembly::Run;
/// assert!(!Run::to_the_end().stopped());
/// ```
#[derive(Clone, Copy, Default)]
pub struct Run<'a> {
    finished: Option<&'a Finished<'a>>,
    stop: Option<&'a (dyn Fn() -> bool + Sync)>,
}

impl<'a> Run<'a> {
    /// Evaluates everything and tells nobody.
    pub fn to_the_end() -> Self {
        Self::default()
    }

    /// Tells `finished` of rows as they become final.
    pub fn telling(self, finished: &'a Finished<'a>) -> Self {
        Self { finished: Some(finished), ..self }
    }

    /// Stops as soon as `stop` says so.
    pub fn stopping_when(self, stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { stop: Some(stop), ..self }
    }

    /// The same, telling nobody: for a part of an answer that is no answer yet.
    pub fn quiet(self) -> Self {
        Self { finished: None, ..self }
    }

    /// These rows of `out` are final: values or errors, for every output asked.
    pub fn finished(&self, rows: &[usize], out: &Responses) {
        if let Some(finished) = self.finished {
            finished(rows, out);
        }
    }

    /// Whether to return now, with what is answered so far.
    pub fn stopped(&self) -> bool {
        self.stop.is_some_and(|stop| stop())
    }
}
