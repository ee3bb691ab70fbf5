//! A Python callable as assembly function. Its calls go to the thread that started the run.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, SyncSender, sync_channel};
use std::time::Instant;

use sensitol::assembly::{AssemblyFunction, EvaluationError, Request, Responses, Run, Signature};

/// Request for the values of some points.
pub(crate) struct Call {
    /// Values of all points for the first dimension, then for the next one.
    pub(crate) values: Vec<f64>,
    /// Number of points.
    pub(crate) rows: usize,
    /// Indices of the requested outputs.
    pub(crate) outputs: Vec<usize>,
    /// Channel for the answer. None is sent if the run is stopped.
    pub(crate) reply: SyncSender<Option<Answer>>,
}

/// Values of the points of a call.
pub(crate) struct Answer {
    /// Values of all points for the first output, then for the next one.
    pub(crate) values: Vec<f64>,
    /// Indices of points without a value, each with the reason.
    pub(crate) failed: Vec<(usize, String)>,
    /// Number of points known from an earlier run.
    pub(crate) reused: usize,
}

/// Message from the threads of a run to the thread that started it.
pub(crate) enum Event<T> {
    /// Request for the values of points.
    Call(Call),
    /// End of the run.
    Done(T),
}

/// Target time of a portion of points, in seconds. Between portions, signals are checked and progress is shown.
const PORTION: f64 = 0.1;

/// Model that another thread evaluates.
pub(crate) struct Host<T> {
    signature: Signature,
    events: Sender<Event<T>>,
    /// Points of a portion. None if every block is sent as a whole.
    portion: Option<AtomicUsize>,
}

impl<T> Host<T> {
    /// Returns a host with this signature. A `cheap` model allows tens of thousands of evaluations. The blocks of a `whole` one are never
    /// cut: a vectorized function may round differently on parts, and an executor needs all points at once.
    pub(crate) fn new(signature: Signature, (cheap, whole): (bool, bool), events: Sender<Event<T>>) -> Self {
        let portion = (!whole).then(|| AtomicUsize::new(1));
        Self { signature: Signature { costly: !cheap, cheap, ..signature }, events, portion }
    }

    /// Sends these rows and stores the answers. Returns false if the run was stopped.
    fn ask(&self, request: &Request<'_>, rows: Range<usize>, out: &mut Responses) -> bool {
        let points = request.points;
        let values = (0..points.dimensions()).flat_map(|d| &points.column(d)[rows.clone()]).copied().collect();
        let (reply, answer) = sync_channel(1);
        let call = Call { values, rows: rows.len(), outputs: request.outputs.to_vec(), reply };
        // A closed channel means that the run was stopped.
        if self.events.send(Event::Call(call)).is_err() {
            return false;
        }
        let Ok(Some(Answer { values, failed, reused })) = answer.recv() else { return false };
        for (column, values) in values.chunks_exact(rows.len()).enumerate() {
            values.iter().zip(rows.clone()).for_each(|(&value, row)| out.set(row, column, value));
        }
        for (row, message) in failed {
            for column in 0..request.outputs.len() {
                out.fail(rows.start + row, column, EvaluationError::Refused { message: message.clone() });
            }
        }
        if reused > 0 {
            out.reused(reused);
        }
        true
    }
}

impl<T: Send> AssemblyFunction for Host<T> {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        let all = request.points.rows();
        let mut first = 0;
        while first < all && !run.stopped() {
            let size = self.portion.as_ref().map_or(all, |portion| portion.load(Ordering::Relaxed));
            let rows = first..(first + size).min(all);
            let begun = Instant::now();
            if !self.ask(request, rows.clone(), out) {
                return;
            }
            if let Some(portion) = &self.portion {
                let each = begun.elapsed().as_secs_f64() / rows.len() as f64;
                portion.store((PORTION / each.max(1e-9)).clamp(1.0, 65_536.0) as usize, Ordering::Relaxed);
            }
            first = rows.end;
            run.finished(&rows.collect::<Vec<_>>(), out);
        }
    }
}
