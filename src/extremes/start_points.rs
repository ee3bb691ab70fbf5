//! Starts of a search: extremes of the surrogate, and a few points that check the surrogate.

use crate::extremes::model::{Model, Region};

/// Points that are evaluated first for one characteristic.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Starts {
    /// Places of the surrogate's least values: its lowest local minima first, then the vertex given by the signs of its
    /// slopes.
    pub(super) least: Vec<Vec<f64>>,
    /// Places of the surrogate's greatest values, in the same order.
    pub(super) greatest: Vec<Vec<f64>>,
    /// Check points away from the extremes.
    pub(super) checks: Vec<Vec<f64>>,
}

/// Greatest number of local minima of the surrogate that are evaluated.
const MINIMA: usize = 3;
/// Golden section. Its multiples, modulo 1, give coordinates of a check point that follow no pattern.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl Starts {
    /// Computes the starts from a surrogate over a box, without evaluations.
    pub(super) fn of(surrogate: &Model, region: &Region) -> Self {
        let least = least_of(surrogate, region);
        let greatest = least_of(&surrogate.negated(), region);
        let generic = region.at(|d| ((d + 1) as f64 * GOLDEN).fract());
        Self { checks: vec![crossed(surrogate, region, &least[0]), generic], least, greatest }
    }

    pub(super) fn points(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.least.iter().chain(&self.greatest).chain(&self.checks)
    }
}

impl Model {
    /// Place of the surrogate's least value in a box: the lowest end of descents from several starts.
    pub(crate) fn least_in(&self, region: &Region) -> Vec<f64> {
        least_of(self, region).swap_remove(0)
    }
}

/// Descends from the base, from the vertex of the slopes and its opposite, and from two corners of the box.
fn least_of(surrogate: &Model, region: &Region) -> Vec<Vec<f64>> {
    let n = region.len();
    let flat = |d: usize| surrogate.parts[d] == [0.0; 4] && surrogate.products[d].is_empty();
    let slope = |d: usize| surrogate.parts[d][0];
    let downhill = region.at(|d| if slope(d) < 0.0 { 1.0 } else { 0.0 });
    let uphill = region.at(|d| if slope(d) < 0.0 || flat(d) { 0.0 } else { 1.0 });
    let base: Vec<f64> =
        (0..n).map(|d| if flat(d) { region.lower[d] } else { region.clamp(d, surrogate.base[d]) }).collect();
    let corners = [region.at(|_| 0.0), region.at(|d| if flat(d) { 0.0 } else { 1.0 })];
    let mut minima: Vec<(f64, Vec<f64>)> = Vec::new();
    for start in [base, downhill.clone(), uphill].into_iter().chain(corners) {
        let minimum = surrogate.descend(region, &start);
        if minima.iter().all(|(_, known)| *known != minimum) {
            minima.push((surrogate.rise(&minimum), minimum));
        }
    }
    minima.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut least: Vec<Vec<f64>> = minima.into_iter().take(MINIMA).map(|(_, minimum)| minimum).collect();
    if !least.contains(&downhill) {
        least.push(downhill);
    }
    least
}

/// Vertex that differs from `from` in every second coordinate, sorted by their effect on the surrogate.
fn crossed(surrogate: &Model, region: &Region, from: &[f64]) -> Vec<f64> {
    let effect = |d: usize| surrogate.rise_along(from, d, [region.lower[d], region.upper[d]]).abs();
    let mut order: Vec<(f64, usize)> = (0..region.len()).map(|d| (effect(d), d)).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut point = from.to_vec();
    for &(_, d) in order.iter().step_by(2) {
        point[d] = if from[d] == region.lower[d] { region.upper[d] } else { region.lower[d] };
    }
    point
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `3 x0 - x1` in the unit box: the two vertices, one that mixes them, and one point within.
    #[test]
    fn a_linear_surrogate_has_two_vertices() {
        let region = Region { lower: vec![0.0; 2], upper: vec![1.0; 2] };
        let surrogate = Model {
            base: vec![0.5; 2],
            scale: vec![1.0; 2],
            parts: vec![[3.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 0.0]],
            products: vec![Vec::new(); 2],
        };
        let starts = Starts::of(&surrogate, &region);
        assert_eq!(starts.least, [[0.0, 1.0]]);
        assert_eq!(starts.greatest, [[1.0, 0.0]]);
        assert_eq!(starts.checks[0], [1.0, 1.0]);
        assert!(starts.checks[1].iter().all(|x| 0.0 < *x && *x < 1.0));
    }
}
