//! Walks from the nominal point to points in small steps, side by side in as many fresh children as there are.

use std::collections::VecDeque;

use super::batch::Batch;
use super::lane::Lane;
use super::pool::{Pool, State};
use super::protocol::request;
use super::sentinel::{FLIP, Values};
use super::suspicion::moved;
use sensitol::assembly::{EvaluationError, Points, Responses, Run};
use sensitol::assembly::{ProcessError, ProcessFault};

/// Number of equal steps of a walk.
pub(super) const STEPS: usize = 3;
/// Route from the nominal point to another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Route {
    /// All dimensions at once.
    Straight,
    /// One dimension after the other.
    AxisByAxis,
}

impl Route {
    /// Points on the route, the last one included.
    fn points(self, from: &[f64], to: &[f64]) -> Vec<Vec<f64>> {
        let part = |start: &[f64], end: &[f64], step: usize, steps: usize| -> Vec<f64> {
            let between =
                |(&a, &b): (&f64, &f64)| if step == steps { b } else { a + (b - a) * step as f64 / steps as f64 };
            start.iter().zip(end).map(between).collect()
        };
        match self {
            _ if from == to => vec![to.to_vec()],
            Self::Straight => (1..=STEPS).map(|step| part(from, to, step, STEPS)).collect(),
            Self::AxisByAxis => {
                let moved = moved(from, to);
                // A single dimension has no second route, so the steps become smaller.
                let steps = if moved.len() == 1 { 2 * STEPS - 1 } else { STEPS.div_ceil(moved.len().max(1)).max(2) };
                let mut at = from.to_vec();
                let mut way = Vec::new();
                for d in moved.into_iter().rev() {
                    let mut next = at.clone();
                    next[d] = to[d];
                    way.extend((1..=steps).map(|step| part(&at, &next, step, steps)));
                    at = next;
                }
                way
            }
        }
    }
}

/// Result of one walk.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Walked {
    /// The process did not reach the end: it crashed, was too slow, or could not be started. The answer remains open.
    Lost,
    /// The nominal point had another value than expected at the start of the walk, so the end does not count.
    Astray,
    /// Values at the end of the walk.
    There(Values),
}

impl Walked {
    pub(super) fn values(&self) -> Option<&Values> {
        match self {
            Self::There(values) => Some(values),
            _ => None,
        }
    }
}

/// Number of fresh children with another value of the nominal point than expected, after which the walk has no end.
const ASTRAY: usize = 3;

/// Answers to the points of a way; None if its end was not reached.
type WayAnswers = Option<Vec<Values>>;

/// State of the walks to some points.
struct Walks {
    /// Targets without a walk so far, in order.
    open: VecDeque<usize>,
    ended: Vec<Option<Walked>>,
    /// Number of fresh children with another value of the nominal point than expected, for every target.
    strays: Vec<usize>,
    /// Values of the nominal point that every walk must begin with; None before the first walk.
    truth: Option<Values>,
    /// Values of the nominal point that fresh children gave in a row, and that are not the expected ones.
    others: Vec<Values>,
    /// True if the expected values were replaced once.
    corrected: bool,
}

impl Walks {
    fn new(targets: usize) -> Self {
        let ended = (0..targets).map(|_| None).collect();
        let strays = vec![0; targets];
        Self { open: (0..targets).collect(), ended, strays, truth: None, others: Vec::new(), corrected: false }
    }

    /// Begins all walks again with other values of the nominal point.
    fn begin_again(&mut self, nominal: Values) {
        let targets = self.ended.len();
        *self = Self { truth: Some(nominal), corrected: true, ..Self::new(targets) };
    }
}

impl Pool {
    /// Answers at these points, each reached from the nominal one by a child that has made no long step before. Returns None if a stop came
    /// before the end.
    pub(super) fn walk(
        &mut self,
        targets: &[Vec<f64>],
        route: Route,
        out: &mut Responses,
        run: &Run<'_>,
    ) -> Option<Vec<Walked>> {
        let mut walks = Walks::new(targets.len());
        let mut lanes = self.lanes(targets.len());
        self.end_used_children(lanes.iter().map(|lane| lane.slot));
        while !walks.open.is_empty() {
            // One walk in every lane. All walks of a route have about the same length, so lanes hardly wait for each other.
            let count = lanes.len().min(walks.open.len());
            let round: Vec<usize> = walks.open.drain(..count).collect();
            let way = |&target: &usize| {
                let mut way = vec![self.hello.nominal.clone()];
                way.extend(route.points(&way[0], &targets[target]));
                way
            };
            let ways: Vec<Vec<Vec<f64>>> = round.iter().map(way).collect();
            let (answers, returned) = self.side_by_side(&ways, lanes, out, run)?;
            lanes = returned;
            let mut renewed = Vec::new();
            for (lane, (target, answers)) in lanes.iter_mut().zip(round.into_iter().zip(answers)) {
                // All walks began again during this round, and this one is open once more.
                let begun_again = walks.open.contains(&target);
                if !begun_again && !self.end_of_walk(&mut walks, target, answers, lane.used) {
                    renewed.push(lane.slot);
                }
                lane.used = true;
            }
            for lane in &mut lanes {
                lane.used &= !renewed.contains(&lane.slot);
            }
            self.end_used_children(renewed);
            if walks.truth.is_none() {
                // No child can be started any more.
                return Some(vec![Walked::Lost; targets.len()]);
            }
        }
        Some(walks.ended.into_iter().map(|walked| walked.unwrap_or(Walked::Lost)).collect())
    }

    /// Lanes for so many walks: every child, and in a child that evaluates at several places each of those.
    fn lanes(&self, walks: usize) -> Vec<Lane> {
        let mut lanes = Vec::new();
        for (slot, places) in self.places() {
            // A child without places gets its points one at a time, since it may evaluate them in one process.
            let places = if places.is_empty() { vec![None] } else { places.into_iter().map(Some).collect() };
            lanes.extend(places.into_iter().map(|place| Lane { slot, place, used: false }));
        }
        lanes.truncate(walks);
        lanes
    }

    /// Takes the end of a walk into account. Returns false if its child must be replaced.
    fn end_of_walk(&mut self, walks: &mut Walks, target: usize, answers: WayAnswers, used: bool) -> bool {
        let Some(answers) = answers else {
            walks.ended[target] = Some(Walked::Lost);
            return false;
        };
        let nominal = &answers[0];
        let Some(truth) = walks.truth.clone() else {
            // A fresh child has made no long step, so its value of the nominal point becomes the reference.
            self.reference.trust(nominal);
            walks.truth = Some(nominal.clone());
            walks.ended[target] = answers.last().cloned().map(Walked::There);
            return true;
        };
        if self.settles(&truth, nominal) {
            walks.others.clear();
            walks.ended[target] = answers.last().cloned().map(Walked::There);
            return true;
        }
        if used {
            // The child flipped on the way back, and a fresh one walks to the point.
            walks.open.push_front(target);
            return false;
        }
        // Two fresh children that give different values of one point are a flip.
        self.set_flips();
        if !walks.corrected && walks.others.iter().any(|other| self.settles(other, nominal)) {
            // The expected value was the wrong one, so the walks that began with it do not count.
            self.reference.trust(nominal);
            walks.begin_again(nominal.clone());
            return false;
        }
        walks.strays[target] += 1;
        if walks.strays[target] < ASTRAY {
            walks.others.push(nominal.clone());
            walks.open.push_front(target);
        } else {
            walks.others.clear();
            walks.ended[target] = Some(Walked::Astray);
        }
        false
    }

    /// True if the nominal point has the expected values. Small differences are added to the noise.
    fn settles(&mut self, expected: &Values, found: &Values) -> bool {
        self.noise.resize(expected.len(), 0.0);
        let mut same = true;
        for (output, (a, b)) in expected.iter().zip(found).enumerate() {
            match (a, b) {
                (Some(a), Some(b)) if (a - b).abs() <= FLIP * self.reference.spread(output) => {
                    self.noise[output] = self.noise[output].max((a - b).abs());
                }
                (None, None) => {}
                (Some(a), Some(b)) if a == b => {}
                _ => same = false,
            }
        }
        same
    }

    /// Answers to the points of each way, in order, each way in its own lane; None for a way whose end was not reached. Returns None if a
    /// stop came first.
    fn side_by_side(
        &mut self,
        ways: &[Vec<Vec<f64>>],
        lanes: Vec<Lane>,
        out: &mut Responses,
        run: &Run<'_>,
    ) -> Option<(Vec<WayAnswers>, Vec<Lane>)> {
        let rows: Vec<&[f64]> = ways.iter().flatten().map(Vec::as_slice).collect();
        let mut answers = Responses::open(rows.len(), out.outputs());
        let (stopped, abandoned) = (|| run.stop_reason(), || run.abandoned());
        let quiet = Run::to_the_end().stopping_when(&stopped).abandoning_when(&abandoned);
        let points = Points::from_rows(&rows);
        let lengths: Vec<usize> = ways.iter().map(Vec::len).collect();
        self.walking = lanes;
        self.work_off(Batch::in_lanes(&points, &mut answers, &lengths), &quiet);
        let lanes = std::mem::take(&mut self.walking);
        let sent = answers.answered().count();
        out.spent(sent as i64 + answers.extra());
        if sent < rows.len() {
            return None;
        }
        let mut lost = vec![false; rows.len()];
        for (row, _, error) in answers.errors() {
            lost[row] |= match error {
                EvaluationError::Process(error) => !matches!(error.fault, ProcessFault::NoValue { .. }),
                _ => true,
            };
        }
        let mut found = Vec::new();
        let mut first = 0;
        for length in lengths {
            let rows = first..first + length;
            let values = |row: usize| (0..answers.outputs()).map(|output| answers.value(row, output)).collect();
            found.push((!lost[rows.clone()].contains(&true)).then(|| rows.map(values).collect()));
            first += length;
        }
        Some((found, lanes))
    }

    /// Starts a child for every lane with points to send, and sends each lane its next point once the last one is answered.
    pub(super) fn dispatch_walks(&mut self, batch: &mut Batch<'_>) -> Result<(), ProcessError> {
        for lane in 0..self.walking.len() {
            let slot = self.walking[lane].slot;
            if batch.lane_is_empty(lane) || !self.ensure_child(slot)? {
                continue;
            }
            let place = self.walking[lane].place.clone();
            let id = self.next_point;
            let State::Ready(worker) = &mut self.slots[slot].state else { continue };
            // A fresh child may have a smaller window than the one that told its places.
            let is_full = worker.under_way.len() >= worker.window;
            if is_full || worker.under_way.iter().any(|sent| batch.lane_of(sent.row) == lane) {
                continue;
            }
            let Some(row) = batch.take_from_lane(lane) else { continue };
            let mut line = Vec::new();
            request(&mut line, id, worker.border.out(batch.points.row(row).into_iter()), place.as_deref());
            worker.sent(id, row);
            worker.child.send(line);
            batch.sends(row);
            self.next_point += 1;
        }
        Ok(())
    }
}
