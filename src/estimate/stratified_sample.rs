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
//! points that carry the variance of a power (Kish 1965), and by Student's quantile.

use crate::estimate::cheap_model::CheapModel;
use crate::estimate::figures::moments;
use crate::estimate::normal_space::Columns;
use crate::estimate::strata::{HalfSpace, between, outside_of, unit};
use crate::estimate::switch_side::{Sides, sides};
use crate::estimate::weighted_sample::{WeightedPart, WeightedSample};
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::Normals;
use sensitol_numeric::surrogate::Surrogate;

/// Number of randomisations (scramblings) of a stratum.
pub(crate) const REPLICATES: usize = 16;
/// Points of a half-space in all randomisations together.
pub(crate) const TAIL: usize = 1 << 12;
/// Greatest number of random numbers for the points of one stratum.
const NUMBERS: usize = 1_000_000;
/// Points that determine the direction of the tails.
pub(crate) const PILOT: usize = 1 << 10;
/// Greatest absolute value, in sigmas, that counts for the direction of the tails.
const WINSORISED: f64 = 4.0;
/// Distance at which the tails begin, in sigmas along their direction.
pub(crate) const FAR: f64 = 2.5;

/// Sample of one characteristic, with the switches that were found on the way.
pub(crate) struct StratifiedSample {
    /// Points of each stratum in each randomisation that no earlier stratum contains. Its `point` is a point of the core.
    pub(crate) sample: WeightedSample,
    /// Number of evaluated points, including those that searched for strata.
    pub(crate) points: usize,
    pub(crate) sides: Sides,
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
            let own = outside_of(spaces[..stratum].iter().copied(), &z);
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
        Self { sample: WeightedSample::new(parts, REPLICATES, one), points: drawn + PILOT, sides }
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
