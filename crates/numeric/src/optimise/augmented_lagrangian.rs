//! Augmented Lagrangian: minimises a smooth objective under smooth rows and bounds by descents of L-BFGS.
//!
//! ```text
//! min over x of  f(x) + sum_i (max(0, lambda_i + rho c_i(x))^2 - lambda_i^2)/(2 rho),   lambda_i <- max(0, lambda_i + rho c_i)
//! ```
//!
//! The terms are those of the rows `c_i <= 0` and of the bounds alike. Source: M. R. Hestenes, "Multiplier and gradient
//! methods", J. Optimization Theory and Applications 4 (1969); R. T. Rockafellar, same journal 12 (1973), for
//! inequalities.

use crate::optimise::minimise::minimise;
use crate::optimise::separable::{BoundedCost, CostedUnknown, PowerRow, SeparableProblem};

/// Iterations of the descent between two updates of the multipliers.
const DESCENT: u64 = 60;
/// Greatest ratio of a violation to the last one with which the weight stays.
const FALLS: f64 = 0.25;
/// First weight of the violations, and its factor at each increase.
const WEIGHT: f64 = 10.0;

/// Value with its derivatives.
pub type ValueAndSlopes = (f64, Vec<f64>);

/// Smooth objective under smooth rows and bounds.
///
/// ```
/// use sensitol_numeric::optimise::augmented_lagrangian::{EndConditions, SmoothProblem};
/// // The point of the line x + y >= 1 that is nearest to 0.
/// let objective = |x: &[f64]| (x[0] * x[0] + x[1] * x[1], vec![2.0 * x[0], 2.0 * x[1]]);
/// let rows = |x: &[f64]| Some(vec![(1.0 - x[0] - x[1], vec![-1.0, -1.0])]);
/// let bounds = [[-9.0, 9.0]; 2];
/// let problem = SmoothProblem { objective: &objective, rows: &rows, bounds: &bounds };
/// let found = problem.solve_by_sqp(&[3.0, 0.0], EndConditions { by: 1e-11, updates: 50 }, &|_, _| false).unwrap();
/// assert!((found.x[0] - 0.5).abs() < 1e-9 && (found.multipliers[0] - 1.0).abs() < 1e-8);
/// ```
pub struct SmoothProblem<'a> {
    /// Objective, scaled to a size near 1.
    pub objective: &'a dyn Fn(&[f64]) -> ValueAndSlopes,
    /// Rows, each kept if it is at most 0. Returns None if one is not defined.
    pub rows: &'a dyn Fn(&[f64]) -> Option<Vec<ValueAndSlopes>>,
    /// Least and greatest value of every unknown.
    pub bounds: &'a [[f64; 2]],
}

/// End conditions of a search.
#[derive(Clone, Copy)]
pub struct EndConditions {
    /// Greatest violation of rows and bounds.
    pub by: f64,
    /// Greatest number of updates of the multipliers.
    pub updates: usize,
}

/// Result of a search.
pub struct SmoothSolution {
    /// Unknowns, within their bounds.
    pub x: Vec<f64>,
    /// Multipliers of the rows.
    pub multipliers: Vec<f64>,
    /// Largest violation of the conditions of Karush, Kuhn and Tucker. Stationarity is relative to the largest slope of
    /// the objective.
    pub residual: f64,
}

impl SmoothProblem<'_> {
    /// Searches from a start. Returns None if a constraint is undefined there.
    pub fn minimise(&self, start: &[f64], near: EndConditions) -> Option<SmoothSolution> {
        let mut x = start.to_vec();
        let rows = (self.rows)(&x)?.len();
        let mut multipliers = vec![0.0; rows + 2 * x.len()];
        let mut weight = WEIGHT;
        let mut last = f64::INFINITY;
        for _ in 0..near.updates {
            x = minimise(&|x| self.lagrangian(x, &multipliers, weight), &x, 0.1 * near.by, DESCENT);
            let over = self.over(&(self.rows)(&x)?, &x);
            let mut error: f64 = 0.0;
            for (multiplier, over) in multipliers.iter_mut().zip(&over) {
                error = error.max(if *multiplier > 0.0 { over.abs() } else { over.max(0.0) });
                *multiplier = (*multiplier + weight * over).max(0.0);
            }
            if error <= near.by {
                break;
            }
            if error > FALLS * last {
                weight *= WEIGHT;
            }
            last = error;
        }
        let residual = self.residual(&x, &multipliers)?;
        x.iter_mut().zip(self.bounds).for_each(|(x, &[low, high])| *x = x.clamp(low, high));
        multipliers.truncate(rows);
        Some(SmoothSolution { x, multipliers, residual })
    }

    /// Excess of every row, and of every unknown below its lower and above its upper bound.
    fn over(&self, rows: &[ValueAndSlopes], x: &[f64]) -> Vec<f64> {
        let bounds = self.bounds.iter().zip(x).flat_map(|(&[low, high], &x)| [low - x, x - high]);
        rows.iter().map(|row| row.0).chain(bounds).collect()
    }

    fn lagrangian(&self, x: &[f64], multipliers: &[f64], weight: f64) -> Option<ValueAndSlopes> {
        let (mut value, mut slopes) = (self.objective)(x);
        let rows = (self.rows)(x)?;
        let (of_rows, of_bounds) = multipliers.split_at(rows.len());
        let mut pulled = |over: f64, multiplier: f64| {
            let pull = (multiplier + weight * over).max(0.0);
            value += (pull * pull - multiplier * multiplier) / (2.0 * weight);
            pull
        };
        for ((over, by), &multiplier) in rows.iter().zip(of_rows) {
            let pull = pulled(*over, multiplier);
            if pull > 0.0 {
                slopes.iter_mut().zip(by).for_each(|(slope, by)| *slope += pull * by);
            }
        }
        for (g, &[low, high]) in self.bounds.iter().enumerate() {
            slopes[g] += pulled(x[g] - high, of_bounds[2 * g + 1]) - pulled(low - x[g], of_bounds[2 * g]);
        }
        Some((value, slopes))
    }

    fn residual(&self, x: &[f64], multipliers: &[f64]) -> Option<f64> {
        Some(self.residual_of(&(self.objective)(x).1, &(self.rows)(x)?, x, multipliers))
    }

    /// Largest violation of the conditions of Karush, Kuhn and Tucker, by the slopes of the objective and the rows at
    /// `x`.
    pub fn residual_of(&self, own: &[f64], rows: &[ValueAndSlopes], x: &[f64], multipliers: &[f64]) -> f64 {
        let scale = own.iter().fold(f64::MIN_POSITIVE, |scale, slope| scale.max(slope.abs()));
        let (of_rows, of_bounds) = multipliers.split_at(rows.len());
        let mut slopes = own.to_vec();
        for ((_, by), multiplier) in rows.iter().zip(of_rows) {
            slopes.iter_mut().zip(by).for_each(|(slope, by)| *slope += multiplier * by);
        }
        let bounds = slopes.iter_mut().zip(of_bounds.chunks(2));
        bounds.for_each(|(slope, sides)| *slope += sides[1] - sides[0]);
        let stationary = slopes.iter().fold(0.0f64, |most, slope| most.max(slope.abs() / scale));
        let over = self.over(rows, x);
        let kept = over.iter().zip(multipliers).fold(0.0f64, |most, (&over, &multiplier)| {
            most.max(over).max((multiplier / scale * over).abs().min(over.abs()))
        });
        stationary.max(kept)
    }
}

/// Solves a separable problem from any start to near its optimum. Returns unknowns and multipliers, which Newton steps
/// on the dual then refine. Every unknown must have one option.
pub fn solve_separable<U: CostedUnknown>(problem: &SeparableProblem<'_, U>, start: &[f64]) -> (Vec<f64>, Vec<f64>) {
    const NEAR: EndConditions = EndConditions { by: 1e-3, updates: 12 };
    let bounds: Vec<[f64; 2]> =
        problem.unknowns.iter().map(|unknown| unknown.options()[0].bounds().map(libm::log)).collect();
    let x: Vec<f64> = start.iter().map(|t| libm::log(*t)).collect();
    let scale = with_losses(problem, start, &x).0.abs().max(f64::MIN_POSITIVE);
    let tolerances = |x: &[f64]| x.iter().map(|x| libm::exp(*x)).collect::<Vec<f64>>();
    let objective = |x: &[f64]| {
        let (value, slopes) = with_losses(problem, &tolerances(x), x);
        (value / scale, slopes.into_iter().map(|slope| slope / scale).collect())
    };
    let rows = |x: &[f64]| {
        let t = tolerances(x);
        let of = |row: &PowerRow| {
            let slopes = row.terms.iter().zip(&t).map(|(term, &t)| term.power * term.value(t)).collect();
            (row.value(&t) - 1.0, slopes)
        };
        Some(problem.rows.iter().map(of).collect())
    };
    let smooth = SmoothProblem { objective: &objective, rows: &rows, bounds: &bounds };
    match smooth.minimise(&x, NEAR) {
        Some(SmoothSolution { x, multipliers, .. }) => {
            (tolerances(&x), multipliers.into_iter().map(|multiplier| multiplier * scale).collect())
        }
        None => (start.to_vec(), vec![0.0; problem.rows.len()]),
    }
}

/// Cost of all unknowns plus the losses, with the derivatives with respect to `ln T`. `x` are the logarithms of `at`.
fn with_losses<U: CostedUnknown>(problem: &SeparableProblem<'_, U>, at: &[f64], x: &[f64]) -> ValueAndSlopes {
    let (mut value, mut slopes) = cost(problem.unknowns, at, x);
    for row in problem.losses {
        value += row.value(at);
        let terms = row.terms.iter().zip(at).map(|(term, &t)| term.power * term.value(t));
        slopes.iter_mut().zip(terms).for_each(|(slope, term)| *slope += term);
    }
    (value, slopes)
}

/// Cost of all unknowns by the first option of each, with the derivatives with respect to `ln T`. `x` are the logarithms of `at`.
pub fn cost<U: CostedUnknown>(unknowns: &[U], at: &[f64], x: &[f64]) -> ValueAndSlopes {
    let of = unknowns.iter().zip(at.iter().zip(x)).map(|(unknown, (&t, &ln))| {
        let [cost, slope] = unknown.options()[0].with_slope(t, ln);
        (unknown.weight() * cost, unknown.weight() * slope)
    });
    let (costs, slopes): (Vec<f64>, Vec<f64>) = of.unzip();
    (costs.iter().sum(), slopes)
}
