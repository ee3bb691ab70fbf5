//! Worst case by the formula itself, at the places of the box with its extremes.
//!
//! ```text
//! W(T) = max over k of y(m + h T v_k) - nominal         v_k: places in the box, each coordinate in [-1, 1]
//! dW/d ln T_j = dy/dx_j h_j T_j v_kj                      at the place of the maximum, which keeps its v
//! ```
//!
//! A second-order surface follows neither a kink nor a corner far from the mean. The places are found at every
//! linearization point by a search of the box. Those of earlier points stay, so that the search does not return to
//! tolerances that it has left. Sources: J. W. Blankenship, J. E. Falk, "Infinitely constrained optimization problems",
//! J. Optimization Theory and Applications 19 (1976); J. M. Danskin, "The theory of max-min" (1967), for the slope.
//!
//! Cost: some hundred values of the formula for every side, counted separately from the evaluations.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::assembly::{Directions, Points, Request, Responses, Run};
use crate::problem::Problem;

/// Greatest number of dimensions for a search of the box, which would otherwise take too long.
const MOST: usize = 40;
/// Greatest number of dimensions for a search that begins at the best of all combinations of both ends and the middle.
const ALL: usize = 6;
/// Places that are kept for every side.
const KEPT: usize = 24;
/// Last step of the search, as a part of half a band. The error of the value there goes with its square.
const LAST_STEP: f64 = 1e-6;
/// Distance within which two places are the same.
const SAME: f64 = 1e-4;

/// Places in the box, by their coordinates in `[-1, 1]`.
pub(in crate::allocation) type Places = Vec<Vec<f64>>;

/// Band of a dimension that varies, in its own unit: its middle, its half-width, and the move of the middle per
/// half-width that is added.
#[derive(Debug, Clone, Copy)]
pub(in crate::allocation) struct Band {
    pub(in crate::allocation) dimension: usize,
    pub(in crate::allocation) middle: f64,
    pub(in crate::allocation) half: f64,
    pub(in crate::allocation) lean: f64,
    /// Standard deviation of the dimension.
    pub(in crate::allocation) sigma: f64,
}

/// Characteristic with a formula, about a linearization point.
pub(in crate::allocation) struct Corners {
    problem: Problem,
    characteristic: usize,
    nominal: f64,
    bands: Vec<Band>,
    /// Places of the farthest reach, below and above.
    places: [Places; 2],
    /// Number of values so far, for all characteristics and linearization points.
    asked: Arc<AtomicU64>,
}

impl Corners {
    /// Creates the corners from the places known before, and searches those of this linearization point. Returns None
    /// if the formula has no derivatives, or there are too many dimensions.
    pub(in crate::allocation) fn of(
        problem: &Problem,
        characteristic: usize,
        nominal: f64,
        bands: Vec<Band>,
        starts: [Vec<f64>; 2],
        known: [Places; 2],
        asked: &Arc<AtomicU64>,
    ) -> Option<Self> {
        if bands.len() > MOST {
            return None;
        }
        let asked = Arc::clone(asked);
        let mut corners = Self { problem: problem.clone(), characteristic, nominal, bands, places: known, asked };
        let point = corners.point(&vec![0.0; corners.bands.len()], &[], &[]);
        corners.slopes(&point)?;
        for (side, start) in starts.into_iter().enumerate() {
            let found = corners.searched(side == 1, start)?;
            let near = |place: &Vec<f64>| place.iter().zip(&found).all(|(a, b)| (a - b).abs() < SAME);
            let places = &mut corners.places[side];
            places.retain(|place| !near(place));
            places.push(found);
            let over = places.len().saturating_sub(KEPT);
            places.drain(..over);
        }
        Some(corners)
    }

    /// Places, for the next linearization point.
    pub(in crate::allocation) fn places(&self) -> [Places; 2] {
        self.places.clone()
    }

    /// Reach beyond the nominal value, above or below, and its derivatives by the logarithm of every tolerance. Returns
    /// None if the formula has no value.
    pub(in crate::allocation) fn reach(
        &self,
        factors: &[f64],
        shifts: &[f64],
        above: bool,
    ) -> Option<(f64, Vec<(usize, f64)>)> {
        let sign = if above { 1.0 } else { -1.0 };
        let places = &self.places[usize::from(above)];
        let points: Vec<Vec<f64>> = places.iter().map(|place| self.point(place, factors, shifts)).collect();
        let values = self.values(&points);
        let reaches = values.iter().enumerate().filter_map(|(k, value)| Some((k, sign * ((*value)? - self.nominal))));
        let (k, most) = reaches.reduce(|best, other| if other.1 > best.1 { other } else { best })?;
        let slopes = self.slopes(&points[k])?;
        let of = |((band, slope), v): ((&Band, &Option<f64>), &f64)| {
            let way = (v + band.lean) * band.half * factor(factors, band.dimension);
            // A coordinate at the middle has no slope by its tolerance, even at a kink.
            let slope = if way == 0.0 { 0.0 } else { (*slope)? };
            Some((band.dimension, sign * slope * way))
        };
        let by: Option<Vec<(usize, f64)>> = self.bands.iter().zip(&slopes).zip(&places[k]).map(of).collect();
        Some((most, by?))
    }

    /// Place of the farthest reach found by a search along the coordinates.
    fn searched(&self, above: bool, start: Vec<f64>) -> Option<Vec<f64>> {
        let sign = if above { 1.0 } else { -1.0 };
        let n = self.bands.len();
        let best_of = |places: Places| {
            let points: Vec<Vec<f64>> = places.iter().map(|place| self.point(place, &[], &[])).collect();
            let values = self.values(&points);
            let known = places.into_iter().zip(values).filter_map(|(place, value)| Some((place, sign * value?)));
            known.reduce(|best, other| if other.1 > best.1 { other } else { best })
        };
        let levels =
            |index: usize| -> Vec<f64> { (0..n as u32).map(|j| [-1.0, 1.0, 0.0][index / 3usize.pow(j) % 3]).collect() };
        let all = if n <= ALL { (0..3usize.pow(n as u32)).map(levels).collect() } else { Vec::new() };
        let known = self.places[usize::from(above)].iter().cloned();
        let begun: Places = known.chain([start, vec![-1.0; n], vec![1.0; n]]).chain(all).collect();
        let (mut at, mut value) = best_of(begun)?;
        let mut step = 2.0;
        while step > LAST_STEP {
            let mut moved = false;
            for j in 0..n {
                let aside = |by: f64| {
                    let mut place = at.clone();
                    place[j] = (place[j] + by).clamp(-1.0, 1.0);
                    place
                };
                let found = best_of([-step, step].into_iter().map(aside).filter(|place| *place != at).collect());
                // A gain must exceed the rounding.
                if let Some((place, more)) = found.filter(|(_, more)| more - value > 8.0 * f64::EPSILON * more.abs()) {
                    (at, value, moved) = (place, more, true);
                }
            }
            if !moved {
                step *= 0.5;
            }
        }
        Some(at)
    }

    /// Values of all dimensions at a place of the box.
    fn point(&self, place: &[f64], factors: &[f64], shifts: &[f64]) -> Vec<f64> {
        let dimensions = self.problem.dimensions();
        let mut x: Vec<f64> = dimensions.iter().map(sensitol_numeric::dimension::Dimension::nominal).collect();
        for (band, v) in self.bands.iter().zip(place) {
            let (d, factor) = (band.dimension, factor(factors, band.dimension));
            let shift = shifts.get(d).copied().unwrap_or(0.0) * band.sigma;
            x[d] += band.middle + shift + band.half * (v * factor + band.lean * (factor - 1.0));
        }
        x
    }

    fn values(&self, points: &[Vec<f64>]) -> Vec<Option<f64>> {
        let outputs = [self.problem.outputs()[self.characteristic]];
        self.asked.fetch_add(points.len() as u64, Ordering::Relaxed);
        let mut answers = Responses::open(points.len(), 1);
        let request = Points::from_rows(points);
        self.problem.function().evaluate(&Request::values(&request, &outputs), &Run::to_the_end(), &mut answers);
        (0..points.len()).map(|row| answers.value(row, 0).filter(|value| value.is_finite())).collect()
    }

    /// Derivatives by every dimension with a band.
    fn slopes(&self, point: &[f64]) -> Option<Vec<Option<f64>>> {
        let outputs = [self.problem.outputs()[self.characteristic]];
        let inputs: Vec<usize> = self.bands.iter().map(|band| band.dimension).collect();
        let directions = Directions { point, inputs: &inputs, pairs: &[] };
        Some(self.problem.function().derivatives(&outputs, &directions).into_iter().next()??.first)
    }
}

fn factor(factors: &[f64], d: usize) -> f64 {
    factors.get(d).copied().unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::formula::Formula;
    use crate::assembly::{Composite, Input, Parts};
    use sensitol_numeric::characteristic::Characteristic;
    use sensitol_numeric::dimension::Dimension;

    /// `hypot` about its kink and a parabola within its band: the places are the corners and the middle, and the slopes
    /// are those of the closed form.
    #[test]
    fn corners_of_a_kink_have_its_reach_and_slopes() {
        let formula = Formula::parse("hypot(x, y) - (t - 0.25)^2").unwrap();
        let names = ["x", "y", "t"];
        let function = Composite::new(Parts {
            inputs: names.map(|name| Input { name: name.to_owned(), unit: None }).to_vec(),
            formulas: vec![("z".to_owned(), formula)],
            outputs: vec![("z".to_owned(), None)],
            ..Parts::default()
        });
        let halves = [0.3, 0.4, 1.0];
        let dimensions = names.into_iter().zip(halves).map(|(name, half)| Dimension::normal(name, 0.0, half).unwrap());
        let problem = Problem::new(dimensions, function.unwrap()).unwrap();
        let problem = problem.asking([Characteristic::new("z")]).unwrap();
        let band = |dimension: usize, half: f64| Band { dimension, middle: 0.0, half, lean: 0.0, sigma: half / 3.0 };
        let bands = vec![band(0, 0.3), band(1, 0.4), band(2, 1.0)];
        let nothing = [Vec::new(), Vec::new()];
        let starts = [vec![0.0; 3], vec![0.0; 3]];
        let corners = Corners::of(&problem, 0, -0.0625, bands, starts, nothing, &Arc::default()).unwrap();
        let (above, slopes) = corners.reach(&[1.0; 3], &[0.0; 3], true).unwrap();
        assert!((above - 0.5625).abs() < 1e-11, "{above}");
        // d hypot/d ln T = T^2/hypot. The parabola is greatest within its band, where its slope is that of the last
        // step.
        for ((_, slope), expected) in slopes.iter().zip([0.18, 0.32, 0.0]) {
            assert!((slope - expected).abs() < 1e-5, "{slopes:?}");
        }
        let (below, slopes) = corners.reach(&[1.0; 3], &[0.0; 3], false).unwrap();
        assert!((below - 1.5).abs() < 1e-12, "{below}");
        assert!((slopes[2].1 - 2.5).abs() < 1e-12, "{slopes:?}");
        // At twice the tolerance the offsets reach 1, and the parabola is 0.5, because its coordinate is kept.
        assert!((corners.reach(&[2.0; 3], &[0.0; 3], true).unwrap().0 - (1.0 - 0.0625 + 0.0625)).abs() < 1e-6);
    }
}
