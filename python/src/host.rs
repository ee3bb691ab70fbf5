//! A Python callable as assembly function: its calls are passed to the thread that started the run.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, SyncSender, sync_channel};
use std::time::Instant;

use sensitol::assembly::{AssemblyFunction, EvaluationError, Request, Responses, Run, Signature};

/// Points to be evaluated.
pub(crate) struct Call {
    /// The coordinates, a dimension after the other.
    pub(crate) values: Vec<f64>,
    /// How many points.
    pub(crate) rows: usize,
    /// The outputs wanted.
    pub(crate) outputs: Vec<usize>,
    /// Where the answer goes.
    pub(crate) reply: SyncSender<Option<Answer>>,
}

/// The answers to a call; none where the run is stopped.
pub(crate) struct Answer {
    /// An output after the other.
    pub(crate) values: Vec<f64>,
    /// Points without a value, and why.
    pub(crate) failed: Vec<(usize, String)>,
    /// How many points were known from an earlier run.
    pub(crate) reused: usize,
}

/// The messages from the threads of a run to the thread that started it.
pub(crate) enum Event<T> {
    /// Points to be evaluated.
    Call(Call),
    /// The run is over.
    Done(T),
}

/// How long the points of a call should take where they are sent in portions: so often a stop is looked for, and progress is shown.
const PORTION: f64 = 0.1;

/// A model that another thread answers.
pub(crate) struct Host<T> {
    signature: Signature,
    events: Sender<Event<T>>,
    /// Points of a portion; none where every block is sent as a whole.
    portion: Option<AtomicUsize>,
}

impl<T> Host<T> {
    /// Of this signature. Where it is `cheap`, tens of thousands of evaluations go unnoticed; where it is `whole`, blocks are not cut: a
    /// vectorized function could answer parts in other bits, and an executor wants everything at once.
    pub(crate) fn new(signature: Signature, (cheap, whole): (bool, bool), events: Sender<Event<T>>) -> Self {
        let portion = (!whole).then(|| AtomicUsize::new(1));
        Self { signature: Signature { costly: !cheap, cheap, ..signature }, events, portion }
    }

    /// Sends these rows; whether they were answered.
    fn ask(&self, request: &Request<'_>, rows: Range<usize>, out: &mut Responses) -> bool {
        let points = request.points;
        let values = (0..points.dimensions()).flat_map(|d| &points.column(d)[rows.clone()]).copied().collect();
        let (reply, answer) = sync_channel(1);
        let call = Call { values, rows: rows.len(), outputs: request.outputs.to_vec(), reply };
        // Whoever does not listen any more has stopped the run.
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
