//! Sample of a cheap model in strata: figures with their errors.
//!
//! ```text
//! E f = sum_s mean over stratum s of w f [in no earlier stratum]
//!   1. sides of switches that are seldom met       half-spaces, 4096 points each
//!   2. two tails, +-a.z > 2.5                      4096 points each
//!   3. the core, |a.z| <= 2.5                      32 768 points
//! ```
//!
//! Every point counts in the first stratum that contains it, so that the sum is unbiased for any strata. The points are Sobol' points in 16
//! scramblings (Owen 1997), from which the jackknife computes the errors. These are multiplied by `1 + 5/sqrt(n)`, with `n` the number of
//! points that carry the variance of a power (Kish 1965), and by Student's quantile. The error of a share also includes the weight of one
//! point, because a rare event may exist although no point shows it.

use crate::estimate::cheap_model::CheapModel;
use crate::estimate::figures::{MOMENTS, carried_by, effective, jackknife, moments, standard, student, totals};
use crate::estimate::normal_space::Columns;
use crate::estimate::strata::{HalfSpace, between, unit};
use crate::estimate::switch_side::{Sides, sides};
use crate::estimate::verified::Verified;
use crate::estimate::weighted_sample::{WeightedPart, WeightedSample};
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::Normals;
use sensitol_numeric::surrogate::Surrogate;

/// Number of randomisations (scramblings) of a stratum.
pub(crate) const REPLICATES: usize = 16;
/// Points of a half-space in all randomisations together.
pub(crate) const TAIL: usize = 1 << 12;
/// Most random numbers for the points of one stratum.
const NUMBERS: usize = 1_000_000;
/// Points that determine the direction of the tails.
pub(crate) const PILOT: usize = 1 << 10;
/// Greatest absolute value, in sigmas, that counts for the direction of the tails.
const WINSORISED: f64 = 4.0;
/// Distance at which the tails begin, in sigmas along their direction.
pub(crate) const FAR: f64 = 2.5;

pub(crate) struct StratifiedSample {
    /// Points of each stratum in each randomisation that no earlier stratum contains.
    parts: Vec<WeightedPart>,
    /// Weight of one point of the core.
    one: f64,
    /// Number of evaluated points, including those that searched for strata.
    pub(crate) points: usize,
    pub(crate) sides: Sides,
}

/// Figures of a sample with their errors: mean, sigma, skewness, kurtosis, then a share for every requested interval.
pub(crate) struct Figures {
    pub(crate) values: Vec<f64>,
    pub(crate) errors: Vec<f64>,
    /// Share of the assemblies that have a value, and its error.
    pub(crate) valid: (f64, f64),
}

impl StratifiedSample {
    /// Draws a sample with `core` points in the core.
    pub(crate) fn draw(model: &CheapModel<'_>, seed: u64, core: usize, beside: Option<(&[usize], &Surrogate)>) -> Self {
        let normals = Normals::new(model.len(), seed);
        let (direction, known) = {
            let pilot = normals.columns(1 << 33, PILOT);
            let known = model.values(&pilot);
            (steepest(&pilot, &known), known)
        };
        // The spread of the pilot is the scale of jumps at switches.
        let valid: Vec<f64> = known.iter().copied().filter(|y| y.is_finite()).collect();
        let spread = moments(&valid, &vec![1.0; valid.len()])[1];
        let sides = sides(model, &normals, if spread > 0.0 { spread } else { 1.0 });
        let opposite = direction.iter().map(|part| -part).collect();
        let tails = [direction.clone(), opposite].map(|direction| HalfSpace { direction, from: FAR });
        let spaces: Vec<&HalfSpace> = sides.half_spaces.iter().chain(&tails).collect();
        let strata = spaces.len() + 1;
        let most = (NUMBERS / model.len().max(1) / REPLICATES).max(1);
        let rows = |stratum: usize| (if stratum + 1 < strata { TAIL } else { core } / REPLICATES).min(most);
        let part = |index: usize| -> WeightedPart {
            let (replicate, stratum) = (index / strata, index % strata);
            // A stopped run does not wait for the rest of the points.
            let rows = if model.stopped() { 0 } else { rows(stratum) };
            let mut z = normals.columns((replicate * 64 + stratum) as u64, rows);
            let weights = match spaces.get(stratum) {
                Some(space) => space.enter(&mut z),
                None => vec![between(&mut z, &direction, FAR); rows],
            };
            let mut own = vec![true; rows];
            for earlier in &spaces[..stratum] {
                own.iter_mut().zip(earlier.holds(&z)).for_each(|(own, held)| *own &= !held);
            }
            let kept = |column: &[f64]| -> Vec<f64> {
                column.iter().zip(&own).filter(|(_, own)| **own).map(|(value, _)| *value).collect()
            };
            z.iter_mut().for_each(|column| *column = kept(column));
            let weights = kept(&weights).into_iter().map(|weight| weight / rows as f64).collect();
            let surface = beside.and_then(|(varying, surrogate)| model.surface(&z, varying, surrogate));
            WeightedPart { replicate, values: model.values(&z), weights, surface: surface.unwrap_or_default() }
        };
        let parts: Vec<WeightedPart> = (0..REPLICATES * strata).into_par_iter().map(part).collect();
        let core = rows(strata - 1);
        let one = between(&mut vec![vec![0.0]], &[1.0], FAR) / (core * REPLICATES) as f64;
        let drawn: usize = parts.iter().map(|part| part.values.len()).sum();
        Self { parts, one, points: drawn + PILOT, sides }
    }

    /// Figures, with the shares of the assemblies within these intervals, ends included.
    ///
    /// Points without a value are left out of numerator and denominator alike: every figure refers to the assemblies that have a value.
    pub(crate) fn figures(&self, intervals: &[[f64; 2]]) -> Figures {
        let all = || self.parts.iter().flat_map(|part| part.values.iter().zip(&part.weights));
        let (values, weights): (Vec<f64>, Vec<f64>) = all().filter(|(y, _)| y.is_finite()).unzip();
        let total: f64 = all().map(|(_, weight)| weight).sum();
        let [origin, spread, ..] = moments(&values, &weights);
        let scale = if spread > 0.0 { spread } else { 1.0 };
        // Sums of the valid points, of powers 1 to 4, of every interval, and of all points.
        let count = 1 + MOMENTS + intervals.len();
        let mut sums = vec![vec![0.0; REPLICATES]; count + 1];
        for part in &self.parts {
            let mut row = vec![0.0; count + 1];
            for (&y, &weight) in part.values.iter().zip(&part.weights) {
                row[count] += weight;
                if !y.is_finite() {
                    continue;
                }
                let v = (y - origin) / scale;
                let mut term = weight;
                for sum in &mut row[..=MOMENTS] {
                    *sum += term;
                    term *= v;
                }
                for (sum, [low, high]) in row[1 + MOMENTS..].iter_mut().zip(intervals) {
                    *sum += if *low <= y && y <= *high { weight } else { 0.0 };
                }
            }
            sums.iter_mut().zip(row).for_each(|(sums, more)| sums[part.replicate] += more);
        }
        let of = |total: &[f64]| {
            let raw: Vec<f64> = total[1..count].iter().map(|sum| sum / total[0]).collect();
            standard(&raw, origin, scale)
        };
        let mut errors = jackknife(of, &sums);
        // Few points may carry a high power: the jackknife underestimates its error.
        for (power, error) in errors.iter_mut().enumerate().take(MOMENTS) {
            let terms = values.iter().zip(&weights);
            let carried = terms.map(|(y, weight)| weight * ((y - origin) / scale).abs().powi(power as i32 + 1));
            *error *= carried_by(effective(carried));
        }
        let student = student(REPLICATES);
        errors.iter_mut().for_each(|error| *error *= student);
        errors[MOMENTS..].iter_mut().for_each(|error| *error = libm::hypot(*error, self.one));
        let share = |total: &[f64]| vec![total[0] / total[count]];
        let failed = total > 0.0 && values.len() < all().count();
        let off = if failed { libm::hypot(student * jackknife(share, &sums)[0], self.one) } else { self.one };
        Figures { values: of(&totals(&sums)), errors, valid: (weights.iter().sum::<f64>() / total, off) }
    }

    /// Difference of the shares of model and surface within each interval, ends included: `mean(1_model - 1_surface)`. Returns None if
    /// there is no surface, or if some points have no value, because the shares refer to different assemblies then.
    pub(crate) fn difference<const N: usize>(&self, intervals: &[[f64; 2]; N]) -> Option<[Verified; N]> {
        let whole =
            |part: &WeightedPart| part.surface.len() == part.values.len() && part.values.iter().all(|y| y.is_finite());
        if !self.parts.iter().all(whole) {
            return None;
        }
        let mut sums = vec![vec![0.0; REPLICATES]; N + 1];
        for part in &self.parts {
            let points = part.values.iter().zip(&part.surface).zip(&part.weights);
            for ((model, surface), weight) in points {
                let within = |[low, high]: &[f64; 2], y: &f64| f64::from(u8::from(low <= y && y <= high));
                for (sum, interval) in sums.iter_mut().zip(intervals) {
                    sum[part.replicate] += weight * (within(interval, model) - within(interval, surface));
                }
                sums[N][part.replicate] += weight;
            }
        }
        let shares = |total: &[f64]| total[..N].iter().map(|sum| sum / total[N]).collect::<Vec<f64>>();
        let (values, errors) = (shares(&totals(&sums)), jackknife(shares, &sums));
        let student = student(REPLICATES);
        // The weight of one point, as for a share: a difference may exist although no point shows it.
        Some(std::array::from_fn(|i| Verified { value: values[i], error: libm::hypot(student * errors[i], self.one) }))
    }

    /// Weight of one point of the core.
    pub(crate) fn point(&self) -> f64 {
        self.one
    }

    /// Converts it to a sample for tails and shares that are computed later.
    pub(crate) fn kept(self) -> WeightedSample {
        WeightedSample::new(self.parts, REPLICATES, self.one)
    }

    /// True if no point has a value.
    pub(crate) fn is_void(&self) -> bool {
        !self.parts.iter().flat_map(|part| &part.values).any(|y| y.is_finite())
    }
}

/// Direction along which the tails lie: `E[z d^3]` with `d` the standardised values, winsorised. For a function that is nearly linear it is
/// along `R b`.
pub(crate) fn steepest(z: &Columns, y: &[f64]) -> Vec<f64> {
    let valid: Vec<f64> = y.iter().copied().filter(|y| y.is_finite()).collect();
    let [mean, sigma, ..] = moments(&valid, &vec![1.0; valid.len()]);
    let cubes: Vec<f64> = (y.iter())
        .map(|y| match y.is_finite() && sigma > 0.0 {
            true => ((y - mean) / sigma).clamp(-WINSORISED, WINSORISED).powi(3),
            false => 0.0,
        })
        .collect();
    unit(z.iter().map(|column| column.iter().zip(&cubes).map(|(z, cube)| z * cube).sum()).collect())
}
