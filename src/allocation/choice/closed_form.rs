//! Optimum in closed form, if Lagrange's condition has one.
//!
//! For costs `a + b/T^k` with one exponent `k` for all, and one constraint `constant + sum_g p_g (T_g/at_g)^q = 1`, the
//! condition gives
//!
//! ```text
//! T_g = mu (parts_g b_g at_g^q / p_g)^(1/(k+q)),     mu from the constraint
//! ```
//!
//! with q = 1 for a worst case and q = 2 for a root of the sum of squares. Source: K. W. Chase, A. R. Parkinson, "A survey of research
//! in the application of tolerance analysis to the design of mechanical assemblies", Research in Engineering Design 3 (1991).

use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint;
use sensitol_numeric::optimise::separable::{PowerRow, SeparableProblem};

/// Tolerances and multipliers of the optimum. Returns None if costs differ in kind, there are losses, several
/// constraints are active, or a tolerance meets a bound.
pub(in crate::allocation) fn closed_form(problem: &SeparableProblem<'_, Priced>) -> Option<(Vec<f64>, Vec<f64>)> {
    if !problem.losses.is_empty() {
        return None;
    }
    (0..problem.rows.len()).find_map(|k| {
        let at = bound_by(problem, k)?;
        let kept = |(other, row): (usize, &PowerRow)| other == k || constraint::kept(row.value(&at));
        let inside =
            problem.unknowns.iter().zip(&at).all(|(group, t)| (group.offers[0].min..=group.offers[0].max).contains(t));
        let mut multipliers = vec![0.0; problem.rows.len()];
        // The ratio of saving to use by a wider tolerance is the same for every group.
        let (group, term) = (&problem.unknowns[0], &problem.rows[k].terms[0]);
        let saved = -group.parts * group.offers[0].curve.log_derivatives(at[0], libm::log(at[0]))[0];
        multipliers[k] = saved / (term.power * term.value(at[0]));
        (inside && problem.rows.iter().enumerate().all(kept)).then_some((at, multipliers))
    })
}

/// Optimum with only this constraint.
fn bound_by(problem: &SeparableProblem<'_, Priced>, k: usize) -> Option<Vec<f64>> {
    let row = &problem.rows[k];
    let (_, exponent) = problem.unknowns.first()?.offers[0].curve.power()?;
    let power = row.terms[0].power;
    let ratio = problem.unknowns.iter().zip(&row.terms).map(|(group, term)| {
        let (b, k) = group.offers[0].curve.power()?;
        let same = group.offers.len() == 1 && k == exponent && term.power == power && term.coefficient > 0.0;
        // Ratio in units of the tolerance at which the term was taken.
        same.then(|| libm::pow(group.parts * b * libm::pow(term.at, -k) / term.coefficient, 1.0 / (k + power)))
    });
    let ratio: Vec<f64> = ratio.collect::<Option<_>>()?;
    let used: f64 = row.terms.iter().zip(&ratio).map(|(term, ratio)| term.coefficient * libm::pow(*ratio, power)).sum();
    let free = 1.0 - row.constant;
    (free > 0.0).then(|| {
        let mu = libm::pow(free / used, 1.0 / power);
        row.terms.iter().zip(&ratio).map(|(term, ratio)| term.at * mu * ratio).collect()
    })
}
