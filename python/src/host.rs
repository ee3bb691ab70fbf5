//! A Python callable as assembly function: its calls are passed to the thread that started the run.

use std::sync::mpsc::{Sender, SyncSender, sync_channel};

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

/// What the threads of a run tell the thread that started it.
pub(crate) enum Event<T> {
    /// Points to be evaluated.
    Call(Call),
    /// The run is over.
    Done(T),
}

/// A model that another thread answers.
pub(crate) struct Host<T> {
    signature: Signature,
    events: Sender<Event<T>>,
}

impl<T> Host<T> {
    /// Of this signature. Where it is `cheap`, tens of thousands of evaluations go unnoticed.
    pub(crate) fn new(signature: Signature, cheap: bool, events: Sender<Event<T>>) -> Self {
        Self { signature: Signature { costly: !cheap, cheap, ..signature }, events }
    }
}

impl<T: Send> AssemblyFunction for Host<T> {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        if run.stopped() {
            return;
        }
        let points = request.points;
        let values: Vec<f64> = (0..points.dimensions()).flat_map(|d| points.column(d)).copied().collect();
        let (reply, answer) = sync_channel(1);
        let call = Call { values, rows: points.rows(), outputs: request.outputs.to_vec(), reply };
        // Whoever does not listen any more has stopped the run.
        if self.events.send(Event::Call(call)).is_err() {
            return;
        }
        let Ok(Some(Answer { values, failed, reused })) = answer.recv() else { return };
        for (column, values) in values.chunks_exact(points.rows().max(1)).enumerate() {
            values.iter().enumerate().for_each(|(row, &value)| out.set(row, column, value));
        }
        for (row, message) in failed {
            for column in 0..request.outputs.len() {
                out.fail(row, column, EvaluationError::Refused { message: message.clone() });
            }
        }
        if reused > 0 {
            out.reused(reused);
        }
        let all: Vec<usize> = (0..points.rows()).collect();
        run.finished(&all, out);
    }
}
