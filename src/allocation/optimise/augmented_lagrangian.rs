//! Augmented Lagrangian: minimises a smooth objective under smooth rows and bounds by descents of L-BFGS.
//!
//! ```text
//! min over x of  f(x) + sum_i (max(0, lambda_i + rho c_i(x))^2 - lambda_i^2)/(2 rho),   lambda_i <- max(0, lambda_i + rho c_i)
//! ```
//!
//! The terms are those of the rows `c_i <= 0` and of the bounds alike. Source: M. R. Hestenes, "Multiplier and gradient
//! methods", J. Optimization Theory and Applications 4 (1969); R. T. Rockafellar, same journal 12 (1973), for
//! inequalities.

use crate::allocation::cost::cost_curve::Priced;
use crate::allocation::optimise::minimise::minimised;
use crate::allocation::optimise::separable;
use crate::allocation::optimise::separable::Separable;

/// Iterations of the descent between two updates of the multipliers.
const DESCENT: u64 = 60;
/// Greatest ratio of a violation to the last one with which the weight stays.
const FALLS: f64 = 0.25;
/// First weight of the violations, and its factor at each increase.
const WEIGHT: f64 = 10.0;

/// Value with its derivatives.
pub(in crate::allocation) type Slope = (f64, Vec<f64>);

pub(in crate::allocation) struct Smooth<'a> {
    /// Objective, scaled to a size near 1.
    pub(in crate::allocation) objective: &'a dyn Fn(&[f64]) -> Slope,
    /// Rows, each kept if it is at most 0. Returns None if one is not defined.
    pub(in crate::allocation) rows: &'a dyn Fn(&[f64]) -> Option<Vec<Slope>>,
    pub(in crate::allocation) bounds: &'a [[f64; 2]],
}

/// End conditions of a search.
#[derive(Clone, Copy)]
pub(in crate::allocation) struct Near {
    /// Greatest violation of rows and bounds.
    pub(in crate::allocation) by: f64,
    /// Most updates of the multipliers.
    pub(in crate::allocation) updates: usize,
}

/// Result of a search.
pub(in crate::allocation) struct Ended {
    /// Unknowns, within their bounds.
    pub(in crate::allocation) x: Vec<f64>,
    /// Multipliers of the rows.
    pub(in crate::allocation) multipliers: Vec<f64>,
    /// Largest violation of the conditions of Karush, Kuhn and Tucker. Stationarity is relative to the largest slope of
    /// the objective.
    pub(in crate::allocation) residual: f64,
}

impl Smooth<'_> {
    /// Searches from a start. Returns None if the rows are not defined there.
    pub(in crate::allocation) fn minimised(&self, start: &[f64], near: Near) -> Option<Ended> {
        let mut x = start.to_vec();
        let rows = (self.rows)(&x)?.len();
        let mut multipliers = vec![0.0; rows + 2 * x.len()];
        let mut weight = WEIGHT;
        let mut last = f64::INFINITY;
        for _ in 0..near.updates {
            x = minimised(&|x| self.lagrangian(x, &multipliers, weight), &x, 0.1 * near.by, DESCENT);
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
        Some(Ended { x, multipliers, residual })
    }

    /// Excess of every row, and of every unknown below its lower and above its upper bound.
    fn over(&self, rows: &[Slope], x: &[f64]) -> Vec<f64> {
        let bounds = self.bounds.iter().zip(x).flat_map(|(&[low, high], &x)| [low - x, x - high]);
        rows.iter().map(|row| row.0).chain(bounds).collect()
    }

    fn lagrangian(&self, x: &[f64], multipliers: &[f64], weight: f64) -> Option<Slope> {
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
    pub(in crate::allocation) fn residual_of(
        &self,
        own: &[f64],
        rows: &[Slope],
        x: &[f64],
        multipliers: &[f64],
    ) -> f64 {
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

/// Solves a separable problem from any start to near its optimum. Returns tolerances and multipliers, which Newton
/// steps on the dual then refine. Every group must have one offer.
pub(in crate::allocation) fn augmented(problem: &Separable<'_>, start: &[f64]) -> (Vec<f64>, Vec<f64>) {
    const NEAR: Near = Near { by: 1e-3, updates: 12 };
    let bounds: Vec<[f64; 2]> =
        problem.priced.iter().map(|group| [libm::log(group.offers[0].min), libm::log(group.offers[0].max)]).collect();
    let x: Vec<f64> = start.iter().map(|t| libm::log(*t)).collect();
    let scale = with_losses(problem, start, &x).0.abs().max(f64::MIN_POSITIVE);
    let tolerances = |x: &[f64]| x.iter().map(|x| libm::exp(*x)).collect::<Vec<f64>>();
    let objective = |x: &[f64]| {
        let (value, slopes) = with_losses(problem, &tolerances(x), x);
        (value / scale, slopes.into_iter().map(|slope| slope / scale).collect())
    };
    let rows = |x: &[f64]| {
        let t = tolerances(x);
        let of = |row: &separable::Row| {
            let slopes = row.terms.iter().zip(&t).map(|(term, &t)| term.power * term.value(t)).collect();
            (row.value(&t) - 1.0, slopes)
        };
        Some(problem.rows.iter().map(of).collect())
    };
    let smooth = Smooth { objective: &objective, rows: &rows, bounds: &bounds };
    match smooth.minimised(&x, NEAR) {
        Some(Ended { x, multipliers, .. }) => {
            (tolerances(&x), multipliers.into_iter().map(|multiplier| multiplier * scale).collect())
        }
        None => (start.to_vec(), vec![0.0; problem.rows.len()]),
    }
}

/// Cost of all groups and losses at tolerances and their logarithms, with the derivatives by `ln T`.
fn with_losses(problem: &Separable<'_>, at: &[f64], x: &[f64]) -> Slope {
    let (mut value, mut slopes) = cost(problem.priced, at, x);
    for row in problem.losses {
        value += row.value(at);
        let terms = row.terms.iter().zip(at).map(|(term, &t)| term.power * term.value(t));
        slopes.iter_mut().zip(terms).for_each(|(slope, term)| *slope += term);
    }
    (value, slopes)
}

/// Cost of all groups at tolerances and their logarithms, by the first offer of each, with the derivatives by `ln T`.
pub(in crate::allocation) fn cost(priced: &[Priced], at: &[f64], x: &[f64]) -> Slope {
    let of = priced.iter().zip(at.iter().zip(x)).map(|(group, (&t, &ln))| {
        let [cost, slope] = group.offers[0].curve.with_slope(t, ln);
        (group.parts * cost, group.parts * slope)
    });
    let (costs, slopes): (Vec<f64>, Vec<f64>) = of.unzip();
    (costs.iter().sum(), slopes)
}
