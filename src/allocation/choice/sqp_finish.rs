//! Search that follows if sums of powers do not converge: sequential quadratic programming on the requirements
//! themselves.
//!
//! Every requirement is a row that its form writes ([`smooth_row`](crate::allocation::requirement::form::RequirementForm::smooth_row)).

use crate::allocation::choice::single_offer::{SMALL, Setting};
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::requirement::linearised::Linearised;
use crate::allocation::result::solver_result::{Ends, Solved};
use sensitol_numeric::optimise::augmented_lagrangian::{
    EndConditions, SmoothProblem, SmoothSolution, ValueAndSlopes, cost,
};

/// Greatest number of unknowns and rows. Beyond it the dense matrices of a step take longer than a round of the model.
const MOST: usize = 300;
/// End conditions: the tolerance of rows and bounds, and the most steps.
const NEAR: EndConditions = EndConditions { by: 1e-11, updates: 100 };

impl Setting<'_> {
    /// Searches from any start. Returns the end, or that of an earlier search that it approaches. Returns None if
    /// values are unknown at the start, or there are too many unknowns.
    pub(in crate::allocation) fn finished(&self, start: &[f64], ends: &Ends) -> Option<Solved> {
        if start.len() + self.constraints.len() > MOST {
            return None;
        }
        let ones = vec![1.0; self.responses.dimensions.len()];
        let widths: Vec<f64> =
            self.constraints.iter().map(|one| one.width(self.responses, &ones)).collect::<Option<_>>()?;
        let bounds: Vec<[f64; 2]> = self.bounds().iter().map(|bounds| bounds.map(libm::log)).collect();
        let tolerances = |x: &[f64]| x.iter().map(|x| libm::exp(*x)).collect::<Vec<f64>>();
        let scale = self.cost(start).abs().max(f64::MIN_POSITIVE);
        let objective = |x: &[f64]| {
            let t = tolerances(x);
            let (mut value, mut slopes) = cost(self.priced, &t, x);
            for loss in self.losses {
                match loss.linearised(self.responses, self.priced, &t) {
                    Some(of) => {
                        value += of.value;
                        slopes.iter_mut().zip(&of.slopes).for_each(|(slope, of)| *slope += of);
                    }
                    None => value = f64::NAN,
                }
            }
            (value / scale, slopes.into_iter().map(|slope| slope / scale).collect())
        };
        let rows = |x: &[f64]| {
            let t = tolerances(x);
            self.constraints.iter().zip(&widths).map(|(one, &width)| self.excess(one, width, &t)).collect()
        };
        let smooth = SmoothProblem { objective: &objective, rows: &rows, bounds: &bounds };
        let x: Vec<f64> = start.iter().map(|t| libm::log(*t)).collect();
        let near = |x: &[f64], residual: f64| ends.near(&tolerances(x), residual).is_some();
        let SmoothSolution { x, multipliers, residual } = smooth.solve_by_sqp(&x, NEAR, &near)?;
        let at = self.within(&tolerances(&x));
        if let Some(known) = ends.near(&at, residual) {
            return Some(known.clone());
        }
        let linearised = self.linearised(&at)?;
        // Both rows of a requirement are 0 at the same place, so that their slopes are proportional.
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let scaled = |((multiplier, own), value): ((&f64, &ValueAndSlopes), &Linearised)| {
            let square = product(&value.slopes, &value.slopes);
            if square == 0.0 { 0.0 } else { multiplier * scale * product(&value.slopes, &own.1) / square }
        };
        let own = rows(&x)?;
        let multipliers: Vec<f64> = multipliers.iter().zip(&own).zip(&linearised).map(scaled).collect();
        let mut solved = self.judged(&at, &linearised, &multipliers, false);
        solved.converged = solved.residual <= SMALL;
        self.tighten(&mut solved);
        Some(Solved { sequential: true, ..solved })
    }

    /// Excess of a requirement, with slopes by `ln T`.
    fn excess(&self, one: &Constraint, width: f64, at: &[f64]) -> Option<ValueAndSlopes> {
        one.form().smooth_row(one, self.responses, (self.priced, at), width)
    }
}
