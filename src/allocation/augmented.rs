//! A separable problem by the augmented Lagrangian: from any start near to its multipliers.
//!
//! ```text
//! min over x = ln T of  cost(x) + sum_i (max(0, lambda_i + rho c_i(x))^2 - lambda_i^2)/(2 rho),   lambda_i <- max(0, lambda_i + rho c_i)
//! ```
//!
//! over the constraints and the bounds alike. Source: M. R. Hestenes, "Multiplier and gradient methods", J. Optimization Theory and
//! Applications 4 (1969); R. T. Rockafellar, same journal 12 (1973), for inequalities.

use super::minimise::minimised;
use super::separable::Separable;

/// Updates of the multipliers; what is left after that Newton steps on the dual do.
const UPDATES: usize = 12;
/// Descents of one update.
const DESCENT: u64 = 60;
/// Near enough for Newton's method.
const NEAR: f64 = 1e-5;

/// Tolerances and multipliers of the constraints. Every group must have one offer.
pub(super) fn augmented(problem: &Separable<'_>, start: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let bounds: Vec<[f64; 2]> =
        problem.priced.iter().map(|group| [group.offers[0].min.ln(), group.offers[0].max.ln()]).collect();
    let scale = cost(problem, start).0.abs().max(f64::MIN_POSITIVE);
    let mut x: Vec<f64> = start.iter().map(|t| t.ln()).collect();
    let rows = problem.rows.len();
    let mut multipliers = vec![0.0; rows + 2 * x.len()];
    let mut weight = 10.0;
    let mut last = f64::INFINITY;
    for _ in 0..UPDATES {
        let lagrangian = |x: &[f64]| {
            let t: Vec<f64> = x.iter().map(|x| x.exp()).collect();
            let (value, mut slopes) = cost(problem, &t);
            let mut value = value / scale;
            slopes.iter_mut().for_each(|slope| *slope /= scale);
            for (row, &multiplier) in problem.rows.iter().zip(&multipliers) {
                let pull = (multiplier + weight * (row.value(&t) - 1.0)).max(0.0);
                value += (pull * pull - multiplier * multiplier) / (2.0 * weight);
                if pull > 0.0 {
                    let terms = row.terms.iter().zip(&t);
                    slopes
                        .iter_mut()
                        .zip(terms)
                        .for_each(|(slope, (term, &t))| *slope += pull * term.power * term.value(t));
                }
            }
            for (g, &[low, high]) in bounds.iter().enumerate() {
                for (side, over) in [low - x[g], x[g] - high].into_iter().enumerate() {
                    let multiplier = multipliers[rows + 2 * g + side];
                    let pull = (multiplier + weight * over).max(0.0);
                    value += (pull * pull - multiplier * multiplier) / (2.0 * weight);
                    slopes[g] += if side == 0 { -pull } else { pull };
                }
            }
            Some((value, slopes))
        };
        x = minimised(&lagrangian, &x, 0.1 * NEAR, DESCENT);
        let t: Vec<f64> = x.iter().map(|x| x.exp()).collect();
        let mut over: Vec<f64> = problem.rows.iter().map(|row| row.value(&t) - 1.0).collect();
        over.extend(bounds.iter().zip(&x).flat_map(|(&[low, high], &x)| [low - x, x - high]));
        let mut error: f64 = 0.0;
        for (multiplier, over) in multipliers.iter_mut().zip(&over) {
            error = error.max(if *multiplier > 0.0 { over.abs() } else { over.max(0.0) });
            *multiplier = (*multiplier + weight * over).max(0.0);
        }
        if error <= NEAR {
            break;
        }
        if error > 0.25 * last {
            weight *= 10.0;
        }
        last = error;
    }
    let t = x.iter().zip(&bounds).map(|(x, &[low, high])| x.clamp(low, high).exp()).collect();
    (t, multipliers[..rows].iter().map(|multiplier| multiplier * scale).collect())
}

/// Cost of all groups and its derivatives by `ln T`.
fn cost(problem: &Separable<'_>, at: &[f64]) -> (f64, Vec<f64>) {
    let of = problem.priced.iter().zip(at).map(|(group, &t)| {
        let curve = &group.offers[0].curve;
        (group.parts * curve.cost(t), group.parts * curve.log_derivatives(t)[0])
    });
    let (costs, slopes): (Vec<f64>, Vec<f64>) = of.unzip();
    (costs.iter().sum(), slopes)
}
