//! Open work of a batch of points, and its results.

use std::collections::{HashMap, HashSet, VecDeque};

use super::protocol::Line;
use sensitol::assembly::{Points, Progress, Responses, Run};
use sensitol::assembly::{ProcessError, ProcessFault, StderrTail};

/// Open work of a batch of points.
pub(super) struct Batch<'a> {
    pub(super) points: &'a Points,
    pub(super) out: &'a mut Responses,
    pub(super) waiting: VecDeque<usize>,
    /// Groups of rows of which one made a child crash. Each group is tried again with nothing else under way, and is divided after another
    /// crash.
    pub(super) suspects: VecDeque<Vec<usize>>,
    /// Number of failures of every row that had one.
    pub(super) failures: HashMap<usize, u32>,
    pub(super) left: usize,
    /// Rows that are evaluated a second time, because the child that answered them is not trusted.
    pub(super) again: HashSet<usize>,
    /// Rows whose second answer is in doubt as well.
    pub(super) twice: HashSet<usize>,
    /// Rows with final answers that are not yet reported.
    pub(super) done: Vec<usize>,
    /// Rows with withdrawn answers that are not yet reported.
    pub(super) withdrawn: Vec<usize>,
    pub(super) sent: usize,
    /// Number of these sends that repeated a row.
    pub(super) resent: usize,
    ever: Vec<bool>,
    /// Rows of every walk that are still to be sent, in their order. Empty in a batch without walks.
    lanes: Vec<VecDeque<usize>>,
    /// Walk of every row. Empty in a batch without walks.
    lane_of: Vec<usize>,
}

impl<'a> Batch<'a> {
    /// Batch in which every row of `points` without an answer is waiting.
    pub(super) fn new(points: &'a Points, out: &'a mut Responses) -> Self {
        let is_open = |row: &usize| (0..out.outputs()).any(|output| out.is_open(*row, output));
        let waiting: VecDeque<usize> = (0..points.rows()).filter(is_open).collect();
        Self {
            left: waiting.len(),
            points,
            out,
            waiting,
            suspects: VecDeque::new(),
            failures: HashMap::new(),
            again: HashSet::new(),
            twice: HashSet::new(),
            done: Vec::new(),
            withdrawn: Vec::new(),
            sent: 0,
            resent: 0,
            ever: vec![false; points.rows()],
            lanes: Vec::new(),
            lane_of: Vec::new(),
        }
    }

    /// Batch of walks with these numbers of points, one after the other in `points`.
    pub(super) fn in_lanes(points: &'a Points, out: &'a mut Responses, lengths: &[usize]) -> Self {
        let mut batch = Self::new(points, out);
        let mut rows = std::mem::take(&mut batch.waiting);
        for (lane, &length) in lengths.iter().enumerate() {
            batch.lanes.push(rows.drain(..length).collect());
            batch.lane_of.extend(std::iter::repeat_n(lane, length));
        }
        batch
    }

    pub(super) fn lane_is_empty(&self, lane: usize) -> bool {
        self.lanes.get(lane).is_none_or(VecDeque::is_empty)
    }

    /// Walk of a row.
    pub(super) fn lane_of(&self, row: usize) -> usize {
        self.lane_of[row]
    }

    /// Next row of a walk.
    pub(super) fn take_from_lane(&mut self, lane: usize) -> Option<usize> {
        self.lanes.get_mut(lane)?.pop_front()
    }

    /// Sends a row again before all others, a row of a walk in its own lane.
    pub(super) fn put_back(&mut self, row: usize) {
        match self.lane_of.get(row) {
            Some(&lane) => self.lanes[lane].push_front(row),
            None => self.waiting.push_front(row),
        }
    }

    /// Tries a row again with nothing else under way in its child, a row of a walk in its own lane.
    pub(super) fn try_again(&mut self, row: usize) {
        match self.lane_of.get(row) {
            Some(&lane) => self.lanes[lane].push_front(row),
            None => self.suspects.push_back(vec![row]),
        }
    }

    /// Number of rows that are still to be sent.
    pub(super) fn unsent(&self) -> usize {
        self.waiting.len() + self.suspects.iter().map(Vec::len).sum::<usize>()
    }

    /// Tries the rows of a crash again in two groups.
    pub(super) fn divide(&mut self, rows: &[usize]) {
        let (first, second) = rows.split_at(rows.len().div_ceil(2));
        self.suspects.extend([first, second].into_iter().filter(|half| !half.is_empty()).map(<[usize]>::to_vec));
    }

    /// Counts a send of a row.
    pub(super) fn sends(&mut self, row: usize) {
        self.sent += 1;
        self.resent += usize::from(std::mem::replace(&mut self.ever[row], true));
    }

    /// True if the row is evaluated with nothing else under way in its child.
    pub(super) fn goes_alone(&self, row: usize) -> bool {
        self.failures.contains_key(&row) || self.again.contains(&row)
    }

    /// Points of the rows.
    pub(super) fn coordinates(&self, rows: &[usize]) -> Vec<Vec<f64>> {
        rows.iter().map(|&row| self.points.row(row)).collect()
    }

    /// Counts a failure of a row. Returns its failures so far.
    pub(super) fn charged(&mut self, row: usize) -> u32 {
        let failures = self.failures.entry(row).or_insert(0);
        *failures += 1;
        *failures
    }

    /// Tries a row again, or fails it after more than `retries` failures.
    pub(super) fn charge(&mut self, row: usize, error: &ProcessError, retries: u32) {
        if self.charged(row) <= retries {
            self.try_again(row);
        } else {
            self.fail(row, error);
        }
    }

    pub(super) fn fail(&mut self, row: usize, error: &ProcessError) {
        for output in 0..self.out.outputs() {
            self.out.fail(row, output, Box::new(error.clone()).into());
        }
        self.finish(row);
    }

    /// Evaluates rows with doubtful answers again, but once only. An answer that is in doubt a second time stays in doubt.
    pub(super) fn distrust(&mut self, rows: &[usize]) {
        self.withdrawn.extend(rows);
        for &row in rows {
            if self.again.insert(row) {
                self.waiting.push_back(row);
                self.left += 1;
            } else {
                self.twice.insert(row);
            }
        }
    }

    pub(super) fn finish(&mut self, row: usize) {
        self.left -= 1;
        // A new answer takes the place of the withdrawn one.
        self.withdrawn.retain(|&withdrawn| withdrawn != row);
        self.done.push(row);
    }

    /// Stores the answer of the model: values, and the reason for each that is missing.
    pub(super) fn settle(&mut self, row: usize, line: Line, names: &[String]) {
        let no_value = |message: String| {
            // A failure that another attempt could have mended is no answer of the model.
            let fault = if line.retry && line.error.is_some() {
                ProcessFault::Unable { message }
            } else {
                ProcessFault::NoValue { message }
            };
            Box::new(ProcessError { fault, stderr: StderrTail::default() }).into()
        };
        for (output, name) in names.iter().enumerate() {
            let value = line.y.as_ref().and_then(|values| values[output]);
            match (value, &line.error) {
                (Some(value), None) => {
                    self.out.set(row, output, value);
                    if let Some(dy) = &line.dy {
                        self.out.set_gradient(row, output, dy[output].clone());
                    }
                }
                (_, Some(message)) => self.out.fail(row, output, no_value(message.clone())),
                (None, None) => {
                    let message = line.errors.get(name).cloned();
                    let silent = if line.not_finite { "NaN or an infinity" } else { "null" };
                    self.out.fail(
                        row,
                        output,
                        no_value(message.unwrap_or_else(|| format!("the model returned {silent}"))),
                    );
                }
            }
        }
        self.finish(row);
    }

    /// Fails everything that is open with this error, since no child can be started any more.
    pub(super) fn give_up(&mut self, error: &ProcessError) {
        for row in 0..self.out.rows() {
            if (0..self.out.outputs()).any(|output| self.out.is_open(row, output)) {
                self.fail(row, error);
            }
        }
        // A row that was to be evaluated again keeps its first answer.
        self.waiting.clear();
        self.lanes.iter_mut().for_each(VecDeque::clear);
        self.suspects.clear();
        self.left = 0;
    }

    pub(super) fn tell(&mut self, run: &Run<'_>) {
        if !self.done.is_empty() {
            let failed = self.out.failed_among(&self.done);
            run.progressed(Progress { points: self.done.len(), failed, reused: 0 });
            run.finished(&self.done, self.out);
            self.done.clear();
        }
        if !self.withdrawn.is_empty() {
            run.withdraw(&self.withdrawn);
            self.withdrawn.clear();
        }
    }
}
