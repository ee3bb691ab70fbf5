//! Check points: points of the dimensions' own distribution, at which a surrogate is compared with the model.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{DifferencePlan, Point};
use sensitol_numeric::correlation::Correlation;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::{Probability, standard_normal};

/// Seed of the check points. They are the same for every study with the same number of dimensions, and independent of the user's seed.
const KEY: u64 = 0x5e_75_17_01;

/// Random orders of the levels of a dimension, of which the best is chosen.
const CANDIDATES: usize = 24;
/// Preceding dimensions that the order of a dimension's levels is compared with.
const NEIGHBOURS: usize = 32;
/// Place in the outermost interval, as a part of it from the outer end, at which the square of a normal variable equals its mean over the
/// interval.
const OUTERMOST: f64 = 0.36;

/// Pairs of points of the joint distribution. The second point of each pair lies at the mirrored probabilities of the first.
///
/// A Latin hypercube: along every dimension the `2 pairs` points fall into `2 pairs` different intervals of equal probability, so that few
/// of them reach far out along every dimension. For symmetric distributions the second point is the first mirrored at the means. Half the
/// sum and half the difference of the values there are then the even and the odd part. Dimensions known by moments alone are placed at the
/// nodes of their rule. Each number `set` gives another set of points.
pub(crate) fn scattered(
    plan: &mut DifferencePlan,
    dimensions: &[Dimension],
    set: u64,
    pairs: usize,
) -> Vec<[Point; 2]> {
    let varying = plan.varying().to_vec();
    let levels = spread(varying.len(), set, pairs);
    let correlation = plan.inputs().correlation().cloned();
    let place = |plan: &mut DifferencePlan, pair: usize, mirrored: bool| {
        let level = |position: usize| if mirrored { 1.0 - levels[position][pair] } else { levels[position][pair] };
        let levels: Vec<f64> = (0..varying.len()).map(level).collect();
        let x = values(plan, dimensions, &varying, correlation.as_ref(), &levels);
        plan.point_at(varying.iter().copied().zip(x))
    };
    (0..pairs).map(|pair| [place(plan, pair, false), place(plan, pair, true)]).collect()
}

/// Levels of the first point of each pair, for every position.
fn spread(positions: usize, set: u64, pairs: usize) -> Vec<Vec<f64>> {
    let mut levels: Vec<Vec<f64>> = Vec::with_capacity(positions);
    let mut places: Vec<Vec<f64>> = Vec::with_capacity(positions);
    for position in 0..positions {
        // Seed by position, so that the levels of a dimension do not depend on the number of dimensions after it.
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(KEY ^ (set << 48) ^ ((position as u64) << 16));
        let mut best: Option<(f64, Vec<f64>, Vec<f64>)> = None;
        for _ in 0..CANDIDATES {
            let mut strata: Vec<usize> = (0..pairs).collect();
            strata.shuffle(&mut rng);
            let level = |stratum: usize| {
                // Place the first set at the root mean square of a normal's interval, so that squares have the right mean.
                let within = match (set, stratum) {
                    (0, 0) => OUTERMOST,
                    (0, _) => 0.5,
                    _ => rng.random::<f64>().clamp(1e-3, 1.0 - 1e-3),
                };
                let low = (stratum as f64 + within) / (2 * pairs) as f64;
                if rng.random() { low } else { 1.0 - low }
            };
            let own: Vec<f64> = strata.into_iter().map(level).collect();
            let place: Vec<f64> = own.iter().map(|&level| standard_normal::quantile(level)).collect();
            let score = crowding(&place, &places[position.saturating_sub(NEIGHBOURS)..]);
            if best.as_ref().is_none_or(|(least, ..)| score < *least) {
                best = Some((score, own, place));
            }
        }
        if let Some((_, own, place)) = best {
            levels.push(own);
            places.push(place);
        }
    }
    levels
}

/// Deviation of the products with other dimensions from their expected mean 0 and mean square 1.
fn crowding(place: &[f64], others: &[Vec<f64>]) -> f64 {
    let n = place.len() as f64;
    let of = |other: &Vec<f64>| {
        let product = |power: i32| place.iter().zip(other).map(|(a, b)| (a * b).powi(power)).sum::<f64>() / n;
        product(1).powi(2) + (product(2) - 1.0).powi(2)
    };
    others.iter().map(of).sum()
}

/// Values of the dimensions at these levels of their own distributions, made dependent if they are correlated.
fn values(
    plan: &DifferencePlan,
    dimensions: &[Dimension],
    varying: &[usize],
    correlation: Option<&Correlation>,
    levels: &[f64],
) -> Vec<f64> {
    let law = |position: usize| dimensions[varying[position]].distribution().and_then(|law| law.probability());
    let sigmas = |position: usize, u: f64| {
        let dimension = &dimensions[varying[position]];
        dimension.mean() + u * dimension.sigma()
    };
    let own = |(position, &level): (usize, &f64)| match law(position) {
        Some(law) => at_level(law, level),
        None => sigmas(position, plan.inputs().shapes()[position].rule.at_level(level)),
    };
    let mut x: Vec<f64> = levels.iter().enumerate().map(own).collect();
    if let Some(correlation) = correlation {
        let members = correlation.members();
        let factor = correlation.factor();
        let mut normal = vec![0.0; levels.len()];
        members.iter().for_each(|&position| normal[position] = standard_normal::quantile(levels[position]));
        let mixed: Vec<f64> = (0..members.len())
            .map(|j| members.iter().enumerate().map(|(k, &position)| factor[(j, k)] * normal[position]).sum())
            .collect();
        members.iter().zip(mixed).for_each(|(&position, z)| normal[position] = z);
        let mut scratch = Vec::new();
        correlation.blocks().iter().for_each(|block| block.apply(&mut normal, &mut scratch));
        for (&position, transform) in members.iter().zip(correlation.transforms()) {
            let z = normal[position];
            x[position] = match (transform.is_normal(), law(position)) {
                (false, Some(law)) => at_level(law, standard_normal::cdf(z)),
                _ => sigmas(position, z),
            };
        }
    }
    x
}

fn at_level(law: &dyn Probability, level: f64) -> f64 {
    if level < 0.5 { law.quantile(level) } else { law.upper_quantile(1.0 - level) }
}
