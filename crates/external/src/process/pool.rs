//! Pool of child processes, with the points under way in each.

mod answers;
mod renewal;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use super::batch::Batch;
use super::border::Border;
use super::child::{Child, Event, What};
use super::futility::Futility;
use super::lane::Lane;
use super::protocol::{Hello, Line, VERSION, request};
use super::sentinel::{Reference, SENTINEL, interval, is_flip};
use super::suspicion::Answers;
use super::worker::Worker;
use crate::settings::Settings;
use sensitol::assembly::EvaluatorAccount;
use sensitol::assembly::{ModelInfo, Points, Responses, Run};
use sensitol::assembly::{ProcessError, ProcessFault, Quoted, StderrTail};

/// Longest time between two looks for a stop.
const TICK: Duration = Duration::from_millis(50);
/// First pause before a failed child is started again. It doubles with every failure in a row.
const PAUSE: Duration = Duration::from_millis(50);
/// Greatest pause before a failed child is started again.
const LONGEST_PAUSE: Duration = Duration::from_secs(5);
/// Longest deadline, some thirty years. A later moment may be more than the clock can hold.
const FOREVER: Duration = Duration::from_secs(1_000_000_000);
/// Failed starts in a row after which no more are tried.
const STARTS: u32 = 4;
/// Crashes in a row without an answer after which points of an isolated program are suspected after all.
const ISOLATED: u32 = 3;
/// Time that a stop waits for points that were taken back. An answer that still comes is kept.
const TAKEN_BACK: Duration = Duration::from_secs(1);

/// Children of one model for one choice of outputs.
pub(super) struct Pool {
    pub(super) settings: Settings,
    pub(super) hello: Hello,
    pub(super) slots: Vec<Slot>,
    events: (Sender<Event>, Receiver<Event>),
    /// Number of the next child.
    next_child: u64,
    /// Number of the next point.
    pub(super) next_point: u64,
    /// Failed starts in a row.
    failed_starts: u32,
    /// Children in a row that were ready and ended before they were sent a point.
    unused: u32,
    /// Error of the last such child, once there were too many.
    useless: Option<ProcessError>,
    /// Error of a child whose line did not end, or of a model that fails everywhere. No points are sent after it.
    last_error: Option<ProcessError>,
    /// Outcomes of points, until one had a value.
    pub(super) futility: Futility,
    /// Number of fresh children that the check of the current batch needs.
    fresh_wanted: usize,
    adapter: Option<ModelInfo>,
    /// True if numbers are converted on their way to the program and back.
    pub(super) converts: bool,
    pub(super) reference: Reference,
    pub(super) account: EvaluatorAccount,
    /// Answers so far, from which some are chosen for a replay.
    pub(super) answers: Answers,
    /// Greatest difference of every output between two evaluations of the nominal point.
    pub(super) noise: Vec<f64>,
    /// True once an answer was found to depend on the points before it, in this run or in an earlier one.
    flips: Arc<AtomicBool>,
    /// True if the model gives another answer every time.
    pub(super) hopeless: bool,
    /// Lanes in which points go one by one in their order, without sentinels. Empty unless answers are replayed.
    pub(super) walking: Vec<Lane>,
}

/// Slot of one child.
#[derive(Default)]
pub(super) struct Slot {
    pub(super) state: State,
    /// Failures since the last answer.
    failures: u32,
    /// Time since which the slot has had no child that answers; None unless a child failed.
    lost: Option<Instant>,
    /// Places at which an earlier child of the slot reported evaluations.
    known_places: Vec<String>,
}

#[derive(Default)]
pub(super) enum State {
    /// No child, and none is needed yet.
    #[default]
    Empty,
    /// No child may start before this moment.
    Pausing(Instant),
    /// A child that is not ready yet, and the deadline for it.
    Starting(Child, Instant),
    Ready(Box<Worker>),
    /// A child that was told to end, so that a fresh one takes its place.
    Ending(Child),
}

impl Pool {
    pub(super) fn new(mut settings: Settings, hello: Hello, flips: Arc<AtomicBool>) -> Self {
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
            unused: 0,
            useless: None,
            last_error: None,
            futility: Futility::default(),
            fresh_wanted: 0,
            adapter: None,
            converts: false,
            reference: Reference::default(),
            account: EvaluatorAccount::default(),
            answers: Answers::default(),
            noise: Vec::new(),
            flips,
            hopeless: false,
            walking: Vec::new(),
        }
    }

    /// True once an answer was found to depend on the points before it.
    pub(super) fn flips(&self) -> bool {
        self.flips.load(Ordering::Relaxed)
    }

    /// Notes that answers depend on the points before them. From now on every answer is replayed.
    pub(super) fn set_flips(&self) {
        self.flips.store(true, Ordering::Relaxed);
    }

    pub(super) fn asks(&self, characteristics: &[String]) -> bool {
        self.hello.characteristics == characteristics
    }

    /// Starts one child and waits until it is ready. Fails if the model cannot be used.
    pub(super) fn prepare(&mut self) -> Result<&ModelInfo, ProcessError> {
        while self.adapter.is_none() {
            if matches!(self.slots[0].state, State::Empty | State::Pausing(_)) {
                self.start(0)?;
            }
            self.turn(&mut None)?;
        }
        Ok(self.adapter.as_ref().expect("a child is ready"))
    }

    /// Evaluates all rows of `points` that have no answer yet. After a stop, points under way are waited for and others stay open.
    pub(super) fn evaluate(&mut self, points: &Points, run: &Run<'_>, out: &mut Responses) {
        self.fresh_wanted = self.walkers(points);
        self.work_off(Batch::new(points, out), run);
        self.fresh_wanted = 0;
    }

    /// Evaluates the open rows of a batch.
    pub(super) fn work_off(&mut self, batch: Batch<'_>, run: &Run<'_>) {
        let open = batch.left;
        let mut batch = Some(batch);
        let mut stopped_at = None;
        loop {
            let stopping = run.stopped();
            if run.abandoned() {
                break;
            }
            if stopping && stopped_at.is_none() {
                stopped_at = Some(Instant::now());
                self.workers().for_each(Worker::take_back);
            }
            let work = batch.as_mut().expect("a batch");
            // The batch ends when all rows are answered and a sentinel has confirmed them. After a stop it ends when nothing is under way.
            let checked = work.left == 0 && self.slots.iter().all(Slot::is_checked);
            let waits = stopped_at.is_some_and(|at| at.elapsed() < TAKEN_BACK)
                && self.workers().any(|worker| worker.cancelled.values().any(Option::is_some));
            if checked || (stopping && !self.busy() && !waits) {
                break;
            }
            let dispatched = match &self.last_error {
                Some(error) => Err(error.clone()),
                None if stopping => Ok(()),
                None => self.dispatch(work),
            };
            let turned = dispatched.and_then(|()| self.turn(&mut batch));
            let work = batch.as_mut().expect("a batch");
            self.note_outcomes(work);
            if let Err(error) = turned {
                // No child can be had any more.
                work.give_up(&error);
                work.tell(run);
                break;
            }
            work.tell(run);
        }
        let work = batch.expect("a batch");
        work.out.spent(work.sent as i64 - (open - work.left) as i64);
        self.account.counts.retried += work.resent as u64;
        if self.settings.verify == Some(0) {
            // Nothing is replayed, so rows that are in doubt twice stay in doubt.
            self.account.counts.unconfirmed += work.twice.len() as u64;
        }
        work.out.retried(work.resent);
        // After giving up, a process may still work on points of this batch. The next batch must not receive their answers.
        for slot in &mut self.slots {
            if let State::Ready(worker) = &mut slot.state {
                worker.unchecked.clear();
                worker.cancelled.values_mut().for_each(|row| *row = None);
                if !worker.under_way.is_empty() {
                    worker.child.kill();
                    slot.state = State::Empty;
                }
            }
        }
    }

    /// True if the child is ready. Starts one if there is none.
    pub(super) fn ensure_child(&mut self, index: usize) -> Result<bool, ProcessError> {
        let start = match &mut self.slots[index].state {
            State::Ready(_) => return Ok(true),
            State::Starting(..) => false,
            State::Empty => true,
            State::Pausing(until) => *until <= Instant::now(),
            State::Ending(child) => child.is_at_its_end(),
        };
        // Later failures arrive as events.
        if start && let Err(error) = self.start(index) {
            self.lost_start(index, error)?;
        }
        Ok(false)
    }

    fn workers(&mut self) -> impl Iterator<Item = &mut Worker> {
        self.slots.iter_mut().filter_map(|slot| match &mut slot.state {
            State::Ready(worker) => Some(&mut **worker),
            _ => None,
        })
    }

    fn busy(&self) -> bool {
        self.slots.iter().any(|slot| matches!(&slot.state, State::Ready(worker) if !worker.under_way.is_empty()))
    }

    /// Starts children if there is work for them, and sends every ready one as many points as it may have.
    fn dispatch(&mut self, batch: &mut Batch<'_>) -> Result<(), ProcessError> {
        if !self.walking.is_empty() {
            return self.dispatch_walks(batch);
        }
        let mut wanted = batch.unsent();
        for index in 0..self.slots.len() {
            if matches!(self.slots[index].state, State::Ready(_)) {
                self.give(index, batch);
                wanted = batch.unsent();
                continue;
            }
            if wanted > 0 {
                self.ensure_child(index)?;
            }
            // One child for each window of points is enough.
            wanted = wanted.saturating_sub(self.adapter.as_ref().map_or(1, |adapter| adapter.window));
        }
        if batch.unsent() == 0 { self.renew() } else { Ok(()) }
    }

    fn give(&mut self, index: usize, batch: &mut Batch<'_>) {
        let State::Ready(worker) = &mut self.slots[index].state else { return };
        let mut lines = Vec::new();
        let idle = batch.waiting.is_empty() && batch.suspects.is_empty();
        // A sentinel follows every point that is evaluated again: it may have led the model to a wrong solution, and would do so once more.
        let again = worker.unchecked.last().is_some_and(|row| batch.again.contains(row));
        let due = worker.troubled || again || worker.unchecked.len() >= interval(worker.window) || idle;
        if self.settings.sentinels && due && !worker.unchecked.is_empty() {
            if worker.under_way.is_empty() {
                // One sentinel for each known place, if the program evaluates in several.
                let places: Vec<Option<String>> = worker.places.iter().cloned().map(Some).collect();
                for place in if places.is_empty() { vec![None] } else { places } {
                    let nominal = worker.border.out(self.hello.nominal.iter().copied());
                    request(&mut lines, self.next_point, nominal, place.as_deref());
                    worker.sent(self.next_point, SENTINEL);
                    self.next_point += 1;
                    batch.sent += 1;
                }
                worker.child.send(lines);
            }
            return;
        }
        if worker.under_way.is_empty() {
            worker.exclusive = false;
        }
        let mut send = |row: usize, worker: &mut Worker, batch: &mut Batch<'_>| {
            worker.sent(self.next_point, row);
            batch.sends(row);
            let columns = batch.points.dimensions();
            let point = (0..columns).map(|column| batch.points.column(column)[row]);
            request(&mut lines, self.next_point, worker.border.out(point), None);
            self.next_point += 1;
        };
        // A suspected group is sent first, to a child with nothing else under way.
        if worker.under_way.is_empty()
            && let Some(group) = batch.suspects.pop_front()
        {
            worker.exclusive = true;
            group.into_iter().for_each(|row| send(row, worker, batch));
        }
        // Other rows fill the window. A row that must be evaluated alone waits until nothing is under way.
        let room = worker.room();
        while worker.under_way.len() < room && !worker.exclusive {
            let Some(&row) = batch.waiting.front() else { break };
            if batch.goes_alone(row) {
                if !worker.under_way.is_empty() {
                    break;
                }
                worker.exclusive = true;
            }
            batch.waiting.pop_front();
            send(row, worker, batch);
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
        self.account.counts.starts += 1;
        self.slots[index].state = State::Starting(child, Instant::now() + self.settings.start_timeout);
        Ok(())
    }

    /// Waits for an event or a deadline, and handles it. Fails if no child can be started.
    fn turn(&mut self, batch: &mut Option<Batch<'_>>) -> Result<(), ProcessError> {
        let now = Instant::now();
        let pause = self.deadlines().map(|deadline| deadline.saturating_duration_since(now)).min();
        let timeout = pause.unwrap_or(TICK).min(TICK);
        match self.events.1.recv_timeout(timeout) {
            Ok(event) => {
                self.hear(event, batch)?;
                // Events that came meanwhile are handled before points are sent.
                while let Ok(event) = self.events.1.try_recv() {
                    self.hear(event, batch)?;
                }
            }
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {}
        }
        self.late(batch)?;
        self.useless.take().map_or(Ok(()), Err)
    }

    fn deadlines(&self) -> impl Iterator<Item = Instant> {
        self.slots.iter().filter_map(|slot| match &slot.state {
            State::Empty | State::Ending(_) => None,
            State::Pausing(until) => Some(*until),
            State::Starting(_, until) => Some(*until),
            State::Ready(worker) => worker.deadline(self.settings.timeout),
        })
    }

    /// Ends children that have missed a deadline.
    fn late(&mut self, batch: &mut Option<Batch<'_>>) -> Result<(), ProcessError> {
        let now = Instant::now();
        for index in 0..self.slots.len() {
            match &mut self.slots[index].state {
                State::Starting(child, until) if *until <= now => {
                    let (_, stderr) = child.kill();
                    let fault = ProcessFault::SilentAtStart { after: self.settings.start_timeout };
                    self.lost_start(index, ProcessError { fault, stderr })?;
                }
                State::Ready(worker) => {
                    let Some(position) = worker.overdue(self.settings.timeout, now) else { continue };
                    let after = self.settings.timeout;
                    if worker.child.writes_on(after / 2) {
                        // Every child would cost a timeout, and no point is to blame.
                        let (_, stderr) = worker.child.kill();
                        let error = ProcessError { fault: ProcessFault::EndlessLine { after }, stderr };
                        self.slots[index].state = State::Empty;
                        self.account.failed(&error);
                        self.last_error = Some(error.clone());
                        return Err(error);
                    }
                    let fault = ProcessFault::TimedOut { after };
                    let Some(late) = worker.under_way.remove(position) else { continue };
                    if worker.abilities.cancel && late.started.is_some() && late.row != SENTINEL {
                        // The program can cancel this point, so the child goes on.
                        worker.cancel([late]);
                        let error = ProcessError { fault, stderr: worker.child.tail() };
                        self.account.failed(&error);
                        batch.iter_mut().for_each(|batch| batch.charge(late.row, &error, self.settings.retries));
                    } else {
                        worker.under_way.push_front(late);
                        self.fail(index, fault, batch);
                    }
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
        // A child that has been ended may still have lines in the channel.
        let Some(index) = self.slots.iter().position(of) else { return Ok(()) };
        match event.what {
            What::Closed => self.closed(index, batch),
            What::Lines(lines) => {
                for line in lines {
                    match &self.slots[index].state {
                        State::Starting(..) => self.greet(index, line)?,
                        State::Ready(_) => self.answer(index, line, batch),
                        // An earlier line has ended the child.
                        _ => break,
                    }
                }
                Ok(())
            }
        }
    }

    /// Handles the first line of a child.
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
                line @ Line { ready: Some(true), .. } => {
                    match Border::of(&self.hello, &line.units, self.settings.units) {
                        Err(fault) => fault,
                        Ok(border) => {
                            self.converts = !border.is_open();
                            self.adapter = Some(line.info());
                            self.failed_starts = 0;
                            let slot = &mut self.slots[index];
                            if let Some(lost) = slot.lost.take() {
                                self.account.counts.lost_s += lost.elapsed().as_secs_f64();
                            }
                            let State::Starting(child, _) = std::mem::take(&mut slot.state) else { return Ok(()) };
                            slot.state = State::Ready(Box::new(Worker::new(child, &line, border, self.next_point)));
                            return Ok(());
                        }
                    }
                }
                other => ProcessFault::NotReady { line: other.quoted.unwrap_or_else(|| Quoted(String::new())) },
            },
        };
        let stderr = child.kill().1;
        self.lost_start(index, ProcessError { fault, stderr })
    }

    /// Handles a failed start after an earlier one that worked: it is tried again, a few times.
    fn lost_start(&mut self, index: usize, error: ProcessError) -> Result<(), ProcessError> {
        self.failed_starts += 1;
        self.account.failed(&error);
        self.pause(index);
        if self.is_hopeless() { Err(error) } else { Ok(()) }
    }

    /// True if there is no child and no more starts are tried: the first start failed, or too many in a row did.
    fn is_hopeless(&self) -> bool {
        let alone = !self.slots.iter().any(|slot| matches!(slot.state, State::Ready(_)));
        self.adapter.is_none() || (alone && self.failed_starts >= STARTS)
    }

    /// Leaves a slot empty for a pause that grows with every failure.
    fn pause(&mut self, index: usize) {
        let slot = &mut self.slots[index];
        let pause = if slot.failures == 0 { Duration::ZERO } else { PAUSE * 2u32.pow(slot.failures.min(10) - 1) };
        slot.failures += 1;
        slot.state = State::Pausing(Instant::now() + pause.min(LONGEST_PAUSE));
    }

    /// The nominal point, evaluated again: a child that answers otherwise than before is not trusted any more.
    fn checked(&mut self, index: usize, found: Vec<Option<f64>>, batch: &mut Option<Batch<'_>>) {
        let State::Ready(worker) = &mut self.slots[index].state else { return };
        // With several places each has a sentinel. The last one clears the check, and the first difference ends the child.
        let last = !worker.under_way.iter().any(|sent| sent.row == SENTINEL);
        let rows = worker.unchecked.clone();
        let suspects = batch.as_ref().map(|batch| batch.coordinates(&rows)).unwrap_or_default();
        let non_repeatable = self.reference.check(found, &self.hello.characteristics, &suspects);
        if non_repeatable.is_empty() {
            if last {
                worker.troubled = false;
                worker.unchecked.clear();
            }
            return;
        }
        worker.child.kill();
        // An even number of flips does not show at the nominal point, so every answer of the batch is replayed at its end.
        if is_flip(&non_repeatable) {
            self.set_flips();
        }
        if let Some(batch) = batch {
            batch.out.note_non_repeatable(non_repeatable);
            batch.distrust(&rows);
        }
        self.pause(index);
    }

    /// Handles a child that closed its stdout.
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

    /// Ends a child after a fault. Its oldest point is charged with it, and the others are sent again.
    fn fail(&mut self, index: usize, fault: ProcessFault, batch: &mut Option<Batch<'_>>) {
        self.crash(index, Some(fault), batch);
    }

    fn crash(&mut self, index: usize, fault: Option<ProcessFault>, batch: &mut Option<Batch<'_>>) {
        let State::Ready(mut worker) = std::mem::take(&mut self.slots[index].state) else { return };
        let (exit, stderr) = if fault.is_some() { worker.child.kill() } else { worker.child.ended() };
        let known = fault.is_some();
        let error = ProcessError { fault: fault.unwrap_or(ProcessFault::Crashed { exit }), stderr };
        self.account.failed(&error);
        self.slots[index].lost.get_or_insert(worker.since);
        let crashes = self.slots[index].failures;
        self.unused = if worker.asked { 0 } else { self.unused + 1 };
        // No point can be charged. Without this limit such children would be started for ever.
        if self.unused >= STARTS && !self.slots.iter().any(|slot| matches!(slot.state, State::Ready(_))) {
            self.useless = Some(error);
            return self.pause(index);
        }
        if let Some(batch) = batch {
            if worker.under_way.iter().any(|sent| sent.row == SENTINEL) {
                // The child crashed at the nominal point, which it had answered before.
                batch.distrust(&worker.unchecked);
                return self.pause(index);
            }
            // Points that were taken back stay open.
            let rows: Vec<usize> = worker.under_way.iter().map(|sent| sent.row).collect();
            if known || rows.len() == 1 {
                if let Some(&row) = rows.first() {
                    batch.charge(row, &error, self.settings.retries);
                }
                rows.iter().skip(1).rev().for_each(|&row| batch.put_back(row));
            } else if worker.abilities.isolated && crashes < ISOLATED {
                rows.iter().rev().for_each(|&row| batch.put_back(row));
            } else if !self.walking.is_empty() {
                // A walk goes on in its own lane, so its points cannot be tried alone.
                rows.iter().for_each(|&row| batch.charge(row, &error, self.settings.retries));
            } else {
                // A crash with several points under way does not show which of them caused it.
                batch.divide(&rows);
            }
        }
        self.pause(index);
    }
}

impl Slot {
    /// True if the slot has no answers that a sentinel must still confirm, and no points under way.
    fn is_checked(&self) -> bool {
        match &self.state {
            State::Ready(worker) => worker.unchecked.is_empty() && worker.under_way.is_empty(),
            _ => true,
        }
    }
}
