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
use crate::allocation::cost::priced_group::Priced;
use crate::allocation::requirement::constraint::Constraint;
use sensitol_numeric::optimise::augmented_lagrangian::{
    EndConditions, SmoothProblem, SmoothSolution, ValueAndSlopes, cost,
};

/// Step of the differences, in `ln T` and in sigmas. Truncation and rounding are both 1e-10.
const STEP: f64 = 1e-5;
/// End conditions: the tolerance of rows and bounds, and the most updates of the multipliers.
const NEAR: EndConditions = EndConditions { by: 1e-9, updates: 40 };
/// Greatest number of unknowns times rows, because differences take long. Beyond it nominal values move to the fewest rejects instead.
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
    let ones = vec![1.0; setting.responses.dimensions.len()];
    let widths =
        setting.constraints.iter().map(|one| one.width(setting.responses, &ones)).collect::<Option<Vec<f64>>>()?;
    let scale = setting.cost(at).abs().max(f64::MIN_POSITIVE);
    let unknowns = Unknowns { setting, of, bounds, widths, scale };
    let SmoothSolution { x, residual, .. } = unknowns.cheapest(at)?;
    let [ln, shifts] = [&x[..groups], &x[groups..]];
    Some(Together { shifts: shifts.to_vec(), at: ln.iter().map(|x| libm::exp(*x)).collect(), residual })
}

/// The problem by its unknowns `x`: `ln T` of the groups, then the shifts of the movable dimensions.
struct Unknowns<'s> {
    setting: &'s Setting<'s>,
    /// The movable dimensions, and bounds of their shifts.
    of: &'s [usize],
    bounds: &'s [[f64; 2]],
    /// `w` of every constraint.
    widths: Vec<f64>,
    /// The cost by which all costs are divided.
    scale: f64,
}

impl Unknowns<'_> {
    /// Half bands of the groups.
    fn half_bands(&self, x: &[f64]) -> Vec<f64> {
        x[..self.setting.priced.len()].iter().map(|x| libm::exp(*x)).collect()
    }

    /// The factors of all tolerances, and the shifts of all dimensions.
    fn places(&self, x: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let responses = self.setting.responses;
        let mut shifts = vec![0.0; responses.dimensions.len()];
        self.of.iter().zip(&x[self.setting.priced.len()..]).for_each(|(&d, &shift)| shifts[d] = shift);
        (responses.factors(self.setting.priced, &self.half_bands(x)), shifts)
    }

    /// The excess of every constraint.
    fn values(&self, x: &[f64]) -> Option<Vec<f64>> {
        let (factors, shifts) = self.places(x);
        let excess = |(one, width): (&Constraint, &f64)| one.excess(self.setting.responses, &factors, &shifts, *width);
        self.setting.constraints.iter().zip(&self.widths).map(excess).collect()
    }

    /// The excess of every constraint with its slopes.
    fn rows(&self, x: &[f64]) -> Option<Vec<ValueAndSlopes>> {
        let mut rows: Vec<ValueAndSlopes> =
            self.values(x)?.into_iter().map(|value| (value, vec![0.0; x.len()])).collect();
        let mut moved = x.to_vec();
        for j in 0..x.len() {
            moved[j] = x[j] + STEP;
            let up = self.values(&moved)?;
            moved[j] = x[j] - STEP;
            let down = self.values(&moved)?;
            moved[j] = x[j];
            rows.iter_mut()
                .zip(up.iter().zip(down))
                .for_each(|(row, (up, down))| row.1[j] = (up - down) / (2.0 * STEP));
        }
        Some(rows)
    }

    /// The cost of deviations and rejects.
    fn lost(&self, x: &[f64]) -> f64 {
        let (factors, shifts) = self.places(x);
        let losses = self.setting.losses.iter();
        losses.map(|loss| loss.at(self.setting.responses, &factors, Some(&shifts)).unwrap_or(f64::NAN)).sum()
    }

    /// The cost of tolerances and losses, with its slopes.
    fn objective(&self, x: &[f64]) -> ValueAndSlopes {
        let scale = self.scale;
        let (value, mut slopes) = cost(self.setting.priced, &self.half_bands(x), x);
        slopes.resize(x.len(), 0.0);
        slopes.iter_mut().for_each(|slope| *slope /= scale);
        if self.setting.losses.is_empty() {
            return (value / scale, slopes);
        }
        let mut moved = x.to_vec();
        for (j, slope) in slopes.iter_mut().enumerate() {
            moved[j] = x[j] + STEP;
            let up = self.lost(&moved);
            moved[j] = x[j] - STEP;
            *slope += (up - self.lost(&moved)) / (2.0 * STEP * scale);
            moved[j] = x[j];
        }
        ((value + self.lost(x)) / scale, slopes)
    }

    /// A start at these half bands within their bounds, with nominal values that move as little as their bounds allow.
    fn within(&self, t: &[f64]) -> Vec<f64> {
        let groups = self.setting.priced.iter().zip(t);
        let clamped = groups.map(|(group, t)| libm::log(t.clamp(group.tightest(), group.loosest())));
        clamped.chain(self.bounds.iter().map(|&[low, high]| 0.0f64.clamp(low, high))).collect()
    }

    /// The cheapest end that keeps all constraints, from these half bands, from the tightest, and from between them.
    fn cheapest(&self, at: &[f64]) -> Option<SmoothSolution> {
        let priced = self.setting.priced;
        let of_groups = priced.iter().map(|group| [libm::log(group.tightest()), libm::log(group.loosest())]);
        let bounds: Vec<[f64; 2]> = of_groups.chain(self.bounds.iter().copied()).collect();
        let (objective, rows) = (|x: &[f64]| self.objective(x), |x: &[f64]| self.rows(x));
        let smooth = SmoothProblem { objective: &objective, rows: &rows, bounds: &bounds };
        let tight: Vec<f64> = priced.iter().map(Priced::tightest).collect();
        let middle: Vec<f64> = at.iter().zip(&tight).map(|(at, tight)| (at * tight).sqrt()).collect();
        let mut best: Option<(f64, SmoothSolution)> = None;
        for start in [at, &middle, &tight] {
            let Some(ended) = smooth.minimise(&self.within(start), NEAR) else { continue };
            let kept = self.values(&ended.x).is_some_and(|values| values.iter().all(|&value| value <= KEPT));
            let cost = self.objective(&ended.x).0;
            if kept && best.as_ref().is_none_or(|(least, _)| cost < least * (1.0 - KEPT)) {
                best = Some((cost, ended));
            }
            if (self.setting.stopped)() {
                break;
            }
        }
        best.map(|(_, ended)| ended)
    }
}
