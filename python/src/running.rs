//! Runs: the engine works on a pool, while the calling thread evaluates points, checks for signals and shows progress.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList};
use sensitol::StopReason;
use sensitol::assembly::Run;
use sensitol_report::task::{Asked, TaskReport, done};
use sensitol_study::AnyError;
use sensitol_study::Study;

use crate::host::{Answer, Call, Event};
use crate::pools::Pool;

/// Time that the calling thread waits between two checks for signals.
const TICK: Duration = Duration::from_millis(20);

/// Result of a run. None if the engine panicked.
pub(crate) type Ended = Option<Result<TaskReport, Box<AnyError>>>;

/// Conditions that end a run.
#[derive(Default)]
struct Stop {
    /// True after Ctrl-C or an exception of the model.
    asked: AtomicBool,
    deadline: Option<Instant>,
}

impl Stop {
    fn reason(&self) -> Option<StopReason> {
        if self.asked.load(Ordering::Relaxed) {
            return Some(StopReason::Interrupted);
        }
        self.deadline.filter(|deadline| Instant::now() >= *deadline).map(|_| StopReason::TimeLimit)
    }
}

/// Progress of a run: answered points, and expected points (0 if unknown).
#[derive(Debug, Default)]
struct Counter {
    points: AtomicU64,
    expected: AtomicU64,
}

impl Counter {
    fn tell(&self, points: u64, expected: u64) {
        self.points.store(points, Ordering::Relaxed);
        self.expected.store(expected, Ordering::Relaxed);
    }
}

/// Tasks of the calling thread while it waits.
pub(crate) struct Caller<'py> {
    /// Function that evaluates blocks of points.
    pub(crate) model: Option<Bound<'py, PyAny>>,
    /// Function that receives the answered and expected points.
    pub(crate) progress: Option<Bound<'py, PyAny>>,
    /// True if an interrupted run returns its results so far.
    pub(crate) partial: bool,
}

/// Runs a command on a study. `events` receives the calls of the study's model, and the end of the run from `ended`.
///
/// An exception of the model or of a signal ends the run and is raised unchanged.
pub(crate) fn run(
    py: Python<'_>,
    (study, asked): (Study, Asked),
    (threads, seconds): (usize, Option<f64>),
    caller: &Caller<'_>,
    events: Receiver<Event<Ended>>,
    ended: std::sync::mpsc::Sender<Event<Ended>>,
) -> PyResult<Result<TaskReport, Box<AnyError>>> {
    let pool = Pool::of(threads).map_err(|error| PyRuntimeError::new_err(format!("no threads: {error}")))?;
    let deadline =
        seconds.and_then(|s| Duration::try_from_secs_f64(s).ok()).and_then(|s| Instant::now().checked_add(s));
    let stop = Arc::new(Stop { asked: AtomicBool::new(false), deadline });
    let counter = Arc::new(Counter::default());
    let (stopped, counted) = (Arc::clone(&stop), Arc::clone(&counter));
    pool.spawn(move || {
        let result = catch_unwind(AssertUnwindSafe(|| answer(&study, &asked, &stopped, &counted))).ok();
        // Children of an external model end with the study, before the caller goes on; after Ctrl-C it does not wait for children that
        // take their time to end.
        if stopped.asked.load(Ordering::Relaxed) {
            let _ = ended.send(Event::Done(result));
            return;
        }
        drop(study);
        let _ = ended.send(Event::Done(result));
    });
    let mut serving = Serving { caller, stop: &stop, counter: &counter, raised: None, shown: Instant::now() };
    let events = Mutex::new(events);
    let result = serving.until_done(py, &events);
    serving.conclude(py, result)
}

/// Answers a question to a study on the thread of the engine.
fn answer(study: &Study, asked: &Asked, stop: &Stop, counter: &Counter) -> Result<TaskReport, Box<AnyError>> {
    let reason = || stop.reason();
    let abandoned = || stop.asked.load(Ordering::Relaxed);
    let run = Run::to_the_end().stopping_when(&reason).abandoning_when(&abandoned);
    let mut found = done(study, asked, &run, &|answered, expected| counter.tell(answered, expected))?;
    if let Some(account) = study.problem.function().account() {
        found.not_kept = account.not_kept.or(account.fails_everywhere.map(|error| error.to_string()));
    }
    Ok(found)
}

/// The calling thread while the engine works.
struct Serving<'s, 'py> {
    caller: &'s Caller<'py>,
    stop: &'s Stop,
    counter: &'s Counter,
    /// The first exception of the model or of a signal.
    raised: Option<PyErr>,
    /// The moment when progress was shown last.
    shown: Instant,
}

impl Serving<'_, '_> {
    /// Evaluates points, looks for signals and shows progress until the engine is done.
    fn until_done(&mut self, py: Python<'_>, events: &Mutex<Receiver<Event<Ended>>>) -> Ended {
        loop {
            let wait = || events.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(TICK);
            match py.detach(wait) {
                Ok(Event::Done(result)) => return result,
                Ok(Event::Call(call)) => self.reply(py, call),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return None,
            }
            if self.raised.is_none()
                && let Err(error) = self.look(py)
            {
                self.raise(error);
            }
        }
    }

    /// Stops the engine for an exception.
    fn raise(&mut self, error: PyErr) {
        self.stop.asked.store(true, Ordering::Relaxed);
        self.raised = Some(error);
    }

    /// Replies to a call of the model; without values once an exception was raised.
    fn reply(&mut self, py: Python<'_>, call: Call) {
        let answered = if self.raised.is_some() { Ok(None) } else { evaluated(py, self.caller, &call).map(Some) };
        let answer = answered.unwrap_or_else(|error| {
            self.raise(error);
            None
        });
        if answer.is_some() {
            self.counter.points.fetch_add(call.rows as u64, Ordering::Relaxed);
        }
        // Who asked may have been stopped meanwhile.
        let _ = call.reply.send(answer);
    }

    /// Looks for signals, and shows progress from time to time.
    fn look(&mut self, py: Python<'_>) -> PyResult<()> {
        py.check_signals()?;
        match &self.caller.progress {
            Some(progress) if self.shown.elapsed() >= TICK => {
                self.shown = Instant::now();
                let count = |value: &AtomicU64| value.load(Ordering::Relaxed);
                progress.call1((count(&self.counter.points), count(&self.counter.expected))).map(drop)
            }
            _ => Ok(()),
        }
    }

    /// Raises the exception of a run, or returns its result with the last progress.
    fn conclude(self, py: Python<'_>, result: Ended) -> PyResult<Result<TaskReport, Box<AnyError>>> {
        let caller = self.caller;
        match (self.raised, result) {
            (Some(error), Some(Ok(found))) if caller.partial && error.is_instance_of::<PyKeyboardInterrupt>(py) => {
                Ok(Ok(found))
            }
            (Some(error), _) => Err(error),
            (None, Some(result)) => {
                if let Some(progress) = &caller.progress {
                    let points = self.counter.points.load(Ordering::Relaxed);
                    progress.call1((points, points))?;
                }
                Ok(result)
            }
            (None, None) => Err(PyRuntimeError::new_err(
                "the engine failed; please report it with the study and the model, at the address of the package",
            )),
        }
    }
}

/// Evaluates a block of points with the model.
fn evaluated(py: Python<'_>, caller: &Caller<'_>, call: &Call) -> PyResult<Answer> {
    let Some(model) = &caller.model else {
        return Err(PyRuntimeError::new_err("a study without a model of Python asked for one"));
    };
    let points = PyBytes::new_with(py, call.values.len() * size_of::<f64>(), |bytes| {
        for (place, value) in bytes.chunks_exact_mut(size_of::<f64>()).zip(&call.values) {
            place.copy_from_slice(&value.to_ne_bytes());
        }
        Ok(())
    })?;
    let answer = model.call1((points, call.rows, PyList::new(py, &call.outputs)?))?;
    let (values, failed, reused): (Bound<'_, PyBytes>, Vec<(usize, String)>, usize) = answer.extract()?;
    let number = |bytes: &[u8]| f64::from_ne_bytes(bytes.try_into().expect("chunks of eight bytes"));
    let values: Vec<f64> = values.as_bytes().chunks_exact(size_of::<f64>()).map(number).collect();
    if values.len() != call.rows * call.outputs.len() {
        return Err(PyRuntimeError::new_err("the package answered another number of values than asked for"));
    }
    Ok(Answer { values, failed, reused })
}
