//! The probability that several characteristics keep their limits together, on common points.
//!
//! ```text
//! P(any limit broken) = sum of the tails - E[ (number of broken limits - 1)+ ]
//! ```
//!
//! The tails are those of each law; only the second term is sampled. Where failures are rare or far apart it is small, and so
//! is its error. Of two sums of normal inputs it is exact too.

use std::collections::BTreeMap;
use std::sync::Arc;

use faer::{Mat, Side};

use super::input::Input;
use super::points::{QUANTILE, REPLICATES, mixed};
use super::quadrant::both_broken;
use super::{LawFigure, SurfaceLaw};
use crate::characteristic::SpecLimits;
use crate::correlation::Block;
use crate::distribution::standard_normal;
use crate::parallel::prelude::*;
use crate::sampling::{SOBOL_DIMENSIONS, Sobol, tails};

/// Points in every replicate.
const POINTS: usize = 1 << 11;
/// Seed of the points.
const SEED: u64 = 1;

/// The share of assemblies that keep all limits, for laws over the same inputs in the same order.
///
/// Points are common to all laws and always the same. Cost: 2^15 values of every surface. The error has the part of 16
/// replicates and those of the tails. Laws over other inputs give the yield of characteristics that share the input of each
/// position.
///
/// ```
/// use std::sync::Arc;
/// use sensitol::SpecLimits;
/// use sensitol::distribution::{Distribution, Normal};
/// use sensitol::internals::{Interactions, LawOptions, SurfaceLaw, Surrogate, Univariate, joint_yield};
/// let inputs: Vec<Arc<dyn Distribution>> = vec![Arc::new(Normal::new(0.0, 1.0)?), Arc::new(Normal::new(0.0, 1.0)?)];
/// let law = |slopes: [f64; 2]| {
///     let parts = slopes.map(|slope| Some(Univariate::of_coefficients(&[slope]))).to_vec();
///     let surrogate = Surrogate { centre: 0.0, parts, interactions: Interactions::none(2) };
///     SurfaceLaw::of(&surrogate, &inputs, None, &LawOptions::default())
/// };
/// // Two independent characteristics: the joint yield is the product of their yields.
/// let (first, second) = (law([1.0, 0.0])?, law([0.0, 1.0])?);
/// let limits = SpecLimits::new(Some(-2.0), Some(2.0))?;
/// let both = joint_yield(&[(&first, limits), (&second, limits)]);
/// let one = 1.0 - 2.0 * first.above(2.0).value;
/// assert!((both.value - one * one).abs() <= both.error && both.error < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn joint_yield(characteristics: &[(&SurfaceLaw, SpecLimits)]) -> LawFigure {
    let mut tails = LawFigure::new(0.0, 0.0);
    for (law, limits) in characteristics {
        for tail in [limits.lower().map(|y| law.below(y)), limits.upper().map(|y| law.above(y))].into_iter().flatten() {
            tails = LawFigure::new(tails.value + tail.value, tails.error + tail.error);
        }
    }
    let limited: Vec<&(&SurfaceLaw, SpecLimits)> =
        characteristics.iter().filter(|(_, limits)| limits.exist()).collect();
    if limited.len() < 2 {
        return LawFigure::new((1.0 - tails.value).clamp(0.0, 1.0), tails.error);
    }
    let common = overlap(&limited, tails.value);
    LawFigure::new((1.0 - tails.value + common.value).clamp(0.0, 1.0), tails.error + common.error)
}

/// The mean of the broken limits beyond the first: exact of two sums of normal inputs, sampled of all others. `tails` is what all limits
/// reject together.
fn overlap(limited: &[&(&SurfaceLaw, SpecLimits)], tails: f64) -> LawFigure {
    if let [first, second] = limited
        && let Some(both) = both_broken([**first, **second])
    {
        return both;
    }
    let inputs = Inputs::of(limited);
    let sobol = Sobol::new(inputs.laws.len().min(SOBOL_DIMENSIONS));
    let of = |replicate: usize| inputs.several(limited, &inputs.columns(sobol.as_ref(), replicate));
    let several: Vec<f64> = (0..REPLICATES).into_par_iter().map(of).collect();
    let n = REPLICATES as f64;
    let mean = several.iter().sum::<f64>() / n;
    let variance = several.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (n - 1.0);
    // As for every other sampled figure; and no point with two broken limits is not a proof that there is none.
    let fewest = if mean == 0.0 { (3.0 / (n * POINTS as f64)).min(tails) } else { 0.0 };
    let error = QUANTILE * (variance / n).sqrt();
    LawFigure::new(mean, error.max(fewest))
}

/// The rejects of several characteristics by their limits: the sum of the tails, and by how much that counts assemblies twice.
pub(crate) fn rejected(characteristics: &[(&SurfaceLaw, SpecLimits)]) -> (f64, LawFigure) {
    let sides = |law: &SurfaceLaw, limits: SpecLimits| {
        [limits.lower().map(|y| law.below(y).value), limits.upper().map(|y| law.above(y).value)]
    };
    let tails: f64 = characteristics.iter().flat_map(|(law, limits)| sides(law, *limits)).flatten().sum();
    let limited: Vec<&(&SurfaceLaw, SpecLimits)> =
        characteristics.iter().filter(|(_, limits)| limits.exist()).collect();
    let twice = if limited.len() < 2 { LawFigure::new(0.0, 0.0) } else { overlap(&limited, tails) };
    (tails, twice)
}

/// All inputs that count for any of the laws, by their positions.
struct Inputs {
    laws: Vec<(usize, Arc<Input>)>,
    /// Places in `laws` of correlated inputs, and the factor of their normal variables.
    members: Vec<usize>,
    factor: Mat<f64>,
    /// Those of them that vary together as a whole.
    blocks: Vec<Block>,
}

impl Inputs {
    fn of(characteristics: &[&(&SurfaceLaw, SpecLimits)]) -> Self {
        let mut by_position: BTreeMap<usize, Arc<Input>> = BTreeMap::new();
        for (law, _) in characteristics {
            for (position, place) in law.given.places.iter().enumerate() {
                if let Some(place) = *place {
                    by_position.entry(position).or_insert_with(|| Arc::clone(&law.given.inputs[place]));
                }
            }
        }
        let laws: Vec<(usize, Arc<Input>)> = by_position.into_iter().collect();
        let (mut members, mut factor, mut blocks) = (Vec::new(), Mat::zeros(0, 0), Vec::new());
        if let Some(correlation) = characteristics.iter().find_map(|(law, _)| law.correlation.as_ref()) {
            let place = |position: usize| laws.binary_search_by_key(&position, |&(position, _)| position).ok();
            let known: Vec<(usize, usize)> = (correlation.members().iter().enumerate())
                .filter_map(|(member, &position)| Some((place(position)?, member)))
                .collect();
            let m = known.len();
            let matrix = Mat::from_fn(m, m, |a, b| correlation.normal()[(known[a].1, known[b].1)]);
            if let Ok(eigen) = matrix.self_adjoint_eigen(Side::Lower) {
                factor = Mat::from_fn(m, m, |a, b| eigen.U()[(a, b)] * eigen.S()[b].max(0.0).sqrt());
                members = known.into_iter().map(|(place, _)| place).collect();
            }
            blocks = correlation.blocks().iter().filter_map(|block| block.among(&place)).collect();
        }
        Self { laws, members, factor, blocks }
    }

    /// The mean of the broken limits beyond the first over some points.
    fn several(&self, characteristics: &[&(&SurfaceLaw, SpecLimits)], columns: &[Vec<f64>]) -> f64 {
        let mut broken = vec![0usize; POINTS];
        for (law, limits) in characteristics {
            let mut own: Vec<&[f64]> = vec![&[]; law.given.len()];
            for ((position, _), column) in self.laws.iter().zip(columns) {
                if let Some(at) = law.given.places.get(*position).copied().flatten() {
                    own[at] = column;
                }
            }
            for (broken, value) in broken.iter_mut().zip(law.given.values(&own, POINTS)) {
                *broken += usize::from(!limits.contains(value));
            }
        }
        broken.into_iter().map(|broken| broken.saturating_sub(1)).sum::<usize>() as f64 / POINTS as f64
    }

    /// The inputs at the points of a replicate, in sigmas off their means.
    fn columns(&self, sobol: Option<&Sobol>, replicate: usize) -> Vec<Vec<f64>> {
        let mut columns: Vec<Vec<f64>> = Vec::with_capacity(self.laws.len());
        let mut digits = vec![0; POINTS];
        for (dimension, (_, law)) in self.laws.iter().enumerate() {
            let key = mixed(mixed(mixed(SEED) ^ replicate as u64).wrapping_add(dimension as u64));
            match sobol {
                Some(sobol) if dimension < SOBOL_DIMENSIONS => sobol.digits(dimension, 0, &mut digits),
                // Random digits, scrambled like the others.
                _ => {
                    digits.iter_mut().enumerate().for_each(|(i, digits)| *digits = mixed(key ^ i as u64).reverse_bits())
                }
            }
            let mut column = vec![0.0; POINTS];
            tails(&digits, key, &mut column);
            match self.members.contains(&dimension) {
                true => standard_normal::quantiles(&mut column),
                false => law.at_tails(&mut column),
            }
            columns.push(column);
        }
        if !self.members.is_empty() {
            self.correlate(&mut columns);
        }
        columns
    }

    /// From independent normal variables of the correlated inputs to the inputs.
    fn correlate(&self, columns: &mut [Vec<f64>]) {
        let (mut z, mut scratch) = (vec![0.0; self.laws.len()], Vec::new());
        for point in 0..POINTS {
            z.iter_mut().zip(columns.iter()).for_each(|(z, column)| *z = column[point]);
            let normals: Vec<f64> = self.members.iter().map(|&place| z[place]).collect();
            for (a, &place) in self.members.iter().enumerate() {
                z[place] = normals.iter().enumerate().map(|(b, v)| self.factor[(a, b)] * v).sum();
            }
            self.blocks.iter().for_each(|block| block.apply(&mut z, &mut scratch));
            for &place in &self.members {
                let (law, normal) = (&self.laws[place].1, z[place]);
                columns[place][point] = match (law.is_normal(), normal < 0.0) {
                    (true, _) => normal,
                    (_, true) => law.at_tail(standard_normal::cdf(normal)),
                    _ => law.at_tail(-standard_normal::sf(normal)),
                };
            }
        }
    }
}
