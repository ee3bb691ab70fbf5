//! Where a search begins: what the surrogate says, and a few points that put it to the test.

use super::model::{Model, Region};

/// The points that are evaluated first for one characteristic.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Starts {
    /// Where the surrogate is least: its lowest local minima first, then the vertex of the signs of its slopes.
    pub(super) least: Vec<Vec<f64>>,
    /// Where it is greatest.
    pub(super) greatest: Vec<Vec<f64>>,
    /// Points elsewhere.
    pub(super) checks: Vec<Vec<f64>>,
}

/// Local minima of the surrogate that are worth an evaluation.
const MINIMA: usize = 3;
/// Parts of the way through the box that have no pattern: multiples of the golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl Starts {
    /// Of a surrogate over a box. Evaluates nothing.
    pub(super) fn of(surrogate: &Model, region: &Region) -> Self {
        let least = least_of(surrogate, region);
        let greatest = least_of(&surrogate.negated(), region);
        let generic = region.at(|d| ((d + 1) as f64 * GOLDEN).fract());
        Self { checks: vec![crossed(surrogate, region, &least[0]), generic], least, greatest }
    }

    /// All of them.
    pub(super) fn points(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.least.iter().chain(&self.greatest).chain(&self.checks)
    }
}

impl Model {
    /// Where it is least in a box, as far as descents from several starts tell.
    pub(crate) fn least_in(&self, region: &Region) -> Vec<f64> {
        least_of(self, region).swap_remove(0)
    }
}

/// Descents from the base, from the vertex of the slopes and the one opposite to it, and from two corners of the box.
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

/// The vertex that differs from `from` in every other coordinate, in the order of what they do to the surrogate.
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
