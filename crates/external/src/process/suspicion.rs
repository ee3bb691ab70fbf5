//! Finds the answers of a program that may depend on earlier points: those that fit worst into a surface of slopes and curvatures.
//!
//! An axis has answers `f+`, `f-` on either side of the centre's `f0`. Its slope is `g = |f+ - f-|/2`, its curvature `c = |f+ + f- - 2
//! f0|/2`, and its effect `e = max(g, c)`. `m` is the median of `e` over the axes. The score of a point is `max(c/(g + 0.02 m), e/(5 m))`,
//! and that of a pair `|f_ij - f_i - f_j + f0| / (0.5 (g_i + g_j) + 0.02 m)`.
//!
//! The score ranks points, in turns of those on axes and others. It is not a test: smooth and strongly curved models come out on top as
//! well, and their answers repeat.

use std::collections::{HashMap, HashSet};

/// Greatest number of answers that are kept. It covers the axes of any plan that a process can pay for.
const KEPT: usize = 20_000;
/// Part of all answers that is replayed.
const PART: f64 = 0.05;
/// Replays owed wait for the next batch while they are at most this part of those made: 4.5 % are replayed at any time.
const PATIENCE: usize = 10;
/// Smallest number of replayed answers, besides the random ones.
const LEAST: usize = 5;
/// Number of the replayed answers that are chosen independently of their score.
const RANDOM: usize = 2;
/// Greatest number of replayed answers. They find flips in 5 % of the points with a probability of 95 %, since 0.95^59 < 0.05.
const MOST: usize = 59;
/// Fraction of the median effect in the denominator, which keeps a quotient finite.
const FLOOR: f64 = 0.02;

/// A point by the bits of its coordinates. A negative zero is stored as zero.
type Key = Vec<u64>;

fn key(point: &[f64]) -> Key {
    point.iter().map(|&x| (x + 0.0).to_bits()).collect()
}

/// Answers by point, across batches: a stage of pairs is compared with the axes of an earlier stage.
#[derive(Debug, Default)]
pub(super) struct Answers {
    known: HashMap<Key, Vec<Option<f64>>>,
    centre: Option<Vec<f64>>,
    answered: usize,
    replayed: usize,
    /// Number of answers that were not kept for lack of space: of the last batch, and of those before it.
    dropped: [usize; 2],
    /// Points with answers that a fresh process confirmed, or that are known to have none.
    confirmed: HashSet<Key>,
    /// Confirmed points that were not yet handed out by `take_confirmed`.
    newly_confirmed: Vec<Vec<f64>>,
}

/// A point and its answers.
pub(super) type Answered = (Vec<f64>, Vec<Option<f64>>);

impl Answers {
    /// Notes an answer that a fresh process confirmed, or that is not used any more.
    pub(super) fn confirm(&mut self, point: &[f64]) {
        let key = key(point);
        if self.known.contains_key(&key) && self.confirmed.insert(key) {
            self.newly_confirmed.push(point.to_vec());
        }
    }

    /// True if a fresh process confirmed the answer to this point.
    pub(super) fn is_confirmed(&self, point: &[f64]) -> bool {
        self.confirmed.contains(&key(point))
    }

    /// Points with answers that were confirmed since the last call.
    pub(super) fn take_confirmed(&mut self) -> Vec<Vec<f64>> {
        std::mem::take(&mut self.newly_confirmed)
    }

    /// Answers of earlier batches without a confirmation, and the number of further ones that were not kept.
    pub(super) fn unconfirmed(&mut self, batch: &[Vec<f64>]) -> (Vec<Answered>, usize) {
        let batch: HashSet<Key> = batch.iter().map(|point| key(point)).collect();
        let open = |key: &Key| !self.confirmed.contains(key) && !batch.contains(key);
        let mut found: Vec<(&Key, &Vec<Option<f64>>)> = self.known.iter().filter(|(key, _)| open(key)).collect();
        found.retain(|(_, values)| values.iter().any(Option::is_some));
        // Sorted, since the order of a hash map differs between runs.
        found.sort_unstable_by(|a, b| a.0.cmp(b.0));
        let point = |key: &Key| key.iter().map(|&bits| f64::from_bits(bits)).collect();
        let found = found.into_iter().map(|(key, values)| (point(key), values.clone())).collect();
        // The current batch is confirmed by now, so only the count of earlier ones is returned.
        let [_, dropped] = std::mem::take(&mut self.dropped);
        (found, dropped)
    }

    /// Adds answers of an earlier run, which checked a part of them or each. They need no replay until a flip is found.
    pub(super) fn remember(
        &mut self,
        points: &[Vec<f64>],
        values: &[Vec<Option<f64>>],
        nominal: &[f64],
        each_confirmed: bool,
    ) {
        let answered = self.answered;
        self.learn(points, values, nominal);
        self.answered = answered;
        if each_confirmed {
            self.confirmed.extend(points.iter().map(|point| key(point)));
        }
    }

    /// Adds new answers. The first point of all becomes the centre, unless more points are one step away from the nominal one.
    pub(super) fn learn(&mut self, points: &[Vec<f64>], values: &[Vec<Option<f64>>], nominal: &[f64]) {
        self.answered += points.len();
        self.dropped = [0, self.dropped[0] + self.dropped[1]];
        if let Some(first) = points.first()
            && self.centre.is_none()
        {
            let steps = |centre: &[f64]| points.iter().filter(|point| moved(centre, point).len() == 1).count();
            let centre = if steps(first) >= steps(nominal) { first.as_slice() } else { nominal };
            self.centre = Some(centre.to_vec());
        }
        for (point, values) in points.iter().zip(values) {
            if self.known.len() < KEPT || self.known.contains_key(&key(point)) {
                self.known.insert(key(point), values.clone());
            } else {
                self.dropped[0] += 1;
            }
        }
    }

    /// Number of answers to replay once so many more are there. Few of them wait for the next batch, since a check of its own takes as long
    /// for one as for many.
    pub(super) fn owed_after(&self, more: usize, given: Option<usize>) -> usize {
        let all = most_replays(self.answered + more, given);
        let owed = all.saturating_sub(self.replayed);
        let may_wait = given.is_none() && all < MOST && owed * PATIENCE <= self.replayed;
        if may_wait { 0 } else { owed }
    }

    /// Rows to replay: those with the highest scores, and two others. Their number follows from `most` or from the usual part, less those
    /// replayed before.
    pub(super) fn choose(
        &mut self,
        points: &[Vec<f64>],
        values: &[Vec<Option<f64>>],
        nominal: &[f64],
        most: Option<usize>,
    ) -> Vec<usize> {
        let owed = self.owed_after(0, most);
        let scores = self.scores(points, values);
        let usable = |&row: &usize| values[row].iter().any(Option::is_some) && !moved(nominal, &points[row]).is_empty();
        let mut rows: Vec<usize> = (0..points.len()).filter(usable).collect();
        rows.sort_by(|&a, &b| scores[b].total_cmp(&scores[a]).then(a.cmp(&b)));
        // Points on axes and others take turns, since a wrong answer on an axis raises the scores of all pairs that use it.
        let on_axis = |&row: &usize| self.centre.as_ref().is_some_and(|centre| moved(centre, &points[row]).len() == 1);
        let (axes, others): (Vec<usize>, Vec<usize>) = rows.into_iter().partition(on_axis);
        let ranked = |of: Vec<usize>| of.into_iter().enumerate();
        let mut turns: Vec<(usize, usize)> = ranked(axes).map(|(turn, row)| (2 * turn, row)).collect();
        turns.extend(ranked(others).map(|(turn, row)| (2 * turn + 1, row)));
        turns.sort_unstable();
        let mut rows: Vec<usize> = turns.into_iter().map(|(_, row)| row).collect();
        let random = RANDOM.min(owed);
        let mut others = rows.split_off((owed - random).min(rows.len()));
        // Fractions of the golden ratio give the same choice in every run, and no plan has such a pattern.
        for turn in 1..=random {
            if !others.is_empty() {
                let place = (turn as f64 * 0.618_033_988_749_894_9).fract() * others.len() as f64;
                rows.push(others.swap_remove(place as usize));
            }
        }
        self.replayed += rows.len();
        rows
    }

    fn value(&self, point: &[f64], output: usize) -> Option<f64> {
        *self.known.get(&key(point))?.get(output)?
    }

    /// Score of every row; 0 if it cannot be computed.
    fn scores(&self, points: &[Vec<f64>], values: &[Vec<Option<f64>>]) -> Vec<f64> {
        let mut scores = vec![0.0f64; points.len()];
        if let Some(centre) = &self.centre {
            (0..values.first().map_or(0, Vec::len))
                .for_each(|output| self.score(centre, output, points, values, &mut scores));
        }
        scores
    }

    /// Raises the scores to those of one output.
    fn score(
        &self,
        centre: &[f64],
        output: usize,
        points: &[Vec<f64>],
        values: &[Vec<Option<f64>>],
        scores: &mut [f64],
    ) {
        let Some(f0) = self.value(centre, output) else { return };
        let axes = self.axes(centre, output, f0);
        let mut effects: Vec<f64> = axes.values().map(|axis| axis.slope.max(axis.curvature)).collect();
        effects.sort_by(f64::total_cmp);
        let Some(&median) = effects.get(effects.len() / 2) else { return };
        let slope = |d: usize| axes.get(&d).map_or(0.0, |axis| axis.slope);
        for (row, point) in points.iter().enumerate() {
            let Some(value) = values[row][output] else { continue };
            let score = match moved(centre, point)[..] {
                [d] => axes.get(&d).map_or(0.0, |axis| {
                    let curved = axis.curvature / (axis.slope + FLOOR * median);
                    curved.max(axis.slope.max(axis.curvature) / (5.0 * median))
                }),
                [i, j] => {
                    let alone = |d: usize| {
                        let mut at = centre.to_vec();
                        at[d] = point[d];
                        self.value(&at, output)
                    };
                    alone(i).zip(alone(j)).map_or(0.0, |(fi, fj)| {
                        (value - fi - fj + f0).abs() / (0.5 * (slope(i) + slope(j)) + FLOOR * median)
                    })
                }
                _ => 0.0,
            };
            // An output that does not vary gives 0/0, which fails this comparison.
            if score > scores[row] {
                scores[row] = score;
            }
        }
    }

    /// Slope and curvature along every axis with answers on both sides, from the pair of points nearest to the centre.
    fn axes(&self, centre: &[f64], output: usize, f0: f64) -> HashMap<usize, Axis> {
        let mut sides: HashMap<usize, [Option<(f64, f64)>; 2]> = HashMap::new();
        for (key, values) in &self.known {
            let point: Vec<f64> = key.iter().map(|&bits| f64::from_bits(bits)).collect();
            if let ([d], Some(value)) = (&moved(centre, &point)[..], values.get(output).copied().flatten()) {
                let step = point[*d] - centre[*d];
                let side = &mut sides.entry(*d).or_default()[usize::from(step > 0.0)];
                if side.is_none_or(|(nearest, _)| step.abs() < nearest) {
                    *side = Some((step.abs(), value));
                }
            }
        }
        let axis = |(d, [left, right]): (usize, [Option<(f64, f64)>; 2])| {
            let ((_, left), (_, right)) = (left?, right?);
            Some((d, Axis { slope: (right - left).abs() / 2.0, curvature: (right + left - 2.0 * f0).abs() / 2.0 }))
        };
        sides.into_iter().filter_map(axis).collect()
    }
}

/// Number of replays of so many answers: the given number, or else the usual part.
pub(super) fn most_replays(answers: usize, given: Option<usize>) -> usize {
    let part = (PART * answers as f64).ceil() as usize;
    given.unwrap_or(part.clamp(LEAST + RANDOM, MOST))
}

struct Axis {
    slope: f64,
    curvature: f64,
}

/// Indices of the coordinates in which two points differ.
pub(super) fn moved(from: &[f64], to: &[f64]) -> Vec<usize> {
    (0..from.len()).filter(|&d| from[d] != to[d]).collect()
}
