//! Lines of a child that is ready: answers to points, and news of how it works.

use std::sync::atomic::Ordering;
use std::time::Instant;

use super::super::batch::Batch;
use super::super::protocol::Line;
use super::super::sentinel::{SENTINEL, is_flip, values};
use super::super::worker::Sent;
use super::{Pool, State};
use sensitol::assembly::{ProcessError, ProcessFault, StderrTail};

impl Pool {
    /// An answer, or something that should have been one.
    pub(super) fn answer(&mut self, index: usize, line: Result<Line, ProcessFault>, batch: &mut Option<Batch<'_>>) {
        let State::Ready(worker) = &mut self.slots[index].state else { return };
        let mut line = match line {
            Ok(line) => line,
            Err(fault) => return self.fail(index, fault, batch),
        };
        worker.border.back(&mut line);
        if let Some(note) = &line.note
            && let Some(listener) = &self.settings.listener
        {
            listener(note);
        }
        if line.id.is_none() && (line.alive || line.window.is_some()) {
            worker.window = line.window.unwrap_or(worker.window).max(1);
            if line.alive {
                worker.since = Instant::now();
            }
            return;
        }
        let Some(id) = line.id else {
            return self.fail(index, line.garbage("it has no id"), batch);
        };
        let is_start = line.started.is_some() && line.y.is_none() && line.error.is_none();
        if let Some(row) = worker.cancelled.get(&id).copied() {
            if !is_start {
                worker.cancelled.remove(&id);
                self.late_answer(row, line, batch);
            }
            return;
        }
        let Some(position) = worker.under_way.iter().position(|sent| sent.id == id) else {
            let twice = id >= worker.first && id < self.next_point;
            let fault = if twice { ProcessFault::AnsweredTwice { id } } else { ProcessFault::UnknownPoint { id } };
            return self.fail(index, fault, batch);
        };
        if is_start {
            worker.note_place(line.started.as_ref());
            worker.under_way[position].started = Some(Instant::now());
            return;
        }
        self.point_answer(index, position, line, batch);
    }

    /// An answer to the point of this position among those under way.
    fn point_answer(&mut self, index: usize, position: usize, line: Line, batch: &mut Option<Batch<'_>>) {
        let slot = &mut self.slots[index];
        let State::Ready(worker) = &mut slot.state else { return };
        let expected = self.hello.characteristics.len();
        if let Some(fault) = line.misshapen(expected, self.hello.dimensions.len()) {
            // Only this point: the line was whole, and the others may be right.
            if worker.under_way[position].row == SENTINEL {
                return self.fail(index, fault, batch);
            }
            if let Some(Sent { row, .. }) = worker.under_way.remove(position) {
                worker.since = Instant::now();
                let error = ProcessError { fault, stderr: worker.child.tail() };
                batch.iter_mut().for_each(|batch| batch.fail(row, &error));
            }
            return;
        }
        if line.y.is_none() && line.error.is_none() {
            return self.fail(index, line.garbage("it has neither y nor error"), batch);
        }
        let Some(Sent { row, .. }) = worker.under_way.remove(position) else { return };
        worker.note_place(line.place.as_ref());
        self.account.answered(line.place.as_ref(), line.cost_s);
        worker.since = Instant::now();
        slot.failures = 0;
        (self.failed_starts, self.unused) = (0, 0);
        let values = values(&line, expected);
        if row == SENTINEL {
            self.note_sentinel(&line, &values);
            return self.checked(index, values, batch);
        }
        self.reference.learn(&values);
        if let Some(batch) = batch {
            self.settle_answer(index, row, (line, values), batch);
        }
    }

    /// Notes the outcome of the nominal point, until some point has a value.
    fn note_sentinel(&mut self, line: &Line, values: &[Option<f64>]) {
        if self.futility.is_ruled_out() {
            return;
        }
        if values.iter().any(Option::is_some) {
            return self.futility.note_value();
        }
        let message = line.error.clone().or_else(|| line.errors.values().next().cloned());
        let fault = ProcessFault::NoValue { message: message.unwrap_or_else(|| "the model returned null".to_owned()) };
        self.futility.note_failure(true, &ProcessError { fault, stderr: StderrTail::default() });
    }

    /// Settles a row of the batch, or sends it again where the program requests that.
    fn settle_answer(
        &mut self,
        index: usize,
        row: usize,
        (line, values): (Line, Vec<Option<f64>>),
        batch: &mut Batch<'_>,
    ) {
        let State::Ready(worker) = &mut self.slots[index].state else { return };
        let nominal = |(column, x): (usize, &f64)| batch.points.column(column)[row] == *x;
        let is_nominal = self.hello.nominal.iter().enumerate().all(nominal);
        let troubled = values.contains(&None);
        let walking = !self.walking.is_empty();
        if is_nominal && !walking {
            // The study's own evaluation of the nominal point is the first sentinel.
            let non_repeatable =
                self.reference.check(values, &self.hello.characteristics, &batch.coordinates(&worker.unchecked));
            self.flips.fetch_or(is_flip(&non_repeatable), Ordering::Relaxed);
            batch.out.note_non_repeatable(non_repeatable);
        }
        let again = line.error.is_some() && line.retry && batch.charged(row) <= self.settings.retries;
        if self.settings.sentinels && !walking && !is_nominal && !again {
            worker.unchecked.push(row);
            worker.troubled |= troubled;
        }
        if again {
            batch.try_again(row);
        } else {
            batch.settle(row, line, &self.hello.characteristics);
        }
    }

    /// An answer to a point that was taken back: it is kept where its row is still open.
    fn late_answer(&mut self, row: Option<usize>, line: Line, batch: &mut Option<Batch<'_>>) {
        let shaped =
            line.y.is_some() && line.misshapen(self.hello.characteristics.len(), self.hello.dimensions.len()).is_none();
        if let (Some(row), Some(batch), true) = (row, batch, shaped)
            && (0..batch.out.outputs()).all(|output| batch.out.is_open(row, output))
        {
            self.account.answered(line.place.as_ref(), line.cost_s);
            batch.settle(row, line, &self.hello.characteristics);
        }
    }
}
