//! Moves nominal values, together with the tolerances or to the fewest rejects.

use crate::allocation::choice::single_offer::Setting;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::search::driver::{Driver, Near};
use crate::allocation::search::linearization_point::LinearizationPoint;
use crate::allocation::search::nominal_and_tolerance::{Together, together};
use crate::allocation::surface::response::Responses;
use crate::allocation::task::{AllocateError, Goal};
use crate::problem::Problem;
use sensitol_numeric::capability::Law;
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::optimise::minimise::minimise;

/// Step of the central differences, in sigmas.
const STEP: f64 = 1e-4;
/// Gradient of the logarithm per sigma at which the descent ends.
const REST: f64 = 1e-9;
/// Greatest number of iterations of the descent.
const DESCENT: u64 = 200;
/// Greatest move at which nominal values chosen alone are at rest, in sigmas.
const REST_ALONE: f64 = 1e-3;
/// Greatest step of a nominal value for which derivatives are trusted, in sigmas.
const FAR: f64 = 30.0;

/// Problem with moved nominal values.
pub(in crate::allocation) struct Recentred {
    pub(in crate::allocation) problem: Problem,
    /// Greatest move, in sigmas.
    pub(in crate::allocation) far: f64,
    /// Greatest move at which the nominal values are at rest, in sigmas.
    pub(in crate::allocation) rest: f64,
    /// Half bands that belong to the nominal values, if both were chosen together.
    pub(in crate::allocation) at: Option<Vec<f64>>,
    pub(in crate::allocation) residual: Option<f64>,
}

impl Driver<'_> {
    /// Moves nominal values: together with the tolerances if these may change too, or to the fewest rejects.
    pub(in crate::allocation) fn recentred(
        &self,
        station: &LinearizationPoint,
        constraints: &[Constraint],
        at: &[f64],
    ) -> Result<Recentred, AllocateError> {
        let problem = &station.problem;
        let of: Vec<usize> = (self.options.recentre.iter())
            .filter_map(|name| problem.dimensions().iter().position(|dimension| dimension.name() == name))
            .collect();
        let bounds: Vec<[f64; 2]> = of.iter().map(|&d| self.bounds_of(&problem.dimensions()[d])).collect();
        let stopped = || self.run.stopped();
        let priced = &self.task.priced;
        let (responses, losses, setups) = (&station.responses, &self.task.losses, &self.task.setups);
        let setting = Setting { responses, priced, constraints, losses, setups, stopped: &stopped, anywhere: false };
        // Without a requirement nothing fixes the nominal values. An objective for a given cost is then best with the
        // fewest rejects.
        let required = !priced.is_empty() && self.task.goal == Goal::LeastCost;
        let both = required.then(|| together(&setting, &of, &bounds, at)).flatten();
        let none = Recentred { problem: problem.clone(), far: 0.0, rest: REST_ALONE, at: None, residual: None };
        let (shifts, found) = match both {
            Some(Together { shifts, at, residual }) => {
                (shifts, Recentred { at: Some(at), residual: Some(residual), rest: Near::of(problem).rest, ..none })
            }
            None => match shifts(problem, &station.responses, &of) {
                Some(shifts) => (shifts, none),
                None => return Ok(none),
            },
        };
        let far = shifts.iter().fold(0.0f64, |far, shift| far.max(shift.abs()));
        let part = if far > FAR && found.at.is_none() { FAR / far } else { 1.0 };
        let mut dimensions = problem.dimensions().to_vec();
        let mut way: f64 = 0.0;
        for ((&d, shift), &[low, high]) in of.iter().zip(&shifts).zip(&bounds) {
            let shift = (part * shift).clamp(low, high);
            way = way.max(shift.abs());
            if let Some(moved) = dimensions[d].moved(dimensions[d].nominal() + shift * dimensions[d].sigma()) {
                dimensions[d] = moved?;
            }
        }
        Ok(Recentred { problem: problem.clone().with_dimensions(dimensions)?, far: way, ..found })
    }

    /// Bounds of a dimension's nominal value, in sigmas from the present one.
    fn bounds_of(&self, dimension: &Dimension) -> [f64; 2] {
        let given = self.options.nominal_bounds.iter().find(|(name, _)| name == dimension.name());
        given.map_or([-FAR, FAR], |(_, bounds)| bounds.map(|bound| (bound - dimension.nominal()) / dimension.sigma()))
    }
}

/// Moves of these dimensions in sigmas to the fewest rejects of all characteristics with limits together, at fixed
/// derivatives. Returns None if the rejects are unknown.
///
/// It minimises `ln (sum of rejected shares) - ln (least share kept)`, which has a slope at any distance from the
/// limits. If several dimensions have the same effect, each moves in proportion to it, which is the least way in
/// sigmas.
fn shifts(problem: &Problem, responses: &Responses, of: &[usize]) -> Option<Vec<f64>> {
    let limited: Vec<(usize, SpecLimits)> = (problem.characteristics().iter().enumerate())
        .map(|(c, one)| (c, one.limits()))
        .filter(|(_, limits)| limits.exist())
        .collect();
    let ones = vec![1.0; problem.dimensions().len()];
    let value = |shifts: &[f64]| -> Option<f64> {
        let mut all = vec![0.0; ones.len()];
        of.iter().zip(shifts).for_each(|(&d, &shift)| all[d] = shift);
        let (mut rejected, mut kept) = (0.0, f64::INFINITY);
        for &(c, limits) in &limited {
            let moments = responses.moments_shifted(c, &ones, Some(&all))?;
            let [out, within] = shares(&moments, limits)?;
            rejected += libm::exp(out);
            kept = within.min(kept);
        }
        Some(libm::log(rejected.max(f64::MIN_POSITIVE)) - kept)
    };
    let function = |shifts: &[f64]| {
        let here = value(shifts)?;
        let mut at = shifts.to_vec();
        let gradient: Option<Vec<f64>> = (0..shifts.len())
            .map(|j| {
                at[j] = shifts[j] + STEP;
                let up = value(&at);
                at[j] = shifts[j] - STEP;
                let down = value(&at);
                at[j] = shifts[j];
                Some((up? - down?) / (2.0 * STEP))
            })
            .collect();
        Some((here, gradient?))
    };
    let start = vec![0.0; of.len()];
    value(&start)?;
    Some(minimise(&function, &start, REST, DESCENT))
}

/// Logarithms of the shares rejected and kept.
fn shares(moments: &Moments, limits: SpecLimits) -> Option<[f64; 2]> {
    let Law::Pearson(law) = Law::fit(moments).ok()? else { return None };
    let below = limits.lower().map_or(f64::NEG_INFINITY, |lower| law.log_cdf(lower));
    let above = limits.upper().map_or(f64::NEG_INFINITY, |upper| law.log_sf(upper));
    let most = below.max(above);
    // Rejects below the range of doubles, or beyond the end of a bounded distribution, get the least logarithm.
    let out = if most == f64::NEG_INFINITY {
        -700.0
    } else {
        most + libm::log(libm::exp(below - most) + libm::exp(above - most))
    };
    let left = limits.lower().map_or(0.0, |lower| law.log_sf(lower));
    let right = limits.upper().map_or(0.0, |upper| law.log_cdf(upper));
    Some([out.max(-700.0), left.min(right).max(-1e5)])
}
