//! Search that moves from a point to a better one by true values: along every coordinate, then along several at once.
//!
//! A climb evaluates nothing. It returns the points that it needs, gets their values, and moves. Values are signed so
//! that less is better. A point without a value is never better.

use crate::extremes::model::{Model, Region};
use sensitol_numeric::surrogate::Univariate;

/// Search that continues from `x` with value `y`.
#[derive(Debug, Clone)]
pub(super) struct Climb<'r> {
    region: &'r Region,
    pub(super) x: Vec<f64>,
    pub(super) y: f64,
    /// Step to both sides of an interior coordinate for every dimension, as a part of the width of the box.
    step: Vec<f64>,
    /// Surrogate, for its products.
    surrogate: &'r Model,
    phase: Phase,
    rounds: usize,
    /// Gain of the rounds along interior coordinates since the last round along all.
    gained: f64,
}

/// Coordinates that are moved next.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    /// All coordinates, to the other end of the box.
    All,
    /// Interior coordinates, a step to either side.
    Interior,
    Done,
}

/// First step about an interior coordinate, as a part of the width of the box.
const STEP: f64 = 0.125;
/// Factor by which the step is shortened after a round without gain.
const SHORTER: f64 = 0.125;
/// Least step, as a part of the width of the box.
const SHORTEST: f64 = 1e-3;
/// Greatest number of interior coordinates whose pairs are evaluated.
const TOGETHER: usize = 8;
/// Rounds after which a climb ends in any case.
const ROUNDS: usize = 40;

impl<'r> Climb<'r> {
    pub(super) fn new(region: &'r Region, surrogate: &'r Model, x: Vec<f64>, y: f64) -> Self {
        let step = vec![STEP; region.len()];
        Self { region, x, y, step, surrogate, phase: Phase::All, rounds: 0, gained: 0.0 }
    }

    pub(super) fn done(&self) -> bool {
        self.phase == Phase::Done
    }

    fn interior(&self, d: usize) -> bool {
        self.region.lower[d] < self.x[d] && self.x[d] < self.region.upper[d]
    }

    /// Coordinates of the samples on the line through `x` along `d`.
    fn line(&self, d: usize) -> Vec<f64> {
        let (lower, upper) = (self.region.lower[d], self.region.upper[d]);
        let reach = self.step[d] * self.region.width(d);
        let sides = || [self.x[d] - reach, self.x[d] + reach].map(|x| self.region.clamp(d, x));
        let mut line = match (self.phase, self.interior(d)) {
            (Phase::All, false) => vec![lower, 0.5 * (lower + upper), upper],
            (Phase::All, true) => [[lower, upper], sides()].concat(),
            (Phase::Interior, true) => sides().to_vec(),
            (Phase::Interior, false) | (Phase::Done, _) => Vec::new(),
        };
        line.sort_unstable_by(f64::total_cmp);
        line.dedup();
        line.retain(|&x| x != self.x[d]);
        line
    }

    fn with(&self, d: usize, x: f64) -> Vec<f64> {
        let mut point = self.x.clone();
        point[d] = x;
        point
    }

    /// Pairs of interior coordinates that are moved together to find their mixed derivatives, if there are few.
    fn pairs(&self) -> Vec<(usize, usize)> {
        let interior: Vec<usize> = (0..self.x.len()).filter(|&d| self.interior(d)).collect();
        if self.phase != Phase::Interior || interior.len() > TOGETHER {
            return Vec::new();
        }
        let with =
            |(place, &j): (usize, &usize)| interior[place + 1..].iter().map(move |&k| (j, k)).collect::<Vec<_>>();
        interior.iter().enumerate().flat_map(with).collect()
    }

    /// Point with both coordinates at the upper ends of their lines, and the two coordinates.
    fn pair(&self, j: usize, k: usize) -> Option<(f64, f64, Vec<f64>)> {
        let (at_j, at_k) = (*self.line(j).last()?, *self.line(k).last()?);
        let mut point = self.with(j, at_j);
        point[k] = at_k;
        Some((at_j, at_k, point))
    }

    /// Points on the lines through `x`: two for a coordinate at a bound, up to four for an interior one, one for a pair.
    pub(super) fn samples(&self) -> Vec<Vec<f64>> {
        let lines = (0..self.x.len()).flat_map(|d| self.line(d).into_iter().map(move |x| self.with(d, x)));
        let pairs = self.pairs().into_iter().filter_map(|(j, k)| Some(self.pair(j, k)?.2));
        lines.chain(pairs).collect()
    }

    /// Promising points from the samples: coordinates at the lowest points of curves through their lines, all, some or one at once.
    pub(super) fn candidates(&self, value: &impl Fn(&[f64]) -> Option<f64>) -> Vec<Vec<f64>> {
        let known: Vec<Vec<(f64, f64)>> = (0..self.x.len())
            .map(|d| self.line(d).into_iter().filter_map(|x| Some((x, value(&self.with(d, x))?))).collect())
            .collect();
        let (region, model) = self.local(&known, value);
        let separate = model.separate();
        let mut moves: Vec<(usize, f64, f64)> = (0..self.x.len())
            .map(|d| (d, separate.lowest(&region, &self.x, d)))
            .filter_map(|(d, (x, gain))| (gain > 0.0).then_some((d, x, gain)))
            .collect();
        moves.sort_by(|a, b| b.2.total_cmp(&a.2));
        let together = |moves: &mut dyn Iterator<Item = (usize, f64, f64)>| {
            let mut point = self.x.clone();
            moves.for_each(|(d, x, _)| point[d] = x);
            point
        };
        let half = moves.len().div_ceil(2);
        let corners: Vec<(usize, f64, f64)> =
            (0..self.x.len()).filter_map(|d| Some((d, self.corner(d, &known[d])?, 0.0))).collect();
        let mut candidates = vec![
            model.descend(&region, &self.x),
            together(&mut moves.iter().copied()),
            together(&mut moves.iter().take(half).copied()),
            together(&mut moves.iter().copied().filter(|(d, _, _)| d % 2 == 0)),
            together(&mut moves.iter().copied().filter(|(d, _, _)| d % 2 == 1)),
            together(&mut moves.iter().take(1).copied()),
            together(&mut corners.iter().copied()),
        ];
        candidates.extend(corners.iter().map(|&corner| together(&mut std::iter::once(corner))));
        candidates.retain(|point| *point != self.x);
        candidates
    }

    /// Local model about `x` from curves through the lines and the surrogate's products, within the sampled range.
    fn local(&self, known: &[Vec<(f64, f64)>], value: &impl Fn(&[f64]) -> Option<f64>) -> (Region, Model) {
        let ends = |d: usize| known[d].iter().map(|&(x, _)| x).chain([self.x[d]]);
        let n = self.x.len();
        let region = Region {
            lower: (0..n).map(|d| ends(d).fold(f64::INFINITY, f64::min)).collect(),
            upper: (0..n).map(|d| ends(d).fold(f64::NEG_INFINITY, f64::max)).collect(),
        };
        let scale: Vec<f64> = (0..n).map(|d| 0.5 * self.region.width(d)).collect();
        let part = |d: usize| {
            let samples: Vec<(f64, f64)> =
                known[d].iter().map(|&(x, y)| ((x - self.x[d]) / scale[d], y - self.y)).collect();
            Univariate::through(&samples).map_or([0.0; 4], |part| part.coefficients())
        };
        let parts = (0..n).map(part).collect();
        let per = |d: usize| scale[d] / self.surrogate.scale[d];
        let mut products: Vec<Vec<(usize, f64)>> = (self.surrogate.products.iter().enumerate())
            .map(|(j, row)| row.iter().map(|&(k, a)| (k, a * per(j) * per(k))).collect())
            .collect();
        for (j, k) in self.pairs() {
            if let Some(mixed) = self.mixed(j, k, value) {
                for (j, k) in [(j, k), (k, j)] {
                    products[j].retain(|&(known, _)| known != k);
                    products[j].push((k, mixed * scale[j] * scale[k]));
                }
            }
        }
        (region, Model { base: self.x.clone(), scale, parts, products })
    }

    /// Mixed derivative of two interior coordinates. Returns None if a value is missing.
    fn mixed(&self, j: usize, k: usize, value: &impl Fn(&[f64]) -> Option<f64>) -> Option<f64> {
        let (at_j, at_k, both) = self.pair(j, k)?;
        let rise = value(&both)? - value(&self.with(j, at_j))? - value(&self.with(k, at_k))? + self.y;
        Some(rise / (at_j - self.x[j]) / (at_k - self.x[k]))
    }

    /// Corner of a kink: the meeting point of two straight lines through the two known points on either side of an
    /// interior coordinate. It must lie between the inner points and below the current value.
    fn corner(&self, d: usize, known: &[(f64, f64)]) -> Option<f64> {
        let (left, right): (Vec<_>, Vec<_>) = known.iter().copied().partition(|&(x, _)| x < self.x[d]);
        let ([(a, ya), (b, yb)], [(c, yc), (e, ye)]) = (&left[..], &right[..]) else { return None };
        let (rising, falling) = ((ye - yc) / (e - c), (yb - ya) / (b - a));
        let x = (yb - falling * b - yc + rising * c) / (rising - falling);
        let y = yb + falling * (x - b);
        (*b < x && x < *c && y < self.y).then_some(x)
    }

    /// Moves to the best of these points. A gain of at most `least` does not count as one.
    pub(super) fn advance(&mut self, tried: &[Vec<f64>], value: &impl Fn(&[f64]) -> Option<f64>, least: f64) {
        let better = tried.iter().filter_map(|point| Some((point, value(point)?))).filter(|&(_, y)| y < self.y);
        let best = better.min_by(|a, b| a.1.total_cmp(&b.1));
        let (mut gain, mut relocated) = (0.0, false);
        if let Some((point, y)) = best {
            gain = self.y - y;
            for (d, &x) in point.iter().enumerate() {
                let (moved, interior) = ((x - self.x[d]).abs() / self.region.width(d), self.interior(d));
                self.x[d] = x;
                relocated |= moved > 0.0 && !(interior && self.interior(d));
                if moved > 0.0 {
                    self.step[d] = if interior { (2.0 * moved).clamp(SHORTEST, STEP) } else { STEP };
                }
            }
            self.y = y;
        }
        self.rounds += 1;
        self.gained = if self.phase == Phase::All && !relocated { gain } else { self.gained + gain };
        self.phase = self.next(gain > least, relocated, 1e3 * least);
    }

    fn next(&mut self, improved: bool, relocated: bool, much: f64) -> Phase {
        if self.rounds >= ROUNDS {
            return Phase::Done;
        }
        match self.phase {
            Phase::All if relocated && improved => return Phase::All,
            // If only interior coordinates move, all the others are moved again later.
            Phase::All | Phase::Interior if improved => return Phase::Interior,
            _ => {}
        }
        let interior: Vec<usize> = (0..self.x.len()).filter(|&d| self.interior(d)).collect();
        if interior.iter().any(|&d| self.step[d] > SHORTEST) {
            interior.iter().for_each(|&d| self.step[d] = (self.step[d] * SHORTER).max(SHORTEST));
            return Phase::Interior;
        }
        // Moves along the interior coordinates may have opened a way along the others.
        if self.gained > much {
            self.gained = 0.0;
            return Phase::All;
        }
        Phase::Done
    }
}
