//! The search that begins where sums of powers lead nowhere: sequential quadratic programming on the requirements themselves.
//!
//! A Cpk is a row `(mean ± 3 C sigma - limit)/w`, which has slopes wherever the mean lies; the ratio that [`Constraint::value`] compares has a pole where
//! it passes the limit. All other requirements are rows `value - 1`.

use super::augmented::{Ended, Near, Slope, Smooth, cost};
use super::constraint::{Constraint, Linearised};
use super::quadratic::dot;
use super::solve::{SMALL, Setting};
use super::solved::{Ends, Solved};
use sensitol_numeric::requirement::Requirement;

/// Unknowns and rows beyond which the dense matrices of a step take longer than a round of the model.
const MOST: usize = 300;
const NEAR: Near = Near { by: 1e-11, updates: 100 };

impl Setting<'_> {
    /// The end of a search from a start that need keep nothing, or that of an earlier one which it comes near; None where values are unknown there,
    /// or there are too many unknowns.
    pub(super) fn finished(&self, start: &[f64], ends: &Ends) -> Option<Solved> {
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
        let smooth = Smooth { objective: &objective, rows: &rows, bounds: &bounds };
        let x: Vec<f64> = start.iter().map(|t| libm::log(*t)).collect();
        let near = |x: &[f64], residual: f64| ends.near(&tolerances(x), residual).is_some();
        let Ended { x, multipliers, residual } = smooth.sequential(&x, NEAR, &near)?;
        let at = self.within(&tolerances(&x));
        if let Some(known) = ends.near(&at, residual) {
            return Some(known.clone());
        }
        let linearised = self.linearised(&at)?;
        // Both rows of a requirement are 0 together, so that one's slopes are a multiple of the other's.
        let scaled = |((multiplier, own), value): ((&f64, &Slope), &Linearised)| match dot(&value.slopes, &value.slopes)
        {
            0.0 => 0.0,
            square => multiplier * scale * dot(&value.slopes, &own.1) / square,
        };
        let own = rows(&x)?;
        let multipliers: Vec<f64> = multipliers.iter().zip(&own).zip(&linearised).map(scaled).collect();
        let mut solved = self.judged(&at, &linearised, &multipliers, false);
        solved.converged = solved.residual <= SMALL;
        self.tighten(&mut solved);
        Some(Solved { sequential: true, ..solved })
    }

    /// By how much a requirement is exceeded, with slopes by `ln T`.
    fn excess(&self, one: &Constraint, width: f64, at: &[f64]) -> Option<Slope> {
        let (responses, priced) = (self.responses, self.priced);
        if !matches!(one.requirement, Requirement::Cpk(_)) {
            let linearised = one.linearised(responses, priced, at)?;
            return Some((linearised.value - 1.0, linearised.slopes));
        }
        let factors = responses.factors(priced, at);
        let still = vec![0.0; factors.len()];
        let value = one.excess(responses, &factors, &still, width)?;
        let sigma = responses.moments(one.characteristic, &factors)?.sigma();
        let sign = if one.is_above() { 1.0 } else { -1.0 };
        let reach = 3.0 * one.target(responses) * sigma;
        let of = |by: &[f64; 4]| (sign * by[0] + reach * by[1]) / width;
        Some((value, responses.moment_slopes(one.characteristic, priced, &factors)?.iter().map(of).collect()))
    }
}
