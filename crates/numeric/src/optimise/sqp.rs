//! Sequential quadratic programming: minimises a smooth objective under smooth rows and bounds to the last digits.
//!
//! Every step solves the quadratic problem (`quadratic_program`) of the present slopes, with the matrix of the Lagrangian
//! from earlier slopes (damped BFGS). It goes as far as the merit `f + w max(0, c)` falls. If a whole step does not
//! lower the merit because rows are curved, the step is solved again with the rows at its end. Sources: M. J. D.
//! Powell, "A fast algorithm for nonlinearly constrained optimization calculations" (1978), for the damped update; R.
//! Fletcher, "Second order corrections for non-differentiable optimization" (1982).

use crate::optimise::augmented_lagrangian::{EndConditions, SmoothProblem, SmoothSolution, ValueAndSlopes};
use crate::optimise::quadratic_program::{Quadratic, Step, dot};

/// Longest step of an unknown. For a logarithm it is a factor of 4.5, beyond which slopes are of little use.
const LONGEST: f64 = 1.5;
/// Least fall of the merit, as a part of the predicted one.
const FALL: f64 = 1e-4;
/// Greatest number of halvings of a step until the merit falls.
const HALVINGS: i32 = 25;
/// Least and greatest weight of the excess of rows. Greater ones lose digits beside an objective near 1.
const WEIGHTS: [f64; 2] = [1e-6, 1e6];
/// Excess of a row that is rounding of the quadratic problem.
const ROUNDING: f64 = 1e-12;
/// Powell's bound of damping.
const DAMPED: f64 = 0.2;
/// Number of steps near the end without a halved residual after which a search ends. Rounding prevents a smaller one
/// then.
const PATIENCE: usize = 8;
/// Greatest residual near the end.
const NEAR_THE_END: f64 = 1e-6;

/// Point with its values and slopes.
struct Place {
    x: Vec<f64>,
    value: f64,
    gradient: Vec<f64>,
    rows: Vec<ValueAndSlopes>,
}

impl Place {
    /// Greatest excess of a row.
    fn excess(&self) -> f64 {
        self.rows.iter().fold(0.0, |most, row| most.max(row.0))
    }

    fn merit(&self, weight: f64) -> f64 {
        self.value + weight * self.excess()
    }

    /// Slopes of the Lagrangian, without bounds.
    fn lagrangian(&self, multipliers: &[f64]) -> Vec<f64> {
        let mut slopes = self.gradient.clone();
        for ((_, by), multiplier) in self.rows.iter().zip(multipliers) {
            slopes.iter_mut().zip(by).for_each(|(slope, by)| *slope += multiplier * by);
        }
        slopes
    }
}

impl SmoothProblem<'_> {
    /// Searches by quadratic problems from a start. Returns the end, or the first place at which `enough` returns true
    /// for it and its residual. Returns None if values or slopes are not defined at the start.
    pub fn solve_by_sqp(
        &self,
        start: &[f64],
        near: EndConditions,
        enough: &dyn Fn(&[f64], f64) -> bool,
    ) -> Option<SmoothSolution> {
        let within: Vec<f64> = start.iter().zip(self.bounds).map(|(x, &[low, high])| x.clamp(low, high)).collect();
        let mut here = self.place(within)?;
        let mut inverse = Inverse::new(start.len());
        let mut weight = 1.0;
        let mut best: Option<SmoothSolution> = None;
        let (mut least, mut in_vain) = (f64::INFINITY, 0);
        for _ in 0..near.updates {
            let Some((step, of_step)) = self.step(&here, &inverse, weight) else { break };
            weight = of_step;
            let residual = self.residual_of(&here.gradient, &here.rows, &here.x, &step.multipliers);
            in_vain = if residual < 0.5 * least { 0 } else { in_vain + 1 };
            if residual < least {
                least = residual;
                let multipliers = step.multipliers[..here.rows.len()].to_vec();
                best = Some(SmoothSolution { x: here.x.clone(), multipliers, residual });
            }
            if enough(&here.x, residual) {
                let multipliers = step.multipliers[..here.rows.len()].to_vec();
                return Some(SmoothSolution { x: here.x, multipliers, residual });
            }
            if residual <= near.by || in_vain > PATIENCE && least <= NEAR_THE_END {
                break;
            }
            match self.gone(&here, &step, &inverse, weight) {
                Some((there, step, part)) => {
                    inverse.update(&here, &there, &step, part);
                    here = there;
                }
                // The matrix may be the reason for the failure.
                None if !inverse.is_new => inverse = Inverse::new(start.len()),
                None => break,
            }
        }
        best
    }

    fn place(&self, x: Vec<f64>) -> Option<Place> {
        let (value, gradient) = (self.objective)(&x);
        let rows = (self.rows)(&x)?;
        let finite =
            |(value, slopes): (&f64, &[f64])| value.is_finite() && slopes.iter().all(|slope| slope.is_finite());
        let defined = finite((&value, &gradient)) && rows.iter().all(|(value, slopes)| finite((value, slopes)));
        defined.then_some(Place { x, value, gradient, rows })
    }

    /// Step from a place, with a weight at which rows are kept if they can be.
    fn step(&self, here: &Place, inverse: &Inverse, before: f64) -> Option<(Step, f64)> {
        let solved = |weight: f64| self.quadratic(here, &here.rows, inverse, weight).solved();
        let mut weight = before;
        let mut step = solved(weight)?;
        while step.slack > ROUNDING && 10.0 * weight <= WEIGHTS[1] {
            let next = solved(10.0 * weight)?;
            // Rows that exclude each other within reach are exceeded at any weight.
            if next.slack > 0.9 * step.slack {
                break;
            }
            (step, weight) = (next, 10.0 * weight);
        }
        let sum: f64 = step.multipliers[..here.rows.len()].iter().sum();
        // The weight stays above the multipliers, and falls again after a distant place that needed more.
        Some((step, (2.0 * sum).max(0.5 * (weight + 2.0 * sum)).clamp(WEIGHTS[0], WEIGHTS[1])))
    }

    fn quadratic<'q>(
        &self,
        here: &'q Place,
        rows: &'q [ValueAndSlopes],
        inverse: &'q Inverse,
        weight: f64,
    ) -> Problem<'q> {
        let one = |(&x, &[low, high]): (&f64, &[f64; 2])| [(low - x).max(-LONGEST), (high - x).min(LONGEST)];
        Problem { here, rows, inverse, weight, bounds: here.x.iter().zip(self.bounds).map(one).collect() }
    }

    /// Place at the end of a step, the step with a correction that it may need, and the part of it that was taken.
    fn gone(&self, here: &Place, step: &Step, inverse: &Inverse, weight: f64) -> Option<(Place, Step, f64)> {
        let foretold = -dot(&here.gradient, &step.d) + weight * (here.excess() - step.slack);
        let merit = here.merit(weight);
        // Rounding of the merit hides the last steps.
        let rounding = 4.0 * f64::EPSILON * merit.abs();
        let lower =
            |there: &Place, part: f64| there.merit(weight) <= merit - FALL * part * foretold.max(0.0) + rounding;
        let along = |d: &[f64], part: f64| {
            let moved = here.x.iter().zip(d).zip(self.bounds);
            self.place(moved.map(|((x, d), &[low, high])| (x + part * d).clamp(low, high)).collect())
        };
        for halved in 0..HALVINGS {
            let part = 0.5f64.powi(halved);
            let Some(there) = along(&step.d, part) else { continue };
            if lower(&there, part) {
                return Some((there, step.clone(), part));
            }
            if halved == 0 && there.excess() > step.slack {
                let bent: Vec<ValueAndSlopes> = (here.rows.iter().zip(&there.rows))
                    .map(|((_, by), (value, _))| (value - dot(by, &step.d), by.clone()))
                    .collect();
                let corrected = self.quadratic(here, &bent, inverse, weight).solved();
                let place = corrected.as_ref().and_then(|corrected| along(&corrected.d, 1.0));
                if let Some((place, corrected)) = place.zip(corrected).filter(|(place, _)| lower(place, 1.0)) {
                    return Some((place, corrected, 1.0));
                }
            }
        }
        None
    }
}

/// Quadratic problem with the data that it owns.
struct Problem<'q> {
    here: &'q Place,
    rows: &'q [ValueAndSlopes],
    inverse: &'q Inverse,
    weight: f64,
    bounds: Vec<[f64; 2]>,
}

impl Problem<'_> {
    fn solved(&self) -> Option<Step> {
        let Self { here, rows, inverse, weight, bounds } = self;
        Quadratic { inverse: &inverse.rows, gradient: &here.gradient, rows, bounds, weight: *weight }.solved()
    }
}

/// Inverse of the matrix of the Lagrangian.
struct Inverse {
    rows: Vec<Vec<f64>>,
    /// True if it has no curvature information yet.
    is_new: bool,
}

impl Inverse {
    fn new(n: usize) -> Self {
        Self { rows: (0..n).map(|a| (0..n).map(|b| f64::from(u8::from(a == b))).collect()).collect(), is_new: true }
    }

    /// Updates the matrix with the slopes at the end of a part of a step.
    fn update(&mut self, here: &Place, there: &Place, step: &Step, part: f64) {
        let n = here.x.len();
        let rows = here.rows.len();
        let s: Vec<f64> = step.d.iter().map(|d| part * d).collect();
        let old = here.lagrangian(&step.multipliers);
        let y: Vec<f64> = there.lagrangian(&step.multipliers).iter().zip(&old).map(|(new, old)| new - old).collect();
        // Product of the matrix and the step, from the conditions that the step fulfils: B d = -(slopes of the
        // Lagrangian with bounds).
        let bounds = step.multipliers[rows..].chunks(2).map(|sides| sides[1] - sides[0]);
        let bs: Vec<f64> = old.iter().zip(bounds).map(|(old, bound)| -part * (old + bound)).collect();
        let (sbs, sy) = (dot(&s, &bs), dot(&s, &y));
        if !(sbs > 0.0 && sbs.is_finite()) {
            return;
        }
        let damped = if sy >= DAMPED * sbs { 1.0 } else { (1.0 - DAMPED) * sbs / (sbs - sy) };
        let r: Vec<f64> = y.iter().zip(&bs).map(|(y, bs)| damped * y + (1.0 - damped) * bs).collect();
        let sr = dot(&s, &r);
        if sr <= 0.0 {
            return;
        }
        if self.is_new {
            // Scale the matrix to the first curvature.
            let size = sr / dot(&r, &r);
            self.rows.iter_mut().enumerate().for_each(|(a, row)| row[a] = size);
            self.is_new = false;
        }
        let hr: Vec<f64> = self.rows.iter().map(|row| dot(row, &r)).collect();
        let rhr = dot(&r, &hr);
        for a in 0..n {
            for b in 0..n {
                self.rows[a][b] += (1.0 + rhr / sr) * s[a] * s[b] / sr - (hr[a] * s[b] + s[a] * hr[b]) / sr;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hock and Schittkowski's problem 43 (Rosen and Suzuki): -44 at (0, 1, 2, -1) with multipliers 1, 0, 2.
    #[test]
    fn the_problem_of_rosen_and_suzuki_is_solved() {
        let objective = |x: &[f64]| {
            let value =
                x[0] * x[0] + x[1] * x[1] + 2.0 * x[2] * x[2] + x[3] * x[3] - 5.0 * x[0] - 5.0 * x[1] - 21.0 * x[2]
                    + 7.0 * x[3];
            (value, vec![2.0 * x[0] - 5.0, 2.0 * x[1] - 5.0, 4.0 * x[2] - 21.0, 2.0 * x[3] + 7.0])
        };
        let rows = |x: &[f64]| {
            let row = |a: [f64; 4], b: [f64; 4], most: f64| {
                let value = (0..4).map(|j| a[j] * x[j] * x[j] + b[j] * x[j]).sum::<f64>() - most;
                (value, (0..4).map(|j| 2.0 * a[j] * x[j] + b[j]).collect())
            };
            Some(vec![
                row([1.0; 4], [1.0, -1.0, 1.0, -1.0], 8.0),
                row([1.0, 2.0, 1.0, 2.0], [-1.0, 0.0, 0.0, -1.0], 10.0),
                row([2.0, 1.0, 1.0, 0.0], [2.0, -1.0, 0.0, -1.0], 5.0),
            ])
        };
        let smooth = SmoothProblem { objective: &objective, rows: &rows, bounds: &[[-10.0, 10.0]; 4] };
        // Starts at a point that keeps every row, and at one that breaks all.
        for start in [[0.0; 4], [9.0; 4]] {
            let found = smooth.solve_by_sqp(&start, EndConditions { by: 1e-11, updates: 60 }, &|_, _| false).unwrap();
            assert!(found.residual <= 1e-11, "{}", found.residual);
            let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
            assert!(near(&found.x, &[0.0, 1.0, 2.0, -1.0]), "{:?}", found.x);
            assert!(near(&found.multipliers, &[1.0, 0.0, 2.0]), "{:?}", found.multipliers);
        }
    }
}
