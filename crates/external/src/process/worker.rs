//! One ready child: what it can do, and the points under way in it.

use std::collections::{BTreeSet, HashMap, VecDeque};
use std::time::{Duration, Instant};

use super::border::Border;
use super::child::Child;
use super::protocol::Line;
use super::sentinel::{SENTINEL, interval};

/// The abilities that a program declares in `ready` beside its window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Abilities {
    /// Points do not share the process's fate: after a crash none of them is suspected.
    pub(super) isolated: bool,
    /// It takes back points that are no longer wanted.
    pub(super) cancel: bool,
    /// In how many places it evaluates.
    pub(super) places: usize,
}

/// A point under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sent {
    pub(super) id: u64,
    pub(super) row: usize,
    /// When the program said that its evaluation began; None while it waits in the program's own queue, or where the program
    /// does not say.
    pub(super) started: Option<Instant>,
}

pub(super) struct Worker {
    pub(super) child: Child,
    pub(super) window: usize,
    pub(super) abilities: Abilities,
    /// Points under way, in the order in which they were sent.
    pub(super) under_way: VecDeque<Sent>,
    /// Since when an answer or a sign of life is being waited for.
    pub(super) since: Instant,
    /// The number of the first point that it was sent.
    pub(super) first: u64,
    /// Whether it was sent any.
    pub(super) asked: bool,
    /// Rows that it has answered since it was last known to be right.
    pub(super) unchecked: Vec<usize>,
    /// Whether it had no value somewhere: a failed request may poison later ones.
    pub(super) troubled: bool,
    /// Whether nothing may join what is under way: among these points is one that made a child crash.
    pub(super) exclusive: bool,
    /// Points that were taken back, with their row while the batch is the same.
    pub(super) cancelled: HashMap<u64, Option<usize>>,
    /// Where it said that it evaluates.
    pub(super) places: BTreeSet<String>,
    /// Between its units and those of the study.
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

    /// The earliest moment at which something under way has taken too long. A point that has started has a clock of its own;
    /// the others share one, which every answer and every sign of life restarts.
    pub(super) fn deadline(&self, timeout: Duration) -> Option<Instant> {
        let shared = self.under_way.iter().any(|sent| sent.started.is_none()).then_some(self.since);
        self.under_way.iter().filter_map(|sent| sent.started).chain(shared).min().map(|since| since + timeout)
    }

    /// The place in `under_way` of the point that has taken too long: the one that started first, or else the oldest.
    pub(super) fn overdue(&self, timeout: Duration, now: Instant) -> Option<usize> {
        let late = |since: Instant| since + timeout <= now;
        let started = self.under_way.iter().position(|sent| sent.started.is_some_and(late));
        let waiting = || self.under_way.iter().position(|sent| sent.started.is_none()).filter(|_| late(self.since));
        started.or_else(waiting)
    }

    /// Adds a point to what is under way.
    pub(super) fn sent(&mut self, id: u64, row: usize) {
        self.asked = true;
        if self.under_way.is_empty() {
            self.since = Instant::now();
        }
        self.under_way.push_back(Sent { id, row, started: None });
    }

    /// Points that may be under way: none beyond the next check, so that the number of checks does not depend on when answers come.
    pub(super) fn room(&self) -> usize {
        self.window.min(interval(self.window).saturating_sub(self.unchecked.len()))
    }

    /// Takes back every point whose evaluation has not started, where the program can; a sentinel stays.
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

    /// Tells the program that these points are no longer wanted.
    pub(super) fn cancel(&mut self, points: impl IntoIterator<Item = Sent>) {
        let points: Vec<Sent> = points.into_iter().collect();
        if points.is_empty() {
            return;
        }
        let ids: Vec<String> = points.iter().map(|sent| sent.id.to_string()).collect();
        self.child.send(format!("{{\"cancel\":[{}]}}\n", ids.join(",")).into_bytes());
        self.cancelled.extend(points.iter().map(|sent| (sent.id, Some(sent.row))));
    }

    /// Notes where the program evaluates, as far as it declared several places.
    pub(super) fn note_place(&mut self, place: Option<&String>) {
        if let Some(place) = place
            && self.abilities.places > 1
            && self.places.len() < self.abilities.places
        {
            self.places.insert(place.clone());
        }
    }
}
