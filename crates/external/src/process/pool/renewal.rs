//! Replacement of children by fresh ones, and the end of all of them.

use super::super::batch::Batch;
use super::super::child::Child;
use super::{Pool, Slot, State};
use sensitol::assembly::{EvaluationError, Points, ProcessError};

impl Pool {
    /// Number of fresh children that walk to answers of this batch once all of them are there.
    pub(super) fn walkers(&self, points: &Points) -> usize {
        if !self.settings.replays() || self.hopeless {
            return 0;
        }
        let nominal = &self.hello.nominal;
        let others = (0..points.rows()).filter(|&row| points.row(row) != *nominal).count();
        let walks = if self.flips() { others } else { self.answers.owed_after(points.rows(), self.settings.verify) };
        walks.min(others)
    }

    /// Replaces children with nothing left to do by fresh ones, while others still work at the last points of a batch.
    pub(super) fn renew(&mut self) -> Result<(), ProcessError> {
        for index in 0..self.slots.len().min(self.fresh_wanted) {
            self.slots[index].retire();
            match &self.slots[index].state {
                State::Ready(_) | State::Starting(..) => {}
                _ => _ = self.ensure_child(index)?,
            }
        }
        Ok(())
    }

    /// Ends children that were sent points, so that the next points go to fresh ones.
    pub(in super::super) fn end_used_children(&mut self, slots: impl IntoIterator<Item = usize>) {
        let mut ended = Vec::new();
        for slot in slots {
            let slot = &mut self.slots[slot];
            if let State::Pausing(_) = slot.state {
                slot.state = State::Empty;
            }
            if slot.is_fresh() {
                continue;
            }
            slot.known_places = slot.places();
            ended.extend(std::mem::take(&mut slot.state).into_child());
        }
        Child::end_all(ended);
    }

    /// Places at which each child has reported evaluations; none for most.
    pub(in super::super) fn places(&self) -> Vec<(usize, Vec<String>)> {
        self.slots.iter().map(Slot::places).enumerate().collect()
    }

    /// Notes outcomes of points, until one has a value. Sets the last error if all fail for one reason.
    pub(super) fn note_outcomes(&mut self, batch: &Batch<'_>) {
        if self.futility.is_ruled_out() || self.last_error.is_some() {
            return;
        }
        for &row in &batch.done {
            let outputs = 0..batch.out.outputs();
            if outputs.clone().any(|output| batch.out.value(row, output).is_some()) {
                return self.futility.note_value();
            }
            let error = outputs.clone().find_map(|output| match batch.out.error(row, output) {
                Some(EvaluationError::Process(error)) => Some(error),
                _ => None,
            });
            if let Some(error) = error {
                self.futility.note_failure(batch.points.row(row) == self.hello.nominal, error);
            }
        }
        if let Some(error) = self.futility.verdict() {
            self.account.fails_everywhere = Some(error.clone());
            self.last_error = Some(error);
        }
    }
}

impl Slot {
    /// True if the slot has a child that was sent no point, or none.
    fn is_fresh(&self) -> bool {
        match &self.state {
            State::Ready(worker) => !worker.asked,
            State::Ending(_) => false,
            State::Empty | State::Pausing(_) | State::Starting(..) => true,
        }
    }

    fn places(&self) -> Vec<String> {
        match &self.state {
            State::Ready(worker) if worker.asked => worker.places.iter().take(worker.window).cloned().collect(),
            _ => self.known_places.clone(),
        }
    }

    /// Tells a child with checked answers to end.
    fn retire(&mut self) {
        if self.is_fresh() || !self.is_checked() {
            return;
        }
        self.known_places = self.places();
        if let State::Ready(mut worker) = std::mem::take(&mut self.state) {
            worker.child.close();
            self.state = State::Ending(worker.child);
        }
    }
}

impl State {
    fn into_child(self) -> Option<Child> {
        match self {
            Self::Ready(worker) => Some(worker.child),
            Self::Starting(child, _) | Self::Ending(child) => Some(child),
            Self::Empty | Self::Pausing(_) => None,
        }
    }
}

impl Drop for Pool {
    /// Ends all children at the same time.
    fn drop(&mut self) {
        let states = self.slots.iter_mut().map(|slot| std::mem::take(&mut slot.state));
        Child::end_all(states.filter_map(State::into_child).collect());
    }
}
