//! One ready child: its abilities, and the points under way in it.

use std::collections::{BTreeSet, HashMap, VecDeque};
use std::time::{Duration, Instant};

use super::border::Border;
use super::child::Child;
use super::protocol::Line;
use super::sentinel::{SENTINEL, interval};

/// Timeouts for which signs of life keep a point that has not started: 17 hours by default, longer than most queues.
const WAITS: u32 = 1000;

/// Abilities that a program declares in `ready`, besides its window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Abilities {
    /// True if a crash of one point does not affect others, so that none of them is suspected.
    pub(super) isolated: bool,
    /// True if the program can cancel points.
    pub(super) cancel: bool,
    /// Number of places at which it evaluates.
    pub(super) places: usize,
}

/// A point under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sent {
    pub(super) id: u64,
    pub(super) row: usize,
    /// Time at which it was sent.
    pub(super) sent: Instant,
    /// Start of the evaluation as the program reported it. None while the point waits in the program's queue, and if the program does not
    /// report starts.
    pub(super) started: Option<Instant>,
}

pub(super) struct Worker {
    pub(super) child: Child,
    pub(super) window: usize,
    pub(super) abilities: Abilities,
    /// Points under way, in the order in which they were sent.
    pub(super) under_way: VecDeque<Sent>,
    /// Time since which an answer or a sign of life is awaited.
    pub(super) since: Instant,
    /// Number of the first point that was sent to it.
    pub(super) first: u64,
    /// True if a point was sent to it.
    pub(super) asked: bool,
    /// Rows answered since the last sentinel that matched.
    pub(super) unchecked: Vec<usize>,
    /// True if it gave no value at some point: a failed request may spoil later ones.
    pub(super) troubled: bool,
    /// True if no point may be added to those under way, because one of them made a child crash.
    pub(super) exclusive: bool,
    /// Cancelled points, with their rows while the batch is the same.
    pub(super) cancelled: HashMap<u64, Option<usize>>,
    /// Places at which it has reported evaluations.
    pub(super) places: BTreeSet<String>,
    /// Conversion between its units and those of the study.
    pub(super) border: Border,
}

impl Worker {
    pub(super) fn new(child: Child, ready: &Line, border: Border, first: u64) -> Self {
        Self {
            child,
            window: ready.window.unwrap_or(1).max(1),
            abilities: Abilities {
                isolated: ready.isolated,
                cancel: ready.cancel,
                places: ready.places.unwrap_or(1).max(1),
            },
            under_way: VecDeque::new(),
            since: Instant::now(),
            first,
            asked: false,
            unchecked: Vec::new(),
            troubled: false,
            exclusive: false,
            cancelled: HashMap::new(),
            places: BTreeSet::new(),
            border,
        }
    }

    /// Earliest deadline of the points under way. A point that has started has its own clock. The others share one, which every answer and
    /// every sign of life restarts, up to a thousand timeouts after the oldest of them was sent.
    pub(super) fn deadline(&self, timeout: Duration) -> Option<Instant> {
        let own = self.under_way.iter().filter_map(|sent| sent.started).map(|started| started + timeout);
        own.chain(waiting_deadline(&self.under_way, self.since, timeout)).min()
    }

    /// Index in `under_way` of the point that has missed its deadline: the first that started, or else the oldest.
    pub(super) fn overdue(&self, timeout: Duration, now: Instant) -> Option<usize> {
        let late = |since: Instant| since + timeout <= now;
        let started = self.under_way.iter().position(|sent| sent.started.is_some_and(late));
        let late_wait = || waiting_deadline(&self.under_way, self.since, timeout).is_some_and(|until| until <= now);
        let waiting = || self.under_way.iter().position(|sent| sent.started.is_none()).filter(|_| late_wait());
        started.or_else(waiting)
    }

    /// Adds a point to those under way.
    pub(super) fn sent(&mut self, id: u64, row: usize) {
        self.asked = true;
        if self.under_way.is_empty() {
            self.since = Instant::now();
        }
        self.under_way.push_back(Sent { id, row, sent: Instant::now(), started: None });
    }

    /// Greatest number of points under way. None goes beyond the next sentinel, so that the number of sentinels does not depend on the
    /// order of answers.
    pub(super) fn room(&self) -> usize {
        self.window.min(interval(self.window).saturating_sub(self.unchecked.len()))
    }

    /// Cancels every point whose evaluation has not started, if the program can. Sentinels stay.
    pub(super) fn take_back(&mut self) {
        if !self.abilities.cancel {
            return;
        }
        let (kept, back): (VecDeque<Sent>, VecDeque<Sent>) = std::mem::take(&mut self.under_way)
            .into_iter()
            .partition(|sent| sent.started.is_some() || sent.row == SENTINEL);
        self.under_way = kept;
        self.cancel(back);
    }

    /// Sends a message that these points are no longer needed.
    pub(super) fn cancel(&mut self, points: impl IntoIterator<Item = Sent>) {
        let points: Vec<Sent> = points.into_iter().collect();
        if points.is_empty() {
            return;
        }
        let ids: Vec<String> = points.iter().map(|sent| sent.id.to_string()).collect();
        self.child.send(format!("{{\"cancel\":[{}]}}\n", ids.join(",")).into_bytes());
        self.cancelled.extend(points.iter().map(|sent| (sent.id, Some(sent.row))));
    }

    /// Notes a place of evaluation, up to the number of places that the program declared.
    pub(super) fn note_place(&mut self, place: Option<&String>) {
        if let Some(place) = place
            && self.abilities.places > 1
            && self.places.len() < self.abilities.places
        {
            self.places.insert(place.clone());
        }
    }
}

/// Deadline of the points that have not started: a timeout after the last sign of life, at the latest [`WAITS`] timeouts after the oldest
/// was sent. Returns None if all have started.
fn waiting_deadline(under_way: &VecDeque<Sent>, since: Instant, timeout: Duration) -> Option<Instant> {
    let oldest = under_way.iter().filter(|sent| sent.started.is_none()).map(|sent| sent.sent).min()?;
    let last = oldest.checked_add(timeout.saturating_mul(WAITS));
    Some(last.map_or(since + timeout, |last| last.min(since + timeout)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A program that reports life without end keeps a point for a thousand timeouts, and no longer.
    #[test]
    fn signs_of_life_have_an_end() {
        let (sent, timeout) = (Instant::now(), Duration::from_secs(2));
        let one = |started| VecDeque::from([Sent { id: 1, row: 0, sent, started }]);
        let until = |since| waiting_deadline(&one(None), sent + Duration::from_secs(since), timeout).unwrap() - sent;
        assert_eq!([0, 1, 1990].map(|since| until(since).as_secs()), [2, 3, 1992]);
        assert_eq!([1999, 5000, 1 << 20].map(|since| until(since).as_secs()), [2000; 3]);
        assert_eq!(waiting_deadline(&one(Some(sent)), sent, timeout), None);
        // The longest timeout of the settings does not overflow.
        assert!(waiting_deadline(&one(None), sent, Duration::from_secs(1 << 30)).is_some());
    }
}
