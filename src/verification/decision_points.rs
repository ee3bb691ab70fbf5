//! Choice of check points where a decision falls: far from the means, where rejects are.
//!
//! | points | place | errors that points near the means do not show |
//! |--:|---|---|
//! | 0 to 2 each | likeliest point of the surface beyond every limit | a surface that is wrong at its own limit |
//! | 0 to 6 | all combinations of signs of up to 3 idle inputs, 4 sigmas | a contact that needs two or three of them |
//! | the rest | 3 sigmas on either side of every input without points of its own | a contact of an unimportant input |
//! | the rest | combinations of signs of all inputs, of 16 at random if there are more, 6 sigmas off at most | effects of several large deviations |
//!
//! The kinds follow in this order as far as the number of points allows: a third of the `2 N + 13` points that a second-order method and the
//! check points near the means take, at least 6 and at most 18.

use rand::RngExt;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::estimate::strata::{dot, length, unit};
use crate::verification::check_points::{Design, IDLE, ON_AXIS, Wish};

/// Smallest number of decision points.
const FEWEST: usize = 6;
/// Greatest number of decision points.
const MOST: usize = 18;
/// Divisor of the number of all other points.
const PART: usize = 3;
/// Greatest number of idle inputs of which all combinations of signs are checked.
const COMBINED: usize = 3;
/// Greatest length of a point at which many inputs deviate, in sigmas: the ends of the bands of four inputs.
const ALL: f64 = 6.0;
/// Least deviation of each input at such a point, in sigmas.
const EACH: f64 = 1.5;
/// Cosine of two directions above which their points check the same.
const SAME: f64 = 0.95;
/// Difference of two distances in sigmas below which points in the same direction check the same.
const CLOSE: f64 = 0.75;
/// Number of points that axes leave for combinations of signs.
const RESERVE: usize = 2;

/// Number of decision points for a number of varying dimensions.
pub(super) fn count(varying: usize) -> usize {
    ((2 * varying + 13) / PART).clamp(FEWEST, MOST)
}

/// Chooses at most `budget` points beside those of a design. `likeliest` are the likeliest points beyond limits, the nearest first.
pub(super) fn choose(
    design: &Design,
    wishes: &[Wish],
    likeliest: &[Vec<f64>],
    budget: usize,
    seed: u64,
) -> Vec<Vec<f64>> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed ^ 0x5eed);
    let far = design.points[..design.random()].to_vec();
    let mut chosen = Chosen { far, points: Vec::new(), budget };
    for point in likeliest.iter().take(budget / 2) {
        chosen.add(point.clone());
    }
    idle_combinations(design, &mut rng).into_iter().for_each(|point| chosen.add(point));
    let n = design.points.first().map_or(0, Vec::len);
    for j in unchecked_axes(design, wishes) {
        if chosen.left() < RESERVE + 2 {
            break;
        }
        for side in [ON_AXIS, -ON_AXIS] {
            chosen.add((0..n).map(|k| if k == j { side } else { 0.0 }).collect());
        }
    }
    // Combinations of signs fill the rest. With few inputs, each appears once.
    let mut tries = 4 * budget;
    while chosen.left() > 0 && tries > 0 {
        chosen.add(combination(n, &mut rng));
        tries -= 1;
    }
    chosen.points
}

/// Point at which all inputs deviate, or as many at random as [`ALL`] sigmas allow.
fn combination(n: usize, rng: &mut Xoshiro256PlusPlus) -> Vec<f64> {
    let moved = n.min((ALL / EACH).powi(2) as usize);
    let each = (ALL / (moved as f64).sqrt()).min(ON_AXIS);
    let mut inputs: Vec<usize> = (0..n).collect();
    inputs.shuffle(rng);
    let mut point = vec![0.0; n];
    inputs[..moved].iter().for_each(|&j| point[j] = if rng.random() { each } else { -each });
    point
}

/// Points chosen so far.
struct Chosen {
    /// Other points far from the means.
    far: Vec<Vec<f64>>,
    points: Vec<Vec<f64>>,
    budget: usize,
}

impl Chosen {
    fn left(&self) -> usize {
        self.budget - self.points.len()
    }

    /// Adds a point, unless another one checks the same.
    fn add(&mut self, point: Vec<f64>) {
        let (distance, direction) = (length(&point), unit(point.clone()));
        let same = |other: &Vec<f64>| dot(&unit(other.clone()), &direction) > SAME && length(other) > distance - CLOSE;
        if self.left() > 0 && !self.far.iter().chain(&self.points).any(same) {
            self.points.push(point);
        }
    }
}

/// Combinations of signs of the idle inputs, with their mirror images: all of up to [`COMBINED`] inputs, else two pairs more.
fn idle_combinations(design: &Design, rng: &mut Xoshiro256PlusPlus) -> Vec<Vec<f64>> {
    let n = design.points.first().map_or(0, Vec::len);
    let idle = &design.idle_inputs;
    if idle.len() < 2 {
        return Vec::new();
    }
    let patterns: Vec<Vec<bool>> = match idle.len() <= COMBINED {
        true => {
            (0..1usize << (idle.len() - 1)).map(|code| (0..idle.len()).map(|j| code >> j & 1 == 0).collect()).collect()
        }
        false => (0..2).map(|_| idle.iter().map(|_| rng.random()).collect()).collect(),
    };
    let mut points = Vec::new();
    for pattern in patterns {
        for sign in [IDLE, -IDLE] {
            let mut point = vec![0.0; n];
            idle.iter().zip(&pattern).for_each(|(&j, &up)| point[j] = if up { sign } else { -sign });
            points.push(point);
        }
    }
    points
}

/// Inputs without points of their own that are not idle, those with the greatest share of the variance first.
fn unchecked_axes(design: &Design, wishes: &[Wish]) -> Vec<usize> {
    let n = design.points.first().map_or(0, Vec::len);
    let share = |j: usize| wishes.iter().filter(|wish| wish.depends[j]).map(|wish| wish.shares[j]).fold(0.0, f64::max);
    let open = |&j: &usize| {
        let alone = design.idle_inputs.len() == 1 || !design.idle_inputs.contains(&j);
        alone && !design.axes.contains(&j) && wishes.iter().any(|wish| wish.depends[j] && !wish.is_followed(j))
    };
    let mut axes: Vec<usize> = (0..n).filter(open).collect();
    axes.sort_by(|&a, &b| share(b).total_cmp(&share(a)).then(a.cmp(&b)));
    axes
}
