//! Choice of the check points of a costly model near the means.
//!
//! | points | place | errors that a surface through its own nodes does not show |
//! |--:|---|---|
//! | 4 | ±1.5 a and ±3 a along the line that carries the output | skewness by the even part, kurtosis by the odd one |
//! | 0 to 6 | ±3 on each of at most 3 inputs with more than 3 % of the variance that the line does not follow | a parabola through three nodes has no redundancy |
//! | 0 or 2 | all inputs below 1e-4 of the variance at once, ±4 | effects of inputs with no slope: an angle through a full turn, a contact |
//! | 6 or 8 | random pairs ±z, even along the line | everything else |
//!
//! Several characteristics share the points: lines that are nearly the same are one, and there are three at most.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::estimate::Columns;
use crate::estimate::strata::dot;
use sensitol_numeric::distribution::standard_normal;

/// Places along a line, in sigmas.
pub(super) const ON_LINE: [f64; 4] = [1.5, -1.5, 3.0, -3.0];
/// Sigmas on either side at which an input is moved by itself.
pub(super) const ON_AXIS: f64 = 3.0;
/// Distance by which inputs without effect are moved together, in sigmas.
pub(super) const IDLE: f64 = 4.0;
/// Greatest number of evaluations of a check.
pub const MOST: usize = 18;
/// Share of the variance above which an input gets points of its own.
const STRONG: f64 = 0.03;
/// Share of the variance below which an input is idle.
const WEAK: f64 = 1e-4;
/// Square of the line's component along an input from which on the points of the line suffice for it.
const FOLLOWED: f64 = 0.5;
/// Greatest number of inputs with points of their own.
const AXES: usize = 3;
/// Greatest number of lines with check points.
const LINES: usize = 3;
/// Cosine of two directions above which they count as one line.
const SAME: f64 = 0.95;
/// Number of pairs of random points, normally and if there are many other points.
const PAIRS: [usize; 2] = [4, 3];
/// Smallest number of evaluations of a check: the random pairs.
pub(super) const FEWEST: usize = 2 * PAIRS[1];
/// Number of other points from which on there are fewer pairs.
const MANY: usize = 8;

/// Request of a characteristic for check points, from its surface.
#[derive(Clone)]
pub(super) struct Wish {
    /// Direction of length 1 along which the surface varies most.
    pub(super) line: Vec<f64>,
    /// Share of the variance of every variable.
    pub(super) shares: Vec<f64>,
    /// True for every variable on which the characteristic can depend.
    pub(super) depends: Vec<bool>,
}

/// Check points, in the order of their purposes.
pub(super) struct Design {
    pub(super) points: Vec<Vec<f64>>,
    /// Directions of all the lines. The points at [`ON_LINE`] of the first come first, and so on.
    pub(super) lines: Vec<Vec<f64>>,
    /// Inputs with two points of their own, after the lines.
    pub(super) axes: Vec<usize>,
    /// Inputs without an effect on any characteristic. Two points after the axes move them together, if there is one.
    pub(super) idle_inputs: Vec<usize>,
    /// Number of random pairs, at the end: all points first, then their mirror images.
    pub(super) pairs: usize,
}

impl Design {
    /// Chooses points for these characteristics within `budget` evaluations. Returns None if the budget does not even allow the random
    /// pairs.
    pub(super) fn new(wishes: &[Wish], seed: u64, budget: usize) -> Option<Self> {
        let n = wishes.first()?.line.len();
        let mut left = budget.min(MOST).checked_sub(2 * PAIRS[1])?;
        // Lines take precedence, then idle inputs, then axes. Random pairs have a reserve.
        let mut lines: Vec<Vec<f64>> = Vec::new();
        for wish in wishes {
            let known = lines.iter().any(|line| dot(line, &wish.line).abs() > SAME);
            if !known && lines.len() < LINES && left >= ON_LINE.len() {
                lines.push(wish.line.clone());
                left -= ON_LINE.len();
            }
        }
        let idle_of = |j: usize| {
            let concerned = || wishes.iter().filter(move |wish| wish.depends[j]);
            concerned().next().is_some() && concerned().all(|wish| wish.shares[j] < WEAK)
        };
        let mut idle_inputs: Vec<usize> = (0..n).filter(|&j| idle_of(j)).collect();
        if left < 2 {
            idle_inputs.clear();
        }
        left -= if idle_inputs.is_empty() { 0 } else { 2 };
        let strength = |j: usize| {
            let strong = |wish: &&Wish| wish.has_axis(j);
            wishes.iter().filter(strong).map(|wish| wish.shares[j]).fold(0.0, f64::max)
        };
        let mut axes: Vec<usize> = (0..n).filter(|&j| strength(j) > 0.0).collect();
        axes.sort_by(|&a, &b| strength(b).total_cmp(&strength(a)).then(a.cmp(&b)));
        axes.truncate(AXES.min(left / 2));
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut points: Vec<Vec<f64>> = Vec::new();
        for line in &lines {
            points.extend(ON_LINE.iter().map(|t| line.iter().map(|part| t * part).collect::<Vec<f64>>()));
        }
        for &j in &axes {
            points.extend([ON_AXIS, -ON_AXIS].map(|t| (0..n).map(|k| if k == j { t } else { 0.0 }).collect()));
        }
        if !idle_inputs.is_empty() {
            let signs = (0..n).map(|j| if rng.random() { IDLE } else { -IDLE } * f64::from(u8::from(idle_of(j))));
            let moved: Vec<f64> = signs.collect();
            points.push(moved.clone());
            points.push(moved.into_iter().map(|z| -z).collect());
        }
        let spent = points.len();
        let pairs = if spent < MANY && spent + 2 * PAIRS[0] <= budget.min(MOST) { PAIRS[0] } else { PAIRS[1] };
        let random = random_pairs(pairs, lines.first().unwrap_or(&wishes[0].line), &mut rng);
        points.extend(random.iter().cloned());
        points.extend(random.into_iter().map(|point| point.into_iter().map(|z| -z).collect()));
        Some(Self { points, lines, axes, idle_inputs, pairs })
    }

    /// Points as columns, one for every variable.
    pub(super) fn columns(&self) -> Columns {
        let n = self.points.first().map_or(0, Vec::len);
        (0..n).map(|j| self.points.iter().map(|point| point[j]).collect()).collect()
    }

    /// Index of the line of a characteristic, which may have the opposite sign. Returns None if it has no line.
    pub(super) fn line_of(&self, wish: &Wish) -> Option<usize> {
        self.lines.iter().position(|line| dot(line, &wish.line).abs() > SAME)
    }

    /// Index of the first random point.
    pub(super) fn random(&self) -> usize {
        self.points.len() - 2 * self.pairs
    }
}

impl Wish {
    /// True if this input gets points of its own.
    pub(super) fn has_axis(&self, j: usize) -> bool {
        self.shares[j] > STRONG && !self.is_followed(j)
    }

    /// True if the points of the line suffice for this input.
    pub(super) fn is_followed(&self, j: usize) -> bool {
        self.line[j] * self.line[j] >= FOLLOWED
    }
}

/// Normal points that are evenly distributed along a direction: the k-th of n lies between the quantiles `(k - 1)/n` and `k/n` of `|t|`.
fn random_pairs(pairs: usize, direction: &[f64], rng: &mut Xoshiro256PlusPlus) -> Vec<Vec<f64>> {
    let mut cells: Vec<usize> = (0..pairs).collect();
    cells.shuffle(rng);
    let mut point = |cell: usize| -> Vec<f64> {
        let mut z: Vec<f64> = direction.iter().map(|_| rng.sample(StandardNormal)).collect();
        let place = (cell as f64 + rng.random::<f64>()) / pairs as f64;
        let shift = standard_normal::quantile(0.5 + 0.5 * place) - dot(&z, direction);
        z.iter_mut().zip(direction).for_each(|(z, part)| *z += shift * part);
        z
    };
    cells.into_iter().map(&mut point).collect()
}
