//! Least and greatest yield over all distributions that agree with the known facts of an input.
//!
//! A supplier promises a band, and perhaps a mean within a range or a sigma at most. Of all distributions that keep the promise, those with
//! the least and the greatest yield put their mass on a few points (Karlin and Studden, Tchebycheff Systems (1966); Smith, Generalized
//! Chebychev inequalities, Operations Research 43 (1995)). They are found by a linear program over points of the band:
//!
//! ```text
//! min  sum w_j h(x_j)   subject to   sum w_j = 1,   a <= sum w_j x_j <= b,   sum w_j (x_j - c)^2 <= s^2,   w >= 0
//! ```
//!
//! `h` is the share within the limits for a given value of the input, so that all other inputs keep their own distributions. A symmetric
//! distribution is a mixture of pairs of points about the middle, and a symmetric unimodal one a mixture of uniform distributions about it
//! (Khintchine 1938): the program is then over their half-widths.
//!
//! # Certificate
//! The program is over cells. A cell counts with a bound of `h` that holds at all of its points, and the dual function is bounded over each
//! cell too. The certified end is therefore never better than the truth, whatever the width of the cells. Cells are split where they matter,
//! until the certified end and the yield of a distribution that was found differ by less than [`CLOSE`].

mod cells;
mod promise;
mod simplex;

pub use promise::{DistributionPromise, PromiseFault};

use cells::Cells;
use simplex::{Column, Programme};

/// Difference of the certified end and the yield of a distribution that was found, at which cells are no longer split.
pub const CLOSE: f64 = 1e-6;
/// Greatest number of rounds. A round splits the cells that matter by [`SPLIT`].
const ROUNDS: usize = 24;
/// Parts of a cell that matters.
const SPLIT: usize = 4;
/// Greatest number of cells: a program of this size takes some tenths of a second.
const MOST: usize = 60_000;
/// Greatest number of cells of a mixture of uniform distributions, whose mean shares over a cell are bounded in many slices.
const MOST_OF_MIXTURES: usize = 1 << 10;
/// Successive rounds without progress after which cells are no longer split: the bounds over a cell keep the ends apart then.
const STALLED: usize = 3;
/// Part of the difference of both ends above which it hardly falls.
const HARDLY: f64 = 0.9;
/// Number of ranges of the mean, if sigma is bounded about an unknown mean.
const MEANS: u32 = 32;

/// Share within the limits as a function of one input, with bounds over an interval of it.
pub trait YieldAtValue {
    /// Share at a value of the input.
    fn at(&self, x: f64) -> f64;

    /// Least and greatest share over an interval; wider ends are permitted.
    fn over(&self, interval: [f64; 2]) -> [f64; 2];
}

/// Least and greatest yield, whatever the distribution of the input.
#[derive(Debug, Clone, PartialEq)]
pub struct YieldBounds {
    /// Certified ends: no distribution that keeps the promise has a yield outside.
    pub certified: [f64; 2],
    /// Yields of two distributions that keep the promise, within rounding and half a range of the mean.
    pub attained: [f64; 2],
    /// Points and weights of these distributions.
    pub distributions: [Vec<[f64; 2]>; 2],
}

/// Least and greatest yield over all distributions that keep a promise.
///
/// # Accuracy
/// Certified ends hold exactly but for rounding. They are within [`CLOSE`] of attained ones, unless a bounded sigma about a range of means
/// leaves more.
///
/// ```
/// use sensitol_numeric::distribution_bounds::{DistributionPromise, LinearYield, yield_bounds};
/// // Chebyshev: at least 1 - 1/k^2 lies within k sigma of a known mean. The band is wide enough not to matter.
/// let promise = DistributionPromise::new([-100.0, 100.0])?.with_mean([0.0, 0.0])?.with_sigma(1.0)?;
/// let within = LinearYield { slope: 1.0, offset: 0.0, limits: [Some(-2.0), Some(2.0)], tails: &|x: f64| [x > 0.0, x < 0.0].map(|of| f64::from(u8::from(of))) };
/// let found = yield_bounds(&promise, &within);
/// assert!((found.certified[0] - 0.75).abs() < 1e-5 && found.certified[1] == 1.0);
/// # Ok::<(), sensitol_numeric::distribution_bounds::PromiseFault>(())
/// ```
pub fn yield_bounds(promise: &DistributionPromise, within: &dyn YieldAtValue) -> YieldBounds {
    let [least, greatest] = [1.0, -1.0].map(|sign| end(promise, within, sign));
    YieldBounds {
        certified: [least.certified.max(0.0), (-greatest.certified).min(1.0)],
        attained: [least.attained, -greatest.attained],
        distributions: [least.points, greatest.points],
    }
}

/// One end: the least of `sign` times the yield.
struct End {
    certified: f64,
    attained: f64,
    points: Vec<[f64; 2]>,
}

fn end(promise: &DistributionPromise, within: &dyn YieldAtValue, sign: f64) -> End {
    let [low, high] = promise.means();
    let ranges: Vec<[f64; 2]> = match promise.sigma().filter(|_| high > low) {
        None => vec![[low, high]],
        Some(_) => {
            let at = |step: u32| low + (high - low) * f64::from(step) / f64::from(MEANS);
            (0..MEANS).map(|step| [at(step), at(step + 1)]).collect()
        }
    };
    let mut best: Option<End> = None;
    for range in ranges {
        let found = of_range(promise, within, sign, range);
        best = Some(match best {
            None => found,
            Some(best) => {
                let certified = best.certified.min(found.certified);
                let (attained, points) = match found.attained < best.attained {
                    true => (found.attained, found.points),
                    false => (best.attained, best.points),
                };
                End { certified, attained, points }
            }
        });
    }
    best.expect("there is a range of the mean")
}

/// End with the mean in a range.
fn of_range(promise: &DistributionPromise, within: &dyn YieldAtValue, sign: f64, range: [f64; 2]) -> End {
    let mut cells = Cells::new(promise, within, sign, f64::midpoint(range[0], range[1]));
    let programme = Programme::of(promise, range);
    let mut found = End { certified: f64::MIN, attained: f64::MAX, points: Vec::new() };
    let most = if promise.is_unimodal() { MOST_OF_MIXTURES } else { MOST };
    let (mut last, mut stalled) = (f64::INFINITY, 0);
    for _ in 0..ROUNDS {
        let columns: Vec<Column> = cells.columns();
        let solution = programme.solve(&columns);
        let room = cells.room(&columns, &solution);
        // Where the dual function is above a value, it is lowered as a whole.
        let short = room.iter().copied().fold(0.0, f64::min);
        found.certified = found.certified.max(solution.value + short);
        // Values at the ends of cells, in place of bounds over cells, give a distribution that can occur.
        let real: Vec<Column> =
            columns.iter().map(|column| Column { value: cells.value(column.x), ..*column }).collect();
        let reached = programme.solve(&real);
        let points: Vec<[f64; 2]> = reached.weights.iter().map(|(column, weight)| [real[*column].x, *weight]).collect();
        let attained: f64 = reached.weights.iter().map(|(column, weight)| weight * real[*column].value).sum();
        if attained < found.attained {
            (found.attained, found.points) = (attained, points);
        }
        let gap = found.attained - found.certified;
        stalled = if gap > HARDLY * last { stalled + 1 } else { 0 };
        last = gap;
        if gap < CLOSE || stalled == STALLED || cells.count() > most || !cells.split(&room, gap, SPLIT) {
            break;
        }
    }
    found
}

/// Yield of a sum `slope x + offset + rest`, with `rest` independent of `x`.
pub struct LinearYield<'l> {
    /// Slope of the characteristic by the input.
    pub slope: f64,
    /// Constant of the characteristic.
    pub offset: f64,
    /// Lower and upper limit.
    pub limits: [Option<f64>; 2],
    /// Probabilities that the rest is below a value, and above it. A rest that lies on the value is neither.
    pub tails: &'l dyn Fn(f64) -> [f64; 2],
}

impl LinearYield<'_> {
    /// Shares below the lower and above the upper limit at a place `slope x + offset`.
    fn rejects(&self, place: f64) -> [f64; 2] {
        let below = self.limits[0].map_or(0.0, |lower| (self.tails)(lower - place)[0]);
        let above = self.limits[1].map_or(0.0, |upper| (self.tails)(upper - place)[1]);
        [below, above]
    }
}

impl YieldAtValue for LinearYield<'_> {
    fn at(&self, x: f64) -> f64 {
        let [below, above] = self.rejects(self.slope * x + self.offset);
        1.0 - below - above
    }

    fn over(&self, interval: [f64; 2]) -> [f64; 2] {
        let [a, b] = interval.map(|x| self.slope * x + self.offset);
        let [low, high] = [self.rejects(a.min(b)), self.rejects(a.max(b))];
        // The share below falls with the place, and the share above rises.
        [1.0 - low[0] - high[1], 1.0 - high[0] - low[1]]
    }
}
