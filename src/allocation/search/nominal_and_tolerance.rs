//! Choice of nominal values and tolerances at once, at fixed derivatives.
//!
//! ```text
//! min over ln T and m of  cost(T)
//! subject to   (mean + 3 C sigma - U)/w <= 0, (L - mean + 3 C sigma)/w <= 0      Cpk at least C; w: 3 C sigma at the station
//!              (middle + rss - U)/w <= 0 and below                               rss
//!              (greatest - U)/w <= 0 and below                                   worst case
//!              sigma/s - 1 <= 0, (sigma/room)^2 - 1 <= 0                         sigma, yield
//!              bounds of T and of the nominal values m
//! ```
//!
//! A Cpk is a ratio with a pole where the mean passes a limit. As written here it is linear in the mean and convex.
//! Derivatives are central differences. The augmented Lagrangian keeps rows to 1e-9. The exact search then chooses the
//! tolerances about the nominal values found.

use crate::allocation::choice::single_offer::Setting;
use crate::allocation::cost::cost_curve::Priced;
use crate::allocation::optimise::augmented_lagrangian::{Ended, Near, Slope, Smooth, cost};
use crate::allocation::requirement::constraint::Constraint;

/// Step of the differences, in `ln T` and in sigmas. Truncation and rounding are both 1e-10.
const STEP: f64 = 1e-5;
/// End conditions: the tolerance of rows and bounds, and the most updates of the multipliers.
const NEAR: Near = Near { by: 1e-9, updates: 40 };
/// Most unknowns times rows, because differences take long. Beyond it nominal values move to the fewest rejects
/// instead.
const MOST: usize = 2000;
/// Greatest violation at which an end is a result.
const KEPT: f64 = 1e-6;

/// Nominal values and tolerances that were chosen together.
pub(in crate::allocation) struct Together {
    /// Move of every movable dimension, in sigmas.
    pub(in crate::allocation) shifts: Vec<f64>,
    /// Half bands of the groups.
    pub(in crate::allocation) at: Vec<f64>,
    /// Largest violation of the conditions of Karush, Kuhn and Tucker.
    pub(in crate::allocation) residual: f64,
}

/// Cheapest tolerances with nominal values of the dimensions `of` moved within `bounds`, in sigmas from their present
/// place. Returns None if none were found, or there are too many unknowns.
pub(in crate::allocation) fn together(
    setting: &Setting<'_>,
    of: &[usize],
    bounds: &[[f64; 2]],
    at: &[f64],
) -> Option<Together> {
    let groups = setting.priced.len();
    let free = setting.priced.iter().all(|group| group.offers.len() == 1);
    if !free || (groups + of.len()) * setting.constraints.len() > MOST {
        return None;
    }
    let responses = setting.responses;
    let dimensions = responses.dimensions.len();
    let ones = vec![1.0; dimensions];
    let widths: Vec<f64> =
        setting.constraints.iter().map(|one| one.width(responses, &ones)).collect::<Option<Vec<f64>>>()?;
    // The unknowns are ln T of the groups, then the moves of the nominal values in sigmas.
    let places = |x: &[f64]| {
        let t: Vec<f64> = x[..groups].iter().map(|x| libm::exp(*x)).collect();
        let mut shifts = vec![0.0; dimensions];
        of.iter().zip(&x[groups..]).for_each(|(&d, &shift)| shifts[d] = shift);
        (responses.factors(setting.priced, &t), shifts)
    };
    let values = |x: &[f64]| -> Option<Vec<f64>> {
        let (factors, shifts) = places(x);
        let of = |(one, width): (&Constraint, &f64)| one.excess(responses, &factors, &shifts, *width);
        setting.constraints.iter().zip(&widths).map(of).collect()
    };
    let rows = |x: &[f64]| -> Option<Vec<Slope>> {
        let mut rows: Vec<Slope> = values(x)?.into_iter().map(|value| (value, vec![0.0; x.len()])).collect();
        let mut moved = x.to_vec();
        for j in 0..x.len() {
            moved[j] = x[j] + STEP;
            let up = values(&moved)?;
            moved[j] = x[j] - STEP;
            let down = values(&moved)?;
            moved[j] = x[j];
            rows.iter_mut()
                .zip(up.iter().zip(down))
                .for_each(|(row, (up, down))| row.1[j] = (up - down) / (2.0 * STEP));
        }
        Some(rows)
    };
    let within = |t: &[f64]| -> Vec<f64> {
        let clamped =
            setting.priced.iter().zip(t).map(|(group, t)| libm::log(t.clamp(group.tightest(), group.loosest())));
        clamped.chain(bounds.iter().map(|&[low, high]| 0.0f64.clamp(low, high))).collect()
    };
    let scale = setting.cost(at).abs().max(f64::MIN_POSITIVE);
    let lost = |x: &[f64]| -> f64 {
        let (factors, shifts) = places(x);
        setting.losses.iter().map(|loss| loss.at(responses, &factors, Some(&shifts)).unwrap_or(f64::NAN)).sum()
    };
    let objective = |x: &[f64]| {
        let t: Vec<f64> = x[..groups].iter().map(|x| libm::exp(*x)).collect();
        let (value, mut slopes) = cost(setting.priced, &t, x);
        slopes.resize(x.len(), 0.0);
        slopes.iter_mut().for_each(|slope| *slope /= scale);
        if setting.losses.is_empty() {
            return (value / scale, slopes);
        }
        let mut moved = x.to_vec();
        for (j, slope) in slopes.iter_mut().enumerate() {
            moved[j] = x[j] + STEP;
            let up = lost(&moved);
            moved[j] = x[j] - STEP;
            *slope += (up - lost(&moved)) / (2.0 * STEP * scale);
            moved[j] = x[j];
        }
        ((value + lost(x)) / scale, slopes)
    };
    let all: Vec<[f64; 2]> =
        (setting.priced.iter().map(|group| [libm::log(group.tightest()), libm::log(group.loosest())]))
            .chain(bounds.iter().copied())
            .collect();
    let smooth = Smooth { objective: &objective, rows: &rows, bounds: &all };
    // Several starts, because the surface may have several optima.
    let tight: Vec<f64> = setting.priced.iter().map(Priced::tightest).collect();
    let middle: Vec<f64> = at.iter().zip(&tight).map(|(at, tight)| (at * tight).sqrt()).collect();
    let mut best: Option<(f64, Ended)> = None;
    for start in [at, &middle, &tight] {
        let Some(ended) = smooth.minimised(&within(start), NEAR) else { continue };
        let kept = values(&ended.x).is_some_and(|values| values.iter().all(|&value| value <= KEPT));
        let cost = objective(&ended.x).0;
        if kept && best.as_ref().is_none_or(|(least, _)| cost < least * (1.0 - KEPT)) {
            best = Some((cost, ended));
        }
        if (setting.stopped)() {
            break;
        }
    }
    let Ended { x, residual, .. } = best?.1;
    Some(Together { shifts: x[groups..].to_vec(), at: x[..groups].iter().map(|x| libm::exp(*x)).collect(), residual })
}
