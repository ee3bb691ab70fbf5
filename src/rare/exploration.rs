//! Exploration of the model before any points are drawn. It finds rejects that the surrogate does not predict, and a
//! bound if there are none.
//!
//! Groups of points are drawn from the inputs' own density, from wider ones `N(0, s^2)` in normal space, and beside the
//! switches of the model. No estimate rests on these points. They show where to draw.

use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::estimate::Columns;
use crate::estimate::seldom_points;
use crate::estimate::strata::length;
use crate::rare::design_point::{BEFORE, FARTHEST, unit};
use crate::rare::model::{Answers, Model};
use crate::rare::plain_points::PlainPoints;
use crate::rare::target::Target;
use sensitol_numeric::distribution::standard_normal;

/// Widths of the groups in sigmas.
const SCALES: [f64; 4] = [1.0, 1.5, 2.0, 3.0];
/// Widths for more than `MANY_VARIABLES` variables: all points of a wider group would lie far out, where nothing is
/// likely.
const MODEST_SCALES: [f64; 3] = [1.0, 1.2, 1.5];
/// Number of variables above which the modest widths are used.
const MANY_VARIABLES: usize = 30;
/// Width of a further group for limits that nothing has reached, relative to the widest group.
const WIDER: f64 = 2.0;
/// Number of points of that group, relative to the others.
const LARGER: usize = 4;
/// Most points of a group.
const MOST: usize = 400;
/// Part of all points for one group, least and greatest. It is less for few points, which the other stages need.
const PART: [f64; 2] = [1.0 / 50.0, 1.0 / 25.0];
/// Number of points from which the greatest part is used.
const ENOUGH: f64 = 2000.0;
/// Probability that a bound is wrong by chance: 2.5 %, the upper half of a 95 % interval.
const CHANCE: f64 = 0.025;

/// Values of the model at the explored points.
pub(super) struct Explored {
    normals: Columns,
    answers: Vec<Answers>,
    /// Width of the group of every point. None for those beside switches.
    scales: Vec<Option<f64>>,
}

impl Explored {
    /// Evaluates the groups: at most a quarter of `samples`, or two fifths if the surrogate has not `reached` a target.
    pub(super) fn new(
        targets: &[Target<'_>],
        reached: &[bool],
        samples: u64,
        seed: u64,
        model: &mut Model<'_>,
    ) -> Self {
        let n = model.space.len();
        let mut explored = Self { normals: vec![Vec::new(); n], answers: Vec::new(), scales: Vec::new() };
        let each = (samples as f64 * (samples as f64 / ENOUGH * PART[1]).clamp(PART[0], PART[1])) as usize;
        let each = each.min(MOST);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut group = |rows: usize, scale: f64| -> Columns {
            (0..n).map(|_| (0..rows).map(|_| scale * rng.sample::<f64, _>(StandardNormal)).collect()).collect()
        };
        let scales: &[f64] = if n > MANY_VARIABLES { &MODEST_SCALES } else { &SCALES };
        let mut first: Columns = vec![Vec::new(); n];
        for &scale in scales {
            first.iter_mut().zip(group(each, scale)).for_each(|(all, more)| all.extend(more));
        }
        let of = scales.iter().flat_map(|&scale| std::iter::repeat_n(Some(scale), each)).collect();
        explored.ask(first, of, model);
        let seen =
            |target: &Target<'_>| explored.values(target.characteristic).flatten().any(|value| target.sought(value));
        if targets.iter().zip(reached).any(|(target, &reached)| !reached && !seen(target)) {
            let (rows, scale) = (LARGER * each, WIDER * scales[scales.len() - 1]);
            let wider = group(rows, scale);
            explored.ask(wider, vec![Some(scale); rows], model);
        }
        explored.beside_switches(targets, each, seed, model);
        explored
    }

    /// Evaluates points in the half-spaces beyond switches that are seldom met.
    fn beside_switches(&mut self, targets: &[Target<'_>], each: usize, seed: u64, model: &mut Model<'_>) {
        let n = self.normals.len();
        let varying: Vec<usize> = model.space.dimensions().collect();
        let mut characteristics: Vec<usize> = targets.iter().map(|target| target.characteristic).collect();
        characteristics.dedup();
        let points: Vec<Vec<f64>> =
            characteristics.iter().flat_map(|&c| seldom_points(model.problem(), c, &varying, seed)).collect();
        let rows = (2 * each / points.len().max(1)).min(each / 2).max(2);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(!seed);
        let mut beside: Columns = vec![Vec::new(); n];
        for point in points {
            let distance = length(&point);
            let Some(direction) = unit(point).filter(|_| distance < FARTHEST) else { continue };
            for _ in 0..rows {
                let tail = rng.sample::<f64, _>(rand_distr::Open01) * standard_normal::sf(distance - BEFORE);
                let across: Vec<f64> = (0..n).map(|_| rng.sample(StandardNormal)).collect();
                let along: f64 = across.iter().zip(&direction).map(|(z, part)| z * part).sum();
                let moved = standard_normal::upper_quantile(tail) - along;
                for (column, (z, part)) in beside.iter_mut().zip(across.iter().zip(&direction)) {
                    column.push(z + moved * part);
                }
            }
        }
        let rows = beside.first().map_or(0, Vec::len);
        self.ask(beside, vec![None; rows], model);
    }

    fn ask(&mut self, normals: Columns, scales: Vec<Option<f64>>, model: &mut Model<'_>) {
        if !scales.is_empty() {
            self.answers.push(model.ask(&normals));
            self.scales.extend(scales);
            self.normals.iter_mut().zip(normals).for_each(|(all, more)| all.extend(more));
        }
    }

    /// Value of a characteristic at every point. None if it has none.
    fn values(&self, characteristic: usize) -> impl Iterator<Item = Option<f64>> + '_ {
        self.answers.iter().flat_map(move |answers| answers.values(characteristic))
    }

    /// Counts the points of the inputs' own density for a target.
    pub(super) fn plain(&self, target: &Target<'_>) -> PlainPoints {
        let mut plain = PlainPoints::default();
        let own: Vec<usize> = (0..self.scales.len()).filter(|&row| self.scales[row] == Some(1.0)).collect();
        let normals = self.normals.iter().map(|column| own.iter().map(|&row| column[row]).collect()).collect();
        let values: Vec<Option<f64>> = self.values(target.characteristic).collect();
        for (&row, margin) in own.iter().zip(target.margins(&normals)) {
            plain.add(values[row].map(|value| target.sought(value)), margin > 0.0);
        }
        plain
    }

    /// Rejects of a target, sorted with the nearest to the means first.
    pub(super) fn rejects(&self, target: &Target<'_>) -> Vec<Vec<f64>> {
        let sought = self.values(target.characteristic).enumerate();
        let sought = sought.filter(|(_, value)| value.is_some_and(|value| target.sought(value)));
        let mut points: Vec<(f64, Vec<f64>)> = sought
            .map(|(row, _)| self.normals.iter().map(|column| column[row]).collect::<Vec<f64>>())
            .map(|point| (length(&point), point))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.into_iter().map(|(_, point)| point).collect()
    }

    /// Largest possible probability of a target that no point has reached, if the target is a half-space.
    ///
    /// A half-space at the distance `b` holds a point of `N(0, s^2)` with the probability `Phi(-b/s)`, for any
    /// direction. The probability that none of `n_s` points of each scale lies in it is `prod_s (1 - Phi(-b/s))^(n_s)`,
    /// which rises with `b`. At the `b` where it is 2.5 %, `b` is the least possible distance and `Phi(-b)` the
    /// greatest possible probability beyond. For a single scale, `b = s Phi^-1(0.025^(1/n))`.
    ///
    /// Returns None if a point reached the target, or no point has a value.
    pub(super) fn bound(&self, target: &Target<'_>) -> Option<f64> {
        let mut groups: Vec<(f64, f64)> = Vec::new();
        for (value, scale) in self.values(target.characteristic).zip(&self.scales) {
            let (Some(value), &Some(scale)) = (value, scale) else { continue };
            if target.sought(value) {
                return None;
            }
            match groups.last_mut().filter(|group| group.0 == scale) {
                Some(group) => group.1 += 1.0,
                None => groups.push((scale, 1.0)),
            }
        }
        half_space(&groups)
    }
}

/// Bound of [`Explored::bound`] from pairs of scale and number of points.
fn half_space(groups: &[(f64, f64)]) -> Option<f64> {
    let none = |b: f64| {
        groups.iter().map(|&(scale, points)| points * libm::log1p(-standard_normal::sf(b / scale))).sum::<f64>()
    };
    let (mut low, mut high) = (0.0, FARTHEST);
    if groups.is_empty() || none(low) > libm::log(CHANCE) {
        return None;
    }
    // Sixty halvings use up the digits of a double.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if none(middle) < libm::log(CHANCE) {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(standard_normal::sf(low))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 400 points three times as wide without a reject: `1 - Phi(-b/3) = 0.025^(1/400)`, and `Phi(-7.07)` is 8e-13
    /// (tables of the normal distribution give `Phi(-2.357) = 0.0092`).
    #[test]
    fn no_reject_bounds_the_distance() {
        let bound = half_space(&[(3.0, 400.0)]).unwrap();
        let distance = -standard_normal::quantile(bound);
        assert!((distance - 7.07).abs() < 0.01, "{distance}");
        // More points, or wider ones, lower the bound.
        assert!(half_space(&[(3.0, 800.0)]).unwrap() < bound && half_space(&[(6.0, 400.0)]).unwrap() < bound);
        assert!(half_space(&[(1.5, 400.0), (3.0, 400.0)]).unwrap() < bound);
        // Three points cannot exclude a half-space through the middle: all miss it with a probability of 1/8.
        assert_eq!(half_space(&[(1.0, 3.0)]), None);
        assert_eq!(half_space(&[]), None);
    }
}
