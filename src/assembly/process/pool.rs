//! Children side by side, and the points under way in each.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use super::Settings;
use super::batch::Batch;
use super::child::{Child, Event, What};
use super::error::{ProcessError, ProcessFault, Quoted, StderrTail};
use super::protocol::{Adapter, Hello, Line, VERSION, request};
use super::sentinel::{Reference, SENTINEL, interval, values};
use crate::assembly::{Points, Responses, Run};

/// How often a stop is looked for.
const TICK: Duration = Duration::from_millis(50);
/// The first pause before a child that failed is started again; it doubles with every failure in a row.
const PAUSE: Duration = Duration::from_millis(50);
const LONGEST_PAUSE: Duration = Duration::from_secs(5);
/// The longest deadline, some thirty years: a later moment may be more than the clock can hold.
const FOREVER: Duration = Duration::from_secs(1_000_000_000);
/// Starts in a row that may fail before no more are tried.
const STARTS: u32 = 4;

/// The children of one model, asked for one choice of outputs.
pub(super) struct Pool {
    settings: Settings,
    hello: Hello,
    slots: Vec<Slot>,
    events: (Sender<Event>, Receiver<Event>),
    /// Number of the next child, and of the next point.
    next_child: u64,
    next_point: u64,
    /// Starts in a row that failed.
    failed_starts: u32,
    adapter: Option<Adapter>,
    reference: Reference,
}

/// A place for one child.
#[derive(Default)]
struct Slot {
    state: State,
    /// Failures since the last answer.
    failures: u32,
}

#[derive(Default)]
enum State {
    /// No child, and none wanted yet.
    #[default]
    Empty,
    /// No child before this moment.
    Pausing(Instant),
    /// A child that has not said that it is ready.
    Starting(Child, Instant),
    Ready(Worker),
}

struct Worker {
    child: Child,
    window: usize,
    /// Points under way, in the order in which they were sent: number and row.
    under_way: VecDeque<(u64, usize)>,
    /// Since when the oldest of them is being waited for.
    since: Instant,
    /// The number of the first point that it was sent.
    first: u64,
    /// Rows that it has answered since it was last known to be right.
    unchecked: Vec<usize>,
    /// Whether it had no value somewhere: a failed request may poison later ones.
    troubled: bool,
}

impl Pool {
    pub(super) fn new(mut settings: Settings, hello: Hello) -> Self {
        settings.timeout = settings.timeout.min(FOREVER);
        settings.start_timeout = settings.start_timeout.min(FOREVER);
        let slots = (0..settings.workers.max(1)).map(|_| Slot::default()).collect();
        Self {
            settings,
            hello,
            slots,
            events: channel(),
            next_child: 0,
            next_point: 0,
            failed_starts: 0,
            adapter: None,
            reference: Reference::default(),
        }
    }

    pub(super) fn asks(&self, characteristics: &[String]) -> bool {
        self.hello.characteristics == characteristics
    }

    /// Starts one child and waits until it is ready: whether the model can be used at all.
    pub(super) fn prepare(&mut self) -> Result<&Adapter, ProcessError> {
        while self.adapter.is_none() {
            if matches!(self.slots[0].state, State::Empty | State::Pausing(_)) {
                self.start(0)?;
            }
            self.turn(&mut None)?;
        }
        Ok(self.adapter.as_ref().expect("a child is ready"))
    }

    /// Evaluates every row of `points`; what a stop leaves undone stays open, but what is under way is waited for.
    pub(super) fn evaluate(&mut self, points: &Points, run: &Run<'_>, out: &mut Responses) {
        let rows = points.rows();
        let mut batch = Some(Batch::new(points, out));
        loop {
            let stopping = run.stopped();
            if run.abandoned() {
                break;
            }
            let work = batch.as_mut().expect("a batch");
            let checked = work.left == 0 && self.slots.iter().all(Slot::is_checked);
            if checked || (stopping && !self.busy()) {
                break;
            }
            let dispatched = if stopping { Ok(()) } else { self.dispatch(work) };
            let turned = dispatched.and_then(|()| self.turn(&mut batch));
            let work = batch.as_mut().expect("a batch");
            if let Err(error) = turned {
                // No child can be had any more.
                work.give_up(&error);
                work.tell(run);
                break;
            }
            work.tell(run);
        }
        let work = batch.expect("a batch");
        work.out.spent(work.sent as i64 - (rows - work.left) as i64);
        work.out.retried(work.resent);
        // After giving up, somebody may still work on points of this batch: the next one must not hear of them.
        for slot in &mut self.slots {
            if let State::Ready(worker) = &mut slot.state {
                worker.unchecked.clear();
                if !worker.under_way.is_empty() {
                    worker.child.kill();
                    slot.state = State::Empty;
                }
            }
        }
    }

    fn busy(&self) -> bool {
        self.slots.iter().any(|slot| matches!(&slot.state, State::Ready(worker) if !worker.under_way.is_empty()))
    }

    /// Starts children where there is work for them, and gives every ready one as much as it may have.
    fn dispatch(&mut self, batch: &mut Batch<'_>) -> Result<(), ProcessError> {
        let now = Instant::now();
        let mut wanted = batch.waiting.len() + batch.suspects.len();
        for index in 0..self.slots.len() {
            let start = match &self.slots[index].state {
                State::Empty => wanted > 0,
                State::Pausing(until) => wanted > 0 && *until <= now,
                State::Starting(..) => false,
                State::Ready(_) => {
                    self.give(index, batch);
                    wanted = batch.waiting.len() + batch.suspects.len();
                    continue;
                }
            };
            // One child for each window of points: no more than there is work for.
            wanted = wanted.saturating_sub(self.adapter.as_ref().map_or(1, |adapter| adapter.window));
            // What goes wrong later is heard of as an event.
            if start && let Err(error) = self.start(index) {
                self.lost_start(index, error)?;
            }
        }
        Ok(())
    }

    fn give(&mut self, index: usize, batch: &mut Batch<'_>) {
        let State::Ready(worker) = &mut self.slots[index].state else { return };
        let mut lines = Vec::new();
        let idle = batch.waiting.is_empty() && batch.suspects.is_empty();
        // After every point that is evaluated again: the one that led the model astray will do so once more.
        let again = worker.unchecked.last().is_some_and(|row| batch.again.contains(row));
        let due = worker.troubled || again || worker.unchecked.len() >= interval(worker.window) || idle;
        if self.settings.sentinels && due && !worker.unchecked.is_empty() {
            if worker.under_way.is_empty() {
                request(&mut lines, self.next_point, self.hello.nominal.iter().copied());
                worker.under_way.push_back((self.next_point, SENTINEL));
                worker.since = Instant::now();
                self.next_point += 1;
                batch.sent += 1;
                worker.child.send(lines);
            }
            return;
        }
        let alone = worker.under_way.front().is_some_and(|&(_, row)| batch.goes_alone(row));
        while worker.under_way.len() < worker.window && !alone {
            let row = if worker.under_way.is_empty() && !batch.suspects.is_empty() {
                batch.suspects.pop_front()
            } else {
                batch.waiting.pop_front()
            };
            let Some(row) = row else { break };
            let id = self.next_point;
            self.next_point += 1;
            if worker.under_way.is_empty() {
                worker.since = Instant::now();
            }
            worker.under_way.push_back((id, row));
            batch.sends(row);
            let columns = batch.points.dimensions();
            request(&mut lines, id, (0..columns).map(|column| batch.points.column(column)[row]));
            if batch.goes_alone(row) {
                break;
            }
        }
        if !lines.is_empty() {
            worker.child.send(lines);
        }
    }

    fn start(&mut self, index: usize) -> Result<(), ProcessError> {
        let Settings { argv, folder, listener, .. } = &self.settings;
        let number = self.next_child;
        self.next_child += 1;
        let child = Child::start(argv, folder, number, &self.events.0, listener.clone())
            .map_err(|fault| ProcessError { fault, stderr: StderrTail::default() })?;
        child.send(self.hello.line());
        self.slots[index].state = State::Starting(child, Instant::now() + self.settings.start_timeout);
        Ok(())
    }

    /// Waits for something to happen, or for a deadline, and acts on it. An error is one of every start.
    fn turn(&mut self, batch: &mut Option<Batch<'_>>) -> Result<(), ProcessError> {
        let now = Instant::now();
        let pause = self.deadlines().map(|deadline| deadline.saturating_duration_since(now)).min();
        let timeout = pause.unwrap_or(TICK).min(TICK);
        match self.events.1.recv_timeout(timeout) {
            Ok(event) => {
                self.hear(event, batch)?;
                // Whatever came meanwhile, before points are sent for it.
                while let Ok(event) = self.events.1.try_recv() {
                    self.hear(event, batch)?;
                }
            }
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {}
        }
        self.late(batch)
    }

    fn deadlines(&self) -> impl Iterator<Item = Instant> {
        self.slots.iter().filter_map(|slot| match &slot.state {
            State::Empty => None,
            State::Pausing(until) => Some(*until),
            State::Starting(_, until) => Some(*until),
            State::Ready(worker) if worker.under_way.is_empty() => None,
            State::Ready(worker) => Some(worker.since + self.settings.timeout),
        })
    }

    /// Ends what has taken too long.
    fn late(&mut self, batch: &mut Option<Batch<'_>>) -> Result<(), ProcessError> {
        let now = Instant::now();
        for index in 0..self.slots.len() {
            match &mut self.slots[index].state {
                State::Starting(child, until) if *until <= now => {
                    let (_, stderr) = child.kill();
                    let fault = ProcessFault::SilentAtStart { after: self.settings.start_timeout };
                    self.lost_start(index, ProcessError { fault, stderr })?;
                }
                State::Ready(worker) if !worker.under_way.is_empty() && worker.since + self.settings.timeout <= now => {
                    let fault = ProcessFault::TimedOut { after: self.settings.timeout };
                    self.fail(index, fault, batch);
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn hear(&mut self, event: Event, batch: &mut Option<Batch<'_>>) -> Result<(), ProcessError> {
        let of = |slot: &Slot| match &slot.state {
            State::Starting(child, _) => child.number == event.child,
            State::Ready(worker) => worker.child.number == event.child,
            _ => false,
        };
        // A child that was ended already may still have something to say.
        let Some(index) = self.slots.iter().position(of) else { return Ok(()) };
        match event.what {
            What::Closed => self.closed(index, batch),
            What::Lines(lines) => {
                for line in lines {
                    match &self.slots[index].state {
                        State::Starting(..) => self.greet(index, line)?,
                        State::Ready(_) => self.answer(index, line, batch),
                        // An earlier line ended the child.
                        _ => break,
                    }
                }
                Ok(())
            }
        }
    }

    /// The first line of a child.
    fn greet(&mut self, index: usize, line: Result<Line, ProcessFault>) -> Result<(), ProcessError> {
        let State::Starting(child, _) = &mut self.slots[index].state else { return Ok(()) };
        let fault = match line {
            Err(ProcessFault::Garbage { line, .. }) => ProcessFault::NotReady { line },
            Err(fault) => fault,
            Ok(line) => match line {
                Line { error: Some(message), .. } => ProcessFault::RefusedStudy { message },
                Line { sensitol: Some(version), .. } if version != VERSION => ProcessFault::RefusedStudy {
                    message: format!("it speaks version {version} of the protocol, and this is version {VERSION}"),
                },
                Line { ready: Some(true), name, version, window, .. } => {
                    let version = version.map(|version| match version {
                        serde_json::Value::String(text) => text,
                        other => other.to_string(),
                    });
                    let window = window.unwrap_or(1).max(1);
                    self.adapter = Some(Adapter { name, version, window });
                    self.failed_starts = 0;
                    let State::Starting(child, _) = std::mem::take(&mut self.slots[index].state) else { return Ok(()) };
                    self.slots[index].state = State::Ready(Worker {
                        child,
                        window,
                        under_way: VecDeque::new(),
                        since: Instant::now(),
                        first: self.next_point,
                        unchecked: Vec::new(),
                        troubled: false,
                    });
                    return Ok(());
                }
                other => ProcessFault::NotReady { line: other.quoted.unwrap_or_else(|| Quoted(String::new())) },
            },
        };
        let stderr = child.kill().1;
        self.lost_start(index, ProcessError { fault, stderr })
    }

    /// A child that could not be started after others could is tried again, a few times.
    fn lost_start(&mut self, index: usize, error: ProcessError) -> Result<(), ProcessError> {
        self.failed_starts += 1;
        self.pause(index);
        if self.is_hopeless() { Err(error) } else { Ok(()) }
    }

    /// Whether there is no child, and none to be had: the first start failed, or too many in a row did.
    fn is_hopeless(&self) -> bool {
        let alone = !self.slots.iter().any(|slot| matches!(slot.state, State::Ready(_)));
        self.adapter.is_none() || (alone && self.failed_starts >= STARTS)
    }

    /// Leaves a place empty for a while that grows with every failure.
    fn pause(&mut self, index: usize) {
        let slot = &mut self.slots[index];
        let pause = if slot.failures == 0 { Duration::ZERO } else { PAUSE * 2u32.pow(slot.failures.min(10) - 1) };
        slot.failures += 1;
        slot.state = State::Pausing(Instant::now() + pause.min(LONGEST_PAUSE));
    }

    /// An answer, or something that should have been one.
    fn answer(&mut self, index: usize, line: Result<Line, ProcessFault>, batch: &mut Option<Batch<'_>>) {
        let slot = &mut self.slots[index];
        let State::Ready(worker) = &mut slot.state else { return };
        let line = match line {
            Ok(line) => line,
            Err(fault) => return self.fail(index, fault, batch),
        };
        let Some(id) = line.id else {
            return self.fail(index, line.garbage("it has no id"), batch);
        };
        let Some(position) = worker.under_way.iter().position(|&(known, _)| known == id) else {
            let twice = id >= worker.first && id < self.next_point;
            let fault = if twice { ProcessFault::AnsweredTwice { id } } else { ProcessFault::UnknownPoint { id } };
            return self.fail(index, fault, batch);
        };
        let expected = self.hello.characteristics.len();
        if let Some(fault) = line.misshapen(expected, self.hello.dimensions.len()) {
            // Only this point: the line was whole, and the others may be right.
            if worker.under_way[position].1 == SENTINEL {
                return self.fail(index, fault, batch);
            }
            if let Some((_, row)) = worker.under_way.remove(position) {
                worker.since = Instant::now();
                let error = ProcessError { fault, stderr: worker.child.tail() };
                batch.iter_mut().for_each(|batch| batch.fail(row, &error));
            }
            return;
        }
        if line.y.is_none() && line.error.is_none() {
            return self.fail(index, line.garbage("it has neither y nor error"), batch);
        }
        let (_, row) = worker.under_way.remove(position).expect("it was found there");
        worker.since = Instant::now();
        slot.failures = 0;
        self.failed_starts = 0;
        let values = values(&line, expected);
        if row == SENTINEL {
            return self.checked(index, values, batch);
        }
        self.reference.learn(&values);
        if let Some(batch) = batch {
            let nominal = |(column, x): (usize, &f64)| batch.points.column(column)[row] == *x;
            let is_nominal = self.hello.nominal.iter().enumerate().all(nominal);
            let troubled = values.contains(&None);
            if is_nominal {
                // The study's own evaluation of the nominal point is the first sentinel.
                let doubts =
                    self.reference.check(values, &self.hello.characteristics, &batch.coordinates(&worker.unchecked));
                batch.out.doubt(doubts);
            }
            let again = line.error.is_some() && line.retry && batch.charged(row) <= self.settings.retries;
            if self.settings.sentinels && !is_nominal && !again {
                worker.unchecked.push(row);
                worker.troubled |= troubled;
            }
            if again {
                batch.suspects.push_back(row);
            } else {
                batch.settle(row, line, &self.hello.characteristics);
            }
        }
    }

    /// The nominal point, evaluated again: a child that answers otherwise than before is not trusted any more.
    fn checked(&mut self, index: usize, found: Vec<Option<f64>>, batch: &mut Option<Batch<'_>>) {
        let State::Ready(worker) = &mut self.slots[index].state else { return };
        worker.troubled = false;
        let rows = std::mem::take(&mut worker.unchecked);
        let suspects = batch.as_ref().map(|batch| batch.coordinates(&rows)).unwrap_or_default();
        let doubts = self.reference.check(found, &self.hello.characteristics, &suspects);
        if doubts.is_empty() {
            return;
        }
        worker.child.kill();
        if let Some(batch) = batch {
            batch.out.doubt(doubts);
            batch.distrust(&rows);
        }
        self.pause(index);
    }

    /// A child closed its stdout.
    fn closed(&mut self, index: usize, batch: &mut Option<Batch<'_>>) -> Result<(), ProcessError> {
        match &mut self.slots[index].state {
            State::Starting(child, _) => {
                let (exit, stderr) = child.ended();
                self.lost_start(index, ProcessError { fault: ProcessFault::EndedAtStart { exit }, stderr })
            }
            State::Ready(_) => {
                self.crash(index, None, batch);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// A child that did something wrong: it is ended, its oldest point is charged with it, the others are free.
    fn fail(&mut self, index: usize, fault: ProcessFault, batch: &mut Option<Batch<'_>>) {
        self.crash(index, Some(fault), batch);
    }

    fn crash(&mut self, index: usize, fault: Option<ProcessFault>, batch: &mut Option<Batch<'_>>) {
        let State::Ready(mut worker) = std::mem::take(&mut self.slots[index].state) else { return };
        let (exit, stderr) = if fault.is_some() { worker.child.kill() } else { worker.child.ended() };
        let known = fault.is_some();
        let error = ProcessError { fault: fault.unwrap_or(ProcessFault::Crashed { exit }), stderr };
        if let Some(batch) = batch {
            if worker.under_way.iter().any(|&(_, row)| row == SENTINEL) {
                // It did not survive the nominal point, which it had answered before.
                batch.distrust(&worker.unchecked);
                return self.pause(index);
            }
            let mut rows = worker.under_way.iter().map(|&(_, row)| row);
            // Of several points under way in a child that crashed nobody knows which one it was.
            if known || worker.under_way.len() == 1 {
                if let Some(row) = rows.next() {
                    batch.charge(row, &error, self.settings.retries);
                }
                for row in rows.rev() {
                    batch.waiting.push_front(row);
                }
            } else {
                for row in rows {
                    batch.failures.entry(row).or_insert(0);
                    batch.suspects.push_back(row);
                }
            }
        }
        self.pause(index);
    }
}

impl Slot {
    /// Whether nothing is left that its child has answered and nobody has checked.
    fn is_checked(&self) -> bool {
        match &self.state {
            State::Ready(worker) => worker.unchecked.is_empty() && worker.under_way.is_empty(),
            _ => true,
        }
    }
}

impl Drop for Pool {
    /// All are told first, so that they end side by side.
    fn drop(&mut self) {
        for slot in &mut self.slots {
            match &mut slot.state {
                State::Starting(child, _) => child.close(),
                State::Ready(worker) => worker.child.close(),
                State::Empty | State::Pausing(_) => {}
            }
        }
    }
}
