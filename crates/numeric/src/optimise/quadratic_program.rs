//! Quadratic problem of a step of sequential quadratic programming.
//!
//! ```text
//! min over d, t of  g'd + d'Bd/2 + w t + t^2/2     subject to  c_i + J_i d <= t for every row,  0 <= t,  low <= d <= high
//! ```
//!
//! `t` is the excess that the rows may have. With `w` above the sum of the multipliers it is 0 if the rows can be kept.
//! The dual method begins at the least without rows, and adds the row with the largest excess again and again. It needs
//! `H`, the inverse of `B`. Source: D. Goldfarb, A. Idnani, "A numerically stable dual method for solving strictly
//! convex quadratic programs", Mathematical Programming 27 (1983).

use faer::Mat;
use faer::linalg::solvers::Solve;

use crate::optimise::augmented_lagrangian::ValueAndSlopes;

/// Greatest excess of a row that is kept. Rows and bounds are near 1 in size.
const KEPT: f64 = 1e-13;
/// Part of a direction outside the span of the active rows, up to which it counts as within the span.
const DEPENDENT: f64 = 1e-14;

pub(crate) struct Quadratic<'a> {
    /// Matrix `H`, row by row.
    pub(crate) inverse: &'a [Vec<f64>],
    pub(crate) gradient: &'a [f64],
    pub(crate) rows: &'a [ValueAndSlopes],
    /// Bounds of every unknown.
    pub(crate) bounds: &'a [[f64; 2]],
    pub(crate) weight: f64,
}

#[derive(Clone)]
pub(crate) struct Step {
    pub(crate) d: Vec<f64>,
    /// Excess `t` of the rows.
    pub(crate) slack: f64,
    /// Multipliers of the rows, then of the lower and the upper bound of every unknown.
    pub(crate) multipliers: Vec<f64>,
}

/// Condition `normal . (d, t) <= bound`.
#[derive(Clone, Copy, PartialEq)]
enum Condition {
    Row(usize),
    Low(usize),
    High(usize),
    /// Condition that `t` is not negative.
    Slack,
}

/// Condition that holds with equality.
struct Active {
    condition: Condition,
    multiplier: f64,
    /// Product of `H` and the normal.
    along: Vec<f64>,
}

impl Quadratic<'_> {
    /// Solves the problem. Returns None if rounding prevents further steps.
    pub(crate) fn solved(&self) -> Option<Step> {
        let n = self.gradient.len();
        let mut z: Vec<f64> = self.inverse.iter().map(|row| -dot(row, self.gradient)).chain([0.0]).collect();
        // Without rows t is 0, which the weight `w` enforces.
        let mut active = vec![self.activated(Condition::Slack, self.weight)];
        for _ in 0..10 * (self.rows.len() + 2 * n + 1) {
            let (added, mut over) = match self.most_exceeded(&z, &active) {
                Some((condition, over)) if over > KEPT => (self.activated(condition, 0.0), over),
                _ => return Some(self.step(&z, &active)),
            };
            self.add(added, &mut over, &mut z, &mut active)?;
        }
        None
    }

    /// Adds a condition, and removes those whose multipliers would become negative.
    fn add(&self, mut added: Active, over: &mut f64, z: &mut [f64], active: &mut Vec<Active>) -> Option<()> {
        loop {
            let share = self.shares(&added, active);
            let mut way = added.along.clone();
            for (one, share) in active.iter().zip(&share) {
                way.iter_mut().zip(&one.along).for_each(|(way, along)| *way -= share * along);
            }
            let curvature = self.times(added.condition, &way);
            let whole = self.times(added.condition, &added.along);
            let full = if curvature > DEPENDENT * whole { *over / curvature } else { f64::INFINITY };
            let leaves = active.iter().zip(&share).map(|(one, &share)| match share > 0.0 {
                true => one.multiplier / share,
                false => f64::INFINITY,
            });
            let leaves = leaves.enumerate().reduce(|a, b| if b.1 < a.1 { b } else { a });
            let (index, partial) = leaves.unwrap_or((0, f64::INFINITY));
            let length = full.min(partial);
            if !length.is_finite() {
                return None;
            }
            if full.is_finite() {
                z.iter_mut().zip(&way).for_each(|(z, way)| *z -= length * way);
            }
            active.iter_mut().zip(&share).for_each(|(one, share)| one.multiplier -= length * share);
            added.multiplier += length;
            if full <= partial {
                active.push(added);
                return Some(());
            }
            active.remove(index);
            *over = self.over(added.condition, z);
        }
    }

    /// Multiples of the active normals that make up the new one, in the metric of `H`.
    fn shares(&self, added: &Active, active: &[Active]) -> Vec<f64> {
        let k = active.len();
        if k == 0 {
            return Vec::new();
        }
        let matrix = Mat::from_fn(k, k, |a, b| self.times(active[a].condition, &active[b].along));
        let right = Mat::from_fn(k, 1, |a, _| self.times(active[a].condition, &added.along));
        matrix.partial_piv_lu().solve(&right).col_as_slice(0).to_vec()
    }

    fn activated(&self, condition: Condition, multiplier: f64) -> Active {
        let n = self.gradient.len();
        let mut along = vec![0.0; n + 1];
        match condition {
            Condition::Row(row) => {
                along.iter_mut().zip(self.inverse).for_each(|(along, of)| *along = dot(of, &self.rows[row].1));
                along[n] = -1.0;
            }
            Condition::Low(j) => along.iter_mut().zip(&self.inverse[j]).for_each(|(along, of)| *along = -of),
            Condition::High(j) => along[..n].copy_from_slice(&self.inverse[j]),
            Condition::Slack => along[n] = -1.0,
        }
        Active { condition, multiplier, along }
    }

    /// Product of a normal and a vector.
    fn times(&self, condition: Condition, vector: &[f64]) -> f64 {
        let n = self.gradient.len();
        match condition {
            Condition::Row(row) => dot(&self.rows[row].1, vector) - vector[n],
            Condition::Low(j) => -vector[j],
            Condition::High(j) => vector[j],
            Condition::Slack => -vector[n],
        }
    }

    /// Excess of a condition.
    fn over(&self, condition: Condition, z: &[f64]) -> f64 {
        let bound = match condition {
            Condition::Row(row) => -self.rows[row].0,
            Condition::Low(j) => -self.bounds[j][0],
            Condition::High(j) => self.bounds[j][1],
            Condition::Slack => 0.0,
        };
        self.times(condition, z) - bound
    }

    fn most_exceeded(&self, z: &[f64], active: &[Active]) -> Option<(Condition, f64)> {
        let bounds = (0..self.gradient.len()).flat_map(|j| [Condition::Low(j), Condition::High(j)]);
        let all = (0..self.rows.len()).map(Condition::Row).chain(bounds).chain([Condition::Slack]);
        all.filter(|&condition| active.iter().all(|one| one.condition != condition))
            .map(|condition| (condition, self.over(condition, z)))
            .reduce(|a, b| if b.1 > a.1 { b } else { a })
    }

    fn step(&self, z: &[f64], active: &[Active]) -> Step {
        let (n, rows) = (self.gradient.len(), self.rows.len());
        let mut multipliers = vec![0.0; rows + 2 * n];
        for one in active {
            let place = match one.condition {
                Condition::Row(row) => row,
                Condition::Low(j) => rows + 2 * j,
                Condition::High(j) => rows + 2 * j + 1,
                Condition::Slack => continue,
            };
            multipliers[place] = one.multiplier.max(0.0);
        }
        let d = (z[..n].iter().zip(self.bounds)).map(|(d, &[low, high])| d.clamp(low, high)).collect();
        Step { d, slack: z[n].max(0.0), multipliers }
    }
}

/// Product over the positions that both vectors have.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Projection of (2, 1) on x + y <= 1 and bounds: the foot of the perpendicular (1, 0), and with x <= 0.5 the
    /// corner (0.5, 0.5). The multipliers come from `d - (2, 1) + lambda (1, 1) + mu (1, 0) = 0`.
    #[test]
    fn a_projection_has_its_foot_and_multipliers() {
        let inverse = [vec![1.0, 0.0], vec![0.0, 1.0]];
        let rows = [(-1.0, vec![1.0, 1.0])];
        let solved = |high: f64| {
            let bounds = [[-5.0, high], [-5.0, 5.0]];
            Quadratic { inverse: &inverse, gradient: &[-2.0, -1.0], rows: &rows, bounds: &bounds, weight: 100.0 }
                .solved()
                .unwrap()
        };
        let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14);
        let foot = solved(5.0);
        assert!(near(&foot.d, &[1.0, 0.0]) && near(&foot.multipliers, &[1.0, 0.0, 0.0, 0.0, 0.0]), "{:?}", foot.d);
        let corner = solved(0.5);
        assert!(
            near(&corner.d, &[0.5, 0.5]) && near(&corner.multipliers, &[0.5, 0.0, 1.0, 0.0, 0.0]),
            "{:?}",
            corner.multipliers
        );
        assert_eq!(corner.slack, 0.0);
    }

    /// Rows that cannot be kept within the bounds are exceeded alike: x >= 3 and x <= 1 by 1, at 2 for any objective
    /// that `w` outweighs.
    #[test]
    fn rows_that_exclude_each_other_are_exceeded_alike() {
        let rows = [(3.0, vec![-1.0]), (-1.0, vec![1.0])];
        let inverse = [vec![1.0]];
        let found = Quadratic { inverse: &inverse, gradient: &[0.3], rows: &rows, bounds: &[[-9.0, 9.0]], weight: 1e3 }
            .solved()
            .unwrap();
        assert!((found.d[0] - 2.0).abs() < 1e-12 && (found.slack - 1.0).abs() < 1e-12, "{:?} {}", found.d, found.slack);
    }
}
